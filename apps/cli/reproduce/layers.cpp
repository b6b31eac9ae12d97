// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/parts.h"
#include "reproduce/pass.h"

namespace vicinity::report {
namespace {

constexpr int ranks = 6;
// A cube of m = 4 reaches this far along its space diagonal.
constexpr int farthest_reach = 44;

std::string name_of(LayerShape shape, int m) {
  return fmt::format("{} m = {}", to_string(shape), m);
}

// Layers of several elements around one part, each with a section and the checks of its ranks.
struct Gallery {
  const Workshop& workshop;
  std::string item;
  Outcome outcome = {};
  std::vector<Wrapping> wrappings = {};
  std::vector<RankFit> fits = {};

  ViscosityField add(const Part& part, const ViscosityField& distances, LayerShape shape, int m,
                     int z, const std::string& says = "") {
    ViscosityField field = workshop.field(part, {.m = m, .q = ranks, .shape = shape});
    fits.push_back(rank_fit(part.name + ", " + name_of(shape, m), field, distances, m));
    wrappings.push_back({part.name, shape, m, layer_reaches(field, distances)});
    outcome.figures.push_back(section(
        workshop, fmt::format("{}/{}_{}_m{}_z{}.png", item, part.name, to_string(shape), m, z),
        field, 2, z,
        fmt::format("{}, {}, FAZ {}, z = {}", part.name, to_string(shape), 2 * m + 1, z), says));
    return field;
  }

  void write_reaches() {
    CsvTable table("part,element,m,rank,least_vox,mean_vox,most_vox");
    outcome.table = {{"part", "element", "m", "reach of rank 1", "least", "most", "reach of rank 6",
                      "least", "most"}};
    for (const Wrapping& w : wrappings) {
      for (const LayerReach& reach : w.reaches) {
        table.row(w.part, to_string(w.shape), w.m, reach.rank, reach.least, reach.mean, reach.most);
      }
      const auto number = [](double value) { return fmt::format("{:.1f}", value); };
      const LayerReach &first = w.reaches.front(), &last = w.reaches.back();
      outcome.table.push_back({w.part, to_string(w.shape), fmt::format("{}", w.m),
                               number(first.mean), number(first.least), number(first.most),
                               number(last.mean), number(last.least), number(last.most)});
    }
    outcome.data.push_back(workshop.file(item + "/reaches.csv"));
    table.write(outcome.data.back());
  }

