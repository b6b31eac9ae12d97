// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/parts.h"
#include "reproduce/voxelisation.h"
#include "vicinity/voxel/boundary.h"

namespace vicinity::report {
namespace {

using Triangle = std::array<Vec3, 3>;

const char* to_string(ProbeLines lines) {
  return lines == ProbeLines::largest_face ? "largest face"
         : lines == ProbeLines::always_z   ? "always z"
                                           : "smallest face";
}

// The axis the lines are parallel to. Among equal sides z goes first, then y.
int axis_of(const Vec3& brick, ProbeLines lines) {
  int best = 2;
  if (lines == ProbeLines::always_z) return best;
  for (const int axis : {1, 0}) {
    const bool better =
        lines == ProbeLines::largest_face ? brick[axis] < brick[best] : brick[axis] > brick[best];
    if (better) best = axis;
  }
  return best;
}

// Where the line along `axis` through (u, v) meets the triangle, edges included.
std::optional<double> meet(const Triangle& t, int axis, double u, double v) {
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  // Twice the area of the triangle over each edge. Both triangles at an edge look at it from the
  // same end, so that no line slips between them.
  std::array<double, 3> side{};
  for (std::size_t n = 0; n < 3; ++n) {
    std::array p{t[(n + 1) % 3][a], t[(n + 1) % 3][b]}, q{t[(n + 2) % 3][a], t[(n + 2) % 3][b]};
    const bool turned = q < p;
    if (turned) std::swap(p, q);
    side[n] = ((q[0] - p[0]) * (v - p[1]) - (q[1] - p[1]) * (u - p[0])) * (turned ? -1 : 1);
  }
  const auto [least, most] = std::ranges::minmax(side);
  const double area = side[0] + side[1] + side[2];
  if ((least < 0 && most > 0) || area == 0) return std::nullopt;
  return (side[0] * t[0][axis] + side[1] * t[1][axis] + side[2] * t[2][axis]) / area;
}

using Hits = std::map<std::tuple<int, int, int>, int>;

void probe_triangle(const Triangle& t, ProbeLines lines, Hits& hits) {
  const Vec3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  const int axis = axis_of(high - low, lines);
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const auto index = [](double x) { return static_cast<int>(std::floor(x)); };
  std::array<int, 3> voxel{};
  const auto at = [&](int n) -> int& { return voxel[static_cast<std::size_t>(n)]; };
  for (at(a) = index(low[a]); at(a) <= index(high[a]); ++at(a)) {
    for (at(b) = index(low[b]); at(b) <= index(high[b]); ++at(b)) {
      const std::optional<double> met = meet(t, axis, at(a) + 0.5, at(b) + 0.5);
      if (!met) continue;
      at(axis) = index(std::clamp(*met, low[axis], high[axis]));
      ++hits[{voxel[0], voxel[1], voxel[2]}];
    }
  }
}

}  // namespace

ProbeResult probe(const std::string& part, const TriangleMesh& mesh, ProbeLines lines) {
  Hits hits;
  for (const auto& corners : mesh.triangles) {
    Triangle t;
    for (std::size_t n = 0; n < 3; ++n) t[n] = mesh.vertices[corners[n]] / voxel_m;
    probe_triangle(t, lines, hits);
  }
  Workspace workspace;
  workspace.voxel_size = voxel_m;
  const VoxelSet exact = boundary_voxels(mesh, workspace);
  // A line that meets the surface within rounding of a voxel's face may name the wrong side.
  std::erase_if(hits, [&](const auto& hit) {
    const auto [i, j, k] = hit.first;
    return !exact.contains({i, j, k});
  });
  ProbeResult result{.part = part, .lines = lines, .exact = exact.count()};
  exact.for_each([&](const VoxelIndex& v) {
    result.missed += hits.contains({v.i, v.j, v.k}) ? 0 : 1;
  });
  for (const auto& [voxel, count] : hits) result.doubled += count > 1 ? 1 : 0;
  return result;
}

std::vector<Check> check_fig11(const std::vector<ProbeResult>& results) {
  struct Sum {
    double exact = 0, missed = 0, doubled = 0;
    double missed_share() const { return missed / exact; }
    double doubled_share() const { return doubled / (exact - missed); }
  } chosen, z;
  std::string worse;
  for (const ProbeResult& r : results) {
    if (r.lines == ProbeLines::smallest_face) continue;
    Sum& sum = r.lines == ProbeLines::largest_face ? chosen : z;
    sum.exact += static_cast<double>(r.exact);
    sum.missed += static_cast<double>(r.missed);
    sum.doubled += static_cast<double>(r.doubled);
    for (const ProbeResult& other : results) {
      const bool is_worse =
          r.lines == ProbeLines::largest_face && other.part == r.part && other.missed < r.missed;
      if (is_worse) {
        worse += fmt::format("{}{}: {} of {} missed, {} with {}", worse.empty() ? "" : "; ", r.part,
                             r.missed, r.exact, other.missed, to_string(other.lines));
      }
    }
  }
  return {{"choosing the largest face of the brick misses fewer voxels than no choice",
           fmt::format("{:.0f} % of the exact boundary of all parts, {:.0f} % with z lines only",
                       100 * chosen.missed_share(), 100 * z.missed_share()),
           chosen.exact > 0 && chosen.missed_share() < z.missed_share()},
          {"it is the right choice on every part", worse.empty() ? "no choice misses fewer" : worse,
           worse.empty()},
          {"a smaller share of the voxels met is met twice",
           fmt::format("{:.2f} % against {:.2f} %", 100 * chosen.doubled_share(),
                       100 * z.doubled_share()),
           chosen.doubled_share() < z.doubled_share()}};
}

Outcome fig11(Workshop& workshop) {
  std::vector<ProbeResult> results;
  for (const Part& part : {circular_cylinder(), complex_cylinder(), cone(), wedge(), ball()}) {
    const TriangleMesh mesh = workshop.read_back(part);
    for (const ProbeLines lines :
         {ProbeLines::largest_face, ProbeLines::always_z, ProbeLines::smallest_face}) {
      results.push_back(probe(part.name, mesh, lines));
    }
  }
  Outcome outcome{.checks = check_fig11(results), .figures = {}};
  CsvTable table("part,lines,exact,missed,doubled");
  outcome.table = {
      {"part", "lines normal to", "exact boundary voxels", "missed", "missed of all", "doubled"}};
  for (const ProbeResult& r : results) {
    table.row(r.part, to_string(r.lines), r.exact, r.missed, r.doubled);
    outcome.table.push_back({r.part, to_string(r.lines), fmt::format("{}", r.exact),
                             fmt::format("{}", r.missed),
                             fmt::format("{:.1f} %", 100 * static_cast<double>(r.missed) /
                                                         static_cast<double>(r.exact)),
                             fmt::format("{}", r.doubled)});
  }
  outcome.data = {workshop.file("fig11/probe_vectors.csv")};
  table.write(outcome.data.front());

  // The skin of the cone, as each method sees it.
  const Part part = cone();
  for (const BoundaryMethod method : {BoundaryMethod::exact, BoundaryMethod::probe}) {
    const bool exact = method == BoundaryMethod::exact;
    const ViscosityField field =
        workshop.field(part, {.m = 1, .q = 0, .boundary = method, .inner = InnerMethod::none});
    outcome.figures.push_back(
        section(workshop, exact ? "fig11/cone_exact.png" : "fig11/cone_probe.png", field, 1,
                static_cast<int>(cone_axis),
                exact ? "The cone's skin, exact" : "The cone's skin, by probe vectors",
                exact ? "Every voxel that a triangle passes through."
                      : "Only voxels that a chosen grid line meets. The triangles are long and "
                        "narrow, and most of their voxels lie between two lines.",
                Box(Vec3(30, 30, 0), Vec3(90, 90, 50))));
  }
  return outcome;
}

}  // namespace vicinity::report
