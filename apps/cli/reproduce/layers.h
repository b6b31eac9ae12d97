// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Ranked layers around the paper's objects: figures 16 to 21 and table 1.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reproduce/item.h"
#include "reproduce/layer_fidelity.h"

namespace vicinity::report {

/// Layers around one object, measured.
struct Wrapping {
  std::string part;
  LayerShape shape = LayerShape::cube;
  int m = 0;
  std::vector<LayerReach> reaches;  ///< by rank
};

/// Fig. 16: neighbours of rank 1 around the cube, m = 1.
struct FirstNeighbours {
  std::uint64_t ranked = 0;   ///< voxels of rank 1
  std::uint64_t missing = 0;  ///< empty voxels beside a boundary voxel, across corners too
  std::uint64_t beyond = 0;   ///< voxels of rank 1 that are beside none
};
std::vector<Check> check_fig16(const FirstNeighbours& first);
Outcome fig16(Workshop& workshop);

/// Fig. 17: cubes. @param cubes  of growing m for each part
std::vector<Check> check_fig17(const std::vector<Wrapping>& cubes);
Outcome fig17(Workshop& workshop);

/// Fig. 18: cube against sphere, m = 2.
/// @param pairs        cube, sphere for each part
/// @param concavities  of the complex cylinder within layers of the sphere, narrowest first
std::vector<Check> check_fig18(const std::vector<Wrapping>& pairs,
                               const std::vector<Concavity>& concavities);
Outcome fig18(Workshop& workshop);

/// Fig. 19: spheres. @param spheres       of growing m for each part
/// @param body_above_top  boundary and inner voxels in the section above the top
std::vector<Check> check_fig19(const std::vector<Wrapping>& spheres, std::uint64_t body_above_top,
                               std::uint64_t ranked_above_top);
Outcome fig19(Workshop& workshop);

/// A row of table 1: six layers around a ball.
struct ElementPerformance {
  LayerShape shape = LayerShape::cube;
  int m = 0, cells = 0;
  LayerReach last;                                         ///< of rank 6, in all directions
  double axis = 0, face_diagonal = 0, space_diagonal = 0;  ///< its reach along these
  Visits plain, ours;

  double thickness() const noexcept { return last.mean / last.rank; }
  /// How far the reach along diagonals is off that along the axes, as a share of it.
  double distortion() const noexcept;
};
/// @param rows  cubes of m = 1, 2, 3, ... then as many spheres
std::vector<Check> check_table1(const std::vector<ElementPerformance>& rows);
Outcome table1(Workshop& workshop);

/// Fig. 20: a contour of the cone's outermost layer.
struct ConeSection {
  int m = 0, z = 0;
  std::vector<double> radii;  ///< as of contour()
};
std::vector<Check> check_fig20(const std::vector<ConeSection>& sections);
Outcome fig20(Workshop& workshop);

/// Fig. 21: voxels of the wedge's layers by rank, and how many have no equal across the V.
std::vector<Check> check_fig21(const std::vector<std::uint64_t>& by_rank, std::uint64_t unequal);
Outcome fig21(Workshop& workshop);

}  // namespace vicinity::report
