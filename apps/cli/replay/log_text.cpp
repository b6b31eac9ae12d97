// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/log_text.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "replay/mcap_log.h"
#include "vicinity/geometry/error.h"

namespace vicinity::cli {

LogText read_log_text(const std::filesystem::path& path) {
  if (path.extension() == ".mcap") return mcap_as_csv(path);
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  LogText log{.csv = std::move(bytes).str()};
  if (!file || log.csv.empty()) {
    throw Error({.where = path.string(), .what = "the log is empty or cannot be read"});
  }
  return log;
}

}  // namespace vicinity::cli