  Outcome finished(std::vector<Check> checks) {
    checks.push_back(ranks_follow_distance(fits));
    outcome.checks = std::move(checks);
    return std::move(outcome);
  }
};

// From least to most reach of a rank, in the order of the table.
std::string spreads(const std::vector<Wrapping>& wrappings, std::size_t rank) {
  std::vector<double> values;
  for (const Wrapping& w : wrappings) values.push_back(w.reaches.at(rank - 1).spread());
  return listed(values, "{:.1f}");
}

}  // namespace

// --------------------------------------------------------------------------------------- fig. 16

namespace {

FirstNeighbours first_neighbours(const ViscosityField& field) {
  FirstNeighbours first;
  const auto record = [&](const VoxelIndex& v) { return field.records()[field.code_at(v)]; };
  const VoxelIndex& dims = field.workspace().dims;
  for (std::int32_t k = 1; k + 1 < dims.k; ++k) {
    for (std::int32_t j = 1; j + 1 < dims.j; ++j) {
      for (std::int32_t i = 1; i + 1 < dims.i; ++i) {
        const VoxelKind kind = record({i, j, k}).kind;
        if (kind == VoxelKind::boundary || kind == VoxelKind::inner) continue;
        bool beside_boundary = false;
        for (std::int32_t n = 0; n < 27; ++n) {
          beside_boundary |=
              record({i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1}).kind == VoxelKind::boundary;
        }
        const bool ranked = record({i, j, k}).rank == 1;
        first.ranked += ranked ? 1 : 0;
        first.missing += beside_boundary && !ranked ? 1 : 0;
        first.beyond += ranked && !beside_boundary ? 1 : 0;
      }
    }
  }
  return first;
}

}  // namespace

std::vector<Check> check_fig16(const FirstNeighbours& first) {
  return {{"every empty voxel of the 27 around a boundary voxel becomes rank 1",
           fmt::format("{} voxels, {} left out", first.ranked, first.missing),
           first.ranked > 0 && first.missing == 0},
          {"no other voxel does", fmt::format("{} others", first.beyond), first.beyond == 0}};
}

Outcome fig16(Workshop& workshop) {
  const Part part = cube();
  const ViscosityField once = workshop.field(part, {.m = 1, .q = 1, .shape = LayerShape::cube});
  const ViscosityField grown = workshop.field(part, {.m = 1, .q = 6, .shape = LayerShape::cube});
  const FirstNeighbours first = first_neighbours(once);
  Outcome outcome{.checks = check_fig16(first), .figures = {}};
  outcome.checks.push_back(
      ranks_follow_distance({rank_fit("six passes", grown, workshop.distances(part, 16), 1)}));
  outcome.figures = {
      section(workshop, "fig16/one_rank.png", once, 2, 30, "One pass: rank 1",
              "A layer of the cube: inner voxels, boundary voxels, and around them the neighbours "
              "of rank 1."),
      section(workshop, "fig16/six_ranks.png", grown, 2, 30, "Six passes: six graded neighbours",
              "The pass repeated on its own result.")};
  CsvTable table("rank,voxels");
  const std::vector<std::uint64_t>& counts = grown.objects().front().ranks;
  for (std::size_t n = 0; n < counts.size(); ++n) table.row(n + 1, counts[n]);
  outcome.data = {workshop.file("fig16/ranks.csv")};
  table.write(outcome.data.front());
  return outcome;
}

// ----------------------------------------------------------------------------------- fig. 17 - 19

std::vector<Check> check_fig17(const std::vector<Wrapping>& cubes) {
  bool wider = true, distorted = true;
  std::vector<double> zones;
  for (std::size_t n = 0; n < cubes.size(); ++n) {
    const LayerReach &first = cubes[n].reaches.front(), &last = cubes[n].reaches.back();
    if (n > 0 && cubes[n].part == cubes[n - 1].part) {
      wider &= last.mean > cubes[n - 1].reaches.back().mean;
    }
    distorted &= last.spread() > 2 * first.spread() && last.most > 1.3 * last.least;
    zones.push_back(last.mean);
  }
  return {{"a bigger FAZ covers a wider zone in as many layers",
           "mean reach of rank 6, as in the table: " + listed(zones, "{:.1f}") + " voxels", wider},
          {"outer layers lose the shape of the object",
           "from least to most reach of rank 1 " + spreads(cubes, 1) + ", of rank 6 " +
               spreads(cubes, ranks) + " voxels",
           distorted}};
}

Outcome fig17(Workshop& workshop) {
  Gallery gallery{workshop, "fig17"};
  for (const Part& part : {circular_cylinder(), complex_cylinder(), hollow_cylinder()}) {
    const ViscosityField distances = workshop.distances(part, farthest_reach);
    for (const int m : {2, 3, 4}) gallery.add(part, distances, LayerShape::cube, m, 40);
  }
  gallery.write_reaches();
  return gallery.finished(check_fig17(gallery.wrappings));
}

std::vector<Check> check_fig18(const std::vector<Wrapping>& pairs,
                               const std::vector<Concavity>& concavities) {
  bool same_first = true, better_last = true;
  std::string first_layers;
  for (std::size_t n = 0; n + 1 < pairs.size(); n += 2) {
    const Wrapping &cube = pairs[n], &sphere = pairs[n + 1];
    const double differ = std::abs(cube.reaches.front().mean - sphere.reaches.front().mean);
    same_first &= differ < 1;
    better_last &= sphere.reaches.back().spread() < cube.reaches.back().spread();
    first_layers += fmt::format("{}{} {:.2f}", n == 0 ? "" : ", ", cube.part, differ);
  }
  // What the contour of the third layer still shows of a concavity, as a share of its depth.
  constexpr std::size_t third = 3;
  const auto left_of = [](const Concavity& each) {
    return each.dip_by_rank.at(third) / each.depth;
  };
  bool others_open = concavities.size() > 1;
  std::string shares;
  for (std::size_t n = 1; n < concavities.size(); ++n) {
    others_open &= left_of(concavities[n]) > 0.5;
    shares += fmt::format("{}{:.0f} wide: {:.0f} %", n == 1 ? "" : ", ", concavities[n].mouth,
                          100 * left_of(concavities[n]));
  }
  const bool any = !concavities.empty();
  return {
      {"in the first layer the difference is not appreciable",
       "mean reach differs by " + first_layers + " voxels", same_first},
      {"at higher rank the sphere is truer to the shape",
       "from least to most reach of rank 6, as in the table: " + spreads(pairs, ranks) + " voxels",
       better_last},
      {"the narrow concavity A fills up",
       any ? fmt::format(
                 "{:.0f} wide, {:.0f} deep; the third layer still shows {:.0f} % of its depth",
                 concavities[0].mouth, concavities[0].depth, 100 * left_of(concavities[0]))
           : "no concavity found",
       any && left_of(concavities[0]) < 0.25},
      {"the wider concavities B to E stay open",
       "the third layer still shows of their depth: " + shares, others_open}};
}

Outcome fig18(Workshop& workshop) {
  Gallery gallery{workshop, "fig18"};
  std::vector<Concavity> found;
  for (const Part& part : {circular_cylinder(), complex_cylinder()}) {
    const ViscosityField distances = workshop.distances(part, farthest_reach);
    gallery.add(part, distances, LayerShape::cube, 2, 40);
    const ViscosityField field = gallery.add(part, distances, LayerShape::sphere, 2, 40);
    if (part.name == "complex_cylinder") {
      found =
          concavities(field, complex_cylinder_x, complex_cylinder_y, 40, complex_cylinder_radius);
    }
  }
  gallery.write_reaches();
  CsvTable table("mouth_vox,depth_vox,rank,dip_vox");
  for (const Concavity& each : found) {
    for (std::size_t n = 0; n < each.dip_by_rank.size(); ++n) {
      table.row(each.mouth, each.depth, n, each.dip_by_rank[n]);
    }
  }
  gallery.outcome.data.push_back(workshop.file("fig18/concavities.csv"));
  table.write(gallery.outcome.data.back());
  return gallery.finished(check_fig18(gallery.wrappings, found));
}

std::vector<Check> check_fig19(const std::vector<Wrapping>& spheres, std::uint64_t body_above_top,
                               std::uint64_t ranked_above_top) {
  std::vector<double> uneven;  // spread of the outermost layer as a share of its reach
  bool truer = true;
  for (std::size_t n = 0; n < spheres.size(); ++n) {
    const LayerReach& last = spheres[n].reaches.back();
    if (spheres[n].m >= 3) uneven.push_back(100 * last.spread() / last.mean);
    if (spheres[n].m < 2 || n == 0 || spheres[n].part != spheres[n - 1].part) continue;
    const LayerReach& smaller = spheres[n - 1].reaches.back();
    truer &= spheres[n].m > 3 || last.spread() / last.mean < smaller.spread() / smaller.mean;
  }
  return {
      {"six layers of m = 3 and 4 keep the shape",
       fmt::format("rank 6 reaches evenly to {} %, which should be less than 25 %",
                   listed(uneven, "{:.0f}")),
       !uneven.empty() && std::ranges::all_of(uneven, [](double percent) { return percent < 25; })},
      {"layers of m = 2 are truer than of m = 1, and of m = 3 than of m = 2",
       "from least to most reach of rank 6, as in the table: " + spreads(spheres, ranks) +
           " voxels",
       truer},
      {"above the top there are only neighbours, of the body below",
       fmt::format("{} ranked voxels and {} of a body", ranked_above_top, body_above_top),
       ranked_above_top > 0 && body_above_top == 0}};
}

Outcome fig19(Workshop& workshop) {
  Gallery gallery{workshop, "fig19"};
  constexpr int above_top = 72;
  std::uint64_t body = 0, ranked = 0;
  for (const Part& part : {circular_cylinder(), complex_cylinder(), hollow_cylinder()}) {
    const ViscosityField distances = workshop.distances(part, farthest_reach);
    for (const int m : {1, 2, 3, 4}) {
      const ViscosityField field = gallery.add(part, distances, LayerShape::sphere, m, 40);
      if (m != 4) continue;
      gallery.outcome.figures.push_back(
          section(workshop, fmt::format("fig19/{}_above_top.png", part.name), field, 2, above_top,
                  fmt::format("{}, m = 4, above the top, z = {}", part.name, above_top),
                  "The body ends at z = 60."));
      const VoxelIndex& dims = field.workspace().dims;
      for (std::int32_t j = 0; j < dims.j; ++j) {
        for (std::int32_t i = 0; i < dims.i; ++i) {
          const VoxelKind kind = field.records()[field.code_at({i, j, above_top})].kind;
          ranked += kind == VoxelKind::neighbour ? 1 : 0;
          body += kind == VoxelKind::boundary || kind == VoxelKind::inner ? 1 : 0;
        }
      }
    }
  }
  gallery.write_reaches();
  return gallery.finished(check_fig19(gallery.wrappings, body, ranked));
}

}  // namespace vicinity::report
