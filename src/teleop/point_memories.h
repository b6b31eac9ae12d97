// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The viscosity memories of all body points, packed: k values a point, newest first, and nothing
/// else, so that a point with a short memory costs one cache line.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "vicinity/drag/viscosity_memory.h"

namespace vicinity {

/// Viscosities are kept in single precision: they are fed into a sum over all points.
class PointMemories {
 public:
  PointMemories(std::size_t points, const MemoryWeights& weights)
      : weights_(weights), k_(static_cast<std::size_t>(weights.k)), latest_(points * k_, 0.f) {}

  /// One point's memory, as record_path() takes it.
  class Memory {
   public:
    Memory(const MemoryWeights& weights, float* latest) noexcept
        : weights_(weights), latest_(latest) {}

    void start(double mu) noexcept { std::fill_n(latest_, weights_.k, static_cast<float>(mu)); }
    void enter_voxel(double mu) noexcept {
      std::copy_backward(latest_, latest_ + weights_.k - 1, latest_ + weights_.k);
      *latest_ = static_cast<float>(mu);
    }
    void update(double mu) noexcept { *latest_ = static_cast<float>(mu); }
    double effective(const MemoryWeights& weights) const noexcept {
      if (weights.k == 1) return static_cast<double>(*latest_);
      return effective_viscosity(
          weights, [this](int i) noexcept { return static_cast<double>(latest_[i]); });
    }
    /// Whether any viscosity that still counts is above zero. A point that remembers nothing need
    /// not be moved through empty space.
    bool remembers() const noexcept {
      return std::any_of(latest_, latest_ + weights_.k, [](float mu) { return mu > 0; });
    }

   private:
    const MemoryWeights& weights_;
    float* latest_;
  };

  Memory operator[](std::size_t point) noexcept { return {weights_, &latest_[point * k_]}; }

 private:
  MemoryWeights weights_;
  std::size_t k_;
  std::vector<float> latest_;  // shape (points, k)
};

}  // namespace vicinity
