// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "picture/slice_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "picture/axis.h"
#include "picture/canvas.h"
#include "picture/rank_palette.h"
#include "vicinity/geometry/error.h"

namespace vicinity::cli {
namespace {

// Voxels of a section are enlarged to about this many pixels, a page's width, ...
constexpr double wanted_pixels = 1300;
// ... and merged where they are more than these, which every viewer still opens.
constexpr int most_pixels = 2400;
// More names than this hide what they name.
constexpr std::size_t most_names = 16;
constexpr double title_size = 12, text_size = 10, name_size = 9;
constexpr double left = 58, top = 34, bottom = 46, legend_gap = 20, margin = 12;
constexpr std::array axis_names{'x', 'y', 'z'};

// The section as a grid of cells, row 0 at the top; a cell is one voxel, or `merged` by `merged`.
struct Section {
  int across = 2, right = 0, up = 1;  // axes
  std::int32_t layer = 0;             // index across
  std::array<std::int32_t, 3> lo{}, hi{};
  int merged = 1, columns = 0, rows = 0;
  std::vector<VoxelCode> codes;  // of cells, shape (rows, columns)

  VoxelCode at(int column, int row) const {
    return codes[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
};

[[noreturn]] void outside(const std::string& what, const std::string& found,
                          const std::string& expected) {
  throw Error({.where = "slice",
               .what = what + " outside the workspace",
               .found = found,
               .expected = expected});
}

// Nearer to a surface is higher, so that merging cells never hides one.
int nearness(const VoxelRecord& record) {
  return record.kind == VoxelKind::neighbour ? 256 - record.rank
                                             : 256 * static_cast<int>(record.kind);
}

Section cut(const ViscosityField& field, const Slice& slice) {
  const Workspace& workspace = field.workspace();
  const std::array dims{workspace.dims.i, workspace.dims.j, workspace.dims.k};
  const double h = workspace.voxel_size;
  Section section;
  section.across = slice.axis;
  section.right = slice.axis == 0 ? 1 : 0;
  section.up = slice.axis == 2 ? 1 : 2;
  const auto index_along = [&](int axis, double position) {
    return std::floor((position - workspace.origin[axis]) / h);
  };
  const double layer = index_along(slice.axis, slice.position);
  const auto a = static_cast<std::size_t>(slice.axis);
  if (!(layer >= 0 && layer < dims[a])) {
    const double first = workspace.origin[slice.axis];
    outside(fmt::format("the plane {} = {:g} m lies", axis_names[a], slice.position),
            fmt::format("{:g} m", slice.position),
            fmt::format("{:g} to {:g} m", first, first + h * dims[a]));
  }
  section.layer = static_cast<std::int32_t>(layer);
  for (const int axis : {section.right, section.up}) {
    const auto n = static_cast<std::size_t>(axis);
    double lo = 0, hi = dims[n];
    if (slice.part) {
      lo = std::max(lo, index_along(axis, slice.part->min()[axis] + 1e-6 * h));
      hi = std::min(hi, index_along(axis, slice.part->max()[axis] - 1e-6 * h) + 1);
    }
    if (!(lo < hi)) {
      outside("the part to be drawn lies",
              fmt::format("{} from {:g} to {:g} m", axis_names[n], slice.part->min()[axis],
                          slice.part->max()[axis]),
              fmt::format("{:g} to {:g} m", workspace.origin[axis],
                          workspace.origin[axis] + h * dims[n]));
    }
    section.lo[n] = static_cast<std::int32_t>(lo);
    section.hi[n] = static_cast<std::int32_t>(hi);
  }
  const auto right = static_cast<std::size_t>(section.right),
             up = static_cast<std::size_t>(section.up);
  const int width = section.hi[right] - section.lo[right], height = section.hi[up] - section.lo[up];
  section.merged = (std::max(width, height) + most_pixels - 1) / most_pixels;
  section.columns = (width + section.merged - 1) / section.merged;
  section.rows = (height + section.merged - 1) / section.merged;
  section.codes.assign(
      static_cast<std::size_t>(section.columns) * static_cast<std::size_t>(section.rows), 0);
  std::array<std::int32_t, 3> voxel{};
  voxel[a] = section.layer;
  for (voxel[up] = section.lo[up]; voxel[up] < section.hi[up]; ++voxel[up]) {
    const int row = section.rows - 1 - (voxel[up] - section.lo[up]) / section.merged;
    for (voxel[right] = section.lo[right]; voxel[right] < section.hi[right]; ++voxel[right]) {
      const int column = (voxel[right] - section.lo[right]) / section.merged;
      VoxelCode& cell =
          section.codes[static_cast<std::size_t>(row) * static_cast<std::size_t>(section.columns) +
                        static_cast<std::size_t>(column)];
      const VoxelCode code = field.code_at({voxel[0], voxel[1], voxel[2]});
      if (nearness(field.records()[code]) > nearness(field.records()[cell])) cell = code;
    }
  }
  return section;
}

std::uint32_t to_pixel(const Colour& colour) {
  const auto byte = [](double x) { return static_cast<std::uint32_t>(std::lround(255 * x)); };
  return byte(colour.red) << 16 | byte(colour.green) << 8 | byte(colour.blue);
}

std::vector<std::uint32_t> paint(const ViscosityField& field, const Section& section, int side) {
  std::vector<std::uint32_t> colours;  // by code
  for (const VoxelRecord& record : field.records()) {
    colours.push_back(to_pixel(colour_of(record, most_ranks(field))));
  }
  const std::uint32_t hatch = to_pixel(inner_hatch_colour);
  const int width = section.columns * side, height = section.rows * side;
  std::vector<std::uint32_t> pixels(static_cast<std::size_t>(width) *
                                    static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const VoxelCode code = section.at(x / side, y / side);
      const bool hatched = field.records()[code].kind == VoxelKind::inner && (x + y) % 10 < 2;
      pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(x)] = hatched ? hatch : colours[code];
    }
  }
  return pixels;
}

// A cell of each object that lies in the plane: of its material if any is there, else of its
// layers, and of those the one nearest to their middle, so that the name stands on what it names.
struct Place {
  double sum_column = 0, sum_row = 0, count = 0;
  double column = 0, row = 0, distance = INFINITY;
};

std::map<std::uint16_t, Place> places_of_objects(const ViscosityField& field,
                                                 const Section& section) {
  std::map<std::uint16_t, Place> material, layers;
  const auto for_each_cell = [&](auto&& visit) {
    for (int row = 0; row < section.rows; ++row) {
      for (int column = 0; column < section.columns; ++column) {
        const VoxelRecord& record = field.records()[section.at(column, row)];
        if (record.kind == VoxelKind::empty) continue;
        auto& places = record.kind == VoxelKind::neighbour ? layers : material;
        visit(places[record.object], column + 0.5, row + 0.5);
      }
    }
  };
  for_each_cell([](Place& place, double column, double row) {
    place.sum_column += column;
    place.sum_row += row;
    ++place.count;
  });
  for_each_cell([](Place& place, double column, double row) {
    const double distance =
        std::hypot(column - place.sum_column / place.count, row - place.sum_row / place.count);
    if (distance < place.distance) {
      place.column = column;
      place.row = row;
      place.distance = distance;
    }
  });
  material.merge(layers);
  return material;
}

void draw_names(Canvas& canvas, const ViscosityField& field, const Section& section, double cell,
                double width, double height) {
  const auto places = places_of_objects(field, section);
  if (places.size() > most_names) return;
  std::vector<std::array<double, 4>> taken;
  for (const auto& [object, place] : places) {
    const std::string& name = field.objects()[object].name;
    const double half_width = canvas.text_width(name, name_size) / 2 + 3;
    const double half_height = 0.7 * name_size;
    if (2 * half_width > width || 2 * half_height > height) continue;
    const double x =
        std::clamp(left + cell * place.column, left + half_width, left + width - half_width);
    const double middle =
        std::clamp(top + cell * place.row, top + half_height, top + height - half_height);
    // Where a name stands already, step aside by one line, or leave this one out.
    const auto free = [&](double y) {
      const bool crowded = std::any_of(taken.begin(), taken.end(), [&](const auto& other) {
        return std::abs(x - other[0]) < half_width + other[2] &&
               std::abs(y - other[1]) < half_height + other[3];
      });
      return !crowded && y >= top + half_height && y <= top + height - half_height;
    };
    const std::array tries{middle, middle - 2 * half_height, middle + 2 * half_height};
    const auto* const y = std::find_if(tries.begin(), tries.end(), free);
    if (y == tries.end()) continue;
    taken.push_back({x, *y, half_width, half_height});
    canvas.label(x, *y, name, name_size);
  }
}

struct LegendRow {
  Colour colour;
  bool hatched;
  std::string name, viscosity;
};

// Viscosities of one kind and rank: one number, or the range where objects differ.
std::string viscosity_range(const ViscosityField& field, VoxelKind kind, int rank) {
  double lowest = INFINITY, highest = -INFINITY;
  for (std::size_t code = 0; code < field.records().size(); ++code) {
    const VoxelRecord& record = field.records()[code];
    if (record.kind != kind || record.rank != rank) continue;
    lowest = std::min(lowest, field.viscosities()[code]);
    highest = std::max(highest, field.viscosities()[code]);
  }
  if (lowest > highest) return "";
  return lowest == highest ? fmt::format("{:.4g}", lowest)
                           : fmt::format("{:.4g} – {:.4g}", lowest, highest);
}

std::vector<LegendRow> legend_of(const ViscosityField& field) {
  std::vector<LegendRow> rows{
      {inner_colour, true, "inner", viscosity_range(field, VoxelKind::inner, 0)},
      {boundary_colour, false, "boundary", viscosity_range(field, VoxelKind::boundary, 0)}};
  const int q = most_ranks(field);
  for (int n = 1; n <= q; ++n) {
    rows.push_back({rank_colour(n, q), false, fmt::format("rank {}", n),
                    viscosity_range(field, VoxelKind::neighbour, n)});
  }
  rows.push_back({white, false, "empty", "0"});
  return rows;
}

constexpr double swatch = 22, legend_row = 17;

double legend_width(const Canvas& canvas, const std::vector<LegendRow>& rows) {
  double names = 0, viscosities = canvas.text_width("μ [N·s/m³]", text_size);
  for (const LegendRow& row : rows) {
    names = std::max(names, canvas.text_width(row.name, text_size));
    viscosities = std::max(viscosities, canvas.text_width(row.viscosity, text_size));
  }
  return swatch + 8 + names + 14 + viscosities;
}

void draw_legend(Canvas& canvas, const std::vector<LegendRow>& rows, double x, double width) {
  double y = top;
  canvas.text(x + width, y + 9, "μ [N·s/m³]", text_size, Canvas::Anchor::right);
  for (const LegendRow& row : rows) {
    y += legend_row;
    canvas.rectangle(x, y, swatch, legend_row - 3, row.colour);
    if (row.hatched) {
      canvas.begin_clip(x, y, swatch, legend_row - 3);
      for (double start = 2.5; start < swatch + legend_row; start += 5) {
        canvas.polyline({{x + start, y}, {x + start - legend_row, y + legend_row}},
                        {inner_hatch_colour, 0.8});
      }
      canvas.end_clip();
    }
    canvas.outline(x, y, swatch, legend_row - 3, {{0.35, 0.35, 0.35}, 0.6});
    canvas.text(x + swatch + 8, y + 10.5, row.name, text_size);
    canvas.text(x + width, y + 10.5, row.viscosity, text_size, Canvas::Anchor::right);
  }
}

void draw_axes(Canvas& canvas, const Workspace& workspace, const Section& section, double width,
               double height) {
  constexpr Colour frame{0.35, 0.35, 0.35};
  canvas.outline(left, top, width, height, {frame, 0.8});
  const auto range = [&](int axis) {
    const auto n = static_cast<std::size_t>(axis);
    const double origin = workspace.origin[axis], h = workspace.voxel_size;
    // Whole cells, so that the last one may reach beyond the part.
    const int cells = axis == section.right ? section.columns : section.rows;
    const double lo = origin + h * section.lo[n];
    return std::pair(lo, lo + h * cells * section.merged);
  };
  const auto tick_count = [](double length) { return std::max(2, static_cast<int>(length / 60)); };
  const auto [x_lo, x_hi] = range(section.right);
  for (const Tick& tick : ticks_within(x_lo, x_hi, tick_count(width))) {
    const double x = left + width * (tick.value - x_lo) / (x_hi - x_lo);
    canvas.polyline({{x, top + height}, {x, top + height + 4}}, {frame, 0.8});
    canvas.text(x, top + height + 16, tick.label, text_size, Canvas::Anchor::middle);
  }
  const auto [y_lo, y_hi] = range(section.up);
  for (const Tick& tick : ticks_within(y_lo, y_hi, tick_count(height))) {
    const double y = top + height * (y_hi - tick.value) / (y_hi - y_lo);
    canvas.polyline({{left - 4, y}, {left, y}}, {frame, 0.8});
    canvas.text(left - 7, y + 3.6, tick.label, text_size, Canvas::Anchor::right);
  }
  const auto name = [](int axis) {
    return fmt::format("{} [m]", axis_names[static_cast<std::size_t>(axis)]);
  };
  canvas.text(left + width / 2, top + height + 34, name(section.right), text_size,
              Canvas::Anchor::middle);
  canvas.text(16, top + height / 2, name(section.up), text_size, Canvas::Anchor::middle, black,
              false);
}

}  // namespace

void draw_slice(const ViscosityField& field, const Slice& slice,
                const std::filesystem::path& path) {
  const Section section = cut(field, slice);
  const int side = static_cast<int>(
      std::max(1L, std::lround(wanted_pixels / std::max(section.columns, section.rows))));
  const double cell = side / Canvas::pixels_per_point;
  const double width = cell * section.columns, height = cell * section.rows;
  const std::vector<LegendRow> rows = legend_of(field);
  const double legend = legend_width(Canvas(path, 1, 1), rows);
  const double legend_height = legend_row * (static_cast<double>(rows.size()) + 1);
  Canvas canvas(path, left + width + legend_gap + legend + margin,
                top + std::max(height + bottom, legend_height + margin));

  const double layer =
      field.workspace().origin[slice.axis] + field.workspace().voxel_size * section.layer;
  canvas.text(
      left, 20,
      fmt::format("{} = {:.6g} to {:.6g} m{}", axis_names[static_cast<std::size_t>(slice.axis)],
                  layer, layer + field.workspace().voxel_size,
                  section.merged > 1
                      ? fmt::format("; a pixel is the nearest to a surface of {} x {} voxels",
                                    section.merged, section.merged)
                      : ""),
      title_size);
  canvas.image(left, top, section.columns * side, section.rows * side, paint(field, section, side));
  draw_names(canvas, field, section, cell, width, height);
  draw_axes(canvas, field.workspace(), section, width, height);
  draw_legend(canvas, rows, left + width + legend_gap, legend);
  canvas.write();
}

}  // namespace vicinity::cli
