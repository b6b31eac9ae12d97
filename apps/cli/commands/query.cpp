// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/query.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "arguments.h"
#include "commands/csv_cell.h"
#include "field_summary.h"
#include "vicinity/viscosity/field_file.h"

namespace vicinity::cli {
namespace {

struct Answer {
  Vec3 p_W;
  FieldSample sample;
  std::string object;  // empty: none
  bool inside;         // of the workspace
};

Answer ask(const ViscosityField& field, const Vec3& p_W) {
  const FieldSample sample = field.at(p_W);
  const Workspace& workspace = field.workspace();
  const Vec3 grid = workspace.to_grid(p_W);
  const Vec3 dims(workspace.dims.i, workspace.dims.j, workspace.dims.k);
  return {.p_W = p_W,
          .sample = sample,
          .object = sample.record.kind == VoxelKind::empty
                        ? ""
                        : field.objects()[sample.record.object].name,
          .inside = (grid.array() >= 0).all() && (grid.array() < dims.array()).all()};
}

std::string as_json(const Answer& answer) {
  using Json = nlohmann::ordered_json;
  const auto& [p_W, sample, object, inside] = answer;
  return Json{{"x", p_W.x()},
              {"y", p_W.y()},
              {"z", p_W.z()},
              {"kind", to_string(sample.record.kind)},
              {"object", object.empty() ? Json() : Json(object)},
              {"rank", sample.record.rank},
              {"viscosity", sample.viscosity},
              {"distance", sample.distance_m < 0 ? Json() : Json(sample.distance_m)},
              {"inside", inside}}
      .dump();
}

std::string as_csv(const Answer& answer) {
  const auto& [p_W, sample, object, inside] = answer;
  return fmt::format(
      "{:.10g},{:.10g},{:.10g},{},{},{},{:.10g},{},{}", p_W.x(), p_W.y(), p_W.z(),
      to_string(sample.record.kind), csv_cell(object), sample.record.rank, sample.viscosity,
      sample.distance_m < 0 ? "" : fmt::format("{:.10g}", sample.distance_m), inside ? 1 : 0);
}

std::string in_words(const ViscosityField& field, const Answer& answer) {
  const auto& [p_W, sample, object, inside] = answer;
  const std::string point = fmt::format("({:g}, {:g}, {:g}) m", p_W.x(), p_W.y(), p_W.z());
  if (!inside) {
    return fmt::format("{} lies outside the workspace, where nothing is known; the field has {}",
                       point, grid_in_words(field.workspace()));
  }
  std::string words;
  switch (sample.record.kind) {
    case VoxelKind::empty:
      words = "empty";
      break;
    case VoxelKind::neighbour:
      words = fmt::format("in layer {} of {}", sample.record.rank, object);
      break;
    case VoxelKind::inner:
      words = "inside " + object;
      break;
    case VoxelKind::boundary:
      words = "on the boundary of " + object;
      break;
  }
  words = fmt::format("{}: {}, viscosity {:.4g} N·s/m³", point, words, sample.viscosity);
  if (sample.distance_m >= 0) {
    words += fmt::format(", at least {:.4g} mm from the surface", 1e3 * sample.distance_m);
  }
  return words;
}

void answer_lines(const ViscosityField& field, bool json, std::istream& in, std::ostream& out) {
  if (!json) out << "x,y,z,kind,object,rank,viscosity,distance,inside\n";
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty() || (number == 1 && line == "x,y,z")) continue;
    const Vec3 p_W = point_from(fmt::format("standard input, line {}", number), line);
    const Answer answer = ask(field, p_W);
    out << (json ? as_json(answer) : as_csv(answer)) << '\n';
  }
}

}  // namespace

int query(const QueryOptions& options, std::ostream& out, std::ostream&) {
  const bool from_lines = options.point.empty();
  if ((!from_lines && options.point.size() != 3) || (from_lines && isatty(0) != 0)) {
    throw Error({.where = "query",
                 .what = "no point was given",
                 .expected = "three coordinates in metres, or lines x,y,z on standard input",
                 .hint = "vicinity query " + options.field.string() + " 0.1 0.2 0.3"});
  }
  const ViscosityField field = open_field(options.field);
  if (from_lines) {
    answer_lines(field, options.json, std::cin, out);
    return 0;
  }
  const Answer answer = ask(field, {options.point[0], options.point[1], options.point[2]});
  out << (options.json ? as_json(answer) : in_words(field, answer)) << '\n';
  return 0;
}

}  // namespace vicinity::cli
