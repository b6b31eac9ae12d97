// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Random numbers that are the same on every machine: the standard library's distributions are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace vicinity {

/// SplitMix64 (Steele, Lea & Flood 2014). Takes no memory beyond itself.
class SeededNoise {
 public:
  explicit SeededNoise(std::uint64_t seed) noexcept : state_(seed) {}

  std::uint64_t next() noexcept {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// Even over [0, 1).
  double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }

  /// Mean 0, standard deviation 1 (Box & Muller 1958).
  double normal() noexcept {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

/// A seed of its own for each of several things that one seed stands for.
inline std::uint64_t seed_for(std::uint64_t seed, std::uint64_t thing) noexcept {
  return SeededNoise(seed ^ (thing + 1) * 0xd1342543de82ef95u).next();
}

}  // namespace vicinity
