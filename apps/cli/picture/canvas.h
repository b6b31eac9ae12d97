// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A drawing that becomes a PNG or an SVG file, by the file's extension, through the same calls.
#pragma once

#include <cairo.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vicinity::cli {

/// sRGB, 0..1 each.
struct Colour {
  double red = 0, green = 0, blue = 0;
};

inline constexpr Colour black{0, 0, 0}, white{1, 1, 1};

/// Lengths in points from the upper left corner, y down. One point is two pixels of a PNG file, so
/// that text is sharp on paper. The same calls give the same bytes.
class Canvas {
 public:
  /// Where a text is held.
  enum class Anchor { left, middle, right };
  struct Line {
    Colour colour = black;
    double width = 1;
    std::vector<double> dashes = {};
  };
  static constexpr double pixels_per_point = 2;

  /// White, width by height.
  /// Errors: throws Error for an extension other than .png and .svg.
  Canvas(std::filesystem::path path, double width, double height);

  void rectangle(double x, double y, double width, double height, const Colour& fill);
  void outline(double x, double y, double width, double height, const Line& line);
  void polyline(const std::vector<std::pair<double, double>>& points, const Line& line);
  /// One line of text whose baseline is at y; with `upright` false it reads from below upwards.
  void text(double x, double y, const std::string& words, double size, Anchor anchor = Anchor::left,
            const Colour& colour = black, bool upright = true);
  /// Text in black on a white edge, readable on any ground; its middle is at (x, y).
  void label(double x, double y, const std::string& words, double size);
  /// Pixels of colour 0xRRGGBB, row by row from the top, shape (height, width); each covers one
  /// pixel of a PNG file.
  void image(double x, double y, int width, int height, const std::vector<std::uint32_t>& pixels);
  /// Drawing between is kept to a rectangle.
  void begin_clip(double x, double y, double width, double height);
  void end_clip();

  double text_width(const std::string& words, double size) const;

  /// Writes the file, beside and renamed into place. Nothing may be drawn after.
  /// Errors: throws Error where the file cannot be written.
  void write();

 private:
  void stroke(const Line& line);

  std::filesystem::path path_;
  bool vector_ = false;
  std::unique_ptr<std::string> bytes_;  // where cairo's stream goes; must not move
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface_;
  std::unique_ptr<cairo_t, void (*)(cairo_t*)> cairo_;
};

}  // namespace vicinity::cli
