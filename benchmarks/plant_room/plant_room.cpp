// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "plant_room/plant_room.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "plant_room/parts.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity::benchmarks {
namespace {

using Point = std::array<double, 3>;

// The room, in metres: x 0..10, y 0..8, z 0..4, walls, floor and ceiling within.
constexpr double length = 10, width = 8, height = 4, wall = 0.1;
constexpr double buried = wall / 2;  // where pipes end: within floor, ceiling or wall
constexpr int pipes_per_run = 8;
constexpr std::array narrow = {0.0169, 0.0242, 0.0302};    // outside radii of DN 25, 40, 50 [m]
constexpr std::array middling = {0.0242, 0.0302, 0.0381};  // DN 40, 50, 65

/// A wall as its pipes see it: s along it, off away from it.
struct WallFrame {
  const char* name;
  Vec3 corner, along, inward;
  double length;
  double pipes_until;  // s: before the door, or the next corner

  Point at(double s, double off, double z) const {
    const Vec3 p = corner + s * along + off * inward + z * Vec3::UnitZ();
    return {p.x(), p.y(), p.z()};
  }
};

const std::array<WallFrame, 4>& walls() {
  static const std::array<WallFrame, 4> all = {{
      {"south", {0, 0, 0}, Vec3::UnitX(), Vec3::UnitY(), length, 8.4},
      {"east", {length, 0, 0}, Vec3::UnitY(), -Vec3::UnitX(), width, width - 0.6},
      {"north", {length, width, 0}, -Vec3::UnitX(), -Vec3::UnitY(), length, length - 0.6},
      {"west", {0, width, 0}, -Vec3::UnitY(), Vec3::UnitX(), width, width - 0.6},
  }};
  return all;
}

struct Tank {
  Vec3 centre;
  Vec3 axis;
  double radius, length;
  bool upright() const { return axis.z() > 0.5; }
};

const std::array<Tank, 7>& tanks() {
  static const std::array<Tank, 7> all = {{
      {{1.5, 1.6, 1.25}, Vec3::UnitZ(), 0.60, 1.3},
      {{5.0, 1.6, 1.25}, Vec3::UnitZ(), 0.55, 1.3},
      {{8.3, 2.4, 1.20}, Vec3::UnitZ(), 0.55, 1.2},
      {{1.5, 6.3, 1.25}, Vec3::UnitZ(), 0.60, 1.3},
      {{5.0, 4.0, 0.95}, Vec3::UnitX(), 0.50, 1.9},
      {{8.4, 4.6, 0.95}, Vec3::UnitY(), 0.50, 1.7},
      {{5.2, 6.4, 0.95}, Vec3::UnitX(), 0.50, 1.9},
  }};
  return all;
}

class Builder {
 public:
  explicit Builder(const PlantRoomOptions& options)
      : segments_(options.segments), random_(options.seed) {
    scene_.voxel_size = options.voxel_size;
    scene_.bounds = Box(Vec3::Zero(), Vec3(length, width, height));
  }

  Scene scene() {
    shell();
    for (const WallFrame& frame : walls()) wall_runs(frame);
    racks();
    risers();
    for (std::size_t t = 0; t < tanks().size(); ++t) tank(tanks()[t], std::to_string(t + 1));
    for (const auto& [name, p] :
         {std::pair{"pump_1", Vec3(3.1, 1.4, wall)}, std::pair{"pump_2", Vec3(3.1, 6.4, wall)}}) {
      TriangleMesh mesh;
      append(mesh, pump(segments_), axis_along(p, Vec3::UnitZ()));
      add(name, std::move(mesh));
    }
    return std::move(scene_);
  }

 private:
  void add(const std::string& name, TriangleMesh mesh) {
    scene_.objects.push_back({.name = name, .shape = std::move(mesh)});
  }

  // Not the standard's distributions: they differ from library to library.
  double between(double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(random_()) / 4294967296.0;
  }
  template <std::size_t n>
  double one_of(const std::array<double, n>& values) {
    return values[random_() % n];
  }

