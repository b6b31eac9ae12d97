// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Words of the command line into values.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/mesh/placement.h"

namespace vicinity::cli {

/// "1,2.5,-3" -> numbers, all of them finite. `option` is named in errors.
/// Errors: throws Error for anything else, and unless there are `count` of them (0: any number).
std::vector<double> numbers_from(std::string_view option, const std::string& text,
                                 std::size_t count = 0);

/// "x,y,z" [m] -> point. Errors: as numbers_from().
Vec3 point_from(std::string_view option, const std::string& text);

/// "x,y,z,x,y,z", two opposite corners [m] -> box. Errors: as numbers_from(), and for a flat box.
Box box_from(std::string_view option, const std::string& text);

/// "a,b,c" -> words; none for an empty text.
std::vector<std::string> words_from(const std::string& text);

/// "x,y,z,roll,pitch,yaw" [m, rad] -> pose. Errors: as numbers_from().
Pose pose_from(std::string_view option, const std::string& text);

/// "mm", "cm", "m" or "in" -> unit. Errors: throws Error for another word.
LengthUnit unit_from(std::string_view option, const std::string& text);

/// The value a word stands for. Errors: throws Error that lists the words.
template <class Value, std::size_t n>
Value one_of(std::string_view option, const std::string& text,
             const std::array<std::pair<const char*, Value>, n>& choices) {
  std::vector<std::string> words;
  std::string list;
  for (const auto& [word, value] : choices) {
    if (text == word) return value;
    words.emplace_back(word);
    list += (list.empty() ? "" : ", ") + std::string(word);
  }
  throw Error({.where = std::string(option),
               .what = "is not one of the choices",
               .found = "'" + text + "'",
               .expected = "one of " + list,
               .hint = nearest_word(text, words)});
}

}  // namespace vicinity::cli
