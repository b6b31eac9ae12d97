// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/teleop/master_force.h"

#include <cmath>
#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {

const MasterArm& checked(const MasterArm& master) {
  const auto demand = [](bool good, const char* what, double found, const char* expected) {
    if (good && std::isfinite(found)) return;
    throw Error({.where = "master arm",
                 .what = std::string(what) + " cannot be used",
                 .found = std::to_string(found),
                 .expected = expected});
  };
  demand(master.mass >= 0, "mass M", master.mass, "zero or more kg");
  demand(master.damping >= 0, "damping B", master.damping, "zero or more N·s/m");
  demand(master.gain >= 0, "gain G", master.gain, "zero or more");
  demand(master.attenuation > 0, "attenuation A", master.attenuation, "more than zero");
  demand(master.lever > 0, "lever L", master.lever, "more than zero m");
  demand(master.torque_constant > 0, "torque constant lambda", master.torque_constant,
         "more than zero");
  return master;
}

}  // namespace vicinity
