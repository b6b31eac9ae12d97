// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "picture/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "picture/axis.h"
#include "picture/canvas.h"

namespace vicinity::cli {
namespace {

constexpr double page_width = 640, panel_height = 190, panel_gap = 34;
constexpr double left = 64, right = 20, top = 18, bottom = 42;
constexpr double caption_row = 13;
constexpr double title_size = 13, text_size = 10.5, small_size = 9.5;
constexpr Colour grid{0.88, 0.88, 0.88}, frame{0.35, 0.35, 0.35}, quiet{0.3, 0.3, 0.3};

// Colours of Okabe and Ito, which colour-blind people tell apart, from light-and-wide to
// dark-and-thin: a later series stays visible on top of an earlier one.
const std::array<Canvas::Line, 6> series_lines{{
    {{0.34, 0.71, 0.91}, 3.2, {}},
    {{0.0, 0.0, 0.0}, 1.3, {}},
    {{0.84, 0.37, 0.0}, 1.6, {6, 3}},
    {{0.0, 0.62, 0.45}, 1.6, {2, 2}},
    {{0.8, 0.47, 0.65}, 1.6, {9, 3, 2, 3}},
    {{0.0, 0.45, 0.7}, 1.6, {}},
}};

const Canvas::Line& line_of(const ChartPanel& panel, std::size_t series) {
  // One line alone needs no legend, and no colour.
  return series_lines[panel.series.size() == 1 ? 1 : series % series_lines.size()];
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

constexpr double strip_height = 8;

// A strip between the panel's legend and its top edge.
void draw_bands(Canvas& canvas, const Chart& chart, const Range& along, double y) {
  if (chart.bands.empty()) return;
  const double width = page_width - left - right;
  for (const ChartBand& band : chart.bands) {
    const double from = left + width * along.position(band.from);
    const double to = left + width * along.position(band.to);
    canvas.rectangle(from, y - strip_height, to - from, strip_height, band.colour);
  }
  canvas.outline(left, y - strip_height, width, strip_height, {frame, 0.8});
}

// Legend above the panel, from its right edge.
void draw_legend(Canvas& canvas, const ChartPanel& panel, double y) {
  constexpr double sample = 24, gap = 6, between = 18;
  double x = page_width - right;
  for (std::size_t n = panel.series.size(); n-- > 0;) {
    const std::string& name = panel.series[n].name;
    x -= canvas.text_width(name, text_size);
    canvas.text(x, y - 7, name, text_size);
    canvas.polyline({{x - gap - sample, y - 10.5}, {x - gap, y - 10.5}}, line_of(panel, n));
    x -= gap + sample + between;
  }
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
    const Series& series = panel.series[n];
    Points points;
    for (const auto& [x, value] : series.points) {
      if (series.steps && !points.empty()) points.emplace_back(to_x(x), points.back().second);
      points.emplace_back(to_x(x), to_y(value));
    }
    canvas.polyline(thinned(without_level_middles(points)), line_of(panel, n));
  }
  canvas.end_clip();
  canvas.outline(left, y, width, panel_height, {frame, 0.8});
  canvas.text(18, y + panel_height / 2, panel.y_label, text_size, Canvas::Anchor::middle, black,
              false);
  if (panel.series.size() > 1) draw_legend(canvas, panel, legend_y);
}

}  // namespace

void draw_chart(const Chart& chart, const std::filesystem::path& path) {
  const double strip = chart.bands.empty() ? 0 : strip_height + 3;
  const double head = top + (chart.title.empty() ? 8 : 32) + strip;
  const auto panels = static_cast<double>(chart.panels.size());
  const std::vector<std::string> caption =
      wrapped(Canvas(path, 1, 1), chart.caption, page_width - left - right, small_size);
  const double foot = bottom + caption_row * static_cast<double>(caption.size());
  const double height = head + panels * panel_height + (panels - 1) * panel_gap + foot;
  Canvas canvas(path, page_width, height);
  canvas.text(left, top + 2, chart.title, title_size);
  const Range along = x_range(chart);
  double y = head;
  draw_bands(canvas, chart, along, y);
  for (const ChartPanel& panel : chart.panels) {
    const bool first = &panel == &chart.panels.front(), last = &panel == &chart.panels.back();
    draw_panel(canvas, panel, along, y, first ? y - strip : y, last);
    y += panel_height + panel_gap;
  }
  y -= panel_gap;
  canvas.text(left + (page_width - left - right) / 2, y + 34, chart.x_label, text_size,
              Canvas::Anchor::middle);
  y += 40;
  for (const std::string& line : caption) {
    canvas.text(left, y += caption_row, line, small_size, Canvas::Anchor::left, quiet);
  }
  canvas.write();
}

}  // namespace vicinity::cli
