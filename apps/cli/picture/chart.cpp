// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "picture/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "picture/axis.h"
#include "picture/canvas.h"

namespace vicinity::cli {
namespace {

constexpr double page_width = 640, panel_height = 190, panel_gap = 34;
constexpr double left = 64, right = 20, top = 18, bottom = 48;
constexpr double caption_row = 13;
constexpr double title_size = 13, text_size = 10.5, small_size = 9.5;
constexpr Colour grid{0.88, 0.88, 0.88}, frame{0.35, 0.35, 0.35}, quiet{0.3, 0.3, 0.3};

// Colours of Okabe and Ito, which colour-blind people tell apart, from light-and-wide to
// dark-and-thin: a later series stays visible on top of an earlier one.
const std::array<Canvas::Line, 8> series_lines{{
    {{0.34, 0.71, 0.91}, 3.2, {}},
    {{0.0, 0.0, 0.0}, 1.3, {}},
    {{0.84, 0.37, 0.0}, 1.6, {6, 3}},
    {{0.0, 0.62, 0.45}, 1.6, {2, 2}},
    {{0.8, 0.47, 0.65}, 1.6, {9, 3, 2, 3}},
    {{0.0, 0.45, 0.7}, 1.6, {}},
    {{0.6, 0.6, 0.6}, 2.2, {}},
    {{0.55, 0.27, 0.07}, 1.6, {1, 2}},
}};

Canvas::Line line_of(const ChartPanel& panel, std::size_t series) {
  // One line alone needs no legend, and no colour; among many, a wide one would hide others.
  constexpr double widest_of_many = 2;
  Canvas::Line line = series_lines[panel.series.size() == 1 ? 1 : series % series_lines.size()];
  if (panel.series.size() > 2) line.width = std::min(line.width, widest_of_many);
  return line;
}

struct Range {
  double lo = 0, hi = 0;
  bool logarithmic = false;  // lo and hi are then decades

