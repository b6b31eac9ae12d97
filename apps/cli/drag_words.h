// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Words that say how a point feels the field, into what they stand for.
#pragma once

#include <string>

#include "vicinity/drag/drag.h"
#include "vicinity/drag/moving_point.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::cli {

/// "all" or "closing". Errors: throws Error, naming --direction, for another word.
DragDirection direction_from(const std::string& word);

/// "swept" or "sampled". Errors: throws Error, naming --traversal, for another word.
Traversal traversal_from(const std::string& word);

/// The field with one coding for every object, each with its own number of ranks and its own skin.
/// @param coding  "32,25,20,..." or a name; empty: the field as it is
/// Errors: throws Error, for a name that is none, and as ViscosityField::with_codings().
ViscosityField recoded(const ViscosityField& field, const std::string& coding);

}  // namespace vicinity::cli
