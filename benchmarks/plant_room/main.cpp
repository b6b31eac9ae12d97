// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the plant room as STL files and a scene:
//
//   plant_room FOLDER [voxel size in m] [segments around a pipe] [seed]

#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <numeric>
#include <variant>

#include "plant_room/plant_room.h"

namespace {

constexpr const char* usage =
    "plant_room FOLDER [voxel size in m] [segments around a pipe] [seed]\n";

template <class T>
bool reads(const char* text, T& value) {
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), value);
  return error == std::errc() && *end == 0;
}

}  // namespace

int main(int argc, char** argv) {
  for (int n = 1; n < argc; ++n) {
    if (argv[n][0] != '-') continue;
    std::fprintf(stderr, "plant_room: %s: there are no options; try %s", argv[n], usage);
    return 2;
  }
  vicinity::benchmarks::PlantRoomOptions options;
  if (argc < 2 || argc > 5 || (argc > 2 && !reads(argv[2], options.voxel_size)) ||
      (argc > 3 && !reads(argv[3], options.segments)) ||
      (argc > 4 && !reads(argv[4], options.seed))) {
    std::fputs(usage, stderr);
    return 2;
  }
  try {
    const vicinity::Scene scene = vicinity::benchmarks::plant_room(options);
    const std::size_t triangles =
        std::accumulate(scene.objects.begin(), scene.objects.end(), std::size_t{0},
                        [](std::size_t n, const auto& o) {
                          return n + std::get<vicinity::TriangleMesh>(o.shape).triangles.size();
                        });
    vicinity::benchmarks::write_scene(scene, argv[1]);
    std::fprintf(stderr, "%zu objects, %zu triangles\n", scene.objects.size(), triangles);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "plant_room: %s\n", e.what());
    return 2;
  }
}