  static void add_box(TriangleMesh& mesh, const Vec3& lo, const Vec3& hi) {
    TriangleMesh box = primitive::box(hi - lo);
    for (Vec3& p : box.vertices) p += (lo + hi) / 2;
    append(mesh, box);
  }

  void shell() {
    const auto slab = [&](const std::string& name, const Vec3& lo, const Vec3& hi) {
      TriangleMesh mesh;
      add_box(mesh, lo, hi);
      add(name, std::move(mesh));
    };
    slab("floor", {0, 0, 0}, {length, width, wall});
    slab("ceiling", {0, 0, height - wall}, {length, width, height});
    slab("wall_east", {length - wall, wall, wall}, {length, width - wall, height - wall});
    slab("wall_north", {0, width - wall, wall}, {length, width, height - wall});
    slab("wall_west", {0, wall, wall}, {wall, width - wall, height - wall});
    // The south wall has the door: an upright outline in x and z.
    TriangleMesh south = primitive::extrusion({{0, wall},
                                               {8.8, wall},
                                               {8.8, 2.2},
                                               {9.7, 2.2},
                                               {9.7, wall},
                                               {length, wall},
                                               {length, height - wall},
                                               {0, height - wall}},
                                              wall);
    for (Vec3& p : south.vertices) p = Vec3(p.x(), wall / 2 - p.z(), p.y());
    add("wall_south", std::move(south));
  }

  template <class Path>
  void run(const std::string& name, double radius_of_one, Path&& path) {
    TriangleMesh mesh;
    for (int k = 0; k < pipes_per_run; ++k) {
      const double radius = radius_of_one > 0 ? radius_of_one : one_of(narrow);
      // Neighbours' flanges sit beside each other's pipes, not flanges.
      const double first_flange = 0.2 + 0.45 * (k % 2) + between(0, 0.15);
      append(mesh, flanged_pipe({path(k), radius, first_flange}, segments_));
    }
    add(name, std::move(mesh));
  }

  /// Two runs on brackets: a low one that comes out of the floor and goes back into it, and a high
  /// one from wall to wall. Both step round an expansion loop half-way.
  void wall_runs(const WallFrame& frame) {
    constexpr double pitch = 0.13, off = wall + 0.12, loop_out = 0.3;
    const std::string name = frame.name;
    const double loop = 0.6 + (frame.pipes_until - 0.6) * between(0.45, 0.55);
    const double loop_half = between(0.3, 0.4);
    const auto with_loop = [&](double from, double to, double z, Point first, Point last) {
      return std::vector<Point>{first,
                                frame.at(from, off, z),
                                frame.at(loop - loop_half, off, z),
                                frame.at(loop - loop_half, off + loop_out, z),
                                frame.at(loop + loop_half, off + loop_out, z),
                                frame.at(loop + loop_half, off, z),
                                frame.at(to, off, z),
                                last};
    };
    run("pipes_" + name + "_low", 0, [&](int k) {
      const double from = 0.6 + (pipes_per_run - 1 - k) * pitch;
      const double to = frame.pipes_until - (pipes_per_run - 1 - k) * pitch;
      return with_loop(from, to, 0.45 + k * pitch, frame.at(from, off, buried),
                       frame.at(to, off, buried));
    });
    run("pipes_" + name + "_high", 0, [&](int k) {
      const double from = 0.6 + between(0, 0.3), to = frame.pipes_until - between(0, 0.3);
      return with_loop(from, to, 1.75 + k * pitch, frame.at(from, buried, 1.75 + k * pitch),
                       frame.at(to, buried, 1.75 + k * pitch));
    });
    TriangleMesh brackets;
    const auto bar = [&](double s, double half, double off_from, double off_to, double z_from,
                         double z_to) {
      const Vec3 a(frame.at(s - half, off_from, z_from).data());
      const Vec3 b(frame.at(s + half, off_to, z_to).data());
      add_box(brackets, a.cwiseMin(b), a.cwiseMax(b));
    };
    for (double s = 1.7; s < frame.pipes_until - 1.2; s += 1.25) {
      if (std::abs(s - loop) < loop_half + 0.15) continue;
      for (const double z : {0.45, 1.75}) {
        bar(s, 0.02, buried, wall + 0.04, z - 0.1, z + pipes_per_run * pitch);
        for (int k = 0; k < pipes_per_run; ++k) {
          const double below = z + k * pitch - 0.045;
          bar(s, 0.015, wall + 0.03, off + 0.04, below, below + 0.012);
        }
      }
    }
    add("brackets_" + name, std::move(brackets));
  }

