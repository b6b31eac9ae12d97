// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/voxelisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/parts.h"

namespace vicinity::report {
namespace {

const Layers body_only{.m = 1, .q = 0};

VoxelKind kind_at(const ViscosityField& field, int i, int j, int k) {
  return field.records()[field.code_at({i, j, k})].kind;
}

// Whether a walk through empty voxels of the section, from its corner, meets an inner one.
bool inner_is_enclosed(const ViscosityField& field, int z) {
  const int width = field.workspace().dims.i, height = field.workspace().dims.j;
  std::vector<bool> seen(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<std::pair<int, int>> next{{0, 0}};
  while (!next.empty()) {
    const auto [i, j] = next.back();
    next.pop_back();
    if (i < 0 || j < 0 || i >= width || j >= height) continue;
    const auto n =
        static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
    const VoxelKind kind = kind_at(field, i, j, z);
    if (kind == VoxelKind::inner) return false;
    if (seen[n] || kind == VoxelKind::boundary) continue;
    seen[n] = true;
    next.insert(next.end(), {{i + 1, j}, {i - 1, j}, {i, j + 1}, {i, j - 1}});
  }
  return true;
}

// A regular polygon of so many corners, inscribed.
double polygon_area(double radius, int corners) {
  return 0.5 * corners * radius * radius * std::sin(2 * std::numbers::pi / corners);
}

double off(double measured, double truth) { return measured / truth - 1; }

std::filesystem::path write_sections(const Workshop& workshop, const std::string& file,
                                     const std::vector<BodySection>& sections) {
  CsvTable table("z,boundary,inner,area_vox2,true_area_vox2");
  for (const BodySection& s : sections) table.row(s.z, s.boundary, s.inner, s.area(), s.true_area);
  const std::filesystem::path path = workshop.file(file);
  table.write(path);
  return path;
}

}  // namespace

BodySection body_section(const ViscosityField& field, int z, double true_area) {
  BodySection s{.z = z, .closed = inner_is_enclosed(field, z), .true_area = true_area};
  for (int j = 0; j < field.workspace().dims.j; ++j) {
    for (int i = 0; i < field.workspace().dims.i; ++i) {
      s.boundary += kind_at(field, i, j, z) == VoxelKind::boundary ? 1 : 0;
      s.inner += kind_at(field, i, j, z) == VoxelKind::inner ? 1 : 0;
    }
  }
  return s;
}

// ---------------------------------------------------------------------------------------- fig. 9

std::vector<Check> check_fig9(const BodySection& top, const BodySection& intermediate) {
  return {
      {"the top layer is surface voxels only",
       fmt::format("{} boundary, {} inner", top.boundary, top.inner),
       top.boundary > 0 && top.inner == 0},
      {"an intermediate layer is a closed contour of surface voxels around body voxels",
       fmt::format("{} boundary, {} inner, {}", intermediate.boundary, intermediate.inner,
                   intermediate.closed ? "closed" : "open"),
       intermediate.closed && intermediate.inner > intermediate.boundary},
      {"its area is the cylinder's",
       fmt::format("{:.1f} voxels, in truth {:.1f}", intermediate.area(), intermediate.true_area),
       std::abs(off(intermediate.area(), intermediate.true_area)) < 0.02}};
}

Outcome fig9(Workshop& workshop) {
  const Part part = circular_cylinder();
  const ViscosityField field = workshop.field(part, body_only);
  const double area = polygon_area(20, 128);
  const BodySection top = body_section(field, 60, area), middle = body_section(field, 40, area);
  Outcome outcome{.checks = check_fig9(top, middle), .figures = {}};
  const Box close(Vec3(40, 40, 0), Vec3(88, 88, 96));
  outcome.figures = {section(workshop, "fig9/top_layer.png", field, 2, 60, "Top layer, z = 60",
                             "Triangles of the lid pass through all of it.", close),
                     section(workshop, "fig9/intermediate_layer.png", field, 2, 40,
                             "Intermediate layer, z = 40", "A closed contour, filled.", close)};
  outcome.data = {write_sections(workshop, "fig9/sections.csv", {middle, top})};
  return outcome;
}

// --------------------------------------------------------------------------------------- fig. 12

std::vector<Check> check_fig12(const std::vector<BodyVolume>& volumes) {
  std::vector<Check> checks;
  for (const BodyVolume& v : volumes) {
    checks.push_back({"the voxels of the " + v.part + " fill its volume",
                      fmt::format("{} boundary, {} inner: {:.0f} voxels, in truth {:.0f}",
                                  v.boundary, v.inner, v.volume(), v.true_volume),
                      v.inner > 0 && std::abs(off(v.volume(), v.true_volume)) < 0.03});
  }
  return checks;
}

Outcome fig12(Workshop& workshop) {
  const double height = wedge_top - wedge_bottom;
  const std::vector<std::pair<Part, double>> parts{
      {wedge(), 60 * (60 * height - 0.5 * wedge_mouth * wedge_v_depth)}, {cube(), 20 * 20 * 20}};
  std::vector<BodyVolume> volumes;
  Outcome outcome;
  CsvTable table("part,boundary,inner,volume_vox3,true_volume_vox3");
  for (const auto& [part, truth] : parts) {
    const ViscosityField field = workshop.field(part, body_only);
    const VoxelCounts& counts = field.voxel_counts();
    volumes.push_back({part.name, counts.boundary, counts.inner, truth});
    table.row(part.name, counts.boundary, counts.inner, volumes.back().volume(), truth);
    outcome.figures.push_back(
        section(workshop, fmt::format("fig12/{}.png", part.name), field, 1, part.dims.j / 2,
                fmt::format("The {} in voxels, y = {}", part.name, part.dims.j / 2), ""));
  }
  outcome.checks = check_fig12(volumes);
  outcome.data = {workshop.file("fig12/volumes.csv")};
  table.write(outcome.data.front());
  return outcome;
}

// --------------------------------------------------------------------------------------- fig. 13

std::vector<Check> check_fig13(const ConeProfile& profile) {
  double worst_radius = 0, worst_width = 0;
  bool closed = true;
  for (const BodySection& s : profile.sections) {
    const auto radius = [](double area) { return std::sqrt(area / std::numbers::pi); };
    worst_radius = std::max(worst_radius, std::abs(radius(s.area()) - radius(s.true_area)));
    closed &= s.closed;
  }
  for (std::size_t z = 0; z < profile.width.size(); ++z) {
    worst_width = std::max(worst_width, std::abs(profile.width[z] - profile.true_width[z]));
  }
  return {{"horizontal sections are closed discs that shrink as the cone does",
           fmt::format("radius off by {:.2f} voxels at most over {} heights", worst_radius,
                       profile.sections.size()),
           closed && !profile.sections.empty() && worst_radius < 1},
          {"the vertical section through the apex is the cone's triangle",
           fmt::format("width off by {:.2f} voxels at most over {} heights", worst_width,
                       profile.width.size()),
           !profile.width.empty() && worst_width < 2}};
}

Outcome fig13(Workshop& workshop) {
  const ViscosityField field = workshop.field(cone(), body_only);
  ConeProfile profile;
  CsvTable table("z,width_vox,true_width_vox");
  // The lowest layer is all base; every other section is between two heights.
  for (int z = 1; z < static_cast<int>(cone_height) - 1; ++z) {
    const double radius = cone_base_radius * (1 - (z + 0.5) / cone_height);
    profile.sections.push_back(body_section(field, z, polygon_area(radius, 256)));
    double body = 0, skin = 0;
    for (int i = 0; i < field.workspace().dims.i; ++i) {
      const VoxelKind kind = kind_at(field, i, static_cast<int>(cone_axis), z);
      body += kind == VoxelKind::inner ? 1 : 0;
      skin += kind == VoxelKind::boundary ? 1 : 0;
    }
    profile.width.push_back(body + 0.5 * skin);
    profile.true_width.push_back(2 * radius);
    table.row(z, profile.width.back(), profile.true_width.back());
  }
  Outcome outcome{.checks = check_fig13(profile), .figures = {}};
  const Box close(Vec3(30, 30, 0), Vec3(90, 90, 50));
  for (const int z : {10, 25, 40}) {
    outcome.figures.push_back(section(workshop, fmt::format("fig13/z{}.png", z), field, 2, z,
                                      fmt::format("Section at z = {}", z), "", close));
  }
  outcome.figures.push_back(section(workshop, "fig13/through_apex.png", field, 1,
                                    static_cast<int>(cone_axis),
                                    "Vertical section through the apex", "", close));
  outcome.data = {write_sections(workshop, "fig13/sections.csv", profile.sections),
                  workshop.file("fig13/vertical_section.csv")};
  table.write(outcome.data.back());
  return outcome;
}

// --------------------------------------------------------------------------------------- fig. 14

std::vector<Check> check_fig14(const std::vector<WedgeGap>& from_base) {
  bool right = !from_base.empty();
  std::string gaps;
  for (const WedgeGap& gap : from_base) {
    right &= std::abs(gap.width - gap.true_width) < 2;
    gaps += fmt::format("{}z = {}: {:.1f}, in truth {:.1f}", gaps.empty() ? "" : "; ", gap.z,
                        gap.width, gap.true_width);
  }
  return {{"below its junction the block is whole, above it the V opens with height",
           gaps + " voxels",
           right && from_base.front().width == 0 && from_base.back().width > from_base[1].width}};
}

Outcome fig14(Workshop& workshop) {
  const ViscosityField field = workshop.field(wedge(), body_only);
  std::vector<WedgeGap> gaps;
  Outcome outcome;
  CsvTable table("z,width_vox,true_width_vox");
  int level = 0;
  for (const int z : {35, 50, 62}) {
    const double above_junction = z + 0.5 - (wedge_top - wedge_v_depth);
    WedgeGap gap{.z = z, .true_width = std::max(0.0, wedge_mouth * above_junction / wedge_v_depth)};
    double skin = 0;
    for (int i = 35; i < wedge_mirror - 34; ++i) {  // between the outer walls
      const VoxelKind kind = kind_at(field, i, 64, z);
      gap.width += kind == VoxelKind::empty ? 1 : 0;
      skin += kind == VoxelKind::boundary ? 1 : 0;
    }
    gap.width += 0.5 * skin;
    gaps.push_back(gap);
    table.row(z, gap.width, gap.true_width);
    ++level;
    outcome.figures.push_back(section(workshop, fmt::format("fig14/V{}_z{}.png", level, z), field,
                                      2, z, fmt::format("V{}, z = {}", level, z), ""));
  }
  outcome.checks = check_fig14(gaps);
  outcome.data = {workshop.file("fig14/gaps.csv")};
  table.write(outcome.data.front());
  return outcome;
}

}  // namespace vicinity::report