  double position(double value) const {
    return ((logarithmic ? std::log10(value) : value) - lo) / (hi - lo);
  }
  std::vector<Tick> ticks(int wanted) const {
    if (!logarithmic) return ticks_within(lo, hi, wanted);
    std::vector<Tick> powers;
    for (double decade = std::ceil(lo); decade <= hi; ++decade) {
      powers.push_back({std::pow(10, decade), fmt::format("{:g}", std::pow(10, decade))});
    }
    return powers;
  }
};

Range decades(const Range& values) {
  return {std::floor(std::log10(values.lo)), std::ceil(std::log10(values.hi)), true};
}

Range x_range(const Chart& chart) {
  Range range{INFINITY, -INFINITY};
  for (const ChartPanel& panel : chart.panels) {
    for (const Series& series : panel.series) {
      if (series.points.empty()) continue;
      range.lo = std::min(range.lo, series.points.front().first);
      range.hi = std::max(range.hi, series.points.back().first);
    }
  }
  if (!(range.hi > range.lo)) range = {range.hi < INFINITY ? range.hi : 0, range.lo + 1};
  return chart.logarithmic_x ? decades(range) : range;
}

Range y_range(const ChartPanel& panel) {
  Range range;
  if (panel.logarithmic) range = {INFINITY, -INFINITY};
  for (const Series& series : panel.series) {
    for (const auto& [x, y] : series.points) {
      if (std::isnan(y)) continue;
      range.lo = std::min(range.lo, y);
      range.hi = std::max(range.hi, y);
    }
  }
  if (panel.logarithmic) return decades(range);
  const double room = 0.08 * (range.hi > range.lo ? range.hi - range.lo : 12.5);
  return {range.lo < 0 ? range.lo - room : 0, range.hi + room};
}

using Points = std::vector<std::pair<double, double>>;

// Without the points inside level stretches: the same line.
Points without_level_middles(const Points& points) {
  Points kept;
  for (const auto& point : points) {
    const std::size_t n = kept.size();
    if (n >= 2 && kept[n - 1].second == point.second && kept[n - 2].second == point.second) {
      kept.back() = point;
    } else {
      kept.push_back(point);
    }
  }
  return kept;
}

// The line through all points as it shows at this resolution: within one half point of width the
// first, lowest, highest and last point draw the same ink as all of them.
Points thinned(const Points& points) {
  constexpr double column = 0.5;
  Points kept;
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin;
    while (end < points.size() &&
           std::floor(points[end].first / column) == std::floor(points[begin].first / column)) {
      ++end;
    }
    const auto by_y = [&](std::size_t a, std::size_t b) {
      return points[a].second < points[b].second;
    };
    std::array<std::size_t, 4> chosen{begin, begin, begin, end - 1};
    for (std::size_t n = begin; n < end; ++n) {
      chosen[1] = std::min(chosen[1], n, by_y);
      chosen[2] = std::max(chosen[2], n, by_y);
    }
    std::sort(chosen.begin(), chosen.end());
    const auto* const last = std::unique(chosen.begin(), chosen.end());
    for (const auto* n = chosen.begin(); n != last; ++n) kept.push_back(points[*n]);
    begin = end;
  }
  return kept;
}

constexpr double strip_height = 8, strip_gap = 4;

// Strips between the panel's legend and its top edge, the last one at the panel.
void draw_strips(Canvas& canvas, const std::vector<ChartStrip>& strips, const Range& along,
                 double y) {
  const double width = page_width - left - right;
  y -= static_cast<double>(strips.size()) * (strip_height + strip_gap);
  for (const ChartStrip& strip : strips) {
    for (const ChartBand& band : strip.bands) {
      const double from = left + width * along.position(band.from);
      const double to = left + width * along.position(band.to);
      canvas.rectangle(from, y, to - from, strip_height, band.colour);
    }
    canvas.outline(left, y, width, strip_height, {frame, 0.8});
    canvas.text(left - 8, y + 7, strip.label, small_size, Canvas::Anchor::right);
    y += strip_height + strip_gap;
  }
}

constexpr double legend_row = 14, legend_sample = 22, legend_gap = 5, legend_between = 13;

double legend_entry_width(const Canvas& canvas, const std::string& name) {
  return legend_sample + legend_gap + canvas.text_width(name, text_size) + legend_between;
}

// First series of each row of a legend, and one past the last.
std::vector<std::size_t> legend_rows(const Canvas& canvas, const ChartPanel& panel) {
  std::vector<std::size_t> rows = {0};
  if (panel.series.size() < 2) return rows;
  double width = 0;
  for (std::size_t n = 0; n < panel.series.size(); ++n) {
    width += legend_entry_width(canvas, panel.series[n].name);
    if (n > rows.back() && width - legend_between > page_width - left - right) {
      rows.push_back(n);
      width = legend_entry_width(canvas, panel.series[n].name);
    }
  }
  rows.push_back(panel.series.size());
  return rows;
}

// What a legend needs above its panel beyond the room that is there for one row.
double legend_extra(const Canvas& canvas, const ChartPanel& panel) {
  const std::size_t rows = legend_rows(canvas, panel).size() - 1;
  return rows > 1 ? legend_row * static_cast<double>(rows - 1) : 0;
}

// Legend above y, each row to the right edge.
void draw_legend(Canvas& canvas, const ChartPanel& panel, double y) {
  const std::vector<std::size_t> rows = legend_rows(canvas, panel);
  for (std::size_t row = rows.size() - 1; row-- > 0; y -= legend_row) {
    double x = page_width - right;
    for (std::size_t n = rows[row + 1]; n-- > rows[row];) {
      const std::string& name = panel.series[n].name;
      x -= canvas.text_width(name, text_size);
      canvas.text(x, y - 7, name, text_size);
      canvas.polyline({{x - legend_gap - legend_sample, y - 10.5}, {x - legend_gap, y - 10.5}},
                      line_of(panel, n));
      x -= legend_gap + legend_sample + legend_between;
    }
  }
}

// What the colours of the strips mean, one row for each that says so. Returns the last row's y.
double draw_keys(Canvas& canvas, const std::vector<ChartStrip>& strips, double y) {
  constexpr double swatch = 8, gap = 4, between = 11;
  for (const ChartStrip& strip : strips) {
    if (strip.key.empty()) continue;
    y += legend_row;
    double x = left;
    canvas.text(left - 8, y, strip.label, small_size, Canvas::Anchor::right);
    for (const auto& [name, colour] : strip.key) {
      canvas.rectangle(x, y - swatch, swatch, swatch, colour);
      canvas.outline(x, y - swatch, swatch, swatch, {frame, 0.6});
      canvas.text(x + swatch + gap, y, name, small_size);
      x += swatch + gap + canvas.text_width(name, small_size) + between;
    }
  }
  return y;
}

// The stretches between gaps, on the canvas.
std::vector<Points> stretches(const Series& series, const std::function<double(double)>& to_x,
                              const std::function<double(double)>& to_y) {
  std::vector<Points> all(1);
  for (const auto& [x, value] : series.points) {
    if (series.steps && !all.back().empty()) {
      all.back().emplace_back(to_x(x), all.back().back().second);
    }
    if (!std::isnan(value)) {
      all.back().emplace_back(to_x(x), to_y(value));
    } else if (!all.back().empty()) {
      all.emplace_back();
    }
  }
  return all;
}

// Words on as many lines as they need within the width.
std::vector<std::string> wrapped(const Canvas& canvas, const std::string& words, double width,
                                 double size) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    const std::string word = words.substr(begin, end - begin);
    if (lines.empty() || canvas.text_width(lines.back() + ' ' + word, size) > width) {
      lines.push_back(word);
    } else {
      lines.back() += ' ' + word;
    }
    begin = end + 1;
  }
  return lines;
}

