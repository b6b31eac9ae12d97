// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A plant room that is large and full: the scene that scale is measured on.
///
/// 10 x 8 x 4 m with its walls: fifty objects, among them twenty-five runs of eight pipes each with
/// elbows, expansion loops and bolted flanges, along the walls, in racks under the ceiling, upright
/// through the room and at seven tanks. Pipe sizes, where pipes leave their run and where flanges
/// sit are drawn from the seed. Nothing of it was measured anywhere; it is like a plant room in
/// what matters here: many thin round things close together, seen from inside a closed box.
#pragma once

#include <cstdint>
#include <filesystem>

#include "vicinity/viscosity/scene.h"

namespace vicinity::benchmarks {

struct PlantRoomOptions {
  double voxel_size = 0.005;  ///< h [m]
  int segments = 64;  ///< around a pipe: 64 give 3.5 million triangles, 128 four times as many
  std::uint32_t seed = 1;
};

/// The same options give the same scene. Every mesh is closed; lengths are in metres, meshes in W.
Scene plant_room(const PlantRoomOptions& options = {});

/// Writes a scene whose meshes are in memory: one binary STL file each, and scene.yaml beside them.
/// Errors: throws Error where a file cannot be written.
void write_scene(const Scene& scene, const std::filesystem::path& folder);

}  // namespace vicinity::benchmarks
