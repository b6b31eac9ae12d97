// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulate/interval_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "picture/canvas.h"

namespace vicinity::cli {

void draw_intervals(const std::vector<std::string>& rows,
                    const std::vector<IntervalColumn>& columns, const std::filesystem::path& path) {
  constexpr double names = 120, column = 105, gap = 14, row = 16, head = 34, foot = 26;
  constexpr Colour ink{0.1, 0.13, 0.15}, grid{0.86, 0.88, 0.9}, dot{0.0, 0.45, 0.7};
  const double height = head + row * static_cast<double>(rows.size()) + foot;
  Canvas canvas(path, names + (column + gap) * static_cast<double>(columns.size()), height);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const double y = head + row * (static_cast<double>(n) + 0.5);
    canvas.text(names - 8, y + 3.5, rows[n], 9.5, Canvas::Anchor::right, ink);
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const IntervalColumn& each = columns[c];
    const double left = names + (column + gap) * static_cast<double>(c);
    const auto x = [&](double value) {
      return left + column * std::clamp(value / each.most, 0.0, 1.0);
    };
    canvas.text(left, head - 14, each.title, 10.5, Canvas::Anchor::left, ink);
    if (std::find(each.there.begin(), each.there.end(), true) == each.there.end()) {
      canvas.text(left + column / 2, height / 2, "none", 8.5, Canvas::Anchor::middle, ink);
      continue;
    }
    for (int part = 0; part <= 2; ++part) {
      const double at = left + column * part / 2;
      canvas.polyline({{at, head - 6}, {at, height - foot}}, {grid, 1, {}});
      canvas.text(at, height - foot + 13, fmt::format("{:g}", each.most * part / 2), 8.5,
                  part == 2   ? Canvas::Anchor::right
                  : part == 0 ? Canvas::Anchor::left
                              : Canvas::Anchor::middle,
                  ink);
    }
    for (std::size_t n = 0; n < each.rows.size(); ++n) {
      if (!each.there[n]) continue;
      const double y = head + row * (static_cast<double>(n) + 0.5);
      canvas.polyline({{x(each.rows[n].low), y}, {x(each.rows[n].high), y}}, {dot, 1.6, {}});
      canvas.rectangle(x(each.rows[n].value) - 2.5, y - 2.5, 5, 5, dot);
    }
  }
  canvas.write();
}

}  // namespace vicinity::cli
