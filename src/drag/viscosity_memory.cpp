// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/viscosity_memory.h"

#include <algorithm>
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

}  // namespace vicinity
