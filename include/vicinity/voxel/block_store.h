// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A growing list of blocks that never move.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <type_traits>

#include "vicinity/voxel/huge_pages.h"

namespace vicinity {

/// Blocks by number, from 0. Any thread may add a block, or reach those it knows of.
///
/// Memory is taken in chunks, each twice as long as the one before: no block is ever copied, and
/// what lies behind the last one has not been touched.
template <class Block>
class BlockStore {
  static_assert(std::is_trivially_destructible_v<Block> && std::is_trivially_copyable_v<Block>);

 public:
  BlockStore() = default;
  BlockStore(const BlockStore& other) {
    for (std::uint32_t n = 0; n < other.count_; ++n) (*this)[add()] = other[n];
  }
  BlockStore& operator=(const BlockStore&) = delete;
  ~BlockStore() {
    for (Block* chunk : chunks_) give_back_pages(chunk);
  }

  /// Adds a block, value-initialised, and returns its number.
  std::uint32_t add() {
    std::uint32_t number;
    {
      const std::lock_guard lock(mutex_);
      number = count_;
      Block*& chunk = chunks_[chunk_of(number)];
      if (chunk == nullptr) {
        chunk = static_cast<Block*>(take_pages(length_of(chunk_of(number)) * sizeof(Block)));
      }
      ++count_;
    }
    new (&(*this)[number]) Block{};
    return number;
  }

  Block& operator[](std::uint32_t number) noexcept {
    const std::size_t chunk = chunk_of(number);
    return chunks_[chunk][number + first_length - length_of(chunk)];
  }
  const Block& operator[](std::uint32_t number) const noexcept {
    return const_cast<BlockStore&>(*this)[number];
  }
  std::size_t size() const noexcept { return count_; }

 private:
  /// Chunk c holds first_length * 2^c blocks, from number first_length * (2^c - 1).
  static constexpr std::uint32_t first_length = 8;
  static constexpr std::size_t length_of(std::size_t chunk) noexcept {
    return std::size_t{first_length} << chunk;
  }
  static constexpr std::size_t chunk_of(std::uint32_t number) noexcept {
    return static_cast<std::size_t>(
               std::bit_width((std::uint64_t{number} + first_length) / first_length)) -
           1;
  }

  std::array<Block*, 30> chunks_{};
  std::uint32_t count_ = 0;
  std::mutex mutex_;
};

}  // namespace vicinity
