// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// How true ranked layers are to the shape they surround (§5.1, table 1). Lengths in voxels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reproduce/verdict.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::report {

/// How far a layer reaches from the surface: true distances of the outermost voxels of rank n,
/// their centres plus half a voxel. An ideal layer reaches the same everywhere.
struct LayerReach {
  int rank = 0;
  double least = 0, mean = 0, most = 0;
  double spread() const noexcept { return most - least; }
};

/// Of every rank of a field of one object.
/// @param distances  of Workshop::distances(), far enough
std::vector<LayerReach> layer_reaches(const ViscosityField& field, const ViscosityField& distances);

/// How the ranks of one field fit the true distance of their voxels.
struct RankFit {
  std::string name;
  bool is_cube = false;
  int m = 0;
  std::uint64_t ranked = 0;  ///< voxels
  /// Voxels of rank n that are nearer than n-1 layers, less what the element may cut off, or
  /// farther than n layers are along the element's longest diagonal.
  std::uint64_t too_near = 0, too_far = 0;
  double off_middle = 0;  ///< mean of distance less (n - 1/2) m
};

/// @param m  how thick a layer should be, in voxels
RankFit rank_fit(const std::string& name, const ViscosityField& field,
                 const ViscosityField& distances, int m);

/// No voxel is too near or too far for its rank; and around spheres, whose layers are m thick in
/// all directions, voxels lie in the middle of their layer in the mean: ranks that are off by one
/// would be off by m.
Check ranks_follow_distance(const std::vector<RankFit>& fits);

/// Visits of cells while layers are formed, and how many of them gave a voxel its rank.
struct Visits {
  std::uint64_t cells = 0, changed = 0;
  double redundant() const noexcept {
    return 1 - static_cast<double>(changed) / static_cast<double>(cells);
  }
};

/// Of the paper's loop: every voxel of rank n-1 visits every cell of the element.
Visits visits_of_plain_loop(const ViscosityField& field);

/// Of ours: only voxels of rank n-1 with a neighbour across a face that has no such rank yet do.
/// Ours visits 64 cells of a row at once; they count as cells here.
Visits visits_of_frontier(const ViscosityField& field);

/// How far from an axis parallel to z layers reach, by direction.
/// @param n  rank; 0: the body
/// @return   360 radii, one for each degree from x: of the outermost point whose voxel has a rank
///           up to n or belongs to the body
std::vector<double> contour(const ViscosityField& field, double axis_x, double axis_y, int z,
                            int n);

/// A concavity of the body, as its section shows it, and what layers leave of it.
struct Concavity {
  int from = 0, to = 0;  ///< of its mouth [degrees]; to may pass 360
  double mouth = 0;      ///< width of the mouth
  double depth = 0;      ///< of the body below the rim
  /// By rank: how far the contour of the layers still dips below that over the lips.
  std::vector<double> dip_by_rank;
};

/// Concavities of a round body of the given radius, narrowest mouth first.
std::vector<Concavity> concavities(const ViscosityField& field, double axis_x, double axis_y, int z,
                                   double radius);

}  // namespace vicinity::report
