// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What somebody probably meant to type.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vicinity {

/// The known word that takes the fewest letters inserted, deleted, replaced or swapped with their
/// neighbour to reach; empty where even that one is another word altogether.
std::string nearest_word(std::string_view typed, const std::vector<std::string>& known);

}  // namespace vicinity
