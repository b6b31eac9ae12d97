// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What is wrong with a mesh, and what that means for the build.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

/// One kind of trouble.
struct MeshProblem {
  std::string what;   ///< "open edges", "duplicate triangles", ...
  std::size_t count;  ///< how many
  std::string means;  ///< what it does to the build, as a sentence
};

/// Findings about one mesh. Edges are compared by welded vertices (equal to the last bit).
struct MeshInspection {
  enum class Verdict {
    ok,        ///< nothing to say
    usable,    ///< builds, but read the problems
    unusable,  ///< no triangle with any extent
  };
  Verdict verdict = Verdict::ok;
  std::size_t triangles = 0;
  bool closed =
      true;  ///< every edge is shared by two triangles (or an even number, wound in pairs)
  std::size_t shells = 0;                 ///< pieces connected through shared vertices
  std::size_t open_edges = 0, holes = 0;  ///< edges of one triangle; loops they form
  std::size_t non_manifold_edges = 0, inconsistent_edges = 0;
  std::size_t duplicate_triangles = 0, degenerate_triangles = 0;
  Box bounds;  ///< in the file's unit
  std::vector<MeshProblem> problems;
};

MeshInspection inspect(const TriangleMesh& mesh);

/// "ok", "usable" or "unusable".
const char* to_string(MeshInspection::Verdict verdict) noexcept;

}  // namespace vicinity
