// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The points of the arm that feel: even samples of every link's surface with their share of area
/// (R and S of eq. 5).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/robot/robot_model.h"

namespace vicinity {

/// Starts every array on a cache line, which is also the widest vector register there is.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};

  CacheLineAllocator() noexcept = default;
  template <class Other>
  CacheLineAllocator(const CacheLineAllocator<Other>&) noexcept {}  // NOLINT: rebinding is implicit

  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), alignment)); }
  void deallocate(T* memory, std::size_t) noexcept { ::operator delete(memory, alignment); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};

/// Smallest-enough ball: holds all its points for certain, in the link's frame [m].
struct BoundingSphere {
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();
  float radius = 0;
};

/// Body points of a robot in structure-of-arrays order. Points of one link are neighbours, and
/// within it neighbours on the surface are neighbours in memory: each half of a link's points is
/// one side of a cut across its longest extent, and so on down.
///
/// Every link begins at a multiple of `lane`. The gap before the next one holds copies of its last
/// point with no area, so that whole vectors can be loaded and summed without a tail.
struct BodyPoints {
  static constexpr std::size_t lane = 16;          ///< floats in a cache line
  static constexpr std::size_t cluster_size = 64;  ///< points in every cluster but a link's last
  /// Ten times what a tick can look at in a millisecond. Spreading so many takes some 20 s.
  static constexpr std::size_t most = 1'000'000;

  using Lane = std::vector<float, CacheLineAllocator<float>>;
  Lane x, y, z;  ///< p_LR, position in the frame of the point's link [m]
  Lane area;     ///< S, its share of the link's surface, times the link's weight [m²]

  /// Points [begin, end), the first of them at a multiple of `cluster_size` from the link's first.
  struct Cluster {
    std::uint32_t begin = 0, end = 0;
    BoundingSphere sphere;
  };
  std::vector<Cluster> clusters;

  /// Points [begin, end) and clusters [first_cluster, last_cluster) of one link.
  struct LinkRange {
    int link = 0;  ///< as in RobotModel
    std::uint32_t begin = 0, end = 0;
    std::uint32_t first_cluster = 0, last_cluster = 0;
    BoundingSphere sphere;
    double area = 0;  ///< sum of the shares [m²]
  };
  std::vector<LinkRange> links;  ///< links with points, in the robot's order

  /// Number of points, without the gaps.
  std::size_t count() const noexcept;
};

/// One point in place of a link's surface: the paper's single R.
struct NamedPoint {
  Vec3 p_LR = Vec3::Zero();  ///< in the link's frame, shape (3,) [m]
  double area = 0;           ///< S [m²]
};

struct BodyPointOptions {
  /// Samples per square metre of surface, at least one for each link that has any. Zero: only
  /// `named` points.
  double points_per_m2 = 2000;
  std::optional<std::size_t> total = {};      ///< instead: this many samples, shared out by area
  std::uint64_t seed = 0;                     ///< another seed, another equally good set
  std::vector<std::string> exclude = {};      ///< links that feel nothing
  std::map<std::string, double> weight = {};  ///< by link: factor on its shares, 1 where not named
  std::map<std::string, NamedPoint> named = {};  ///< by link: this point instead of samples
};

/// Spreads points over the links' surfaces (all geometries that `robot` holds), as far as they can
/// be reached from outside: motors, gears and inner walls of a link have no points and no share.
/// Walls thinner than about 3 mm keep both sides; what lies behind slits narrower than that, on
/// links of up to 2 m, counts as inside.
///
/// Points are evenly spread and irregular (blue noise): weighted sample elimination (Yuksel 2015)
/// takes them from many even candidates, by distance in space, so that the two sides of a thin
/// plate share their points. Each point's share is the area of the surface that is nearer to it
/// than to any other, and the shares of a link add up to its outer surface times its weight,
/// whatever the number of points. The result depends on the seed and the surfaces, and not on the
/// order of triangles.
///
/// Errors: throws Error for a link that the robot does not have, a density, weight or area that is
/// negative or not finite, more than BodyPoints::most points, and an invalid robot.
BodyPoints sample_body_points(const RobotModel& robot, const BodyPointOptions& options = {});

}  // namespace vicinity
