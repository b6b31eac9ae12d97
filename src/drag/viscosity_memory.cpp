// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/viscosity_memory.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

MemoryWeights even(int k) {
  MemoryWeights weights{.k = k};
  std::fill_n(weights.alpha.begin(), k, 1.0);
  return weights;
}

}  // namespace

MemoryWeights named_memory(std::string_view name) {
  if (name == "none") return {};
  if (name == "sustained") return even(10);
  if (name == "fading") return {10, {1, .9, .7, .5, .55, .3, .2, .1, .05, .02}};
  if (name == "short") return even(3);
  if (name == "rising") {
    MemoryWeights weights = even(10);
    weights.rise_at_once = true;
    return weights;
  }
  throw Error({.where = "memory",
               .what = "no such preset",
               .found = "'" + std::string(name) + "'",
               .expected = "none, sustained, fading, short or rising"});
}

const MemoryWeights& checked(const MemoryWeights& weights) {
  if (weights.k < 1 || weights.k > memory_capacity) {
    throw Error({.where = "memory",
                 .what = "so many viscosities cannot be remembered",
                 .found = std::to_string(weights.k),
                 .expected = "1 to " + std::to_string(memory_capacity)});
  }
  double sum = 0;
  for (int i = 0; i < weights.k; ++i) {
    const double alpha = weights.alpha[static_cast<std::size_t>(i)];
    sum += alpha;
    if (alpha >= 0 && std::isfinite(sum)) continue;
    throw Error({.where = "memory",
                 .what = "weight " + std::to_string(i + 1) + " is none",
                 .found = std::to_string(alpha),
                 .expected = "a finite number, zero or more"});
  }
  if (sum > 0) return weights;
  throw Error({.where = "memory", .what = "no weight is above zero"});
}

}  // namespace vicinity
