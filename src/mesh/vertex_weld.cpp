// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vertex_weld.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

constexpr std::uint32_t empty_slot = std::numeric_limits<std::uint32_t>::max();

/// Odd multipliers mix the words; the high bits, which hold the mix of all below, are folded down
/// because the table keeps the low ones.
std::size_t hash_of(const Vec3& vertex) noexcept {
  std::uint64_t h = std::bit_cast<std::uint64_t>(vertex.x()) * 0x9E3779B97F4A7C15u;
  h = (std::rotl(h, 29) ^ std::bit_cast<std::uint64_t>(vertex.y())) * 0xBF58476D1CE4E5B9u;
  h = (std::rotl(h, 29) ^ std::bit_cast<std::uint64_t>(vertex.z())) * 0x94D049BB133111EBu;
  return static_cast<std::size_t>(h ^ (h >> 32));
}

}  // namespace

VertexWeld::VertexWeld(std::size_t expected_triangles) : expected_triangles_(expected_triangles) {
  mesh_.triangles.reserve(expected_triangles);
  // A closed mesh has half as many vertices as triangles (Euler), so the table starts half full
  // or less.
  mesh_.vertices.reserve(expected_triangles / 2 + 3);
  slots_.assign(std::bit_ceil(expected_triangles + 8), empty_slot);
}

void VertexWeld::add(std::span<const std::array<Vec3, 3>> triangles) {
  // A lookup waits for memory twice: for the slot and for the vertex it names. Asking for all slots
  // of a batch, then for all vertices, lets the waits overlap: twice as fast where triangles come
  // in no order. What was asked for early may be outdated when it is used; it is only a hint.
  constexpr std::size_t batch_size = 64;
  std::array<Vec3, 3 * batch_size> vertices;
  std::array<std::size_t, 3 * batch_size> hashes;
  while (!triangles.empty()) {
    const auto batch = triangles.first(std::min(batch_size, triangles.size()));
    triangles = triangles.subspan(batch.size());
    const std::size_t mask = slots_.size() - 1;
    const std::size_t corners = 3 * batch.size();
    for (std::size_t i = 0; i < corners; ++i) {
      // Adding +0 turns -0 into +0 and leaves every other number alone.
      vertices[i] = batch[i / 3][i % 3] + Vec3::Zero();
      hashes[i] = hash_of(vertices[i]);
      __builtin_prefetch(&slots_[hashes[i] & mask]);
    }
    for (std::size_t i = 0; i < corners; ++i) {
      const std::uint32_t likely = slots_[hashes[i] & mask];
      if (likely != empty_slot) __builtin_prefetch(&mesh_.vertices[likely]);
    }
    for (std::size_t i = 0; i < corners; i += 3) {
      mesh_.triangles.push_back({number_of(vertices[i], hashes[i]),
                                 number_of(vertices[i + 1], hashes[i + 1]),
                                 number_of(vertices[i + 2], hashes[i + 2])});
    }
  }
}

TriangleMesh VertexWeld::take() && {
  slots_ = {};
  return std::exchange(mesh_, {});
}

std::uint32_t VertexWeld::number_of(const Vec3& vertex, std::size_t hash) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  while (slots_[slot] != empty_slot) {
    if (mesh_.vertices[slots_[slot]] == vertex) return slots_[slot];
    slot = (slot + 1) & mask;
  }
  if (mesh_.vertices.size() >= empty_slot) {
    throw Error({.what = "the mesh has more vertices than can be numbered",
                 .expected = "fewer than 4294967295",
                 .hint = "splitting the mesh into several objects"});
  }
  if (mesh_.vertices.size() == mesh_.vertices.capacity()) make_room();
  const auto number = static_cast<std::uint32_t>(mesh_.vertices.size());
  mesh_.vertices.push_back(vertex);
  slots_[slot] = number;
  // Linear probing stays short while a third of the slots are free.
  if (mesh_.vertices.size() * 3 > slots_.size() * 2) grow_table();
  return number;
}

void VertexWeld::grow_table() {
  const std::size_t size = slots_.size() * 2;
  slots_ = {};  // the vertices hold all there is to know: free the old table before the new one
  slots_.assign(size, empty_slot);
  for (std::uint32_t number = 0; number < mesh_.vertices.size(); ++number) {
    std::size_t slot = hash_of(mesh_.vertices[number]) & (size - 1);
    while (slots_[slot] != empty_slot) slot = (slot + 1) & (size - 1);
    slots_[slot] = number;
  }
}

void VertexWeld::make_room() {
  // A mesh with more vertices than expected mostly goes on as it began: reserve once for all that
  // will come at this rate, rather than doubling.
  const double share =
      std::min(1.0, static_cast<double>(mesh_.triangles.size() + 1) /
                        static_cast<double>(std::max<std::size_t>(expected_triangles_, 1)));
  const double forecast = static_cast<double>(mesh_.vertices.size()) / share;
  const auto most = static_cast<double>(3 * expected_triangles_);
  mesh_.vertices.reserve(std::max(mesh_.vertices.size() * 5 / 4 + 16,
                                  static_cast<std::size_t>(std::min(forecast * 1.02, most))));
}

}  // namespace vicinity
