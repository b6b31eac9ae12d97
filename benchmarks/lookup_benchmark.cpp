// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0
//
// One lookup of the field beside a plain dense byte array of the same region, in nanoseconds:
//
//   build/release/benchmarks/vicinity_benchmark --benchmark_filter=lookup
//
// `coherent` walks straight lines through the hot cell, a voxel at a time, as a point of an arm
// does; `random` jumps anywhere in it. Items per second are lookups. What this does not show: the
// latency of a single cold lookup, and whole sweeps of body points, which belong to the tick.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>
#include <vector>

#include "named_scenes.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity::benchmarks {
namespace {

const ViscosityField& field() {
  static const ViscosityField built = build_field(hot_cell()).field;
  return built;
}

/// One byte per voxel, x fastest: the plain way, and as large as the room.
class DenseArray {
 public:
  explicit DenseArray(const ViscosityField& source) : dims_(source.workspace().dims) {
    bytes_.reserve(static_cast<std::size_t>(dims_.i) * static_cast<std::size_t>(dims_.j) *
                   static_cast<std::size_t>(dims_.k));
    for (VoxelIndex v; v.k < dims_.k; ++v.k) {
      for (v.j = 0; v.j < dims_.j; ++v.j) {
        for (v.i = 0; v.i < dims_.i; ++v.i)
          bytes_.push_back(static_cast<std::uint8_t>(source.code_at(v)));
      }
    }
  }
  std::uint8_t code_at(const VoxelIndex& v) const noexcept {
    return bytes_[(static_cast<std::size_t>(v.k) * static_cast<std::size_t>(dims_.j) +
                   static_cast<std::size_t>(v.j)) *
                      static_cast<std::size_t>(dims_.i) +
                  static_cast<std::size_t>(v.i)];
  }

 private:
  VoxelIndex dims_;
  std::vector<std::uint8_t> bytes_;
};

const DenseArray& dense() {
  static const DenseArray array(field());
  return array;
}

std::vector<VoxelIndex> random_voxels(std::size_t count) {
  std::mt19937 random(1);
  const VoxelIndex dims = field().workspace().dims;
  std::vector<VoxelIndex> voxels(count);
  for (VoxelIndex& v : voxels) {
    v = {std::uniform_int_distribution(0, dims.i - 1)(random),
         std::uniform_int_distribution(0, dims.j - 1)(random),
         std::uniform_int_distribution(0, dims.k - 1)(random)};
  }
  return voxels;
}

/// Straight lines between random voxels, a step of about one voxel at a time.
std::vector<VoxelIndex> coherent_voxels(std::size_t count) {
  std::vector<VoxelIndex> voxels;
  const std::vector<VoxelIndex> ends = random_voxels(count / 64);
  for (std::size_t line = 1; voxels.size() < count; ++line) {
    const VoxelIndex &a = ends[line - 1], &b = ends[line];
    const int steps = std::max({std::abs(b.i - a.i), std::abs(b.j - a.j), std::abs(b.k - a.k), 1});
    for (int s = 0; s < steps && voxels.size() < count; ++s) {
      voxels.push_back({a.i + (b.i - a.i) * s / steps, a.j + (b.j - a.j) * s / steps,
                        a.k + (b.k - a.k) * s / steps});
    }
  }
  return voxels;
}

template <class Source>
void lookup(benchmark::State& state, const Source& source, const std::vector<VoxelIndex>& voxels) {
  std::uint64_t sum = 0;
  for (auto _ : state) {
    for (const VoxelIndex& v : voxels) sum += source.code_at(v);
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * voxels.size()));
}

constexpr std::size_t lookups = 1 << 20;

void field_coherent(benchmark::State& state) { lookup(state, field(), coherent_voxels(lookups)); }
void dense_coherent(benchmark::State& state) { lookup(state, dense(), coherent_voxels(lookups)); }
void field_random(benchmark::State& state) { lookup(state, field(), random_voxels(lookups)); }
void dense_random(benchmark::State& state) { lookup(state, dense(), random_voxels(lookups)); }
BENCHMARK(field_coherent)->Name("lookup_coherent/hot_cell/field");
BENCHMARK(dense_coherent)->Name("lookup_coherent/hot_cell/dense_bytes");
BENCHMARK(field_random)->Name("lookup_random/hot_cell/field");
BENCHMARK(dense_random)->Name("lookup_random/hot_cell/dense_bytes");

}  // namespace
}  // namespace vicinity::benchmarks
