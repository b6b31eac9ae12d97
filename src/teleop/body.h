// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// All body points of an arm on their way through the field, and the drag of each link.
#pragma once

#include <cstdint>
#include <vector>

#include "tree_drag.h"
#include "vicinity/drag/clearance_map.h"
#include "vicinity/teleop/tick.h"

namespace vicinity {

/// A field as the tick reads it.
struct Teleoperation::FieldView {
  explicit FieldView(const ViscosityField& of) : field(of), clearance(of) {}
  ViscosityField field;
  ClearanceMap clearance;
};

/// Points sit in clusters, clusters in links. What is farther from everything than it can have
/// moved is skipped whole, link by link and then cluster by cluster, as long as none of its points
/// remembers any viscosity. In a cluster that is near, only points that have come into another
/// voxel look anything up.
class Teleoperation::Body {
 public:
  Body(BodyPoints points, std::size_t link_count, const TeleoperationOptions& options);

  const BodyPoints& points() const noexcept { return points_; }

  /// The points know no past: the next feel() starts their memories where they are.
  void restart() noexcept;
  /// The next feel() looks at every point that is not far away: the field is another one.
  void look_again() noexcept { look_again_ = true; }

  /// Where the links are and how they move, from this tick on; the last poses are kept for the
  /// paths. False, and the points start anew, where a link's origin went farther than that: no
  /// motion.
  bool move(const ForwardKinematics& kinematics, double longest_jump_m) noexcept;

  /// Moves every point along its path and sums the drag up by link.
  void feel(const FieldView& view) noexcept;

  /// Drag of each link on its own motion: wrench = -drag * (v_WLo, w_WL), in W, about its origin.
  const std::vector<Matrix6>& link_drag() const noexcept { return link_drag_; }
  /// Which point contributed most in the last feel().
  Reason reason(const FieldView& view) const noexcept;
  /// Whether any link's points may be in the workspace.
  bool touches(const Workspace& workspace) const noexcept;
  std::uint32_t points_felt() const noexcept { return points_felt_; }
  std::uint32_t points_looked() const noexcept { return points_looked_; }

 private:
  struct LinkMotion {
    Pose X_WL = Pose::Identity(), last_X_WL = Pose::Identity();
    Vec3 v_WLo = Vec3::Zero(), w_WL = Vec3::Zero();
  };
  /// The largest force of one point, and the sum of all.
  struct Largest {
    std::uint32_t point = 0;
    int link = -1;
    double force = 0, sum = 0;
  };

  bool far_away(const BoundingSphere& sphere, const LinkMotion& motion,
                const FieldView& view) const noexcept;
  void look(const BodyPoints::Cluster& cluster, const LinkMotion& motion, const FieldView& view,
            std::uint32_t& remembering) noexcept;
  void sum_all(const BodyPoints::Cluster& cluster, const LinkMotion& motion, int link) noexcept;
  void sum_closing(const BodyPoints::Cluster& cluster, const LinkMotion& motion, int link) noexcept;
  Vec3 position(std::uint32_t point) const noexcept {
    return {points_.x[point], points_.y[point], points_.z[point]};
  }

  BodyPoints points_;
  MemoryWeights weights_;
  Traversal traversal_;
  bool closing_;

  std::vector<LinkMotion> motion_;                                     // by link
  std::vector<Matrix6> link_drag_;                                     // by link
  std::vector<std::uint32_t> link_remembering_, cluster_remembering_;  // points with a memory
  // By point. Voxels and mu_e S apart from the rest: they are all that a point at rest needs.
  std::vector<std::int32_t> voxel_i_, voxel_j_, voxel_k_;
  BodyPoints::Lane drag_;  // mu_e S [N·s/m]
  std::vector<MovingPoint> moving_;
  std::vector<std::uint8_t> remembers_;
  std::vector<Eigen::Vector3f> towards_W_;  // `closing` only

  bool look_again_ = true, moved_ = false;
  Largest largest_;
  std::uint32_t points_felt_ = 0, points_looked_ = 0;
};

}  // namespace vicinity
