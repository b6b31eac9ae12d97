// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The one exception of the build half: what went wrong, where, and what to try.
#pragma once

#include <stdexcept>
#include <string>

namespace vicinity {

/// Parts of an error sentence; empty parts are left out.
struct ErrorParts {
  std::string where = {};     ///< file, line, object or option
  std::string what = {};      ///< what is wrong, as a clause
  std::string found = {};     ///< what was there
  std::string expected = {};  ///< what should have been there
  std::string hint = {};      ///< what to try
};

/// Thrown by everything that builds, for input that cannot be used. what() is one sentence:
/// "WHERE: WHAT; found FOUND, expected EXPECTED; try HINT".
class Error : public std::runtime_error {
 public:
  explicit Error(ErrorParts parts);
  const ErrorParts& parts() const noexcept { return parts_; }

 private:
  ErrorParts parts_;
};

}  // namespace vicinity
