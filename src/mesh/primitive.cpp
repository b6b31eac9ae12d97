// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/primitive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>

#include "polygon.h"
#include "vicinity/geometry/error.h"

namespace vicinity::primitive {
namespace {

using std::numbers::pi;

void require_length(const char* shape, const char* name, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw Error({.where = shape,
               .what = fmt::format("{} is not a length", name),
               .found = fmt::format("{}", value),
               .expected = "a positive number of metres"});
}

void require_less(const char* shape, const char* small_name, double small, const char* large_name,
                  double large) {
  if (small < large) return;
  throw Error({.where = shape,
               .what = fmt::format("{} must be less than {}", small_name, large_name),
               .found = fmt::format("{}", small),
               .expected = fmt::format("less than {}", large)});
}

std::size_t require_segments(const char* shape, int segments) {
  constexpr int fewest = 3;
  // Beyond this a circle is round to far below a voxel, and the number is a slip of the pen.
  constexpr int most = 1 << 16;
  if (segments < fewest || segments > most) {
    throw Error({.where = shape,
                 .what = "segments out of range",
                 .found = fmt::format("{}", segments),
                 .expected = fmt::format("{} to {}", fewest, most)});
  }
  return static_cast<std::size_t>(segments);
}

/// Returns the outline counter-clockwise, whichever way round it came.
std::vector<PlanePoint> require_polygon(const char* shape, std::vector<PlanePoint> outline) {
  const bool finite = std::all_of(outline.begin(), outline.end(), [](const PlanePoint& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]);
  });
  if (!finite || !is_simple(outline)) {
    throw Error({.where = shape,
                 .what = "the outline is not a simple polygon",
                 .found = fmt::format("{} points", outline.size()),
                 .expected = "three or more finite points, none twice, edges that do not meet",
                 .hint = "leaving out a last point that repeats the first"});
  }
  if (signed_area(outline) < 0) std::reverse(outline.begin(), outline.end());
  return outline;
}

/// The point at `step` of `steps` around a circle; exact on the axes, so that shapes are as wide
/// as they were asked for.
PlanePoint on_circle(double radius, std::size_t step, std::size_t steps) {
  if (4 * step % steps == 0) {
    constexpr double quarters[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const auto& at = quarters[4 * step / steps % 4];
    return {radius * at[0], radius * at[1]};
  }
  const double angle = 2 * pi * static_cast<double>(step) / static_cast<double>(steps);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Adds the two triangles of a quadrilateral, corners counter-clockwise seen from outside; one
/// triangle where an edge has shrunk to a point.
void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              std::uint32_t d) {
  if (a != b && b != c && a != c) mesh.triangles.push_back({a, b, c});
  if (a != c && c != d && a != d) mesh.triangles.push_back({a, c, d});
}

}  // namespace

