// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <assimp/postprocess.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <assimp/Importer.hpp>
#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <unordered_map>

#include "peers/groups.h"
#include "peers/scans.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/stl_file.h"

namespace vicinity::peers {
namespace {

void write_ascii(const TriangleMesh& mesh, const std::filesystem::path& path) {
  std::ofstream file(path);
  file << "solid scan\n";
  for (const auto& t : mesh.triangles) {
    file << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) {
      const Vec3& p = mesh.vertices[v];
      file << fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
    }
    file << "endloop\nendfacet\n";
  }
  file << "endsolid scan\n";
  if (!file.flush()) throw Error({.where = path.string(), .what = "cannot be written"});
}

/// The plain way: the whole file at once, and a hash map from vertex to number.
std::size_t read_through_hash_map(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes(static_cast<std::size_t>(std::filesystem::file_size(path)));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  std::uint32_t count;
  std::memcpy(&count, &bytes[80], sizeof(count));
  using Corner = std::array<float, 3>;
  struct Hash {
    std::size_t operator()(const Corner& c) const noexcept {
      std::size_t h = 0;
      for (const float x : c) {
        h ^= std::hash<float>{}(x) + 0x9e3779b97f4a7c15u + (h << 6) + (h >> 2);
      }
      return h;
    }
  };
  std::unordered_map<Corner, std::uint32_t, Hash> numbers;
  TriangleMesh mesh;
  for (std::uint32_t t = 0; t < count; ++t) {
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      Corner corner;
      std::memcpy(&corner, &bytes[84 + t * std::size_t{50} + 12 + 12 * c], sizeof(corner));
      const auto [found, is_new] =
          numbers.try_emplace(corner, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.emplace_back(corner[0], corner[1], corner[2]);
      triangle[c] = found->second;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh.vertices.size();
}

void read_by_assimp(const std::filesystem::path& path, unsigned steps) {
  Assimp::Importer importer;
  if (importer.ReadFile(path.string(), steps) == nullptr) {
    throw Error({.where = path.string(), .what = importer.GetErrorString()});
  }
}

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Peak memory of reading, from a process of its own that the shell forks for: one that the shell
/// became would inherit our own peak.
double memory_of_reading(const std::filesystem::path& path) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  const std::string command =
      fmt::format("'{}' --memory-of-reading '{}'; exit $?", program.string(), path.string());
  double bytes = -1;
  if (FILE* const pipe = popen(command.c_str(), "r")) {
    if (std::fscanf(pipe, "%lf", &bytes) != 1) bytes = -1;
    pclose(pipe);
  }
  if (bytes < 0)
    throw Error({.where = path.string(), .what = "could not be read in a child process"});
  return bytes;
}

}  // namespace

int print_memory_of_reading(const std::filesystem::path& stl) {
  const double before = peak_bytes();
  const TriangleMesh mesh = read_stl(stl);
  std::printf("%.0f\n", mesh.triangles.empty() ? -1 : peak_bytes() - before);
  return 0;
}

void measure_stl(Report& report, const GroupOptions& options) {
  using Sense = Report::Sense;
  const Scan& scan = scans().back();
  const auto binary = options.scratch / "scan.stl", ascii = options.scratch / "scan_ascii.stl";
  write_stl(scan.mesh, binary);
  write_ascii(scan.mesh, ascii);
  const std::vector<Timing> t = side_by_side({
      {"ours, binary", [&] { read_stl(binary); }, 5},
      {"whole file and std::unordered_map, binary", [&] { read_through_hash_map(binary); }, 3},
      {"assimp, vertices joined, binary",
       [&] { read_by_assimp(binary, aiProcess_JoinIdenticalVertices); }, 1},
      {"ours, ASCII", [&] { read_stl(ascii); }, 3},
      {"assimp as it comes, ASCII", [&] { read_by_assimp(ascii, 0); }, 3},
  });
  report.timings("stl", scan.name, t);
  report.target("STL, binary: times a standard hash map", Sense::at_least, 4, t[1].wall / t[0].wall,
                scan.name);
  report.target("STL, ASCII: times assimp", Sense::at_least, 2, t[4].wall / t[3].wall, scan.name);
  report.target("STL, binary: peak memory, times the file", Sense::at_most, 3,
                memory_of_reading(binary) / static_cast<double>(std::filesystem::file_size(binary)),
                scan.name);
}

}  // namespace vicinity::peers
