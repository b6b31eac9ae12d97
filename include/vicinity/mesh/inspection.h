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

/// Findings about one mesh. Edges are compared by welded vertices (equal to the last bit), and
/// without the triangles that name a vertex twice, which close nothing.
struct MeshInspection {
  enum class Verdict {
    ok,        ///< nothing to say
    usable,    ///< builds, but read the problems
    unusable,  ///< no triangle with any area
  };
  Verdict verdict = Verdict::ok;
  std::size_t triangles = 0;
  /// Every edge is shared by two triangles (or an even number, wound in pairs).
  bool closed = true;
  std::size_t shells = 0;                ///< pieces connected through shared vertices
  std::size_t open_edges = 0;            ///< edges of one triangle only, cracks included
  std::size_t holes = 0;                 ///< rims that the open edges form
  std::size_t crack_edges = 0;           ///< open edges that would close if vertices nearer than
                                         ///< 1e-5 of the bounding box diagonal were one
  std::size_t non_manifold_edges = 0;    ///< edges of more than two triangles
  std::size_t inconsistent_edges = 0;    ///< edges of two triangles that disagree on the outside
  std::size_t duplicate_triangles = 0;   ///< copies, either way round, beyond the first
  std::size_t degenerate_triangles = 0;  ///< without area, to the last bit
  Box bounds;                            ///< in the file's unit
  std::vector<MeshProblem> problems;
};

/// Inspects a mesh in linear time and memory: a second or so for a million triangles.
/// Errors: none; every index must name a vertex.
MeshInspection inspect(const TriangleMesh& mesh);

/// "ok", "usable" or "unusable".
const char* to_string(MeshInspection::Verdict verdict) noexcept;

}  // namespace vicinity