TriangleMesh box(const Vec3& size) {
  require_length("box", "size x", size.x());
  require_length("box", "size y", size.y());
  require_length("box", "size z", size.z());
  const double x = size.x() / 2, y = size.y() / 2;
  return extrusion({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, size.z());
}

TriangleMesh sphere(double radius, int segments) {
  require_length("sphere", "radius", radius);
  const std::size_t bands = std::max<std::size_t>(2, require_segments("sphere", segments) / 2);
  std::vector<PlanePoint> profile{{0, -radius}};
  for (std::size_t band = 1; band < bands; ++band) {
    const PlanePoint up = on_circle(radius, band, 2 * bands);
    profile.push_back({up[1], -up[0]});
  }
  profile.push_back({0, radius});
  return revolution(profile, segments);
}

TriangleMesh cylinder(double radius, double height, int segments) {
  require_length("cylinder", "radius", radius);
  require_length("cylinder", "height", height);
  const double z = height / 2;
  return revolution({{0, -z}, {radius, -z}, {radius, z}, {0, z}}, segments);
}

TriangleMesh capsule(double radius, double height, int segments) {
  require_length("capsule", "radius", radius);
  require_length("capsule", "height", height);
  const auto arcs = std::max<std::size_t>(2, require_segments("capsule", segments) / 4);
  std::vector<PlanePoint> profile;
  for (const double side : {-1., 1.}) {
    for (std::size_t step = 0; step <= arcs; ++step) {
      const std::size_t from_pole = side < 0 ? step : arcs - step;
      const double angle = pi / 2 * static_cast<double>(from_pole) / static_cast<double>(arcs);
      profile.push_back({from_pole == 0 ? 0 : radius * std::sin(angle),
                         side * (height / 2 + radius * std::cos(angle))});
    }
  }
  return revolution(profile, segments);
}

TriangleMesh cone(double base_radius, double height, int segments) {
  require_length("cone", "base radius", base_radius);
  require_length("cone", "height", height);
  return revolution({{0, -height / 2}, {base_radius, -height / 2}, {0, height / 2}}, segments);
}

TriangleMesh torus(double radius, double tube_radius, int segments) {
  require_length("torus", "radius", radius);
  require_length("torus", "tube radius", tube_radius);
  require_less("torus", "tube radius", tube_radius, "radius", radius);
  const std::size_t around = std::max<std::size_t>(3, require_segments("torus", segments) / 2);
  std::vector<PlanePoint> profile;
  for (std::size_t step = 0; step < around; ++step) {
    const PlanePoint at = on_circle(tube_radius, step, around);
    profile.push_back({radius + at[0], at[1]});
  }
  return revolution(profile, segments);
}

TriangleMesh tube(double outer_radius, double inner_radius, double height, int segments) {
  require_length("tube", "outer radius", outer_radius);
  require_length("tube", "inner radius", inner_radius);
  require_length("tube", "height", height);
  require_less("tube", "inner radius", inner_radius, "outer radius", outer_radius);
  const double z = height / 2;
  return revolution({{inner_radius, -z}, {outer_radius, -z}, {outer_radius, z}, {inner_radius, z}},
                    segments);
}

TriangleMesh extrusion(const std::vector<PlanePoint>& outline, double height) {
  require_length("extrusion", "height", height);
  const std::vector<PlanePoint> polygon = require_polygon("extrusion", outline);
  const auto n = static_cast<std::uint32_t>(polygon.size());
  TriangleMesh mesh;
  for (const double z : {-height / 2, height / 2}) {
    for (const PlanePoint& p : polygon) mesh.vertices.emplace_back(p[0], p[1], z);
  }
  for (const auto& [a, b, c] : triangulate(polygon)) {
    mesh.triangles.push_back({c, b, a});
    mesh.triangles.push_back({a + n, b + n, c + n});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    add_quad(mesh, i, next, next + n, i + n);
  }
  return mesh;
}

TriangleMesh revolution(const std::vector<PlanePoint>& profile, int segments) {
  const auto around = static_cast<std::uint32_t>(require_segments("revolution", segments));
  const std::vector<PlanePoint> polygon = require_polygon("revolution", profile);
  TriangleMesh mesh;
  std::vector<std::uint32_t> first;  // vertex of each profile point at angle zero
  for (const PlanePoint& p : polygon) {
    if (p[0] < 0) {
      throw Error({.where = "revolution",
                   .what = "the profile crosses the axis",
                   .found = fmt::format("r = {}", p[0]),
                   .expected = "r of zero or more"});
    }
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    const std::uint32_t copies = p[0] == 0 ? 1 : around;
    for (std::uint32_t step = 0; step < copies; ++step) {
      const PlanePoint at = on_circle(p[0], step, around);
      mesh.vertices.emplace_back(at[0], at[1], p[1]);
    }
  }
  const auto vertex = [&](std::size_t point, std::uint32_t step) {
    return polygon[point][0] == 0 ? first[point] : first[point] + step % around;
  };
  for (std::size_t low = 0; low < polygon.size(); ++low) {
    const std::size_t high = (low + 1) % polygon.size();
    for (std::uint32_t step = 0; step < around; ++step) {
      add_quad(mesh, vertex(low, step), vertex(low, step + 1), vertex(high, step + 1),
               vertex(high, step));
    }
  }
  return mesh;
}

TriangleMesh pipe(const std::vector<std::array<double, 3>>& path, double radius, double bend_radius,
                  int segments) {
  require_length("pipe", "radius", radius);
  require_length("pipe", "bend radius", bend_radius);
  require_less("pipe", "radius", radius, "bend radius", bend_radius);
  const std::size_t around = require_segments("pipe", segments);
  std::vector<Vec3> corners;
  for (const auto& p : path) corners.emplace_back(p[0], p[1], p[2]);
  std::vector<Vec3> ahead;   // direction of each leg
  std::vector<double> left;  // length of each leg not yet taken by an elbow
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vec3 leg = corners[i + 1] - corners[i];
    const double length = leg.norm();
    require_length("pipe", fmt::format("leg {}", i + 1).c_str(), length);
    ahead.push_back(leg / length);
    left.push_back(length);
  }
  if (ahead.empty()) {
    throw Error({.where = "pipe",
                 .what = "the path has no leg",
                 .found = fmt::format("{} points", corners.size()),
                 .expected = "two or more"});
  }

  TriangleMesh mesh;
  std::uint32_t rings = 0;
  const auto n = static_cast<std::uint32_t>(around);
  Vec3 ring_centre = Vec3::Constant(std::numeric_limits<double>::infinity());
  const auto add_ring = [&](const Vec3& centre, const Vec3& u, const Vec3& v) {
    // Where two elbows meet, or one meets an end, the leg between them has no length.
    if ((centre - ring_centre).norm() <= 1e-9 * bend_radius) return;
    ring_centre = centre;
    for (std::size_t step = 0; step < around; ++step) {
      const PlanePoint at = on_circle(radius, step, around);
      mesh.vertices.push_back(centre + at[0] * u + at[1] * v);
    }
    if (++rings == 1) return;
    const std::uint32_t here = (rings - 1) * n, before = here - n;
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t next = (i + 1) % n;
      add_quad(mesh, before + i, before + next, here + next, here + i);
    }
  };

  // u and v span the cross-section, u x v pointing ahead; elbows carry them round without twist.
  Vec3 u = ahead[0].unitOrthogonal(), v = ahead[0].cross(u);
  add_ring(corners.front(), u, v);
  for (std::size_t i = 0; i + 1 < ahead.size(); ++i) {
    const Vec3 cross = ahead[i].cross(ahead[i + 1]);
    const double angle = std::atan2(cross.norm(), ahead[i].dot(ahead[i + 1]));
    constexpr double straight = 1e-6;  // radians
    if (angle < straight) continue;
    const double taken = bend_radius * std::tan(angle / 2);  // from the corner to where it bends
    left[i] -= taken;
    left[i + 1] -= taken;
    const double slack = 1e-9 * (taken + bend_radius);
    if (angle > pi - straight || left[i] < -slack ||
        (i + 2 == ahead.size() && left[i + 1] < -slack)) {
      throw Error({.where = "pipe",
                   .what = fmt::format("no room for the elbow at point {} of the path", i + 2),
                   .found = fmt::format("a turn of {:.1f} degrees", angle * 180 / pi),
                   .expected = fmt::format("legs of at least {:.4g} m on either side", taken),
                   .hint = "a smaller bend radius or longer legs"});
    }
    const Vec3 axis = cross.normalized();
    const Vec3 begin = corners[i + 1] - taken * ahead[i];
    const Vec3 centre = begin + bend_radius * axis.cross(ahead[i]);
    const auto steps = static_cast<std::size_t>(
        std::max(1.0, std::ceil(angle / (2 * pi) * static_cast<double>(around))));
    const Vec3 u_before = u, v_before = v;
    for (std::size_t step = 0; step <= steps; ++step) {
      const Eigen::AngleAxisd bend(angle * static_cast<double>(step) / static_cast<double>(steps),
                                   axis);
      u = bend * u_before;
      v = bend * v_before;
      add_ring(centre + bend * (begin - centre), u, v);
    }
  }
  add_ring(corners.back(), u, v);

  const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
  const std::uint32_t last = (rings - 1) * n;
  mesh.vertices.push_back(corners.front());
  mesh.vertices.push_back(corners.back());
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({centre, next, i});
    mesh.triangles.push_back({centre + 1, last + i, last + next});
  }
  return mesh;
}

