// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <sys/mman.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "layers/triple_loop.h"
#include "named_scenes.h"
#include "peers/exact_transform.h"
#include "peers/groups.h"
#include "peers/openvdb_peer.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/layers/layer_bricks.h"
#include "vicinity/layers/ranked_neighbours.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/inner.h"

namespace vicinity::peers {
namespace {

using benchmarks::layers_m;
using benchmarks::layers_q;

template <class Do>
std::function<void()> in_threads(int threads, Do&& what) {
  return [threads, what] {
    tbb::task_arena arena(threads);
    arena.execute(what);
  };
}

/// How many bricks of 8 x 8 x 8 the layers touch.
std::size_t touched_bricks(const RankedNeighbours& layers) {
  std::set<std::tuple<int, int, int>> bricks;
  for (const VoxelSet& rank : layers.ranks) {
    rank.blocks().for_each([&](const BlockIndex& b, const BitBlock& block) {
      for (int slot = 0; slot < 8; ++slot) {
        std::uint64_t any = 0;
        for (const std::uint64_t word : block.words) any |= word >> (8 * slot) & 0xFF;
        if (any != 0) bricks.insert({b.i * 8 + slot, b.j, b.k});
      }
    });
  }
  return bricks.size();
}

/// Memory for one byte per voxel of so many bricks, fresh from the kernel.
class Bricks {
 public:
  explicit Bricks(std::size_t count)
      : count_(count),
        bytes_(mmap(nullptr, count * brick, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1,
                    0)) {
    if (bytes_ == MAP_FAILED) throw std::bad_alloc();
    madvise(bytes_, count * brick, MADV_HUGEPAGE);
  }
  Bricks(const Bricks&) = delete;
  Bricks& operator=(const Bricks&) = delete;
  ~Bricks() { munmap(bytes_, count_ * brick); }

  /// What no way of making ranks can do without.
  void write() const {
    auto* const bytes = static_cast<std::byte*>(bytes_);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count_, 256), [&](const auto& range) {
      for (std::size_t b = range.begin(); b < range.end(); ++b) {
        std::memset(bytes + b * brick, static_cast<int>(b & 7), brick);
      }
    });
    // The compiler must believe that somebody reads it.
    asm volatile("" : : "r"(bytes) : "memory");
  }

 private:
  static constexpr std::size_t brick = 512;
  std::size_t count_;
  void* bytes_;
};

std::vector<std::uint8_t> dense(const VoxelSet& boundary, const Workspace& workspace) {
  const VoxelIndex d = workspace.dims;
  std::vector<std::uint8_t> set(static_cast<std::size_t>(d.i) * static_cast<std::size_t>(d.j) *
                                static_cast<std::size_t>(d.k));
  boundary.for_each([&](const VoxelIndex& v) {
    if (!workspace.box().contains(v)) return;
    set[(static_cast<std::size_t>(v.k) * static_cast<std::size_t>(d.j) +
         static_cast<std::size_t>(v.j)) *
            static_cast<std::size_t>(d.i) +
        static_cast<std::size_t>(v.i)] = 1;
  });
  return set;
}

}  // namespace

void measure_ranks(Report& report, const GroupOptions&) {
  using Sense = Report::Sense;
  constexpr int length = 512;
  for (const auto& object : benchmarks::named_objects(length)) {
    // A cube of 512 voxels around it, whatever its shape: the array of the plain ways.
    Workspace cube = object.workspace;
    cube.dims = {length, length, length};
    const VoxelSet boundary = boundary_voxels(object.mesh, cube);
    const VoxelSet inner = inner_voxels(object.mesh, boundary, cube);
    const std::vector<std::uint8_t> set = dense(boundary, cube);
    const ShapingElement sphere(LayerShape::sphere, layers_m);
    const ShapingElement full(LayerShape::cube, layers_m);
    const std::size_t bricks = touched_bricks(ranked_neighbours(boundary, inner, sphere, layers_q));
    // As a build does it: by tiles, into bricks of a few bits a voxel, which each thread keeps.
    const auto ranks = [&](const ShapingElement& element) {
      return [&] {
        tbb::enumerable_thread_specific<HugeVector<BrickBits>> kept;
        rank_tiles(boundary, inner, element, layers_q, [&](const LayerBricks& tile) {
          HugeVector<BrickBits>& mine = kept.local();
          tile.for_each_brick([&](const BlockIndex&, std::span<const BrickBits> planes) {
            mine.insert(mine.end(), planes.begin(), planes.end());
          });
        });
      };
    };
    const auto distances = [&] {
      distance_layers(object.mesh, boundary, inner, cube, layers_m, layers_q);
    };
    const Bricks warm(bricks);
    const std::vector<Timing> t = side_by_side({
        {"ours, sphere, 1 thread", in_threads(1, ranks(sphere)), 9},
        {"ours, sphere, 2 threads", in_threads(2, ranks(sphere)), 9},
        {"ours, distance, 2 threads", in_threads(2, distances), 5},
        {"write the touched bricks to fresh memory, 1 thread",
         in_threads(1, [&] { Bricks(bricks).write(); }), 9},
        {"write the touched bricks to fresh memory, 2 threads",
         in_threads(2, [&] { Bricks(bricks).write(); }), 9},
        {"exact transform of the array, 2 threads",
         in_threads(2, [&] { exact_transform(set, cube.dims); }), 3},
        {"the paper's triple loop, sphere",
         [&] {
           triple_loop::ranked_neighbours(boundary, inner, LayerShape::sphere, layers_m, layers_q);
         },
         1},
        {"ours, cube, 2 threads", in_threads(2, ranks(full)), 5},
        {"ours, sphere, as a set of voxels for each rank, 2 threads",
         in_threads(2, [&] { ranked_neighbours(boundary, inner, sphere, layers_q); }), 9},
        {"write the touched bricks to warm memory, 2 threads", in_threads(2, [&] { warm.write(); }),
         9},
        {"OpenVDB dilations, cube, 2 threads",
         in_threads(2, [&] { openvdb_dilations(boundary, layers_m, layers_q); }), 1},
    });
    report.timings("ranks", object.name, t);
    const double ours = t[1].wall, mapped = t[2].wall;
    report.target("ranks: times the paper's triple loop", Sense::at_least, 300, t[6].wall / ours,
                  object.name);
    report.target("ranks: times an exact transform of the array", Sense::at_least, 50,
                  t[5].wall / ours, object.name);
    report.target("ranks: cost of writing the touched bricks", Sense::at_most, 4, ours / t[4].wall,
                  object.name);
    report.target("ranks, distance: times an exact transform", Sense::at_least, 25,
                  t[5].wall / mapped, object.name);
  }
}

}  // namespace vicinity::peers