  /// Three racks along x close under the ceiling, and three along y below them. Each pipe drops to
  /// the floor in the gap between the racks that cross it, with a sidestep on its way down.
  void racks() {
    constexpr double pitch = 0.16, high = 3.4, low = 2.95, dip = 0.3;
    constexpr double across = (pipes_per_run - 1) * pitch;
    const std::array<double, 3> y_of = {1.0, 3.44, 5.8}, x_of = {1.2, 4.4, 7.6};
    const std::array<double, 3> lo_y = {2.6, 2.5, 0.9}, hi_y = {4.5, 3.1, 1.5};
    for (std::size_t r = 0; r < 3; ++r) {
      const std::string number = std::to_string(r + 1);
      const double x_dip = between(2.6, 2.9), y_dip = between(5.0, 5.1);
      run("rack_x_" + number, one_of(middling), [&](int k) {
        const double y = y_of[r] + k * pitch, x = between(6.65, 7.1), z = between(1.0, 2.2);
        return std::vector<Point>{{buried, y, high},
                                  {x_dip, y, high},
                                  {x_dip, y, high - dip},
                                  {x_dip + 0.8, y, high - dip},
                                  {x_dip + 0.8, y, high},
                                  {x, y, high},
                                  {x, y, z},
                                  {x + 0.35, y, z},
                                  {x + 0.35, y, buried}};
      });
      run("rack_y_" + number, one_of(middling), [&](int k) {
        const double x = x_of[r] + k * pitch, y = between(lo_y[r], hi_y[r]), z = between(1.0, 2.2);
        return std::vector<Point>{{x, width - buried, low},
                                  {x, y_dip + 0.6, low},
                                  {x, y_dip + 0.6, low - dip},
                                  {x, y_dip, low - dip},
                                  {x, y_dip, low},
                                  {x, y, low},
                                  {x, y, z},
                                  {x, y - 0.35, z},
                                  {x, y - 0.35, buried}};
      });
      hangers("hangers_x_" + number, {0.9, y_of[r] + across / 2, high}, Vec3::UnitX(), 5.4, across);
      hangers("hangers_y_" + number, {x_of[r] + across / 2, 7.3, low}, -Vec3::UnitY(),
              7.3 - hi_y[r] - 0.2, across);
    }
  }

  /// Trapezes: a bar below the pipes on two rods from the ceiling, every 1.2 m from `first`.
  void hangers(const std::string& name, const Point& first, const Vec3& along, double far,
               double across) {
    const Vec3 side = along.cross(Vec3::UnitZ());
    const double half = across / 2 + 0.1;
    TriangleMesh mesh;
    for (double s = 0; s < far; s += 1.2) {
      const Vec3 p = Vec3(first.data()) + s * along - 0.065 * Vec3::UnitZ();
      const Vec3 reach = half * side.cwiseAbs() + 0.025 * along.cwiseAbs() + 0.02 * Vec3::UnitZ();
      add_box(mesh, p - reach, p + reach);
      const double rod = height - buried - p.z();
      for (const double end : {-1.0, 1.0}) {
        append(mesh, primitive::cylinder(0.008, rod, 16),
               axis_along(p + end * (half - 0.03) * side + rod / 2 * Vec3::UnitZ(), Vec3::UnitZ()));
      }
    }
    add(name, std::move(mesh));
  }

