// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0
//
// From an STL file to voxels, on scans of 70 thousand and 1 million triangles, beside the plain
// way:
//
//   scripts/install_packages.sh --benchmarks
//   cmake --preset release -DVICINITY_BENCHMARKS=ON && cmake --build --preset release
//   VICINITY_DATA=../shared/data build/release/benchmarks/vicinity_mesh_benchmark > mesh.csv
//
// One line of CSV each: what, which scan, threads, milliseconds of ours and of the other, and how
// many times faster ours is. Ours and the other take turns, and the best of each counts: on a
// shared machine the best is what the program costs, the rest is what the neighbours cost. Memory
// is how far a fresh process grows at its peak, over the size of the file.

#include <sys/wait.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "scanned_mesh.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/mesh/stl_file.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/inner.h"

namespace vicinity::benchmarks {
namespace {

constexpr int turns = 5;
constexpr int thread_counts[] = {1, 2};

double milliseconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// A line for each number of threads. Without an `other` its columns stay empty.
void compare(const std::string& what, const std::string& scan, const std::function<void()>& ours,
             const std::function<void()>& other = {}) {
  std::array<double, std::size(thread_counts)> best;
  best.fill(std::numeric_limits<double>::infinity());
  double best_other = best[0];
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t n = 0; n < best.size(); ++n) {
      tbb::task_arena arena(thread_counts[n]);
      arena.execute([&] { best[n] = std::min(best[n], milliseconds(ours)); });
    }
    if (other) best_other = std::min(best_other, milliseconds(other));
  }
  for (std::size_t n = 0; n < best.size(); ++n) {
    std::printf("%s,%s,%d,%.1f,", what.c_str(), scan.c_str(), thread_counts[n], best[n]);
    if (other) std::printf("%.1f,%.2f", best_other, best_other / best[n]);
    std::printf("%s\n", other ? "" : ",");
  }
  std::fflush(stdout);
}

/// The plain way to read and weld a binary file: all of it, then a standard map of vertices.
TriangleMesh read_by_standard_map(const std::filesystem::path& path) {
  using Key = std::array<float, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::size_t h = 0;
      for (const float x : key) h = (h ^ std::bit_cast<std::uint32_t>(x)) * 0x9E3779B97F4A7C15u;
      return h ^ (h >> 32);
    }
  };
  std::vector<char> bytes(std::filesystem::file_size(path));
  std::ifstream(path, std::ios::binary)
      .read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, &bytes[80], sizeof triangles);
  TriangleMesh mesh;
  mesh.triangles.resize(triangles);
  std::unordered_map<Key, std::uint32_t, Hash> numbers;
  numbers.reserve(triangles / 2);
  for (std::size_t t = 0; t < triangles; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      Key key;
      std::memcpy(key.data(), &bytes[84 + 50 * t + 12 + 12 * c], sizeof key);
      for (float& x : key) x += 0.0f;  // -0 and 0 are one place
      const auto [at, fresh] =
          numbers.try_emplace(key, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (fresh) mesh.vertices.push_back({key[0], key[1], key[2]});
      mesh.triangles[t][c] = at->second;
    }
  }
  return mesh;
}

void write_ascii(const TriangleMesh& mesh, const std::filesystem::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) std::exit(1);
  std::fputs("solid scan\n", file);
  for (const auto& triangle : mesh.triangles) {
    std::fputs("  facet normal 0.577350269 0.577350269 0.577350269\n    outer loop\n", file);
    for (const std::uint32_t corner : triangle) {
      const Vec3& p = mesh.vertices[corner];
      std::fprintf(file, "      vertex %.9g %.9g %.9g\n", p.x(), p.y(), p.z());
    }
    std::fputs("    endloop\n  endfacet\n", file);
  }
  std::fputs("endsolid scan\n", file);
  std::fclose(file);
}

/// Peak growth of a process that reads the file, over the size of the file.
void measure_memory(const std::string& what, const std::filesystem::path& path) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    execl(program.c_str(), program.c_str(), what.c_str(), path.c_str(), nullptr);
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
}

int report_memory(const std::string& what, const std::filesystem::path& path) {
  // Not what getrusage() says, which remembers the process that started this one.
  const auto peak_kib = [] {
    std::ifstream lines("/proc/self/status");
    for (std::string word; lines >> word;) {
      double kib = 0;
      if (word == "VmHWM:" && lines >> kib) return kib;
    }
    return 0.0;
  };
  const double before = peak_kib();
  const TriangleMesh mesh = read_stl(path);
  const double grown = (peak_kib() - before) * 1024;
  std::printf("memory_of_%s,%zu triangles,,%.2f of the file,,\n", what.c_str(),
              mesh.triangles.size(), grown / static_cast<double>(std::filesystem::file_size(path)));
  return 0;
}

void measure_scan(const std::string& name, const TriangleMesh& scan,
                  const std::filesystem::path& folder) {
  const std::filesystem::path binary = folder / (name + ".stl"), ascii = folder / (name + "_a.stl");
  write_stl(scan, binary);
  write_ascii(scan, ascii);
  measure_memory("read_binary", binary);
  measure_memory("read_ascii", ascii);
  compare(
      "read_binary", name, [&] { read_stl(binary); }, [&] { read_by_standard_map(binary); });
  compare(
      "read_ascii_beside_assimp", name, [&] { read_stl(ascii); },
      [&] { Assimp::Importer().ReadFile(ascii.c_str(), 0); });
  for (const int voxels : {512, 1024}) {
    const Box bounds = scan.bounds();
    const Workspace workspace =
        Workspace::covering(bounds, bounds.sizes().maxCoeff() / static_cast<double>(voxels));
    const std::string named = name + "_" + std::to_string(voxels);
    const VoxelSet boundary = boundary_voxels(scan, workspace);
    compare("boundary", named, [&] { boundary_voxels(scan, workspace); });
    compare("inner", named, [&] { inner_voxels(scan, boundary, workspace); });
  }
}

}  // namespace
}  // namespace vicinity::benchmarks

int main(int argc, char** argv) {
  using namespace vicinity;
  if (argc == 3) return benchmarks::report_memory(argv[1], argv[2]);
  const char* data = std::getenv("VICINITY_DATA");
  const std::filesystem::path statue =
      std::filesystem::path(data == nullptr ? "" : data) / "meshes" / "clean" / "Plato.stl";
  const bool given = data != nullptr && std::filesystem::exists(statue);
  if (!given)
    std::fputs("VICINITY_DATA has no statue: a torus of our own takes its place\n", stderr);
  const TriangleMesh coarse = given ? read_mesh(statue) : primitive::torus(0.3, 0.1, 130);
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("vicinity_mesh_benchmark." + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::puts("what,scan,threads,ours_ms,other_ms,times_faster");
  for (const auto& [name, triangles] : {std::pair{"scan_70k", 68'000}, {"scan_1m", 1'000'000}}) {
    benchmarks::measure_scan(
        name, benchmarks::scanned_mesh(coarse, static_cast<std::size_t>(triangles), 1), folder);
  }
  std::filesystem::remove_all(folder);
}
