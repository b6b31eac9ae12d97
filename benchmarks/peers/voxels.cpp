// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "peers/groups.h"
#include "peers/openvdb_peer.h"
#include "peers/scans.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/inner.h"

namespace vicinity::peers {

void measure_voxels(Report& report, const GroupOptions&) {
  using Sense = Report::Sense;
  const auto ours = [](int threads, const TriangleMesh& mesh, const Workspace& workspace) {
    return [=, &mesh, &workspace] {
      tbb::task_arena arena(threads);
      arena.execute([&] { inner_voxels(mesh, boundary_voxels(mesh, workspace), workspace); });
    };
  };
  for (const Scan& scan : scans()) {
    const Box bounds = scan.mesh.bounds();
    for (const int length : {512, 1024}) {
      const Workspace workspace = Workspace::covering(bounds, bounds.sizes().maxCoeff() / length);
      const std::string subject = fmt::format("{} at {}", scan.name, length);
      const std::vector<Timing> t = side_by_side({
          {"ours, 1 thread", ours(1, scan.mesh, workspace), 3},
          {"ours, 2 threads", ours(2, scan.mesh, workspace), 5},
          {"OpenVDB meshToVolume and interior, 2 threads",
           [&] {
             tbb::task_arena arena(2);
             arena.execute([&] { openvdb_voxels(scan.mesh, workspace); });
           },
           1},
      });
      report.timings("voxels", subject, t);
      report.target("voxels: times OpenVDB's meshToVolume", Sense::at_least, 10,
                    t[2].wall / t[1].wall, subject);
    }
  }
  report.not_measured("voxels: times the best CPU voxeliser", Sense::at_least, 3,
                      "none is packaged: docs/performance.md");
}

}  // namespace vicinity::peers
