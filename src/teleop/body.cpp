// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lanes.h"

namespace vicinity {
namespace {

Eigen::Matrix3d cross_matrix(const Vec3& r) noexcept {
  Eigen::Matrix3d m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

// No index can be reached from here, so that every point counts as having changed voxels.
constexpr std::int32_t nowhere = std::numeric_limits<std::int32_t>::min();

}  // namespace

Teleoperation::Body::Body(BodyPoints points, std::size_t link_count,
                          const TeleoperationOptions& options)
    : points_(std::move(points)),
      weights_(options.memory),
      traversal_(options.traversal),
      closing_(options.direction == DragDirection::closing),
      motion_(link_count),
      link_drag_(link_count, Matrix6::Zero()),
      link_remembering_(points_.links.size(), 0),
      cluster_remembering_(points_.clusters.size(), 0),
      voxel_i_(points_.x.size(), nowhere),
      voxel_j_(points_.x.size(), nowhere),
      voxel_k_(points_.x.size(), nowhere),
      drag_(points_.x.size(), 0.f),
      moving_(points_.x.size()),
      remembers_(points_.x.size(), 0),
      towards_W_(closing_ ? points_.x.size() : 0, Eigen::Vector3f::Zero()) {}

void Teleoperation::Body::restart() noexcept {
  for (MovingPoint& point : moving_) point.reset();
  std::fill(drag_.begin(), drag_.end(), 0.f);
  std::fill(remembers_.begin(), remembers_.end(), std::uint8_t{0});
  std::fill(link_remembering_.begin(), link_remembering_.end(), 0u);
  std::fill(cluster_remembering_.begin(), cluster_remembering_.end(), 0u);
  look_again_ = true;
  moved_ = false;
}

bool Teleoperation::Body::move(const ForwardKinematics& kinematics,
                               double longest_jump_m) noexcept {
  bool jumped = false;
  for (std::size_t link = 0; link < motion_.size(); ++link) {
    LinkMotion& motion = motion_[link];
    motion.last_X_WL = moved_ ? motion.X_WL : kinematics.X_WL(link);
    motion.X_WL = kinematics.X_WL(link);
    motion.v_WLo = kinematics.v_WLo(link);
    motion.w_WL = kinematics.w_WL(link);
    const Vec3 way = motion.X_WL.translation() - motion.last_X_WL.translation();
    jumped |= !(way.norm() <= longest_jump_m);
  }
  moved_ = true;
  if (jumped) restart();
  return !jumped;
}

bool Teleoperation::Body::far_away(const BoundingSphere& sphere, const LinkMotion& motion,
                                   const FieldView& view) const noexcept {
  const Workspace& workspace = view.field.workspace();
  const Vec3 centre_L = sphere.centre.cast<double>();
  const Vec3 centre_W = motion.X_WL * centre_L;
  // No point of the ball has moved farther than its centre and its turn together.
  const double moved = (centre_W - motion.last_X_WL * centre_L).norm() +
                       (motion.X_WL.linear() - motion.last_X_WL.linear()).norm() * sphere.radius;
  return view.clearance.clearance_vox(workspace.to_grid(centre_W)) * workspace.voxel_size >
         sphere.radius + moved;
}

void Teleoperation::Body::feel(const FieldView& view) noexcept {
  largest_ = {};
  points_felt_ = points_looked_ = 0;
  for (std::size_t l = 0; l < points_.links.size(); ++l) {
    const BodyPoints::LinkRange& range = points_.links[l];
    const auto link = static_cast<std::size_t>(range.link);
    const LinkMotion& motion = motion_[link];
    link_drag_[link].setZero();
    if (link_remembering_[l] == 0 && far_away(range.sphere, motion, view)) continue;
    for (std::uint32_t c = range.first_cluster; c < range.last_cluster; ++c) {
      const BodyPoints::Cluster& cluster = points_.clusters[c];
      std::uint32_t& remembering = cluster_remembering_[c];
      if (remembering == 0 && far_away(cluster.sphere, motion, view)) continue;
      const std::uint32_t before = remembering;
      look(cluster, motion, view, remembering);
      link_remembering_[l] += remembering - before;
      if (remembering == 0) continue;
      if (closing_) {
        sum_closing(cluster, motion, range.link);
      } else {
        sum_all(cluster, motion, range.link);
      }
    }
  }
  look_again_ = false;
}

void Teleoperation::Body::look(const BodyPoints::Cluster& cluster, const LinkMotion& motion,
                               const FieldView& view, std::uint32_t& remembering) noexcept {
  const Workspace& workspace = view.field.workspace();
  GridMap map;
  const Eigen::Matrix3d turn = motion.X_WL.linear() / workspace.voxel_size;
  const Vec3 shift = workspace.to_grid(motion.X_WL.translation());
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) map.a[row][column] = turn(row, column);
    map.t[row] = shift[row];
  }
  // Whole lanes: the gap behind a link's last point holds copies of it.
  const std::size_t n =
      (cluster.end - cluster.begin + BodyPoints::lane - 1) / BodyPoints::lane * BodyPoints::lane;
  std::uint8_t changed[BodyPoints::cluster_size];
  find_voxels(&points_.x[cluster.begin], &points_.y[cluster.begin], &points_.z[cluster.begin], n,
              map, &voxel_i_[cluster.begin], &voxel_j_[cluster.begin], &voxel_k_[cluster.begin],
              changed);
  points_looked_ += cluster.end - cluster.begin;

