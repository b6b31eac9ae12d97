// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "field_summary.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

#include "readable.h"

namespace vicinity::cli {

VoxelCounts count_voxels(const ViscosityField& field) {
  const VoxelIndex dims = field.workspace().dims;
  using PerCode = std::vector<std::uint64_t>;
  const PerCode per_code = tbb::parallel_reduce(
      tbb::blocked_range<std::int32_t>(0, dims.k, 8), PerCode(field.records().size()),
      [&](const tbb::blocked_range<std::int32_t>& layers, PerCode counts) {
        for (std::int32_t k = layers.begin(); k < layers.end(); ++k) {
          for (std::int32_t j = 0; j < dims.j; ++j) {
            for (std::int32_t i = 0; i < dims.i; ++i) ++counts[field.code_at({i, j, k})];
          }
        }
        return counts;
      },
      [](PerCode a, const PerCode& b) {
        for (std::size_t c = 0; c < a.size(); ++c) a[c] += b[c];
        return a;
      });
  VoxelCounts counts;
  for (std::size_t c = 0; c < per_code.size(); ++c) {
    const VoxelRecord& record = field.records()[c];
    switch (record.kind) {
      case VoxelKind::empty:
        break;
      case VoxelKind::boundary:
        counts.boundary += per_code[c];
        break;
      case VoxelKind::inner:
        counts.inner += per_code[c];
        break;
      case VoxelKind::neighbour:
        counts.neighbour += per_code[c];
        counts.ranks.resize(std::max<std::size_t>(counts.ranks.size(), record.rank));
        counts.ranks[record.rank - 1u] += per_code[c];
        break;
    }
  }
  return counts;
}

std::string objects_table(const ViscosityField& field) {
  std::size_t width = 6;
  for (const FieldObject& object : field.objects()) width = std::max(width, object.name.size());
  std::string text =
      fmt::format("  {:<{}}  {:>9}  {:>6}  {:>11}  {:>11}  {:>11}  {}\n", "object", width,
                  "triangles", "closed", "boundary", "inner", "neighbour", "layers");
  for (const FieldObject& object : field.objects()) {
    std::uint64_t neighbours = 0;
    for (const std::uint64_t n : object.ranks) neighbours += n;
    text += fmt::format("  {:<{}}  {:>9}  {:>6}  {:>11}  {:>11}  {:>11}  {} m={} q={}\n",
                        object.name, width, grouped(object.triangles), object.closed ? "yes" : "no",
                        grouped(object.boundary), grouped(object.inner), grouped(neighbours),
                        to_string(object.layers), object.m, object.q);
  }
  return text;
}

std::string grid_in_words(const Workspace& w) {
  const Vec3 end = w.origin + w.voxel_size * Vec3(w.dims.i, w.dims.j, w.dims.k);
  return fmt::format(
      "{} x {} x {} voxels of {:.6g} mm, from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) "
      "m",
      w.dims.i, w.dims.j, w.dims.k, 1000 * w.voxel_size, w.origin.x(), w.origin.y(), w.origin.z(),
      end.x(), end.y(), end.z());
}

double largest_bound_mm(const ViscosityField& field) {
  double largest = 0;
  for (const FieldObject& object : field.objects()) largest = std::max(largest, object.bound_mm);
  return largest;
}

void add_grid(nlohmann::ordered_json& json, const Workspace& w) {
  json["voxel_size"] = w.voxel_size;
  json["origin"] = {w.origin.x(), w.origin.y(), w.origin.z()};
  json["dims"] = {w.dims.i, w.dims.j, w.dims.k};
}

}  // namespace vicinity::cli
