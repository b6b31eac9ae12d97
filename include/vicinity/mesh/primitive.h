// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Closed meshes of simple shapes, in metres: what a scene can hold without a mesh file.
#pragma once

#include <array>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/mesh/triangle_mesh.h"

/// Every shape is closed, wound outward, and free of degenerate triangles. Shapes with a height
/// have their axis along z and the origin at mid-height, as in URDF and SDF. Round shapes are
/// inscribed: their vertices lie on the true surface. Errors: each throws Error for a size that is
/// not positive and finite, for fewer than three segments, and where it says so.
namespace vicinity::primitive {

/// Sides of round shapes, and of pipes, where nothing else is asked for.
inline constexpr int usual_segments = 64, usual_pipe_segments = 32;

/// Cuboid around the origin, shape (3,) edges [m].
TriangleMesh box(const Vec3& size);

TriangleMesh sphere(double radius, int segments = usual_segments);
TriangleMesh cylinder(double radius, double height, int segments = usual_segments);

/// Cylinder of that height with half a ball at each end.
TriangleMesh capsule(double radius, double height, int segments = usual_segments);

/// Apex up.
TriangleMesh cone(double base_radius, double height, int segments = usual_segments);

/// Ring in the x-y plane: `radius` from the axis to the centre of the tube.
TriangleMesh torus(double radius, double tube_radius, int segments = usual_segments);

/// Hollow cylinder, open at both ends.
TriangleMesh tube(double outer_radius, double inner_radius, double height,
                  int segments = usual_segments);

/// Prism over a simple polygon in the x-y plane, counter-clockwise or clockwise, shape (n, 2) [m].
/// Errors: also for a polygon that crosses itself or has no area.
TriangleMesh extrusion(const std::vector<std::array<double, 2>>& outline, double height);

/// Solid of revolution about z of a simple profile (r, z), shape (n, 2) [m], r >= 0; the profile is
/// closed by the axis where its ends lie on it, else from end to start.
TriangleMesh revolution(const std::vector<std::array<double, 2>>& profile,
                        int segments = usual_segments);

/// Round bar (outside of a pipe) along a polyline, shape (n, 3) [m], whose corners are elbows of
/// the given bend radius. Errors: also where a leg is too short for its elbows.
TriangleMesh pipe(const std::vector<std::array<double, 3>>& path, double radius, double bend_radius,
                  int segments = usual_pipe_segments);

/// The wedge of fig. 12: a block with a V cut into its top along y.
/// @param size   of the block, shape (3,) [m]
/// @param depth  of the V below the top, less than size.z [m]
TriangleMesh v_block(const Vec3& size, double depth);

/// The complex cylinder of fig. 17-19 and 23: a cylinder with one narrow and four wider concavities
/// (A and B-E) in its side, the same at every height.
TriangleMesh complex_cylinder(double radius, double height);

}  // namespace vicinity::primitive