  // Where viscosity is interpolated it changes within a voxel too.
  const bool every_point = look_again_ || view.field.keeps_distance();
  for (std::uint32_t p = cluster.begin; p < cluster.end; ++p) {
    if (!every_point && changed[p - cluster.begin] == 0) continue;
    const Vec3 p_L = position(p);
    const Vec3 p_W = motion.X_WL * p_L;
    MovingPoint& moving = moving_[p];
    const double mu_e =
        moving.advance(view.field, weights_, traversal_, motion.last_X_WL * p_L, p_W);
    drag_[p] = static_cast<float>(mu_e) * points_.area[p];
    // A layer that was crossed on the way counts in this tick alone: look again in the next one.
    if (mu_e != moving.effective(weights_)) voxel_i_[p] = nowhere;
    const std::uint8_t remembers = mu_e > 0 || moving.remembers(weights_) ? 1 : 0;
    remembering += remembers;
    remembering -= remembers_[p];
    remembers_[p] = remembers;
    if (closing_ && mu_e > 0) {
      towards_W_[p] = moving.towards_surface(view.field).cast<float>();
    }
  }
}

// In the link's frame r is constant, and the drag of all points together is
//   force = -(W v + omega x M),  moment about Lo = -(M x v + I omega)
// with W = sum w, M = sum w r and I = sum w (r.r 1 - r r').
void Teleoperation::Body::sum_all(const BodyPoints::Cluster& cluster, const LinkMotion& motion,
                                  int link) noexcept {
  const Eigen::Matrix3d& R_WL = motion.X_WL.linear();
  const Vec3 v_L = R_WL.transpose() * motion.v_WLo, w_L = R_WL.transpose() * motion.w_WL;
  const std::size_t n =
      (cluster.end - cluster.begin + BodyPoints::lane - 1) / BodyPoints::lane * BodyPoints::lane;
  const std::uint32_t b = cluster.begin;
  const DragMoments sums =
      sum_drag(&points_.x[b], &points_.y[b], &points_.z[b], &drag_[b], n, v_L.data(), w_L.data());
  if (sums.w == 0) return;
  for (std::uint32_t p = b; p < cluster.end; ++p) points_felt_ += drag_[p] > 0 ? 1 : 0;
  const Eigen::Matrix3d M = R_WL * cross_matrix({sums.wx, sums.wy, sums.wz}) * R_WL.transpose();
  Eigen::Matrix3d I;
  I << sums.wyy + sums.wzz, -sums.wxy, -sums.wxz,  //
      -sums.wxy, sums.wxx + sums.wzz, -sums.wyz,   //
      -sums.wxz, -sums.wyz, sums.wxx + sums.wyy;
  Matrix6& drag = link_drag_[static_cast<std::size_t>(link)];
  drag.topLeftCorner<3, 3>() += sums.w * Eigen::Matrix3d::Identity();
  drag.topRightCorner<3, 3>() -= M;
  drag.bottomLeftCorner<3, 3>() += M;
  drag.bottomRightCorner<3, 3>() += R_WL * I * R_WL.transpose();
  largest_.sum += sums.force_sum;
  if (sums.force_largest > largest_.force) {
    largest_.force = sums.force_largest;
    largest_.point = b + static_cast<std::uint32_t>(sums.largest);
    largest_.link = link;
  }
}

