// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Line charts, one above the other over a shared horizontal axis.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "picture/canvas.h"

namespace vicinity::cli {

struct Series {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< (x, y), x rising; y NaN: a gap
  bool steps = false;                             ///< y holds until the next point
};

struct ChartPanel {
  std::string y_label;  ///< quantity and unit, as "drag |F| [N]"
  std::vector<Series> series;
  bool logarithmic = false;  ///< the vertical axis; values are then above zero
};

/// A stretch of the horizontal axis in a colour of its own.
struct ChartBand {
  double from, to;
  Colour colour;
};

/// What holds along the horizontal axis, in colours.
struct ChartStrip {
  std::string label;  ///< a short word; may be empty
  std::vector<ChartBand> bands;
  std::vector<std::pair<std::string, Colour>> key;  ///< what the colours mean; may be empty
};

struct Chart {
  std::string title, caption;  ///< above and below; may be empty
  std::string x_label;
  std::vector<ChartPanel> panels;
  std::vector<ChartStrip> strips;  ///< drawn along the top of the first panel; may be empty
  bool logarithmic_x = false;      ///< the horizontal axis; values are then above zero
};

/// Draws the chart to a .png or .svg file. Series differ in colour, lightness and dashes, so that
/// they can be told apart by a colour-blind person and in grey print. Vertical axes start at zero
/// where nothing is below, unless they are logarithmic.
/// Errors: throws Error for another extension and where the file cannot be written.
void draw_chart(const Chart& chart, const std::filesystem::path& path);

}  // namespace vicinity::cli
