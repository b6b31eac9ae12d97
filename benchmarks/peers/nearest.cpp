// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <cstdio>
#include <fstream>
#include <random>
#include <vector>

#include "named_scenes.h"
#include "peers/distance_peers.h"
#include "peers/groups.h"
#include "reproduce/nearest_surface.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/inner.h"

namespace vicinity::peers {
namespace {

/// Seconds of scipy's transform and dilations; nothing without scipy.
std::vector<Timing> scipy(const VoxelSet& boundary, const VoxelIndex& dims,
                          const std::filesystem::path& scratch) {
  std::vector<char> bytes(static_cast<std::size_t>(dims.i) * static_cast<std::size_t>(dims.j) *
                          static_cast<std::size_t>(dims.k));
  const VoxelBox box{{0, 0, 0}, dims};
  boundary.for_each([&](const VoxelIndex& v) {
    if (!box.contains(v)) return;
    bytes[(static_cast<std::size_t>(v.k) * static_cast<std::size_t>(dims.j) +
           static_cast<std::size_t>(v.j)) *
              static_cast<std::size_t>(dims.i) +
          static_cast<std::size_t>(v.i)] = 1;
  });
  const auto path = scratch / "boundary.u8";
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
  // Debian's own Python: another one may come first on the path, and has no scipy.
  const std::string command =
      fmt::format("/usr/bin/python3 '{}' '{}' {} {} {} {} {}", VICINITY_SCIPY_LAYERS, path.string(),
                  dims.i, dims.j, dims.k, benchmarks::layers_m, benchmarks::layers_q);
  double transform = 0, dilations = 0;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  const bool read = std::fscanf(pipe, "%lf %lf", &transform, &dilations) == 2;
  pclose(pipe);
  if (!read) return {};
  return {{"scipy distance_transform_edt", transform, transform, 1},
          {"scipy binary_dilation by a ball", dilations, dilations, 1}};
}

}  // namespace

void measure_nearest(Report& report, const GroupOptions& options) {
  constexpr int length = 256;
  constexpr std::size_t lookups = 1 << 18, searches = 1 << 11;
  constexpr int farthest = benchmarks::layers_m * benchmarks::layers_q;
  const auto& object = benchmarks::named_objects(length).back();
  const Workspace& workspace = object.workspace;
  const VoxelSet boundary = boundary_voxels(object.mesh, workspace);
  const VoxelSet inner = inner_voxels(object.mesh, boundary, workspace);
  Scene scene;
  scene.voxel_size = workspace.voxel_size;
  scene.bounds =
      Box(workspace.origin,
          workspace.origin +
              workspace.voxel_size * Vec3(workspace.dims.i, workspace.dims.j, workspace.dims.k));
  scene.objects.push_back({.name = object.name, .shape = object.mesh});
  const ViscosityField ranked = build_field(scene).field;
  scene.objects[0].layers = LayerShape::distance;
  const ViscosityField kept = build_field(scene).field;

  std::mt19937 random(1);
  std::vector<Vec3> points;
  std::vector<VoxelIndex> voxels;
  while (points.size() < lookups) {
    const auto below = [&](std::int32_t n) {
      return n * static_cast<double>(random()) / 4294967296.0;
    };
    const Vec3 grid(below(workspace.dims.i), below(workspace.dims.j), below(workspace.dims.k));
    const VoxelIndex v{static_cast<int>(grid.x()), static_cast<int>(grid.y()),
                       static_cast<int>(grid.z())};
    if (ranked.records()[ranked.code_at(v)].kind != VoxelKind::neighbour) continue;
    points.push_back(workspace.origin + workspace.voxel_size * grid);
    voxels.push_back(v);
  }
  const std::span<const Vec3> few = std::span(points).first(searches);

  const FclDistance fcl(object.mesh);
  const CgalDistance cgal(object.mesh);
  const report::TriangleTree embree(report::corners_of(object.mesh, 1));
  const DynamicEdt dynamic(boundary, workspace.dims, farthest);
  double sum = 0;
  const auto all_at = [&](const ViscosityField& field) {
    return [&] {
      for (const Vec3& p : points) sum += field.at(p).viscosity;
    };
  };
  report.timings("nearest", object.name + ", a point of the layers",
                 side_by_side({{"ours, ranks: field.at()", all_at(ranked)},
                               {"ours, distance, interpolated: field.at()", all_at(kept)},
                               {"dynamicEDT3D getDistance", [&] { sum += dynamic.sum(voxels); }}}),
                 lookups);
  report.timings("nearest", object.name + ", a point of the layers",
                 side_by_side({{"Embree point query",
                                [&] {
                                  for (const Vec3& p : few) sum += embree.nearest(p).distance;
                                }},
                               {"CGAL AABB tree", [&] { sum += cgal.sum(few); }, 3},
                               {"FCL distance", [&] { sum += fcl.sum(few); }, 3}}),
                 searches);
  const ShapingElement sphere(LayerShape::sphere, benchmarks::layers_m);
  report.timings("nearest", object.name + ", all layers",
                 side_by_side({{"ours, ranks, 1 thread",
                                [&] {
                                  tbb::task_arena arena(1);
                                  arena.execute([&] {
                                    ranked_neighbours(boundary, inner, sphere,
                                                      benchmarks::layers_q);
                                  });
                                }},
                               {"ours, distance, 1 thread",
                                [&] {
                                  tbb::task_arena arena(1);
                                  arena.execute([&] {
                                    distance_layers(object.mesh, boundary, inner, workspace,
                                                    benchmarks::layers_m, benchmarks::layers_q);
                                  });
                                }},
                               {"dynamicEDT3D, up to the last rank",
                                [&] { DynamicEdt(boundary, workspace.dims, farthest); }, 1}}));
  report.timings("nearest", object.name + ", all layers",
                 scipy(boundary, workspace.dims, options.scratch));
  asm volatile("" : : "x"(sum) : "memory");
}

}  // namespace vicinity::peers