  /// Four groups upright through the room, two rows of four, that step aside one over the other.
  void risers() {
    constexpr double pitch = 0.15;
    int number = 0;
    for (const double y_first : {2.55, 4.9}) {
      for (const double x_first : {3.0, 6.0}) {
        const double step_z = between(1.6, 2.2);
        run("risers_" + std::to_string(++number), 0, [&](int k) {
          const double x = x_first + (k % 4) * pitch, y = y_first + (k / 4) * 0.2;
          const double z = step_z - (k % 4) * pitch;
          return std::vector<Point>{
              {x, y, buried}, {x, y, z}, {x + 0.3, y, z}, {x + 0.3, y, height - buried}};
        });
      }
    }
  }

  /// A tank on its skirt or its saddles, and the eight lines that leave it for the floor: four from
  /// above and four from its sides.
  void tank(const Tank& tank, const std::string& number) {
    TriangleMesh mesh;
    append(mesh, dished_tank(tank.radius, tank.length, segments_),
           axis_along(tank.centre, tank.axis));
    const double R = tank.radius;
    const Vec3 c = tank.centre;
    if (tank.upright()) {
      const double skirt = c.z() - tank.length / 2 - buried + 0.05;
      append(mesh, primitive::tube(0.9 * R, 0.9 * R - 0.02, skirt, 2 * segments_),
             axis_along({c.x(), c.y(), buried + skirt / 2}, Vec3::UnitZ()));
    } else {
      const Vec3 side = tank.axis.cross(Vec3::UnitZ()).cwiseAbs();
      for (const double end : {-0.35, 0.35}) {
        const Vec3 p = c + end * tank.length * tank.axis;
        const Vec3 reach = 0.7 * R * side + 0.08 * tank.axis;
        add_box(mesh, {p.x() - reach.x(), p.y() - reach.y(), buried},
                {p.x() + reach.x(), p.y() + reach.y(), c.z() - 0.6 * R});
      }
    }
    add("tank_" + number, std::move(mesh));

    run("tank_lines_" + number, 0, [&](int k) {
      const bool from_above = k < 4;
      Vec3 begin, out;
      double far;
      if (tank.upright()) {
        const double angle = std::numbers::pi / 4 * (2 * (k % 4) + (from_above ? 1 : 0));
        out = Vec3(std::cos(angle), std::sin(angle), 0);
        begin = from_above ? Vec3(c + 0.6 * R * out + tank.length / 2 * Vec3::UnitZ())
                           : Vec3(c + 0.8 * R * out - between(0.1, 0.4) * Vec3::UnitZ());
        far = (from_above ? 0.4 : 0.2) * R + between(0.25, 0.3);
      } else {
        const double s = (from_above ? -0.35 : -0.22) + 0.22 * (k % 4);
        out = (k % 2 == 0 ? 1 : -1) * tank.axis.cross(Vec3::UnitZ());
        begin = c + s * tank.length * tank.axis +
                (from_above ? Vec3(0.8 * R * Vec3::UnitZ()) : Vec3(0.8 * R * out));
        far = (from_above ? R : 0.2 * R) + between(0.25, 0.35);
      }
      std::vector<Point> path = {{begin.x(), begin.y(), begin.z()}};
      if (from_above) {
        begin.z() = c.z() + (tank.upright() ? tank.length / 2 + 0.5 * R : R) + between(0.25, 0.4);
        path.push_back({begin.x(), begin.y(), begin.z()});
      }
      const Vec3 end = begin + far * out;
      path.push_back({end.x(), end.y(), end.z()});
      path.push_back({end.x(), end.y(), buried});
      return path;
    });
  }

  int segments_;
  std::mt19937 random_;
  Scene scene_;
};

}  // namespace

Scene plant_room(const PlantRoomOptions& options) { return Builder(options).scene(); }

}  // namespace vicinity::benchmarks
