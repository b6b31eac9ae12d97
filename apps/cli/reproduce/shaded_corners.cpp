// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "picture/canvas.h"
#include "picture/rank_palette.h"
#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/parts.h"
#include "reproduce/search.h"

namespace vicinity::report {
namespace {

constexpr int mid_height = 50;  // of the pentagonal and the curved cylinder
constexpr cli::Colour shaded_colour{0.8, 0.25, 0.1}, clear_colour{0.83, 0.9, 0.95};

struct Around {
  double x, y, radius;
  int z;
};

// The closed way that zones are counted on: round the axis, just outside.
int zones_around(const std::vector<Corners>& triangles, const Around& way) {
  constexpr int steps = 3600;
  int zones = 0;
  bool before = false;
  for (int n = -1; n < steps; ++n) {
    const double angle = 2 * std::numbers::pi * (n + 0.5) / steps;
    const Vec3 p(way.x + way.radius * std::cos(angle), way.y + way.radius * std::sin(angle),
                 way.z + 0.5);
    const bool shaded = !nearest_by_projection(triangles, p).found;
    zones += n >= 0 && shaded && !before ? 1 : 0;
    before = shaded;
  }
  return zones;
}

// In the vicinity, outside the body.
bool in_vicinity(const ViscosityField& distances, const VoxelIndex& v) {
  const VoxelKind kind = distances.records()[distances.code_at(v)].kind;
  const double distance = distances.distance_vox_at(v);
  return kind == VoxelKind::neighbour && distance >= 0 && distance <= vicinity_vox;
}

ShadedCorners measure(const Part& part, const ViscosityField& field,
                      const ViscosityField& distances, const std::vector<Corners>& triangles,
                      const Around& way) {
  ShadedCorners result{.part = part.name, .zones = zones_around(triangles, way)};
  // Every other voxel along each axis: an eighth of them all.
  for (std::int32_t k = 0; k < part.dims.k; k += 2) {
    for (std::int32_t j = 0; j < part.dims.j; j += 2) {
      for (std::int32_t i = 0; i < part.dims.i; i += 2) {
        const VoxelIndex v{i, j, k};
        if (!in_vicinity(distances, v)) continue;
        const Projection found = nearest_by_projection(triangles, Vec3(i + 0.5, j + 0.5, k + 0.5));
        ++result.points;
        result.shaded += found.found ? 0 : 1;
        result.wrong += found.found && found.distance > distances.distance_vox_at(v) + 0.5 ? 1 : 0;
        result.unlabelled += field.viscosities()[field.code_at(v)] > 0 ? 0 : 1;
      }
    }
  }
  return result;
}

// The zones from above, as in the paper's fig. 8b.
Figure draw_zones(const Workshop& workshop, const Part& part, const ViscosityField& distances,
                  const std::vector<Corners>& triangles, int z) {
  constexpr int side = 6;  // pixels of a voxel
  const int width = part.dims.i, height = part.dims.j;
  const auto pixel = [](const cli::Colour& c) {
    const auto byte = [](double x) { return static_cast<std::uint32_t>(std::lround(255 * x)); };
    return byte(c.red) << 16 | byte(c.green) << 8 | byte(c.blue);
  };
  std::vector<std::uint32_t> pixels(static_cast<std::size_t>(width * height * side * side));
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const VoxelIndex v{i, j, z};
      const VoxelKind kind = distances.records()[distances.code_at(v)].kind;
      cli::Colour colour = cli::white;
      if (kind == VoxelKind::inner) colour = cli::inner_colour;
      if (kind == VoxelKind::boundary) colour = cli::boundary_colour;
      for (int n = 0; n < side * side; ++n) {
        const int column = i * side + n % side, row = (height - 1 - j) * side + n / side;
        if (in_vicinity(distances, v)) {
          const Vec3 p(i + (n % side + 0.5) / side, j + 1 - (n / side + 0.5) / side, z + 0.5);
          colour = nearest_by_projection(triangles, p).found ? clear_colour : shaded_colour;
        }
        pixels[static_cast<std::size_t>(row * width * side + column)] = pixel(colour);
      }
    }
  }
  const std::string name = "fig8/" + part.name + "_zones.png";
  const std::filesystem::path path = workshop.file(name);
  constexpr double margin = 12, key = 40;
  const double across = width * side / cli::Canvas::pixels_per_point;
  const double down = height * side / cli::Canvas::pixels_per_point;
  cli::Canvas canvas(path, across + 2 * margin, down + 2 * margin + key);
  canvas.image(margin, margin, width * side, height * side, pixels);
  canvas.outline(margin, margin, across, down, {{0.35, 0.35, 0.35}, 0.8});
  double y = margin + down + 18;
  canvas.rectangle(margin, y - 9, 16, 11, clear_colour);
  canvas.text(margin + 22, y, "some triangle's normal projection exists", 10);
  y += 18;
  canvas.rectangle(margin, y - 9, 16, 11, shaded_colour);
  canvas.text(margin + 22, y, "none does: no nearest surface is found", 10);
  canvas.write();
  return {path, part.name + " from above, z = " + std::to_string(z),
          fmt::format("The vicinity up to {:g} voxels from the surface.", vicinity_vox)};
}

}  // namespace

