// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A file cut into chunks where its content says so: what is put in, taken out or moved changes the
/// chunks around it and no others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vicinity::bridge {

struct Chunk {
  std::uint64_t checksum = 0;  ///< XXH3, 64 bits
  std::uint64_t offset = 0;    ///< from the start of the file [bytes]
  std::uint32_t size = 0;      ///< [bytes]
};

/// The last one of a file may be smaller. On average a chunk has about 10 kB.
inline constexpr std::uint32_t smallest_chunk = 2048, largest_chunk = 65536;

/// All of a file, in order. One pass, about 1 GB/s.
std::vector<Chunk> chunks_of(std::span<const std::byte> file);

}  // namespace vicinity::bridge