void draw_panel(Canvas& canvas, const ChartPanel& panel, const Range& along, double y,
                double legend_y, bool lowest) {
  const double width = page_width - left - right;
  const Range range = y_range(panel);
  const auto to_x = [&](double value) { return left + width * along.position(value); };
  const auto to_y = [&](double value) { return y + panel_height * (1 - range.position(value)); };
  for (const Tick& tick : along.ticks(8)) {
    const double x = to_x(tick.value);
    canvas.polyline({{x, y}, {x, y + panel_height}}, {grid, 0.7});
    if (lowest) {
      canvas.polyline({{x, y + panel_height}, {x, y + panel_height + 4}}, {frame, 0.8});
      canvas.text(x, y + panel_height + 16, tick.label, text_size, Canvas::Anchor::middle);
    }
  }
  for (const Tick& tick : range.ticks(5)) {
    const double at = to_y(tick.value);
    canvas.polyline({{left, at}, {left + width, at}}, {grid, 0.7});
    canvas.polyline({{left - 4, at}, {left, at}}, {frame, 0.8});
    canvas.text(left - 8, at + 3.8, tick.label, text_size, Canvas::Anchor::right);
  }
  canvas.begin_clip(left, y, width, panel_height);
  for (std::size_t n = 0; n < panel.series.size(); ++n) {
    for (const Points& points : stretches(panel.series[n], to_x, to_y)) {
      canvas.polyline(thinned(without_level_middles(points)), line_of(panel, n));
    }
  }
  canvas.end_clip();
  canvas.outline(left, y, width, panel_height, {frame, 0.8});
  canvas.text(18, y + panel_height / 2, panel.y_label, text_size, Canvas::Anchor::middle, black,
              false);
  if (panel.series.size() > 1) draw_legend(canvas, panel, legend_y);
}

}  // namespace

void draw_chart(const Chart& chart, const std::filesystem::path& path) {
  const Canvas ruler(path, 1, 1);
  const double strips = static_cast<double>(chart.strips.size()) * (strip_height + strip_gap);
  const auto keys =
      std::ranges::count_if(chart.strips, [](const auto& s) { return !s.key.empty(); });
  const std::vector<std::string> caption =
      wrapped(ruler, chart.caption, page_width - left - right, small_size);
  double height = top + (chart.title.empty() ? 8 : 32) + strips - panel_gap;
  for (const ChartPanel& panel : chart.panels) {
    height += legend_extra(ruler, panel) + panel_height + panel_gap;
  }
  height += bottom + legend_row * static_cast<double>(keys) +
            caption_row * static_cast<double>(caption.size());
  Canvas canvas(path, page_width, height);
  canvas.text(left, top + 2, chart.title, title_size);
  const Range along = x_range(chart);
  double y = top + (chart.title.empty() ? 8 : 32) + strips;
  for (const ChartPanel& panel : chart.panels) {
    const bool first = &panel == &chart.panels.front(), last = &panel == &chart.panels.back();
    y += legend_extra(canvas, panel);
    if (first) draw_strips(canvas, chart.strips, along, y);
    draw_panel(canvas, panel, along, y, first ? y - strips : y, last);
    y += panel_height + panel_gap;
  }
  y -= panel_gap;
  canvas.text(left + (page_width - left - right) / 2, y + 34, chart.x_label, text_size,
              Canvas::Anchor::middle);
  y = draw_keys(canvas, chart.strips, y + 40) + (keys > 0 ? 4 : 0);
  for (const std::string& line : caption) {
    canvas.text(left, y += caption_row, line, small_size, Canvas::Anchor::left, quiet);
  }
  canvas.write();
}

}  // namespace vicinity::cli
