// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <tbb/task_arena.h>

#include <algorithm>

#include "named_scenes.h"
#include "peers/groups.h"
#include "peers/scans.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/layers/ranked_neighbours.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/inner.h"

namespace vicinity::peers {

void measure_cores(Report& report, const GroupOptions&) {
  using Sense = Report::Sense;
  const TriangleMesh& mesh = scans().back().mesh;
  const Box bounds = mesh.bounds();
  const Workspace workspace = Workspace::covering(bounds, bounds.sizes().maxCoeff() / 512);
  const VoxelSet boundary = boundary_voxels(mesh, workspace);
  const VoxelSet inner = inner_voxels(mesh, boundary, workspace);
  const ShapingElement sphere(LayerShape::sphere, benchmarks::layers_m);
  const Scene cell = benchmarks::hot_cell();
  const std::pair<const char*, std::function<void()>> stages[] = {
      {"voxelise", [&] { boundary_voxels(mesh, workspace); }},
      {"fill", [&] { inner_voxels(mesh, boundary, workspace); }},
      {"rank", [&] { ranked_neighbours(boundary, inner, sphere, benchmarks::layers_q); }},
      {"distance",
       [&] {
         distance_layers(mesh, boundary, inner, workspace, benchmarks::layers_m,
                         benchmarks::layers_q);
       }},
      {"whole build", [&] { build_field(cell, {.threads = 1, .progress = {}}); }},
  };
  for (const auto& [name, stage] : stages) {
    std::vector<Way> ways;
    for (const int threads : {1, 2}) {
      ways.push_back({std::string(name) + ", " + std::to_string(threads) + " threads",
                      [&stage = stage, threads] {
                        tbb::task_arena arena(threads);
                        arena.execute(stage);
                      },
                      5});
    }
    if (std::string_view(name) == "whole build") {
      ways[1].run = [&] { build_field(cell, {.threads = 2, .progress = {}}); };
    }
    const std::vector<Timing> t = side_by_side(ways);
    const std::string subject =
        std::string_view(name) == "whole build" ? "hot cell at 4 mm" : scans().back().name;
    report.timings("cores", subject, t);
    report.target(std::string("two cores: times one core, ") + name, Sense::at_least, 1.8,
                  t[0].wall / t[1].wall, subject);
  }

  const ViscosityField one = build_field(cell, {.threads = 1, .progress = {}}).field;
  const ViscosityField two = build_field(cell, {.threads = 2, .progress = {}}).field;
  const bool same = std::ranges::equal(one.image(), two.image());
  report.target("two cores: fields that are byte for byte the same", Sense::at_least, 1,
                same ? 1 : 0, "hot cell at 4 mm");
}

}  // namespace vicinity::peers
