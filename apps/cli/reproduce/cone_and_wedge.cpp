// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>

#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/layers.h"
#include "reproduce/parts.h"

namespace vicinity::report {

std::vector<Check> check_fig20(const std::vector<ConeSection>& sections) {
  bool shrink = true, round = true, thicker = true;
  std::string radii;  // by m
  int last_m = 0;
  double worst = 0;
  for (std::size_t n = 0; n < sections.size(); ++n) {
    const auto [least, most] = std::ranges::minmax(sections[n].radii);
    const auto mean = [&](const ConeSection& s) {
      double sum = 0;
      for (const double r : s.radii) sum += r;
      return sum / static_cast<double>(s.radii.size());
    };
    // The paper shows horizontal sections of m = 2 and 4.
    if (sections[n].m % 2 == 0) {
      worst = std::max(worst, (most - least) / mean(sections[n]));
      round &= most - least < 0.15 * mean(sections[n]);
    }
    if (n > 0 && sections[n].m == sections[n - 1].m) {
      shrink &= mean(sections[n]) < mean(sections[n - 1]);
    }
    for (const ConeSection& other : sections) {
      if (other.z == sections[n].z && other.m > sections[n].m) {
        thicker &= mean(other) > mean(sections[n]) + other.m - sections[n].m;
      }
    }
    radii += sections[n].m == last_m ? ", "
                                     : fmt::format("{}m = {}: ", n == 0 ? "" : "; ", sections[n].m);
    radii += fmt::format("{:.1f}", mean(sections[n]));
    last_m = sections[n].m;
  }
  return {
      {"sections shrink towards the apex",
       "mean radius of rank 6 at growing height, " + radii + " voxels", shrink},
      {"a larger sphere covers a wider zone", "as above", thicker},
      {"layers stay round",
       fmt::format("the radius of a section of m = 2 or 4 varies by {:.0f} % at most", 100 * worst),
       round}};
}

Outcome fig20(Workshop& workshop) {
  const Part part = cone();
  const ViscosityField distances = workshop.distances(part, 32);
  Outcome outcome;
  std::vector<ConeSection> sections;
  std::vector<RankFit> fits;
  CsvTable table("m,z,degree,radius_vox");
  for (const int m : {1, 2, 3, 4}) {
    const ViscosityField field = workshop.field(part, {.m = m, .q = 6});
    fits.push_back(rank_fit(fmt::format("sphere m = {}", m), field, distances, m));
    outcome.figures.push_back(section(workshop, fmt::format("fig20/vertical_m{}.png", m), field, 1,
                                      static_cast<int>(cone_axis),
                                      fmt::format("Through the apex, sphere m = {}", m), ""));
    for (const int z : {20, 27, 33, 40}) {
      sections.push_back({m, z, contour(field, cone_axis, cone_axis, z, 6)});
      for (std::size_t degree = 0; degree < sections.back().radii.size(); ++degree) {
        table.row(m, z, degree, sections.back().radii[degree]);
      }
      if (m != 2 && m != 4) continue;
      outcome.figures.push_back(
          section(workshop, fmt::format("fig20/horizontal_m{}_z{}.png", m, z), field, 2, z,
                  fmt::format("Horizontal, sphere m = {}, z = {}", m, z), ""));
    }
  }
  outcome.checks = check_fig20(sections);
  outcome.checks.push_back(ranks_follow_distance(fits));
  outcome.data = {workshop.file("fig20/contours_of_rank_6.csv")};
  table.write(outcome.data.front());
  return outcome;
}

std::vector<Check> check_fig21(const std::vector<std::uint64_t>& by_rank, std::uint64_t unequal) {
  std::uint64_t all = 0;
  for (const std::uint64_t count : by_rank) all += count;
  return {{"seven layers form around the wedge, and none is empty",
           fmt::format("{} voxels of rank 1 to {}", fmt::join(by_rank, ", "), by_rank.size()),
           by_rank.size() == 7 && std::ranges::none_of(by_rank, [](auto n) { return n == 0; })},
          {"both flanks of the V are wrapped alike",
           fmt::format("{} of {} voxels differ from their mirror image", unequal, all),
           100 * unequal < all}};
}

Outcome fig21(Workshop& workshop) {
  const Part part = wedge();
  constexpr int q = 7, m = 3;
  const ViscosityField field =
      workshop.field(part, {.m = m, .q = q, .coding = named_coding("linear", q)});
  std::uint64_t unequal = 0;
  const VoxelIndex& dims = field.workspace().dims;
  for (std::int32_t k = 0; k < dims.k; ++k) {
    for (std::int32_t j = 0; j < dims.j; ++j) {
      for (std::int32_t i = 0; i <= wedge_mirror; ++i) {
        unequal += field.code_at({i, j, k}) != field.code_at({wedge_mirror - i, j, k}) ? 1 : 0;
      }
    }
  }
  Outcome outcome{.checks = check_fig21(field.objects().front().ranks, unequal), .figures = {}};
  outcome.checks.push_back(
      ranks_follow_distance({rank_fit("the wedge", field, workshop.distances(part, 28), m)}));
  constexpr int above_junction = 60;
  outcome.figures = {
      section(workshop, "fig21/seen_from_x.png", field, 0, 64, "As seen from x",
              "Through the bottom of the V: the block is as high as its junction here."),
      section(workshop, "fig21/seen_from_z.png", field, 2, above_junction,
              fmt::format("As seen along z, z = {}", above_junction),
              "Above the junction of the V: two flanks, and layers between them."),
      section(workshop, "fig21/seen_from_y.png", field, 1, 64, "As seen from y",
              "The V narrows downwards, and its layers with it.")};
  CsvTable table("rank,voxels");
  const std::vector<std::uint64_t>& counts = field.objects().front().ranks;
  for (std::size_t n = 0; n < counts.size(); ++n) table.row(n + 1, counts[n]);
  outcome.data = {workshop.file("fig21/ranks.csv")};
  table.write(outcome.data.front());
  return outcome;
}

}  // namespace vicinity::report
