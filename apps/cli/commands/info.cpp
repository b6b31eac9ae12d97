// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/info.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "field_summary.h"
#include "readable.h"
#include "vicinity/viscosity/field_file.h"

namespace vicinity::cli {
namespace {

using Json = nlohmann::ordered_json;

Json as_json(const InfoOptions& options, const ViscosityField& field, const VoxelCounts& counts) {
  Json json = {{"field", options.field.string()}};
  add_grid(json, field.workspace());
  json["objects"] = Json::array();
  for (const FieldObject& object : field.objects()) {
    json["objects"].push_back({{"name", object.name},
                               {"layers", to_string(object.layers)},
                               {"m", object.m},
                               {"q", object.q},
                               {"coding", object.coding.mu},
                               {"skin", object.coding.skin},
                               {"bound_mm", object.bound_mm},
                               {"triangles", object.triangles},
                               {"closed", object.closed},
                               {"boundary", object.boundary},
                               {"inner", object.inner},
                               {"ranks", object.ranks}});
  }
  json["voxels"] = {{"boundary", counts.boundary},
                    {"inner", counts.inner},
                    {"neighbour", counts.neighbour},
                    {"ranks", counts.ranks}};
  json["file_bytes"] = field.image().size();
  json["bound_mm"] = largest_bound_mm(field);
  json["keeps_distance"] = field.keeps_distance();
  return json;
}

std::string in_words(const InfoOptions& options, const ViscosityField& field,
                     const VoxelCounts& counts) {
  std::string text =
      fmt::format("{}, {}\n  {}\n\n{}\n", options.field.string(), bytes(field.image().size()),
                  grid_in_words(field.workspace()), objects_table(field));
  text += fmt::format("  boundary   {:>13}\n  inner      {:>13}\n", grouped(counts.boundary),
                      grouped(counts.inner));
  for (std::size_t n = 1; n <= counts.ranks.size(); ++n) {
    text += fmt::format("  rank {:<5} {:>13}\n", n, grouped(counts.ranks[n - 1]));
  }
  text += fmt::format("\n  bound      no point is more than {:.3g} mm nearer than its rank says\n",
                      largest_bound_mm(field));
  text += fmt::format("  distance   {}\n", field.keeps_distance() ? "kept" : "not kept");
  return text;
}

}  // namespace

int info(const InfoOptions& options, std::ostream& out, std::ostream&) {
  const ViscosityField field = open_field(options.field);
  const VoxelCounts counts = count_voxels(field);
  if (options.json) {
    out << as_json(options, field, counts).dump(2) << '\n';
  } else {
    out << in_words(options, field, counts);
  }
  return 0;
}

}  // namespace vicinity::cli
