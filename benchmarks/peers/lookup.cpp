// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

#include "named_scenes.h"
#include "peers/dense_codes.h"
#include "peers/groups.h"
#include "peers/openvdb_peer.h"
#include "plant_room/plant_room.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity::peers {
namespace {

constexpr std::size_t lookups = 1 << 20;

/// Voxels to look up in a field.
class Walks {
 public:
  explicit Walks(const ViscosityField& field) : field_(field), random_(1) {}

  std::vector<VoxelIndex> anywhere() {
    std::vector<VoxelIndex> voxels(lookups);
    for (VoxelIndex& v : voxels) v = one();
    return voxels;
  }

  /// Straight lines through the room, a voxel at a time, as a point of an arm goes.
  std::vector<VoxelIndex> lines() {
    std::vector<VoxelIndex> voxels;
    for (VoxelIndex a = one(); voxels.size() < lookups;) {
      const VoxelIndex b = one();
      const int steps =
          std::max({std::abs(b.i - a.i), std::abs(b.j - a.j), std::abs(b.k - a.k), 1});
      for (int s = 0; s < steps && voxels.size() < lookups; ++s) {
        voxels.push_back({a.i + (b.i - a.i) * s / steps, a.j + (b.j - a.j) * s / steps,
                          a.k + (b.k - a.k) * s / steps});
      }
      a = b;
    }
    return voxels;
  }

  /// Anywhere in the ranked layers.
  std::vector<VoxelIndex> band() {
    std::vector<VoxelIndex> voxels;
    while (voxels.size() < lookups) {
      const VoxelIndex v = one();
      if (field_.records()[field_.code_at(v)].kind == VoxelKind::neighbour) voxels.push_back(v);
    }
    return voxels;
  }

 private:
  VoxelIndex one() {
    const VoxelIndex d = field_.workspace().dims;
    return {below(d.i), below(d.j), below(d.k)};
  }
  std::int32_t below(std::int32_t n) {
    return static_cast<std::int32_t>(random_() % static_cast<std::uint32_t>(n));
  }

  const ViscosityField& field_;
  std::mt19937 random_;
};

void look(Report& report, const std::string& scene, const ViscosityField& field,
          const VdbCodes* vdb) {
  using Sense = Report::Sense;
  Walks walks(field);
  const std::pair<std::string, std::vector<VoxelIndex>> kinds[] = {
      {"coherent", walks.lines()}, {"random", walks.anywhere()}, {"band", walks.band()}};
  const DenseCodes usual(field, DenseCodes::Pages::usual);
  const DenseCodes huge(usual, DenseCodes::Pages::huge);
  std::uint64_t sum = 0;
  double vdb_sum = 0;
  std::vector<VoxelCode> codes(lookups);
  std::vector<std::uint8_t> bytes(lookups);
  for (const auto& [kind, points] : kinds) {
    const std::vector<VoxelIndex>& voxels = points;
    std::vector<Way> ways = {
        {"ours, one by one",
         [&] {
           for (const VoxelIndex& v : voxels) sum += field.code_at(v);
         }},
        {"ours, many at once", [&] { field.codes_at(voxels, codes); }},
        {"dense bytes, one by one",
         [&] {
           for (const VoxelIndex& v : voxels) sum += usual.at(v);
         }},
        {"dense bytes in huge pages, one by one",
         [&] {
           for (const VoxelIndex& v : voxels) sum += huge.at(v);
         }},
        {"dense bytes in huge pages, prefetched", [&] { huge.at(voxels, bytes.data()); }},
    };
    if (vdb != nullptr) {
      ways.push_back({"NanoVDB accessor", [&] { vdb_sum += vdb->nanovdb_sum(voxels); }});
      ways.push_back({"OpenVDB accessor", [&] { vdb_sum += vdb->openvdb_sum(voxels); }});
    }
    for (Way& way : ways) way.runs = 9;
    const std::vector<Timing> t = side_by_side(ways);
    const std::string subject = scene + ", " + kind;
    report.timings("lookup", subject, t, lookups);
    // One thread that waits for nothing: its processor time is what it takes, on a busy machine
    // too.
    if (kind == "coherent") {
      report.target("lookup, coherent, one by one: cost, in dense arrays", Sense::at_most, 1.3,
                    t[0].cpu / t[2].cpu, scene);
      report.target("lookup, coherent, at once: cost, in dense arrays (huge pages)", Sense::at_most,
                    1.3, t[1].cpu / t[4].cpu, scene);
    } else if (kind == "random") {
      report.target("lookup, random, one by one: times a dense array", Sense::at_least, 1,
                    t[2].cpu / t[0].cpu, scene);
      report.target("lookup, random, at once: times a dense array (huge pages)", Sense::at_least, 1,
                    t[4].cpu / t[1].cpu, scene);
    } else if (vdb != nullptr) {
      report.target("lookup, band, one by one: times NanoVDB's accessor", Sense::at_least, 4,
                    t[5].cpu / t[0].cpu, scene);
      report.target("lookup, band, at once: times NanoVDB's accessor", Sense::at_least, 4,
                    t[5].cpu / t[1].cpu, scene);
    }
  }
  // The compiler must believe that somebody reads what was looked up.
  asm volatile("" : : "r"(sum), "x"(vdb_sum), "r"(codes.data()), "r"(bytes.data()) : "memory");
}

}  // namespace

void measure_lookup(Report& report, const GroupOptions&) {
  {
    const ViscosityField cell = build_field(benchmarks::hot_cell()).field;
    const VdbCodes vdb(cell);
    look(report, "hot cell at 4 mm", cell, &vdb);
  }
  // Half a gigabyte when dense: far beyond every cache.
  look(report, "plant room at 8 mm",
       build_field(benchmarks::plant_room({.voxel_size = 0.008})).field, nullptr);
}

}  // namespace vicinity::peers
