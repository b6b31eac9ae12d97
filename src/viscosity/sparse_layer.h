// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Root, regions and bricks on their way into an image, equal ones stored once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vicinity/viscosity/field_image.h"
#include "vicinity/voxel/huge_pages.h"

namespace vicinity {

/// Byte strings of a pool, each stored once. A string is named by the reference to it: the width it
/// was put in with, and its position in units.
class SharedBytes {
 public:
  explicit SharedBytes(std::size_t unit) : unit_(unit), slots_(1024) {}

  std::span<const std::byte> bytes() const noexcept { return bytes_; }
  void release() noexcept { HugeVector<std::byte>().swap(bytes_); }

  /// Makes room for so many bytes in so many strings: growing would copy them all.
  void reserve(std::size_t bytes, std::size_t strings);

  /// @param string  a whole number of units
  /// @return        the reference of an equal string put in before, else of a new one
  /// Errors: throws Error where the pool outgrows its file format.
  std::uint32_t put(std::span<const std::byte> string, std::uint32_t width, std::uint32_t hash);

 private:
  struct Slot {
    std::uint32_t hash = 0;
    bool taken = false;
    std::uint32_t reference = 0;
  };

  bool equal(std::uint32_t reference, std::uint32_t width,
             std::span<const std::byte> string) const noexcept;
  void rehash(std::size_t slots);

  std::size_t unit_;
  std::size_t count_ = 0;
  HugeVector<Slot> slots_;  // open addressing, a power of two of them
  HugeVector<std::byte> bytes_;
};

/// The hash that strings are put in with.
std::uint32_t short_hash(std::span<const std::byte> bytes) noexcept;

class SparseLayer {
 public:
  /// @param cells    how many regions the root has; each is `nothing` until set
  /// @param nothing  the uniform value of a region that nobody sets
  SparseLayer(std::size_t cells, std::size_t brick_unit, std::uint16_t nothing);

  /// Puts a region in.
  /// @return  its reference for the root: uniform, or the number of the region
  std::uint32_t put(const RegionDraft::Layer& draft);
  /// The same for a region whose bricks are in: references, shape (512,).
  std::uint32_t put(std::span<const std::uint32_t, 512> region);
  void set(std::size_t cell, std::uint32_t reference) noexcept { root_[cell] = reference; }

  std::span<const std::uint32_t> root() const noexcept { return root_; }
  std::uint32_t region_count() const noexcept {
    return static_cast<std::uint32_t>(regions_.bytes().size() / region_size);
  }
  /// The references of a region, shape (512,).
  std::span<const std::uint32_t, 512> region(std::uint32_t number) const noexcept {
    return std::span<const std::uint32_t, 512>(
        reinterpret_cast<const std::uint32_t*>(regions_.bytes().data() + number * region_size),
        512);
  }
  /// The bytes from a brick on.
  const std::byte* brick(std::uint32_t reference) const noexcept {
    return bricks_.bytes().data() + (reference & FieldReference::number_mask) * brick_unit_;
  }

  /// Makes room for as much as another field took.
  void reserve(std::size_t region_bytes, std::size_t brick_bytes);

  SharedBytes& regions() noexcept { return regions_; }
  SharedBytes& bricks() noexcept { return bricks_; }

 private:
  static constexpr std::size_t region_size = 512 * sizeof(std::uint32_t);

  std::size_t brick_unit_;
  std::vector<std::uint32_t> root_;
  SharedBytes regions_, bricks_;
};

}  // namespace vicinity
