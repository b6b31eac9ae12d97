// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "oracle.h"

#include <algorithm>
#include <cmath>

namespace vicinity::two_machines {
namespace {

constexpr double face_m = 2e-6;  // body points are floats: so far may their places differ [m]

}  // namespace

Oracle::Oracle(const cli::Arm& arm)
    : arm_(arm), unit_motions_(arm.robot.coordinates.size(), ForwardKinematics(arm.robot)) {}

Drag Oracle::drag(const ViscosityField& field, const std::vector<double>& q,
                  const std::vector<double>& qd) {
  const std::size_t joints = q.size();
  for (std::size_t c = 0; c < joints; ++c) {
    std::vector<double> unit(joints, 0);
    unit[c] = 1;
    unit_motions_[c].update(q.data(), unit.data(), arm_.X_WB);
  }
  Drag drag{std::vector<double>(joints, 0), std::vector<double>(joints, 0)};
  std::vector<Vec3> columns(joints);
  for (const BodyPoints::LinkRange& range : arm_.points.links) {
    const auto link = static_cast<std::size_t>(range.link);
    for (std::uint32_t n = range.begin; n < range.end; ++n) {
      const double S = arm_.points.area[n];
      if (S == 0) continue;  // the gaps between clusters
      const Vec3 p_LR(arm_.points.x[n], arm_.points.y[n], arm_.points.z[n]);
      const Vec3 r = unit_motions_[0].R_WL(link) * p_LR;
      const Vec3 p_WR = unit_motions_[0].p_WL(link) + r;
      const double mu = field.at(p_WR).viscosity;
      double lowest = mu, highest = mu;
      const Vec3 in_voxels = field.workspace().to_grid(p_WR);
      const double to_face = field.workspace().voxel_size *
                             (in_voxels - in_voxels.array().round().matrix()).cwiseAbs().minCoeff();
      if (to_face < face_m) {
        for (int axis = 0; axis < 3; ++axis) {
          for (const double step : {-face_m, face_m}) {
            const double beside = field.at(p_WR + step * Vec3::Unit(axis)).viscosity;
            lowest = std::min(lowest, beside);
            highest = std::max(highest, beside);
          }
        }
      }
      if (highest == 0) continue;
      Vec3 v = Vec3::Zero();
      for (std::size_t c = 0; c < joints; ++c) {
        columns[c] = unit_motions_[c].v_WLo(link) + unit_motions_[c].w_WL(link).cross(r);
        v += qd[c] * columns[c];
      }
      const Vec3 force = -mu * S * v;
      for (std::size_t c = 0; c < joints; ++c) {
        drag.torque[c] += columns[c].dot(force);
        drag.slack[c] += std::abs((highest - lowest) * S * columns[c].dot(v));
      }
    }
  }
  return drag;
}

bool is(const std::vector<double>& torque, const Drag& drag) {
  if (torque.size() != drag.torque.size()) return false;
  double size = 0;
  for (const double x : drag.torque) size = std::max(size, std::abs(x));
  for (std::size_t c = 0; c < torque.size(); ++c) {
    // The tick sums in single precision, some thousand terms.
    const double allowed = 1e-5 * size + drag.slack[c] + 1e-12;
    if (!(std::abs(torque[c] - drag.torque[c]) <= allowed)) return false;
  }
  return true;
}

bool is_zero(const std::vector<double>& torque) {
  return std::ranges::all_of(torque, [](double x) { return x == 0; });
}

}  // namespace vicinity::two_machines
