// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "peers/scans.h"

#include <cstdlib>
#include <filesystem>

#include "scanned_mesh.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity::peers {

const std::vector<Scan>& scans() {
  static const std::vector<Scan> made = [] {
    std::string name = "torus";
    TriangleMesh coarse = primitive::torus(0.3, 0.1, 128);
    if (const char* data = std::getenv("VICINITY_DATA")) {
      const auto statue = std::filesystem::path(data) / "meshes" / "clean" / "Plato.stl";
      if (exists(statue)) {
        name = "statue";
        coarse = read_mesh(statue);
      }
    }
    return std::vector<Scan>{{name + "_70k", benchmarks::scanned_mesh(coarse, 68'000, 1)},
                             {name + "_1m", benchmarks::scanned_mesh(coarse, 1'000'000, 1)}};
  }();
  return made;
}

}  // namespace vicinity::peers
