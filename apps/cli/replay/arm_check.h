// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What is odd about an arm in its field, found without a tick.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "replay/arm.h"
#include "replay/joint_log.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::cli {

/// One sentence each: an arm that never comes into the workspace, and links that start inside
/// objects or in their skin. Without a log the arm is as near to zero as its limits allow.
std::vector<std::string> oddities_of_place(const ViscosityField& field, const Arm& arm,
                                           const std::optional<JointLog>& log);

/// Field, arm, joints, log and remarks.
std::string check_in_words(const ViscosityField& field, const Arm& arm,
                           const std::optional<JointLog>& log);

/// Keys: objects[], robot, links, points, area, joints[{name, type, lower, upper, log_lower,
/// log_upper}], samples, remarks[]. Null where there is no limit and no log.
nlohmann::ordered_json check_as_json(const ViscosityField& field, const Arm& arm,
                                     const std::optional<JointLog>& log);

}  // namespace vicinity::cli
