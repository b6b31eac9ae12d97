// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The circular memory of viscosities that turns steps into slopes (eq. 6-7, fig. 25).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace vicinity {

/// Values a point can remember. The paper needs u >= 2m and m is at most 8, and its longest filter
/// takes 10; a power of two wraps with a mask.
inline constexpr int memory_capacity = 32;

/// Weights of the remembered viscosities, shared by all points that feel alike. As constructed:
/// preset `none`, the viscosity of the voxel itself.
struct MemoryWeights {
  int k = 1;                                      ///< values in use, 1..memory_capacity
  std::array<double, memory_capacity> alpha{1.};  ///< alpha[i] >= 0 weighs the value i voxels ago;
                                                  ///< the first k have a positive sum
  /// The newest value counts in full where it is above the weighted mean: a rise is felt at once
  /// and only a fall is smoothed.
  bool rise_at_once = false;
};

/// A preset of the paper's, or ours:
///
///   none       k = 1                                                        case I
///   sustained  k = 10, all 1                                                case II
///   fading     k = 10, 1 .9 .7 .5 .55 .3 .2 .1 .05 .02, as printed          case III
///   short      k = 3, all 1                                                 case IV
///   rising     mu_e = max(newest, mean of the last 10)                      ours
///
/// `rising` never hides nearness: mu_e is at least the viscosity under the point, and the others
/// fall below it for up to k voxels of every approach.
/// Errors: throws Error for another name.
MemoryWeights named_memory(std::string_view name);

/// The weights themselves. Errors: throws Error where they are not as MemoryWeights says.
const MemoryWeights& checked(const MemoryWeights& weights);

/// mu_e: the weighted mean of exactly k values (eq. 7; eq. 6 where all weights are 1; its sums are
/// read as k terms, i = 0..k-1) [N·s/m³]. The lowest of the k values <= mu_e <= the highest,
/// exactly: a point in even surroundings feels their viscosity to the last bit.
/// @param latest  latest(i) is the value i voxels ago, finite and >= 0, i = 0..k-1
/// Real-time: O(k).
template <class Latest>
double effective_viscosity(const MemoryWeights& weights, const Latest& latest) noexcept {
  const double current = latest(0);
  double weighted = 0, weight = 0, lowest = current, highest = current;
  for (int i = 0; i < weights.k; ++i) {
    const double mu = latest(i);
    weighted += weights.alpha[static_cast<std::size_t>(i)] * mu;
    weight += weights.alpha[static_cast<std::size_t>(i)];
    lowest = std::min(lowest, mu);
    highest = std::max(highest, mu);
  }
  // Rounding alone could carry the mean out of the range of what it is a mean of.
  const double mean = std::clamp(weighted / weight, lowest, highest);
  return weights.rise_at_once ? std::max(current, mean) : mean;
}

/// The latest viscosities of one point. Real-time: O(k), no allocation. Viscosities are finite and
/// >= 0.
class ViscosityMemory {
 public:
  /// Fills the whole memory with mu, the viscosity of the first voxel [N·s/m³].
  void start(double mu) noexcept { remembered_.fill(mu); }

  /// Records mu: the point has come into another voxel.
  void enter_voxel(double mu) noexcept {
    newest_ = (newest_ + 1) & mask;
    remembered_[newest_] = mu;
  }

  /// Replaces the newest value: the point has moved within its voxel. This changes nothing where a
  /// voxel has one viscosity; where viscosity is interpolated, it keeps the drag free of steps.
  void update(double mu) noexcept { remembered_[newest_] = mu; }

  /// mu_e [N·s/m³]: effective_viscosity().
  double effective(const MemoryWeights& weights) const noexcept {
    return effective_viscosity(weights, [this](int i) noexcept {
      return remembered_[(newest_ - static_cast<std::size_t>(i)) & mask];
    });
  }

 private:
  static constexpr std::size_t mask = memory_capacity - 1;
  static_assert((memory_capacity & (memory_capacity - 1)) == 0);

  std::array<double, memory_capacity> remembered_{};
  std::size_t newest_ = 0;
};

}  // namespace vicinity