std::vector<Check> check_fig8(const std::vector<ShadedCorners>& parts) {
  const auto percent = [](std::uint64_t some, const ShadedCorners& of) {
    return 100 * static_cast<double>(some) / static_cast<double>(of.points);
  };
  std::string shares, zones, wrong;
  bool all_shaded = !parts.empty();
  std::uint64_t unlabelled = 0, points = 0, most_wrong = 0;
  for (const ShadedCorners& part : parts) {
    const char* const comma = shares.empty() ? "" : ", ";
    shares += fmt::format("{}{} {:.1f} %", comma, part.part, percent(part.shaded, part));
    zones += fmt::format("{}{} {}", comma, part.part, part.zones);
    wrong += fmt::format("{}{} {:.1f} %", comma, part.part, percent(part.wrong, part));
    all_shaded &= part.shaded > 0;
    unlabelled += part.unlabelled;
    points += part.points;
    most_wrong = std::max(most_wrong, part.wrong);
  }
  return {{"in shaded corners the search finds no nearest surface",
           shares + " of the points in the vicinity", all_shaded},
          {"a curved surface has numerous such zones, a pentagon few", zones + " zones around",
           parts.size() > 1 && parts[1].zones > 5 * parts[0].zones && parts[0].zones > 0},
          {"where an object has concavities, the search also finds a wrong surface",
           wrong + " of the points", most_wrong > 0},
          {"our lookup knows every point",
           fmt::format("{} of {} without viscosity", unlabelled, points),
           points > 0 && unlabelled == 0}};
}

Outcome fig8(Workshop& workshop) {
  struct Shown {
    Part part;
    Around way;
  };
  const std::vector<Shown> shown{
      {pentagonal_cylinder(), {64, 64, 24 + 8, mid_height}},
      {curved_cylinder(), {64, 64, 24 + 8, mid_height}},
      {complex_cylinder(),
       {complex_cylinder_x, complex_cylinder_y, complex_cylinder_radius + 8, 40}}};
  std::vector<ShadedCorners> results;
  Outcome outcome;
  CsvTable table("part,points,shaded,wrong,unlabelled_ours,zones");
  for (const auto& [part, way] : shown) {
    const std::vector<Corners> triangles = corners_of(workshop.read_back(part), voxel_m);
    const ViscosityField distances = workshop.distances(part, 24);
    results.push_back(measure(part, workshop.field(part, {}), distances, triangles, way));
    const ShadedCorners& r = results.back();
    table.row(r.part, r.points, r.shaded, r.wrong, r.unlabelled, r.zones);
    outcome.figures.push_back(draw_zones(workshop, part, distances, triangles, way.z));
  }
  outcome.checks = check_fig8(results);
  outcome.data = {workshop.file("fig8/shaded_corners.csv")};
  table.write(outcome.data.front());
  return outcome;
}

}  // namespace vicinity::report
