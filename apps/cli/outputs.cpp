// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "outputs.h"

#include <system_error>

#include "src/geometry/file_beside.h"
#include "vicinity/geometry/error.h"

namespace vicinity::cli {
namespace {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code no_matter;
  if (fs::equivalent(a, b, no_matter)) return true;
  return fs::weakly_canonical(fs::absolute(a), no_matter) ==
         fs::weakly_canonical(fs::absolute(b), no_matter);
}

}  // namespace

void check_outputs(const std::vector<Output>& outputs, const std::vector<fs::path>& inputs) {
  std::vector<fs::path> places;
  for (const Output& output : outputs) {
    if (output.path.empty()) continue;
    const std::string where = std::string(output.option) + " " + output.path.string();
    const fs::path place = file_to_write(output.path);
    for (const fs::path& input : inputs) {
      if (input.empty() || !same_file(place, input)) continue;
      throw Error(
          {.where = where, .what = "is what is read, and would be lost", .hint = "another name"});
    }
    for (const fs::path& other : places) {
      if (!same_file(place, other)) continue;
      throw Error({.where = where,
                   .what = "is the name of another output too, and one would replace the other",
                   .hint = "two names"});
    }
    places.push_back(place);
  }
}

}  // namespace vicinity::cli
