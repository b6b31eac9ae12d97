// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// How the arm feels, in the words that pages use.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "vicinity/teleop/tick.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::viewer {

struct FeelWords {
  std::string memory = "none", direction = "all", traversal = "swept";
  std::string device;  ///< empty: none, no limiter
  std::string mode = "strict";

  friend bool operator==(const FeelWords&, const FeelWords&) = default;
};

/// Those of `json`, over those that are.
/// @param own_device  the one that the command line named, which may be a file: pages name no other
/// Errors: throws Error for a key that is none, and a device that is neither known nor that.
FeelWords feel_words(FeelWords now, const nlohmann::json& json, const std::string& own_device);

/// @param like  what has no word here: master, tool, longest period
/// @param words  device: a known name, or a file
/// Errors: throws Error for words that are none, and a device that does not state what the mode
/// needs.
TeleoperationOptions feel_options(TeleoperationOptions like, const FeelWords& words);

/// Codings by object, from the keys `coding` and `codings`.
/// @param field  in use; @param original  with the codings of its file
/// Errors: throws Error for a coding that does not fit, and an object that there is none of.
std::vector<Coding> codings_from(const nlohmann::json& json, const ViscosityField& field,
                                 const ViscosityField& original);

/// FEEL.
nlohmann::ordered_json feel_json(const FeelWords& words, const ViscosityField& field);

}  // namespace vicinity::viewer
