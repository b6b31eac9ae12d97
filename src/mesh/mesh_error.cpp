// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "mesh_error.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <system_error>

#include "vicinity/geometry/error.h"

namespace vicinity {

void throw_insane(const std::filesystem::path& path, const std::string& place, const Vec3& vertex) {
  throw Error({.where = path.string() + ", " + place,
               .what = vertex.allFinite() ? "a coordinate is absurdly large"
                                          : "a coordinate is not a finite number",
               .found = fmt::format("({:g}, {:g}, {:g})", vertex.x(), vertex.y(), vertex.z()),
               .expected = fmt::format("numbers between -{0:g} and {0:g}", largest_coordinate),
               .hint = "exporting the mesh again"});
}

void throw_no_triangle(const std::filesystem::path& path) {
  throw Error({.where = path.string(),
               .what = "the mesh holds no triangle",
               .found = "0 triangles",
               .expected = "at least one",
               .hint = "exporting the mesh again, with the part selected"});
}

std::size_t readable_size(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw Error({.where = path.string(), .what = "there is no such file"});
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw Error({.where = path.string(),
                 .what = "not a mesh file",
                 .found = std::filesystem::is_directory(status) ? "a folder" : "a device or pipe",
                 .expected = "a file"});
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || access(path.c_str(), R_OK) != 0) {
    throw Error({.where = path.string(),
                 .what = "the file cannot be read",
                 .hint = "checking its permissions"});
  }
  return static_cast<std::size_t>(size);
}

}  // namespace vicinity
