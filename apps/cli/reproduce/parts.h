// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The objects of the paper's figures. It names heights and counts of layers, rarely a shape's own
/// measures: those are ours. Lengths in voxels; the axes of round parts are parallel to z.
#pragma once

#include "reproduce/workshop.h"

namespace vicinity::report {

/// Apex up, 45 high (the paper's sixth track is level with the apex), base of radius 25 on z = 0.
Part cone();
inline constexpr double cone_axis = 60, cone_base_radius = 25, cone_height = 45;

/// Radius 20, from z = 20 to 60.
Part circular_cylinder();

/// One narrow concavity A and four wider ones, from z = 20 to 60 (fig. 19a), radius 40. Turned and
/// placed so that a point at y = 20 passes both lips of one wide concavity, one nearer than the
/// other, without touching (fig. 23f).
Part complex_cylinder();
inline constexpr double complex_cylinder_x = 100.3, complex_cylinder_y = 60.7,
                        complex_cylinder_radius = 40;

/// Outer radius 36, inner radius 28: six layers of m = 4 do not quite meet in its middle.
Part hollow_cylinder();

/// The block with a V along y: 60 x 60 x 40, the V 28 deep (fig. 12).
Part wedge();
inline constexpr double wedge_bottom = 30, wedge_top = 70, wedge_v_depth = 28, wedge_mouth = 40;
/// Voxel i lies opposite of wedge_mirror - i.
inline constexpr int wedge_mirror = 128;

/// 20 x 20 x 20 (fig. 12c, 16).
Part cube();

/// Regular pentagon of circumradius 24, 40 high (fig. 8a).
Part pentagonal_cylinder();

/// Radius 24, 40 high, of 64 facets (fig. 8c).
Part curved_cylinder();

/// Radius 10: layers around it show an element in every direction.
Part ball();
inline constexpr double ball_centre = 64, ball_radius = 10;

/// Two blocks, face to face across a slot along y (§3.1.1).
Part slot();
inline constexpr double slot_middle = 40, slot_half_gap = 4;

/// A round post, and how far beside its axis a line passes it (fig. 2).
Part post();
inline constexpr double post_axis = 40, post_radius = 4, post_line_offset = 6;

/// Radius 24, of segments * (segments - 2) triangles.
Part faceted_sphere(int segments);
inline constexpr double faceted_sphere_centre = 64, faceted_sphere_radius = 24;

}  // namespace vicinity::report
