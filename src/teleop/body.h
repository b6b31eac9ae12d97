// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// All body points of an arm on their way through the field, and the drag of each link.
#pragma once

#include <cstdint>
#include <vector>

#include "lanes.h"
#include "point_memories.h"
#include "tree_drag.h"
#include "vicinity/drag/clearance_map.h"
#include "vicinity/teleop/tick.h"

namespace vicinity {

/// A field as the tick reads it.
struct Teleoperation::FieldView {
  explicit FieldView(const ViscosityField& of);

  ViscosityField field;
  ClearanceMap clearance;
  /// By object and rank - 1: no point of such a voxel is nearer to the object [m].
  std::vector<std::vector<double>> nearest_m;
};

/// Points sit in clusters, clusters in links. What is farther from everything than it can have
/// moved is skipped whole, link by link and then cluster by cluster, as long as none of its points
/// remembers any viscosity. In a cluster that is near, only points that have come into another
/// voxel look anything up, and only those whose drag changes touch its sums: the drag of a rigid
/// link needs no more than sums that do not depend on how it moves.
class Teleoperation::Body {
 public:
  Body(BodyPoints points, std::size_t link_count, const TeleoperationOptions& options);

  const BodyPoints& points() const noexcept { return points_; }

  /// The points know no past: the next feel() starts their memories where they are.
  void restart() noexcept;
  /// The next feel() looks at every point that is not far away: the field is another one.
  void look_again() noexcept { look_again_ = true; }

  /// Where the links are and how they move, from this tick on; the last poses are kept for the
  /// paths. False, and the points start anew, where a point may have gone farther than that, or
  /// farther than its key can tell at this voxel size: no motion.
  bool move(const ForwardKinematics& kinematics, double longest_jump_m, double voxel_size) noexcept;

  /// Moves every point along its path and sums the drag up by link.
  void feel(const FieldView& view) noexcept;

  /// Drag of each link on its own motion: wrench = -drag * (v_WLo, w_WL), in W, about its origin.
  const std::vector<Matrix6>& link_drag() const noexcept { return link_drag_; }
  /// What one point felt in the last feel().
  PointDrag point_drag(std::uint32_t point) const noexcept;
  /// Which point contributed most in the last feel().
  Reason reason(const FieldView& view) const noexcept;
  /// Whether any link's points may be in the workspace.
  bool touches(const Workspace& workspace) const noexcept;
  std::uint32_t points_felt() const noexcept { return points_felt_; }
  std::uint32_t points_looked() const noexcept { return points_looked_; }

 private:
  struct LinkMotion {
    Pose X_WL = Pose::Identity(), last_X_WL = Pose::Identity();
    Vec3 v_WLo = Vec3::Zero(), w_WL = Vec3::Zero();  // in W
    Vec3 v_L = Vec3::Zero(), w_L = Vec3::Zero();     // the same, in the link's own frame
    double turned = 0;                               // how far a point 1 m away has turned [m]
  };

  /// What a cluster's points have in common.
  struct ClusterState {
    enum class Past : std::uint8_t {
      known,  ///< memories and keys are those of the last tick
      far,    ///< nothing is remembered; keys are out of date
      blank,  ///< as far, and the memories have yet to be emptied
      none,   ///< the points have no past at all
    };
    Past past = Past::none;
    std::uint32_t remembering = 0;  ///< points with a memory
    std::uint32_t feeling = 0;      ///< points with drag
    float highest = 0;              ///< no point has more drag than that [N·s/m]
    float power_bound = 0;          ///< no point takes out more than that in this tick [W]
    DragMoments sums;
  };

  struct LinkState {
    std::uint32_t remembering = 0;  ///< points with a memory
    bool asleep = false;            ///< skipped in the last tick, clusters and all
  };

  /// The largest contribution of one point.
  struct Largest {
    std::uint32_t point = 0;
    int link = -1;
    double power = 0;
  };

  bool far_away(const BoundingSphere& sphere, const LinkMotion& motion,
                const FieldView& view) const noexcept;
  void feel_link(const BodyPoints::LinkRange& range, const LinkMotion& motion,
                 const FieldView& view, LinkState& link, Matrix6& drag) noexcept;
  static void fall_asleep(ClusterState& state) noexcept;
  void wake(const BodyPoints::Cluster& cluster, ClusterState& state, const LinkMotion& motion,
            const FieldView& view) noexcept;
  void look(const BodyPoints::Cluster& cluster, ClusterState& state, const CoarseMap& map,
            const LinkMotion& motion, const FieldView& view) noexcept;
  double advance(std::uint32_t point, PointMemories::Memory& memory, const Vec3& last_p_W,
                 const Vec3& to, const VoxelIndex& voxel, double mu,
                 const FieldView& view) noexcept;
  void sum_up(const BodyPoints::Cluster& cluster, ClusterState& state) noexcept;
  Matrix6 drag_of(const DragMoments& sums, const LinkMotion& motion) const noexcept;
  Matrix6 closing_drag(const BodyPoints::Cluster& cluster, const LinkMotion& motion,
                       int link) noexcept;
  Matrix6 undirected_drag(const BodyPoints::Cluster& cluster, const LinkMotion& motion,
                          int link) noexcept;
  void offer_largest(const BodyPoints::Cluster& cluster, const MostPower& most, int link) noexcept;
  void find_largest() noexcept;
  void turn_towards(std::uint32_t point, const Eigen::Vector3f& surface_W) noexcept {
    towards_x_[point] = surface_W.x();
    towards_y_[point] = surface_W.y();
    towards_z_[point] = surface_W.z();
  }
  Vec3 position(std::uint32_t point) const noexcept {
    return {points_.x[point], points_.y[point], points_.z[point]};
  }

  BodyPoints points_;
  MemoryWeights weights_;
  Traversal traversal_;
  bool closing_;

  std::vector<LinkMotion> motion_;  // by link
  std::vector<double> reach_;       // by link: no point is farther from its origin [m]
  std::vector<Matrix6> link_drag_;  // by link
  std::vector<LinkState> links_;    // by link with points
  std::vector<ClusterState> clusters_;
  // By point. Keys and mu_e S apart from the rest: they are all that a point that stays in its
  // voxel needs.
  std::vector<VoxelKey> key_;
  BodyPoints::Lane drag_;  // mu_e S [N·s/m]
  PointMemories memories_;
  std::vector<std::uint8_t> remembers_;
  BodyPoints::Lane towards_x_, towards_y_, towards_z_;  // in W; `closing` only

  bool look_again_ = true, moved_ = false;
  std::uint32_t tick_ = 0;
  Largest largest_;
  std::uint32_t points_felt_ = 0, points_looked_ = 0;
};

}  // namespace vicinity
