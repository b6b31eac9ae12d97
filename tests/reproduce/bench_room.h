// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A workshop in a folder that goes with the test, and verdicts in short.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "reproduce/verdict.h"
#include "reproduce/workshop.h"

namespace vicinity::report {

class BenchRoom {
 public:
  BenchRoom() : workshop_(fresh_folder()) {}
  ~BenchRoom() { std::filesystem::remove_all(workshop_.folder()); }
  BenchRoom(const BenchRoom&) = delete;
  BenchRoom& operator=(const BenchRoom&) = delete;

  const Workshop& workshop() const { return workshop_; }

 private:
  static std::filesystem::path fresh_folder() {
    std::string name = (std::filesystem::temp_directory_path() / "vicinity_report_XXXXXX").string();
    return mkdtemp(name.data());
  }
  Workshop workshop_;
};

inline bool agrees(const std::vector<Check>& checks) { return verdict_of(checks).agrees; }
inline std::string why(const std::vector<Check>& checks) { return verdict_of(checks).why; }

}  // namespace vicinity::report