TriangleMesh v_block(const Vec3& size, double depth) {
  require_length("v_block", "size x", size.x());
  require_length("v_block", "size y", size.y());
  require_length("v_block", "size z", size.z());
  require_length("v_block", "depth", depth);
  require_less("v_block", "depth", depth, "size z", size.z());
  const double x = size.x() / 2, z = size.z() / 2;
  const double mouth = x * 2 / 3;  // half the width of the V at the top; the rest is its rim
  TriangleMesh mesh = extrusion(
      {{-x, -z}, {x, -z}, {x, z}, {mouth, z}, {0, z - depth}, {-mouth, z}, {-x, z}}, size.y());
  // The outline was drawn in x and z: turn its plane upright about x.
  for (Vec3& p : mesh.vertices) p = Vec3(p.x(), -p.z(), p.y());
  return mesh;
}

TriangleMesh complex_cylinder(double radius, double height) {
  require_length("complex_cylinder", "radius", radius);
  require_length("complex_cylinder", "height", height);
  // Each concavity is a round bite: its middle [degrees], half its mouth [degrees], and how deep
  // it reaches below the rim, in radii. A is deeper than wide, so that layers of a few voxels fill
  // it up; B to E are wider than deep, and keep their free space (§5.1.2).
  struct Concavity {
    double middle, half_mouth, depth;
  };
  constexpr Concavity concavities[] = {{90, 6, 0.45},    // A
                                       {170, 20, 0.25},  // B
                                       {235, 18, 0.22},  // C
                                       {300, 20, 0.28},  // D
                                       {10, 24, 0.30}};  // E
  constexpr double step = 2;                             // degrees between points of the round side
  constexpr std::size_t bite = 12;                       // edges along a concavity
  std::vector<PlanePoint> outline;
  const auto put = [&](double r, double degrees) {
    const double angle = degrees * pi / 180;
    outline.push_back({r * std::cos(angle), r * std::sin(angle)});
  };
  for (std::size_t i = 0; i < std::size(concavities); ++i) {
    const Concavity& here = concavities[i];
    const Concavity& next = concavities[(i + 1) % std::size(concavities)];
    // Half an ellipse, drawn in angle and radius, from one lip of the mouth to the other.
    for (std::size_t k = 0; k <= bite; ++k) {
      const double phase = pi * static_cast<double>(k) / static_cast<double>(bite);
      put(radius * (1 - (k == 0 || k == bite ? 0 : here.depth * std::sin(phase))),
          here.middle - here.half_mouth * std::cos(phase));
    }
    const double from = here.middle + here.half_mouth;
    const double to = next.middle - next.half_mouth + (next.middle < here.middle ? 360 : 0);
    for (double at = from + step; at < to - step / 2; at += step) put(radius, at);
  }
  return extrusion(outline, height);
}

}  // namespace vicinity::primitive
