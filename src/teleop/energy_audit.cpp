// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/energy_audit.h"

#include <algorithm>
#include <limits>

#include "axis_matrix.h"

namespace vicinity {

const char* to_string(AuditStatus status) noexcept {
  switch (status) {
    case AuditStatus::recorded:
      return "recorded";
    case AuditStatus::started:
      return "started";
    case AuditStatus::not_finite:
      return "not finite";
    case AuditStatus::wrong_size:
      return "wrong size";
    case AuditStatus::time_did_not_advance:
      return "time did not advance";
  }
  return "unknown";
}

EnergyAudit::EnergyAudit(const Eigen::MatrixXd& damping)
    : damping_(checked_axis_matrix(damping, "energy audit: damping", Definiteness::semidefinite)),
      position_(AxisVector::Zero(damping.rows())),
      force_(AxisVector::Zero(damping.rows())) {}

AuditStatus EnergyAudit::lose(AuditStatus why) noexcept {
  balance_.unaccounted += open_ ? 1 : 0;
  open_ = false;
  return why;
}

AuditStatus EnergyAudit::record(double time_s, const AxisVectorView& positions,
                                const AxisVectorView& force) noexcept {
  if (positions.size() != position_.size() || force.size() != position_.size()) {
    return lose(AuditStatus::wrong_size);
  }
  if (!std::isfinite(time_s) || !positions.allFinite() || !force.allFinite()) {
    return lose(AuditStatus::not_finite);
  }
  AuditStatus status = AuditStatus::started;
  if (open_) {
    const AxisVector way = positions - position_;
    const double elapsed_s = time_s - time_s_;
    if (elapsed_s > 0) {
      EnergySum drag = drag_, device = device_;
      drag.add(-force_.dot(way));
      device.add(way.dot(damping_.lazyProduct(way)) / elapsed_s);
      if (!std::isfinite(drag.size()) || !std::isfinite(device.size())) {
        status = lose(AuditStatus::not_finite);
      } else {
        drag_ = drag;
        device_ = device;
        balance_.drag = drag_.value();
        balance_.device = device_.value();
        const double total = balance_.drag + balance_.device;
        balance_.lowest = std::min(balance_.lowest, total);
        balance_.lowest_drag = std::min(balance_.lowest_drag, balance_.drag);
        // Each term is a dot product of n rounded products, or n of those: (2n + 4) roundings of
        // its size at most.
        const double rounding = (2 * static_cast<double>(way.size()) + 4) *
                                std::numeric_limits<double>::epsilon() *
                                (drag_.size() + device_.size());
        if (!(total >= -rounding)) balance_.passive = false;
        ++balance_.records;
        status = AuditStatus::recorded;
      }
    } else if (elapsed_s < 0 || !way.isZero(0)) {
      // What happened meanwhile is unknown, but it can start again from here.
      status = lose(AuditStatus::time_did_not_advance);
    }
  }
  position_ = positions;
  force_ = force;
  time_s_ = time_s;
  open_ = true;
  return status;
}

void EnergyAudit::reset() noexcept {
  drag_ = device_ = {};
  balance_ = {};
  open_ = false;
}

}  // namespace vicinity