// One dyad for each point that comes nearer: with n towards the surface and g = (n, r x n), the
// point's drag is w g g', and its force -w (g . twist) n. Where n is not known, the whole velocity
// is opposed.
void Teleoperation::Body::sum_closing(const BodyPoints::Cluster& cluster, const LinkMotion& motion,
                                      int link) noexcept {
  Matrix6& drag = link_drag_[static_cast<std::size_t>(link)];
  Vector6 twist;
  twist << motion.v_WLo, motion.w_WL;
  for (std::uint32_t p = cluster.begin; p < cluster.end; ++p) {
    const double w = drag_[p];
    if (!(w > 0)) continue;
    ++points_felt_;
    const Vec3 r_W = motion.X_WL.linear() * position(p);
    const Vec3 n = towards_W_[p].cast<double>();
    double force = 0;
    if (n.isZero()) {
      Eigen::Matrix<double, 3, 6> velocity;
      velocity << Eigen::Matrix3d::Identity(), -cross_matrix(r_W);
      drag.noalias() += w * velocity.transpose() * velocity;
      force = w * (velocity * twist).norm();
    } else {
      Vector6 g;
      g << n, r_W.cross(n);
      const double closing_speed = g.dot(twist);
      if (!(closing_speed > 0)) continue;
      drag.noalias() += w * g * g.transpose();
      force = w * closing_speed;
    }
    largest_.sum += force;
    if (force > largest_.force) {
      largest_.force = force;
      largest_.point = p;
      largest_.link = link;
    }
  }
}

Reason Teleoperation::Body::reason(const FieldView& view) const noexcept {
  Reason reason;
  if (largest_.link < 0) return reason;
  const LinkMotion& motion = motion_[static_cast<std::size_t>(largest_.link)];
  const Vec3 p_WR = motion.X_WL * position(largest_.point);
  const Vec3 v_WR = motion.v_WLo + motion.w_WL.cross(p_WR - motion.X_WL.translation());
  reason.point = static_cast<int>(largest_.point);
  reason.link = largest_.link;
  reason.share = largest_.force / largest_.sum;
  const FieldSample here = view.field.at(p_WR);
  reason.kind = here.record.kind;
  if (here.record.kind == VoxelKind::empty) return reason;
  reason.object = here.record.object;
  reason.rank = here.record.rank;
  const FieldObject& object = view.field.objects()[here.record.object];
  if (here.distance_m >= 0) {
    reason.distance_m = here.distance_m;
  } else if (here.record.kind == VoxelKind::neighbour) {
    const double at_least = (here.record.rank - 1) * object.m * view.field.workspace().voxel_size;
    reason.distance_m = std::max(0.0, at_least - 1e-3 * object.bound_mm);
  }
  const double speed = v_WR.norm();
  if (speed > 0) reason.time_to_contact_s = reason.distance_m / speed;
  return reason;
}

bool Teleoperation::Body::touches(const Workspace& workspace) const noexcept {
  for (const BodyPoints::LinkRange& range : points_.links) {
    const Vec3 centre_W =
        motion_[static_cast<std::size_t>(range.link)].X_WL * range.sphere.centre.cast<double>();
    const Vec3 grid = workspace.to_grid(centre_W);
    const Vec3 dims(workspace.dims.i, workspace.dims.j, workspace.dims.k);
    const Vec3 outside = (-grid).cwiseMax(grid - dims).cwiseMax(0.0);
    if (outside.norm() * workspace.voxel_size <= range.sphere.radius) return true;
  }
  return false;
}

}  // namespace vicinity
