// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "chunks.h"

#include <array>

#include "vicinity/viscosity/field_image.h"

namespace vicinity::bridge {
namespace {

// A rolling hash, after "gear": every byte shifts what came before by one bit, so that the hash
// knows the last 64 bytes and nothing else. Any numbers without a pattern do; all who share a field
// need the same, and so they are made here (splitmix64).
constexpr std::array<std::uint64_t, 256> gear = [] {
  std::array<std::uint64_t, 256> numbers{};
  std::uint64_t state = 0;
  for (std::uint64_t& number : numbers) {
    state += 0x9E3779B97F4A7C15;
    std::uint64_t z = state;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
    z = (z ^ z >> 27) * 0x94D049BB133111EB;
    number = z ^ z >> 31;
  }
  return numbers;
}();

// A cut where the hash's first 13 bits are zero: one in 8192.
constexpr std::uint64_t cut_mask = ~std::uint64_t{0} << (64 - 13);

std::uint32_t first_chunk(std::span<const std::byte> bytes) {
  const std::size_t most = bytes.size() < largest_chunk ? bytes.size() : largest_chunk;
  std::uint64_t hash = 0;
  // The hash forgets: it need not see what lies more than 64 bytes before the first possible cut.
  for (std::size_t n = smallest_chunk - 64; n < most; ++n) {
    hash = (hash << 1) + gear[std::to_integer<std::size_t>(bytes[n])];
    if (n + 1 >= smallest_chunk && (hash & cut_mask) == 0) return static_cast<std::uint32_t>(n + 1);
  }
  return static_cast<std::uint32_t>(most);
}

}  // namespace

std::vector<Chunk> chunks_of(std::span<const std::byte> file) {
  std::vector<Chunk> chunks;
  for (std::uint64_t offset = 0; offset < file.size();) {
    const std::uint32_t size = first_chunk(file.subspan(offset));
    chunks.push_back(
        {.checksum = checksum_of(file.subspan(offset, size)), .offset = offset, .size = size});
    offset += size;
  }
  return chunks;
}

}  // namespace vicinity::bridge
