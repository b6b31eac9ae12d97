// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "picture/canvas.h"

#include <cairo-svg.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fresh_file.h"
#include "vicinity/geometry/error.h"

namespace vicinity::cli {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;

// Called from C: no exception may leave it.
cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  try {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

bool is_svg(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension != ".svg" && extension != ".png") {
    throw Error({.where = path.string(),
                 .what = "is no kind of picture that can be written",
                 .found = extension.empty() ? "no extension" : "'" + extension + "'",
                 .expected = ".png or .svg"});
  }
  return extension == ".svg";
}

void use(cairo_t* cairo, const Colour& colour) {
  cairo_set_source_rgb(cairo, colour.red, colour.green, colour.blue);
}

}  // namespace

Canvas::Canvas(std::filesystem::path path, double width, double height)
    : path_(std::move(path)),
      vector_(is_svg(path_)),
      bytes_(std::make_unique<std::string>()),
      surface_(vector_
                   ? cairo_svg_surface_create_for_stream(append, bytes_.get(), width, height)
                   : cairo_image_surface_create(
                         CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(width * pixels_per_point)),
                         static_cast<int>(std::ceil(height * pixels_per_point))),
               cairo_surface_destroy),
      cairo_(cairo_create(surface_.get()), cairo_destroy) {
  if (!vector_) cairo_scale(cairo_.get(), pixels_per_point, pixels_per_point);
  cairo_select_font_face(cairo_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         CAIRO_FONT_WEIGHT_NORMAL);
  const std::unique_ptr<cairo_font_options_t, void (*)(cairo_font_options_t*)> options(
      cairo_font_options_create(), cairo_font_options_destroy);
  // The same picture on every screen: no fitting of letters to its pixels.
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cairo_.get(), options.get());
  cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
  use(cairo_.get(), white);
  cairo_paint(cairo_.get());
}

void Canvas::rectangle(double x, double y, double width, double height, const Colour& fill) {
  use(cairo_.get(), fill);
  cairo_rectangle(cairo_.get(), x, y, width, height);
  cairo_fill(cairo_.get());
}

void Canvas::stroke(const Line& line) {
  use(cairo_.get(), line.colour);
  cairo_set_line_width(cairo_.get(), line.width);
  cairo_set_dash(cairo_.get(), line.dashes.data(), static_cast<int>(line.dashes.size()), 0);
  cairo_stroke(cairo_.get());
}

void Canvas::outline(double x, double y, double width, double height, const Line& line) {
  cairo_rectangle(cairo_.get(), x, y, width, height);
  stroke(line);
}

void Canvas::polyline(const std::vector<std::pair<double, double>>& points, const Line& line) {
  cairo_new_path(cairo_.get());
  for (const auto& [x, y] : points) cairo_line_to(cairo_.get(), x, y);
  stroke(line);
}

void Canvas::text(double x, double y, const std::string& words, double size, Anchor anchor,
                  const Colour& colour, bool upright) {
  const double width = text_width(words, size);
  const double back = anchor == Anchor::left ? 0 : anchor == Anchor::middle ? width / 2 : width;
  cairo_save(cairo_.get());
  use(cairo_.get(), colour);
  cairo_set_font_size(cairo_.get(), size);
  cairo_translate(cairo_.get(), x, y);
  if (!upright) cairo_rotate(cairo_.get(), -std::numbers::pi / 2);
  cairo_move_to(cairo_.get(), -back, 0);
  cairo_show_text(cairo_.get(), words.c_str());
  cairo_restore(cairo_.get());
}

void Canvas::label(double x, double y, const std::string& words, double size) {
  cairo_save(cairo_.get());
  cairo_set_font_size(cairo_.get(), size);
  cairo_move_to(cairo_.get(), x - text_width(words, size) / 2, y + 0.36 * size);
  cairo_text_path(cairo_.get(), words.c_str());
  use(cairo_.get(), white);
  cairo_set_line_width(cairo_.get(), 0.3 * size);
  cairo_stroke_preserve(cairo_.get());
  use(cairo_.get(), black);
  cairo_fill(cairo_.get());
  cairo_restore(cairo_.get());
}

void Canvas::image(double x, double y, int width, int height,
                   const std::vector<std::uint32_t>& pixels) {
  const Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height),
                      cairo_surface_destroy);
  if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS) return;  // write() says so
  unsigned char* const rows = cairo_image_surface_get_data(image.get());
  const int stride = cairo_image_surface_get_stride(image.get());
  for (int row = 0; row < height; ++row) {
    std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(row) * width, width,
                reinterpret_cast<std::uint32_t*>(rows + static_cast<std::ptrdiff_t>(row) * stride));
  }
  cairo_surface_mark_dirty(image.get());
  cairo_save(cairo_.get());
  cairo_translate(cairo_.get(), x, y);
  cairo_scale(cairo_.get(), 1 / pixels_per_point, 1 / pixels_per_point);
  cairo_set_source_surface(cairo_.get(), image.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo_.get()), CAIRO_FILTER_NEAREST);
  cairo_paint(cairo_.get());
  cairo_restore(cairo_.get());
}

void Canvas::begin_clip(double x, double y, double width, double height) {
  cairo_save(cairo_.get());
  cairo_rectangle(cairo_.get(), x, y, width, height);
  cairo_clip(cairo_.get());
}

void Canvas::end_clip() { cairo_restore(cairo_.get()); }

double Canvas::text_width(const std::string& words, double size) const {
  cairo_text_extents_t extents;
  cairo_save(cairo_.get());
  cairo_set_font_size(cairo_.get(), size);
  cairo_text_extents(cairo_.get(), words.c_str(), &extents);
  cairo_restore(cairo_.get());
  return extents.x_advance;
}

void Canvas::write() {
  cairo_status_t status = cairo_status(cairo_.get());
  if (status == CAIRO_STATUS_SUCCESS && !vector_) {
    status = cairo_surface_write_to_png_stream(surface_.get(), append, bytes_.get());
  }
  cairo_surface_finish(surface_.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface_.get());
  if (status != CAIRO_STATUS_SUCCESS) {
    throw Error({.where = path_.string(),
                 .what = "the picture could not be drawn",
                 .found = cairo_status_to_string(status)});
  }
  FreshFile file(path_);
  file.write(*bytes_);
  file.commit();
}

}  // namespace vicinity::cli
