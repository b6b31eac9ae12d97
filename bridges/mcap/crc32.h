// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The CRC-32 of zlib and PNG, which MCAP takes its checksums by.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace vicinity::mcap {

inline constexpr std::array<std::uint32_t, 256> crc32_table = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < table.size(); ++n) {
    std::uint32_t value = n;
    for (int bit = 0; bit < 8; ++bit)
      value = (value & 1) != 0 ? 0xEDB88320u ^ value >> 1 : value >> 1;
    table[n] = value;
  }
  return table;
}();

/// @param before  of the bytes in front of these; 0: there are none
inline std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0) noexcept {
  std::uint32_t value = ~before;
  for (const char byte : bytes) {
    value = crc32_table[(value ^ static_cast<unsigned char>(byte)) & 0xFF] ^ value >> 8;
  }
  return ~value;
}

}  // namespace vicinity::mcap
