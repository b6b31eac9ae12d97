// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "peers/exact_transform.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vicinity::peers {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::size_t columns = 16;  // side by side: as many as one cache line of floats holds

/// Squared distances along one line, from those across it: in place.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(std::size_t n) : at_(n), value_(n), from_(n + 1) {}

  void run(float* line, std::size_t stride, std::size_t n) {
    std::size_t parabolas = 0;
    for (std::size_t q = 0; q < n; ++q) {
      const float f = line[q * stride];
      if (f == infinity) continue;
      const auto x = static_cast<float>(q);
      float meets = -infinity;
      while (parabolas > 0) {
        const float v = at_[parabolas - 1];
        meets = ((f + x * x) - (value_[parabolas - 1] + v * v)) / (2 * (x - v));
        if (meets > from_[parabolas - 1]) break;
        --parabolas;
        meets = -infinity;
      }
      at_[parabolas] = x;
      value_[parabolas] = f;
      from_[parabolas] = meets;
      ++parabolas;
    }
    if (parabolas == 0) return;
    from_[parabolas] = infinity;
    for (std::size_t q = 0, p = 0; q < n; ++q) {
      const auto x = static_cast<float>(q);
      while (from_[p + 1] < x) ++p;
      line[q * stride] = (x - at_[p]) * (x - at_[p]) + value_[p];
    }
  }

 private:
  std::vector<float> at_, value_, from_;
};

/// Lines along one axis of a plane of `width` columns, a few columns at a time.
void along(float* plane, std::size_t width, std::size_t stride, std::size_t n,
           LowerEnvelope& envelope, std::vector<float>& block, bool root) {
  for (std::size_t first = 0; first < width; first += columns) {
    const std::size_t count = std::min(columns, width - first);
    for (std::size_t q = 0; q < n; ++q) {
      for (std::size_t c = 0; c < count; ++c) block[c * n + q] = plane[q * stride + first + c];
    }
    for (std::size_t c = 0; c < count; ++c) envelope.run(&block[c * n], 1, n);
    for (std::size_t q = 0; q < n; ++q) {
      for (std::size_t c = 0; c < count; ++c) {
        const float d = block[c * n + q];
        plane[q * stride + first + c] = root ? std::sqrt(d) : d;
      }
    }
  }
}

}  // namespace

std::vector<float> exact_transform(const std::vector<std::uint8_t>& set, const VoxelIndex& dims) {
  const auto nx = static_cast<std::size_t>(dims.i), ny = static_cast<std::size_t>(dims.j),
             nz = static_cast<std::size_t>(dims.k);
  std::vector<float> distance(nx * ny * nz);
  tbb::parallel_for(std::size_t{0}, nz, [&](std::size_t k) {
    LowerEnvelope envelope(ny);
    std::vector<float> block(columns * ny);
    float* const plane = &distance[k * ny * nx];
    for (std::size_t j = 0; j < ny; ++j) {
      const std::uint8_t* const row = &set[(k * ny + j) * nx];
      float* const line = plane + j * nx;
      float steps = infinity;
      for (std::size_t i = 0; i < nx; ++i) line[i] = steps = row[i] != 0 ? 0 : steps + 1;
      steps = infinity;
      for (std::size_t i = nx; i-- > 0;) {
        steps = row[i] != 0 ? 0 : steps + 1;
        line[i] = std::min(line[i], steps);
        line[i] *= line[i];
      }
    }
    along(plane, nx, nx, ny, envelope, block, false);
  });
  tbb::parallel_for(std::size_t{0}, ny, [&](std::size_t j) {
    LowerEnvelope envelope(nz);
    std::vector<float> block(columns * nz);
    along(&distance[j * nx], nx, nx * ny, nz, envelope, block, true);
  });
  return distance;
}

}  // namespace vicinity::peers
