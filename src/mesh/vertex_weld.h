// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Joining vertices that are equal to the last bit, while triangles stream in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity {

/// Collects triangles into a mesh whose vertices are numbered in order of first appearance.
///
/// An open-addressing table of vertex numbers with linear probing: 4 bytes a slot, no key beside
/// it, since the key is the vertex itself. A node-based map spends most of its time, and 40 bytes
/// a vertex, on allocation.
class VertexWeld {
 public:
  /// @param expected_triangles  how many will come; memory is taken for that many, so it must have
  ///                            been verified against the size of the file. More may come.
  explicit VertexWeld(std::size_t expected_triangles);

  /// Adds triangles. Minus zero is stored as zero. Coordinates must not be NaN.
  /// Errors: throws Error beyond 2³² - 2 vertices.
  void add(std::span<const std::array<Vec3, 3>> triangles);

  /// The mesh collected so far; the weld is empty afterwards.
  TriangleMesh take() &&;

 private:
  std::uint32_t number_of(const Vec3& vertex, std::size_t hash);
  void grow_table();
  void make_room();

  std::size_t expected_triangles_;
  TriangleMesh mesh_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace vicinity
