// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0
//
// Vicinity beside what one would use instead, on the same meshes and in one run; started by
// scripts/bench.sh, which says how to choose.

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "peers/groups.h"

namespace {

using namespace vicinity::peers;

struct Group {
  const char* name;
  void (*measure)(Report&, const GroupOptions&);
};

constexpr Group groups[] = {{"ranks", measure_ranks},     {"voxels", measure_voxels},
                            {"stl", measure_stl},         {"lookup", measure_lookup},
                            {"nearest", measure_nearest}, {"rebuild", measure_rebuild},
                            {"cores", measure_cores},     {"scale", measure_scale}};

int usage() {
  std::fputs("vicinity_peers -o FOLDER [--only GROUP,GROUP...] [--scale]\ngroups:", stderr);
  for (const Group& group : groups) std::fprintf(stderr, " %s", group.name);
  std::fputs("\n", stderr);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  std::string output, only;
  GroupOptions options;
  for (std::size_t a = 0; a < arguments.size(); ++a) {
    const bool has_value = a + 1 < arguments.size();
    if (arguments[a] == "-o" && has_value) {
      output = arguments[++a];
    } else if (arguments[a] == "--only" && has_value) {
      only = "," + arguments[++a] + ",";
    } else if (arguments[a] == "--scale") {
      options.scale = true;
    } else if (arguments[a] == "--memory-of-reading" && has_value) {
      return print_memory_of_reading(arguments[++a]);
    } else {
      return usage();
    }
  }
  if (output.empty()) return usage();
  for (std::size_t begin = 1; begin < only.size();) {
    const std::size_t end = only.find(',', begin);
    const std::string name = only.substr(begin, end - begin);
    if (std::none_of(std::begin(groups), std::end(groups),
                     [&](const Group& group) { return name == group.name; })) {
      return usage();
    }
    begin = end + 1;
  }
  options.scratch =
      std::filesystem::temp_directory_path() / ("vicinity_peers_" + std::to_string(getpid()));
  int status = 0;
  try {
    std::filesystem::create_directories(options.scratch);
    Report report;
    for (const Group& group : groups) {
      if (!only.empty() && only.find(std::string(",") + group.name + ",") == std::string::npos) {
        continue;
      }
      std::fprintf(stderr, "%s\n", group.name);
      group.measure(report, options);
      report.save(output);
    }
    report.print();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "vicinity_peers: %s\n", e.what());
    status = 1;
  }
  std::filesystem::remove_all(options.scratch);
  return status;
}
