// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "readable.h"
#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/layers.h"
#include "reproduce/parts.h"
#include "reproduce/pass.h"

namespace vicinity::report {
namespace {

constexpr int rank_count = 6;

// How far voxels of rank n or less reach from the ball's surface, along a direction.
double reach_along(const ViscosityField& field, const Vec3& direction, int n) {
  constexpr double step = 0.05;
  double reached = 0;
  for (double r = ball_radius; r < ball_centre; r += step) {
    const Vec3 p_vox = Vec3::Constant(ball_centre) + r * direction.normalized();
    const VoxelRecord record = field.at(voxel_m * p_vox).record;
    if (record.kind != VoxelKind::empty && record.rank <= n) reached = r - ball_radius;
  }
  return reached;
}

// Of all directions alike to one: the mean over signs, since a voxel belongs to its lower corner.
double reach_alike(const ViscosityField& field, const Vec3& direction, int n) {
  return (reach_along(field, direction, n) + reach_along(field, -direction, n)) / 2;
}

ElementPerformance measure(const ViscosityField& field, const ViscosityField& distances) {
  const FieldObject& object = field.objects().front();
  return {.shape = object.layers,
          .m = object.m,
          .cells = ShapingElement(object.layers, object.m).cell_count(),
          .last = layer_reaches(field, distances).back(),
          .axis = reach_alike(field, {1, 0, 0}, rank_count),
          .face_diagonal = reach_alike(field, {1, 1, 0}, rank_count),
          .space_diagonal = reach_alike(field, {1, 1, 1}, rank_count),
          .plain = visits_of_plain_loop(field),
          .ours = visits_of_frontier(field)};
}

std::vector<double> column(const std::vector<ElementPerformance>& rows, LayerShape shape,
                           double (*value)(const ElementPerformance&)) {
  std::vector<double> values;
  for (const ElementPerformance& row : rows) {
    if (row.shape == shape) values.push_back(value(row));
  }
  return values;
}

std::vector<std::vector<std::string>> as_table(const std::vector<ElementPerformance>& rows) {
  std::vector<std::vector<std::string>> table = {
      {"element", "cells", "layer thickness", "least", "most", "axis", "face diagonal",
       "space diagonal", "distortion", "redundant, plain loop", "redundant, ours",
       "cells visited, plain", "ours"}};
  for (const ElementPerformance& row : rows) {
    const auto number = [](double value) { return fmt::format("{:.2f}", value); };
    const auto percent = [](double share) { return fmt::format("{:.2f} %", 100 * share); };
    table.push_back({fmt::format("{} m = {}", to_string(row.shape), row.m),
                     fmt::format("{}", row.cells), number(row.thickness()),
                     number(row.last.least / rank_count), number(row.last.most / rank_count),
                     number(row.axis), number(row.face_diagonal), number(row.space_diagonal),
                     percent(row.distortion()), percent(row.plain.redundant()),
                     percent(row.ours.redundant()), cli::grouped(row.plain.cells),
                     cli::grouped(row.ours.cells)});
  }
  return table;
}

std::filesystem::path write(const Workshop& workshop, const std::vector<ElementPerformance>& rows) {
  CsvTable table(
      "element,m,cells,thickness_vox,least_vox,most_vox,axis_vox,face_diagonal_vox,space_diagonal_"
      "vox,distortion,plain_visits,plain_redundant,ours_visits,ours_redundant,changed");
  for (const ElementPerformance& row : rows) {
    table.row(to_string(row.shape), row.m, row.cells, row.thickness(), row.last.least / rank_count,
              row.last.most / rank_count, row.axis, row.face_diagonal, row.space_diagonal,
              row.distortion(), row.plain.cells, row.plain.redundant(), row.ours.cells,
              row.ours.redundant(), row.plain.changed);
  }
  const std::filesystem::path path = workshop.file("table1/elements.csv");
  table.write(path);
  return path;
}

}  // namespace

double ElementPerformance::distortion() const noexcept {
  return std::max(std::abs(face_diagonal / axis - 1), std::abs(space_diagonal / axis - 1));
}

std::vector<Check> check_table1(const std::vector<ElementPerformance>& rows) {
  using Row = const ElementPerformance&;
  const auto rising = [](const std::vector<double>& values) {
    return std::ranges::adjacent_find(values, std::greater_equal<>()) == values.end();
  };
  // Table 1 ends with the third size of each.
  const auto falls_to_third = [](const std::vector<double>& values) {
    return values.size() >= 3 && values[0] > values[1] && values[1] > values[2];
  };
  const auto of = [&](LayerShape shape, double (*value)(Row)) {
    return column(rows, shape, value);
  };
  const auto thickness = [](Row row) { return row.thickness(); };
  const auto distortion = [](Row row) { return 100 * row.distortion(); };
  const auto redundant = [](Row row) { return 100 * row.plain.redundant(); };
  Visits plain, ours;
  for (Row row : rows) {
    plain.cells += row.plain.cells;
    plain.changed += row.plain.changed;
    ours.cells += row.ours.cells;
    ours.changed += row.ours.changed;
  }
  const auto less = [](const std::vector<double>& a, const std::vector<double>& b) {
    bool all = a.size() == b.size();
    for (std::size_t n = 0; all && n < a.size(); ++n) all = a[n] < b[n];
    return all;
  };
  constexpr LayerShape cube = LayerShape::cube, sphere = LayerShape::sphere;
  const std::vector<double> cube_distortion = of(cube, distortion);
  return {
      {"layers grow thin, medium, wide with the FAZ, cube and sphere",
       fmt::format("{} and {} voxels a layer", listed(of(cube, thickness)),
                   listed(of(sphere, thickness))),
       rising(of(cube, thickness)) && rising(of(sphere, thickness))},
      {"a cube distorts diagonals highly, whatever its size",
       fmt::format("{} %", listed(cube_distortion, "{:.0f}")),
       std::ranges::all_of(cube_distortion, [](double percent) { return percent > 50; })},
      {"a sphere distorts less than the cube of its size",
       fmt::format("{} % against {} %", listed(of(sphere, distortion), "{:.0f}"),
                   listed(cube_distortion, "{:.0f}")),
       less(of(sphere, distortion), cube_distortion)},
      {"a sphere's distortion falls with its size",
       fmt::format("{} % for m = 1, 2, 3, ...", listed(of(sphere, distortion), "{:.0f}")),
       falls_to_third(of(sphere, distortion))},
      {"a cube's redundant computation rises with its size",
       fmt::format("{} % of visited cells change nothing", listed(of(cube, redundant), "{:.2f}")),
       rising(of(cube, redundant))},
      {"a sphere computes a smaller share in vain than the cube of its size",
       fmt::format("{} % against {} %", listed(of(sphere, redundant), "{:.2f}"),
                   listed(of(cube, redundant), "{:.2f}")),
       less(of(sphere, redundant), of(cube, redundant))},
      {"a sphere's redundant share falls with its size",
       fmt::format("{} % for m = 1, 2, 3, ...", listed(of(sphere, redundant), "{:.2f}")),
       falls_to_third(of(sphere, redundant))},
      {"ours visits fewer cells than the plain loop, with every element (not a claim of the paper)",
       fmt::format(
           "{} against {} cells over all elements, {:.1f} % against {:.1f} % of them in vain",
           cli::grouped(ours.cells), cli::grouped(plain.cells), 100 * ours.redundant(),
           100 * plain.redundant()),
       std::ranges::all_of(rows, [](Row row) { return row.ours.cells < row.plain.cells; })}};
}

Outcome table1(Workshop& workshop) {
  const Part part = ball();
  const ViscosityField distances = workshop.distances(part, 44);
  std::vector<ElementPerformance> rows;
  std::vector<RankFit> fits;
  Outcome outcome;
  cli::Chart chart_of_reach{
      .title = {},
      .caption = {},
      .x_label = "rank",
      .panels = {{"cube: reach [voxels]", {}}, {"sphere: reach [voxels]", {}}},
      .strips = {}};
  for (const LayerShape shape : {LayerShape::cube, LayerShape::sphere}) {
    for (const int m : {1, 2, 3, 4}) {
      const ViscosityField field = workshop.field(part, {.m = m, .q = rank_count, .shape = shape});
      rows.push_back(measure(field, distances));
      fits.push_back(rank_fit(fmt::format("{} m = {}", to_string(shape), m), field, distances, m));
      if (m != 3) continue;
      const std::array<std::pair<const char*, Vec3>, 3> directions{
          {{"axis", {1, 0, 0}}, {"face diagonal", {1, 1, 0}}, {"space diagonal", {1, 1, 1}}}};
      for (const auto& [name, direction] : directions) {
        cli::Series series{.name = name, .points = {}};
        for (int n = 1; n <= rank_count; ++n) {
          series.points.emplace_back(n, reach_alike(field, direction, n));
        }
        chart_of_reach.panels[shape == LayerShape::cube ? 0 : 1].series.push_back(series);
      }
      outcome.figures.push_back(
          section(workshop, fmt::format("table1/{}_m3.png", to_string(shape)), field, 2,
                  static_cast<int>(ball_centre),
                  fmt::format("Six layers of a {}, m = 3, around a ball", to_string(shape)), ""));
    }
  }
  outcome.checks = check_table1(rows);
  outcome.checks.push_back(ranks_follow_distance(fits));
  outcome.figures.insert(
      outcome.figures.begin(),
      chart(workshop, "table1/reach_by_direction.svg", chart_of_reach,
            "How far m = 3 reaches, by direction",
            "An ideal layer reaches the same in all directions: three lines in one."));
  outcome.table = as_table(rows);
  outcome.data = {write(workshop, rows)};
  return outcome;
}

}  // namespace vicinity::report
