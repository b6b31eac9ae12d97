// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Which column of a joint log is what, and in which unit.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace vicinity::cli {

/// One column of a log.
struct Column {
  std::string name;
  std::optional<double> factor = {};  ///< column * factor is in s, rad or m; absent: not said
};

/// Quantity -> column. Quantities: `t`, a joint's name for its position, `qd_` and a joint's name
/// for its velocity.
using ColumnMap = std::map<std::string, Column>;

/// "t=Time*0.001,joint_1=Position1,qd_joint_1=Velocity1". Empty: nothing is said.
/// Errors: throws Error, naming --columns, for anything else, a quantity that is there twice, and a
/// factor that is zero or not finite.
ColumnMap column_map_from(const std::string& text);

}  // namespace vicinity::cli
