// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a plant room is put together from: pipes with flanges, tanks, pumps.
#pragma once

#include <array>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity::benchmarks {

/// Adds a placed copy of `part`; closed meshes stay closed.
void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& X = Pose::Identity());

/// Places a part that has its axis along z: its origin goes to `p`, its z to `axis`, shape (3,)
/// [m].
Pose axis_along(const Vec3& p, const Vec3& axis);

/// A line of one pipe: its corners become elbows of one and a half diameters, its long legs take
/// pairs of bolted flanges.
struct PipeLine {
  std::vector<std::array<double, 3>> path;  ///< [m]
  double radius = 0.03;                     ///< outside [m]
  double first_flange = 0.5;                ///< on each leg, as a part of the distance between two
};

/// @param segments  around a pipe; triangles grow with its square
TriangleMesh flanged_pipe(const PipeLine& line, int segments);

/// A tank with two dished ends (half as deep as their radius) and a manway in one of them; axis
/// along z, origin at mid-height. `length` is that of its straight part [m].
TriangleMesh dished_tank(double radius, double length, int segments);

/// A pump and its finned motor on one base plate, shaft along x, origin on the floor below it.
TriangleMesh pump(int segments);

}  // namespace vicinity::benchmarks
