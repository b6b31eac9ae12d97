// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// From a scene to its field: the whole build half in one call.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vicinity/viscosity/field.h"
#include "vicinity/viscosity/scene.h"

namespace vicinity {

struct BuildOptions {
  int threads = 0;  ///< 0: as many as the machine has
  /// Called now and then, from any thread but never from two at once, with the stage ("read",
  /// "rank", which is all from triangles to ranks, "merge"), and how much of the whole build is
  /// done, 0..1.
  std::function<void(std::string_view stage, double done)> progress;
};

/// What a build did, beside the field.
struct BuildReport {
  /// Wall time. Voxelising, filling and ranking go on side by side, tile by tile: their time is
  /// shared out as threads worked on each.
  struct Seconds {
    double read = 0, voxelise = 0, fill = 0, rank = 0, merge = 0, total = 0;
  } seconds;
  std::uint64_t boundary = 0, inner = 0, neighbour = 0;  ///< voxels of the finished field
  int threads = 0;
  int objects_ranked = 0;  ///< fewer than there are where a FieldBuilder had some already
  std::vector<std::string>
      remarks;  ///< sentences for the user: an open mesh, ignored coding values, ...
};

struct BuildResult {
  ViscosityField field;
  BuildReport report;
};

/// Builds the field of a scene: triangles -> boundary -> inner -> ranks -> one sparse field.
/// The result does not depend on the order of objects or triangles, nor on the number of threads.
/// Errors: throws Error for a scene that cannot be built (the sentence names the object).
BuildResult build_field(const Scene& scene, const BuildOptions& options = {});

/// Builds one scene after another, and does again only what changed: for a workplace that is edited
/// while its operator waits.
///
/// Each field is, byte for byte, what build_field() makes of its scene. An object is kept while its
/// mesh, place and layers stay the same (a mesh file: its path, size and time), and while the grid
/// does: fix Scene::bounds, or an object that moves may move the grid. Memory: all objects' voxels,
/// about as much as the field.
class FieldBuilder {
 public:
  FieldBuilder();
  ~FieldBuilder();
  FieldBuilder(FieldBuilder&&) noexcept;
  FieldBuilder& operator=(FieldBuilder&&) noexcept;

  /// As build_field(). After an error the next build starts from the last field that was built.
  BuildResult build(const Scene& scene, const BuildOptions& options = {});

 private:
  struct Kept;
  BuildResult build_in_arena(const Scene& scene, const BuildOptions& options);

  std::unique_ptr<Kept> kept_;
};

}  // namespace vicinity
