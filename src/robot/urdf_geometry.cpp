// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "urdf_geometry.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>

#include "vicinity/geometry/error.h"
#include "vicinity/mesh/inspection.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/mesh/stl_file.h"

namespace vicinity {
namespace {

namespace fs = std::filesystem;

// Links of real arms lie in between by far; a mesh in millimetres that is taken for metres does
// not.
constexpr double largest_link = 20, smallest_link = 5e-4;  // [m]

template <std::size_t N>
std::array<double, N> parse_numbers(const std::string& text, const char* attribute,
                                    const std::string& where) {
  std::array<double, N> numbers{};
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto skip_space = [&] {
    while (at != end && std::string_view(" \t\r\n").find(*at) != std::string_view::npos) ++at;
  };
  bool good = true;
  for (double& number : numbers) {
    skip_space();
    if (at != end && *at == '+') ++at;
    const auto [next, error] = std::from_chars(at, end, number);
    good = good && error == std::errc() && std::isfinite(number);
    at = next;
  }
  skip_space();
  if (!good || at != end) {
    throw Error({.where = where,
                 .what = fmt::format("{} cannot be read", attribute),
                 .found = fmt::format("'{}'", text),
                 .expected = N == 1 ? "a number" : fmt::format("{} numbers", N)});
  }
  return numbers;
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// Metres per unit as a COLLADA file states it, near its top; 1 where it does not.
double collada_unit(const fs::path& path) {
  std::string head(1 << 16, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  const std::size_t unit = head.find("<unit");
  const std::size_t end = head.find('>', unit);
  const std::size_t meter = head.find("meter=\"", unit);
  if (unit == std::string::npos || meter == std::string::npos || meter > end) return 1;
  double metres = 1;
  const char* const from = head.data() + meter + 7;
  std::from_chars(from, head.data() + head.size(), metres);
  return std::isfinite(metres) && metres > 0 ? metres : 1;
}

void remark_inspection(const TriangleMesh& mesh, const fs::path& path,
                       std::vector<std::string>& remarks) {
  for (const MeshProblem& problem : inspect(mesh).problems) {
    remarks.push_back(
        fmt::format("mesh {}: {} {}", path.filename().string(), problem.count, problem.what));
  }
  if (lower_case(path.extension().string()) != ".stl") return;
  if (const std::size_t zero_normals = count_zero_normals(path); zero_normals > 0) {
    remarks.push_back(fmt::format("mesh {}: {} stored normals are zero; the winding is used",
                                  path.filename().string(), zero_normals));
  }
}

}  // namespace

double read_number(const XmlElement& element, const char* attribute, double otherwise,
                   const std::string& where) {
  const std::string* text = element.attribute(attribute);
  return text ? parse_numbers<1>(*text, attribute, where)[0] : otherwise;
}

Vec3 read_triple(const XmlElement& element, const char* attribute, const Vec3& otherwise,
                 const std::string& where) {
  const std::string* text = element.attribute(attribute);
  if (!text) return otherwise;
  const auto [x, y, z] = parse_numbers<3>(*text, attribute, where);
  return {x, y, z};
}

Pose read_origin(const XmlElement& element, const std::string& where) {
  const XmlElement* origin = element.child("origin");
  if (!origin) return Pose::Identity();
  const Vec3 xyz = read_triple(*origin, "xyz", Vec3::Zero(), where);
  const Vec3 rpy = read_triple(*origin, "rpy", Vec3::Zero(), where);
  return pose_from_rpy(xyz, rpy);
}

std::optional<TriangleMesh> UrdfGeometry::read(const XmlElement& part, const std::string& link) {
  const std::string where = fmt::format("line {}: {} of link '{}'", part.line, part.name, link);
  try {
    const XmlElement* geometry = part.child("geometry");
    if (!geometry) throw Error({.what = "it has no geometry"});
    TriangleMesh mesh = read_shape(*geometry, where);
    const Pose X_LG = read_origin(part, {});
    for (Vec3& vertex : mesh.vertices) vertex = X_LG * vertex;
    return mesh;
  } catch (const Error& error) {
    remarks_.push_back(fmt::format("{}: {}; left out", where, error.what()));
    return std::nullopt;
  }
}

TriangleMesh UrdfGeometry::read_shape(const XmlElement& geometry, const std::string& where) {
  for (const XmlElement& shape : geometry.children) {
    const auto number = [&](const char* attribute) { return read_number(shape, attribute, 0, {}); };
    if (shape.name == "mesh") return read_mesh_element(shape, where);
    if (shape.name == "box") {
      return primitive::box(read_triple(shape, "size", Vec3::Zero(), {}));
    }
    if (shape.name == "cylinder") {
      return primitive::cylinder(number("radius"), number("length"));
    }
    if (shape.name == "sphere") return primitive::sphere(number("radius"));
    if (shape.name == "capsule") {
      return primitive::capsule(number("radius"), number("length"));
    }
  }
  throw Error({.what = "its shape is not known",
               .found = geometry.children.empty() ? "nothing" : geometry.children.front().name,
               .expected = "mesh, box, cylinder, sphere or capsule"});
}

TriangleMesh UrdfGeometry::read_mesh_element(const XmlElement& element, const std::string& where) {
  const std::string* address = element.attribute("filename");
  if (!address) throw Error({.what = "its mesh has no filename"});
  const fs::path path = find_mesh(*address);
  if (path.empty()) {
    throw Error({.what = fmt::format("mesh '{}' is not there", *address),
                 .hint = address->starts_with("package://")
                             ? "naming the folder that holds the package"
                             : ""});
  }
  TriangleMesh mesh = read_mesh_file(path, where);
  const Vec3 scale = read_triple(element, "scale", Vec3::Ones(), {});
  if (scale.cwiseAbs().minCoeff() == 0) {
    throw Error({.what = "the scale of its mesh is zero"});
  }
  for (Vec3& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
  if (scale.prod() < 0) {  // mirrored: inside out unless wound the other way round
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  const double size = mesh.bounds().sizes().maxCoeff();
  if (!std::isfinite(size)) throw Error({.what = "its mesh is scaled beyond all measure"});
  if (size > largest_link || size < smallest_link) {
    remarks_.push_back(fmt::format(
        "{}: mesh '{}' is {:.3g} m long; meshes of a URDF are in metres, so its scale is probably "
        "missing or wrong",
        where, *address, size));
  }
  return mesh;
}

const TriangleMesh& UrdfGeometry::read_mesh_file(const fs::path& path, const std::string& where) {
  if (const auto known = files_.find(path); known != files_.end()) return known->second;
  TriangleMesh mesh = read_mesh(path);
  if (lower_case(path.extension().string()) == ".dae") {
    const double metres = collada_unit(path);
    if (metres != 1) {
      remarks_.push_back(fmt::format("{}: mesh {} states its own unit of {:g} m, which is applied",
                                     where, path.filename().string(), metres));
      for (Vec3& vertex : mesh.vertices) vertex *= metres;
    }
  }
  remark_inspection(mesh, path, remarks_);
  return files_.emplace(path, std::move(mesh)).first->second;
}

// Empty where there is none.
fs::path UrdfGeometry::find_mesh(const std::string& address) const {
  const std::string_view whole = address;
  const auto after = [&](std::string_view prefix) -> std::optional<std::string_view> {
    if (!whole.starts_with(prefix)) return std::nullopt;
    return whole.substr(prefix.size());
  };
  std::error_code ignored;
  const fs::path folder = fs::absolute(urdf_, ignored).parent_path();

  std::optional<std::string_view> in_package = after("package://");
  if (!in_package) in_package = after("model://");
  if (!in_package) {
    const fs::path path = folder / after("file://").value_or(whole);
    return is_file(path) ? path.lexically_normal() : fs::path();
  }
  const fs::path inside = *in_package;
  for (fs::path above = folder;; above = above.parent_path()) {
    if (is_file(above / inside)) return above / inside;
    if (above == above.parent_path()) break;
  }
  const fs::path package = inside.empty() ? fs::path() : *inside.begin();
  for (const fs::path& given : options_.package_folders) {
    if (is_file(given / inside)) return given / inside;
    const fs::path itself = fs::absolute(given, ignored).lexically_normal();
    const fs::path name =
        itself.has_filename() ? itself.filename() : itself.parent_path().filename();
    const fs::path path = given / inside.lexically_relative(package);
    if (name == package && is_file(path)) return path;
  }
  return {};
}

}  // namespace vicinity
