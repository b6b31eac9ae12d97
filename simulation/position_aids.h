// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The aids that drag is compared with: forces and limits that depend on where the arm is alone.
#pragma once

#include <memory>
#include <vector>

#include "vicinity/drag/clearance_map.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/forward_kinematics.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/teleop/aid.h"
#include "vicinity/teleop/lead.h"
#include "vicinity/viscosity/field.h"

namespace vicinity {

/// A body point near something.
struct NearPoint {
  std::uint32_t point = 0;
  std::size_t link = 0;
  Vec3 p_W = Vec3::Zero();
  double distance_m = 0;  ///< at least so far from the surface
};

/// Distances of an arm's points, from a field that keeps them.
class ArmDistance {
 public:
  /// @param field  every object in `distance` mode. Errors: throws Error for another.
  /// @param robot,points,field  outlive it
  ArmDistance(const RobotModel& robot, const BodyPoints& points, const ViscosityField& field,
              std::shared_ptr<const ClearanceMap> clearance);

  /// All points within the layers, in the order of the points. Real-time: no allocation.
  const std::vector<NearPoint>& look(const double* q, const Pose& X_WB) noexcept;
  /// The nearest of the last look; null where all is farther away than the layers are thick.
  const NearPoint* nearest() const noexcept;

  ForwardKinematics& kinematics() noexcept { return kinematics_; }
  const BodyPoints& points() const noexcept { return points_; }
  const ViscosityField& field() const noexcept { return field_; }
  const RobotModel& robot() const noexcept { return robot_; }

 private:
  const RobotModel& robot_;
  const BodyPoints& points_;
  const ViscosityField& field_;
  std::shared_ptr<const ClearanceMap> clearance_;
  ForwardKinematics kinematics_;
  std::vector<double> still_;
  std::vector<NearPoint> near_;
};

/// No help at all.
class NoAid final : public Aid {
 public:
  explicit NoAid(int axes) : force_{AxisVector::Zero(axes), 1} {}
  AidForce feel(const Input&) noexcept override { return force_; }
  void restart() noexcept override {}

 private:
  AidForce force_;
};

/// Force on the handle of a Cartesian master whose tool keeps its orientation, capped as the
/// device's would be [N].
struct HandleLimits {
  int tool_link = -1;
  double force_limit = 12;
};

/// Potential field (Khatib 1986): each point of the arm is repelled by gain S (1/d - 1/d0)/d² along
/// the way from the surface, d not below 5 mm. Points share by area, as drag does.
class PotentialField final : public Aid {
 public:
  PotentialField(ArmDistance distance, double gain, double reach_m, const HandleLimits& limits);
  AidForce feel(const Input& input) noexcept override;
  void restart() noexcept override {}

 private:
  ArmDistance distance_;
  double gain_, reach_m_;
  HandleLimits limits_;
  std::vector<Wrench> wrenches_;
};

/// Virtual fixture (Rosenberg 1993; the barrier of the paper's [12]): a spring from a barrier
/// around every surface, for the point that is deepest beyond it.
class VirtualFixture final : public Aid {
 public:
  VirtualFixture(ArmDistance distance, double stiffness, double barrier_m,
                 const HandleLimits& limits);
  AidForce feel(const Input& input) noexcept override;
  void restart() noexcept override {}

 private:
  ArmDistance distance_;
  double stiffness_, barrier_m_;
  HandleLimits limits_;
  std::vector<Wrench> wrenches_;
};

/// Speed scaling as MoveIt Servo does it: nearer than the threshold, what is led is slowed by
/// exp(k (d - threshold)), k such that at contact a thousandth is left; in every direction. No
/// force.
class SpeedScaling final : public Aid {
 public:
  SpeedScaling(ArmDistance distance, double threshold_m, int axes);
  AidForce feel(const Input& input) noexcept override;
  void restart() noexcept override {}

 private:
  ArmDistance distance_;
  double threshold_m_;
  AidForce force_;
};

}  // namespace vicinity
