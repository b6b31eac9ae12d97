// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "peers/side_by_side.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>

namespace vicinity::peers {
namespace {

double process_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<Timing> side_by_side(const std::vector<Way>& ways) {
  std::vector<std::vector<double>> wall(ways.size()), cpu(ways.size());
  int rounds = 0;
  for (const Way& way : ways) rounds = std::max(rounds, way.runs);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t w = 0; w < ways.size(); ++w) {
      if (round >= ways[w].runs) continue;
      const double cpu_begin = process_seconds();
      const auto begin = std::chrono::steady_clock::now();
      ways[w].run();
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      wall[w].push_back(took.count());
      cpu[w].push_back(process_seconds() - cpu_begin);
      std::fprintf(stderr, "  %s: %.4g s\n", ways[w].name.c_str(), took.count());
    }
  }
  std::vector<Timing> timings;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    timings.push_back({ways[w].name, median(wall[w]), median(cpu[w]), ways[w].runs});
  }
  return timings;
}

}  // namespace vicinity::peers
