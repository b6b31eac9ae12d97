// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/position_aids.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vicinity/drag/approach.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

constexpr double nearest_m = 0.005;  // a potential is not followed into the surface

// Force on the handle that forces on the links amount to: what the tool's motion, carried by the
// joints of least squares, does work against. As tick() does for drag.
Vec3 at_handle(ArmDistance& distance, const std::vector<Wrench>& wrenches, int tool_link,
               ForwardKinematics& kinematics) noexcept {
  const RobotModel& robot = distance.robot();
  AxisVector torque = AxisVector::Zero(static_cast<Eigen::Index>(robot.coordinates.size()));
  kinematics.joint_torques(wrenches.data(), torque.data());
  const std::size_t tool =
      tool_link < 0 ? robot.links.size() - 1 : static_cast<std::size_t>(tool_link);
  const auto J = link_jacobian(robot, kinematics, tool).topRows<3>().eval();
  Eigen::Matrix3d square = J.lazyProduct(J.transpose());
  square.diagonal().array() += 1e-6;
  const Vec3 carried = J.lazyProduct(torque);
  return square.inverse() * carried;
}

AidForce capped(Vec3 force, double limit) noexcept {
  const double size = force.norm();
  if (size > limit) force *= limit / size;
  return {AxisVector(force), 1};
}

void add(Wrench& wrench, const Vec3& force_W, const Vec3& lever_W) noexcept {
  wrench.force += force_W;
  wrench.moment += lever_W.cross(force_W);
}

}  // namespace

ArmDistance::ArmDistance(const RobotModel& robot, const BodyPoints& points,
                         const ViscosityField& field, std::shared_ptr<const ClearanceMap> clearance)
    : robot_(robot),
      points_(points),
      field_(field),
      clearance_(std::move(clearance)),
      kinematics_(robot),
      still_(robot.coordinates.size(), 0.0) {
  for (const FieldObject& object : field.objects()) {
    if (object.layers == LayerShape::distance) continue;
    throw Error({.where = "object '" + object.name + "'",
                 .what = "the field keeps no distances of it",
                 .expected = "shape: distance"});
  }
  near_.reserve(points.x.size());
}

const std::vector<NearPoint>& ArmDistance::look(const double* q, const Pose& X_WB) noexcept {
  kinematics_.update(q, still_.data(), X_WB);
  near_.clear();
  const Workspace& workspace = field_.workspace();
  for (const BodyPoints::LinkRange& range : points_.links) {
    const auto link = static_cast<std::size_t>(range.link);
    const Pose X_WL = kinematics_.X_WL(link);
    for (std::uint32_t c = range.first_cluster; c < range.last_cluster; ++c) {
      const BodyPoints::Cluster& cluster = points_.clusters[c];
      const Vec3 centre = X_WL * Vec3(cluster.sphere.centre.cast<double>());
      const double clear = clearance_->clearance_vox(workspace.to_grid(centre));
      if (clear * workspace.voxel_size > static_cast<double>(cluster.sphere.radius)) continue;
      for (std::uint32_t n = cluster.begin; n < cluster.end; ++n) {
        const Vec3 p_W = X_WL * Vec3(points_.x[n], points_.y[n], points_.z[n]);
        const double distance = field_.at(p_W).distance_m;
        if (distance >= 0) near_.push_back({n, link, p_W, distance});
      }
    }
  }
  return near_;
}

const NearPoint* ArmDistance::nearest() const noexcept {
  const auto found = std::min_element(
      near_.begin(), near_.end(),
      [](const NearPoint& a, const NearPoint& b) { return a.distance_m < b.distance_m; });
  return found == near_.end() ? nullptr : &*found;
}

PotentialField::PotentialField(ArmDistance distance, double gain, double reach_m,
                               const HandleLimits& limits)
    : distance_(std::move(distance)),
      gain_(gain),
      reach_m_(reach_m),
      limits_(limits),
      wrenches_(distance_.robot().links.size()) {}

AidForce PotentialField::feel(const Input& input) noexcept {
  const auto& near = distance_.look(input.q, input.X_WB);
  if (near.empty()) return {AxisVector::Zero(3), 1};
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  for (const NearPoint& point : near) {
    if (point.distance_m >= reach_m_) continue;
    const double d = std::max(point.distance_m, nearest_m);
    const double area = static_cast<double>(distance_.points().area[point.point]);
    const double push = gain_ * area * (1 / d - 1 / reach_m_) / (d * d);
    const Vec3 force_W = -push * towards_surface(distance_.field(), point.p_W);
    add(wrenches_[point.link], force_W, point.p_W - distance_.kinematics().p_WL(point.link));
  }
  return capped(at_handle(distance_, wrenches_, limits_.tool_link, distance_.kinematics()),
                limits_.force_limit);
}

VirtualFixture::VirtualFixture(ArmDistance distance, double stiffness, double barrier_m,
                               const HandleLimits& limits)
    : distance_(std::move(distance)),
      stiffness_(stiffness),
      barrier_m_(barrier_m),
      limits_(limits),
      wrenches_(distance_.robot().links.size()) {}

AidForce VirtualFixture::feel(const Input& input) noexcept {
  distance_.look(input.q, input.X_WB);
  const NearPoint* const nearest = distance_.nearest();
  if (nearest == nullptr || nearest->distance_m >= barrier_m_) return {AxisVector::Zero(3), 1};
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  const Vec3 force_W = -stiffness_ * (barrier_m_ - nearest->distance_m) *
                       towards_surface(distance_.field(), nearest->p_W);
  add(wrenches_[nearest->link], force_W, nearest->p_W - distance_.kinematics().p_WL(nearest->link));
  return capped(at_handle(distance_, wrenches_, limits_.tool_link, distance_.kinematics()),
                limits_.force_limit);
}

SpeedScaling::SpeedScaling(ArmDistance distance, double threshold_m, int axes)
    : distance_(std::move(distance)),
      threshold_m_(threshold_m),
      force_{AxisVector::Zero(axes), 1} {}

AidForce SpeedScaling::feel(const Input& input) noexcept {
  distance_.look(input.q, input.X_WB);
  const NearPoint* const nearest = distance_.nearest();
  const double d = nearest == nullptr ? threshold_m_ : std::min(nearest->distance_m, threshold_m_);
  force_.speed_scale = std::exp(-std::log(0.001) / threshold_m_ * (d - threshold_m_));
  return force_;
}

}  // namespace vicinity
