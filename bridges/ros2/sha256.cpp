// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "ros2/sha256.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace vicinity::ros2 {
namespace {

constexpr std::size_t block = 64;

// The first 32 bits behind the point of the root of x, by bisection over whole numbers: roots of
// primes are where the standard takes its constants from.
template <int power>
constexpr std::uint32_t root_fraction(unsigned x) {
  // The largest r with (r / 2^32)^power <= x.
  std::uint64_t r = 0;
  for (int bit = 35; bit >= 0; --bit) {
    const std::uint64_t tried = r | (std::uint64_t{1} << bit);
    unsigned __int128 product = tried;
    bool above = false;
    for (int n = 1; n < power; ++n) product *= tried;
    above = product > (static_cast<unsigned __int128>(x) << (32 * power));
    if (!above) r = tried;
  }
  return static_cast<std::uint32_t>(r);
}

constexpr std::array<unsigned, 64> primes = [] {
  std::array<unsigned, 64> found{};
  std::size_t count = 0;
  for (unsigned n = 2; count < found.size(); ++n) {
    bool prime = true;
    for (std::size_t k = 0; k < count; ++k) prime = prime && n % found[k] != 0;
    if (prime) found[count++] = n;
  }
  return found;
}();

constexpr std::array<std::uint32_t, 64> round_constants = [] {
  std::array<std::uint32_t, 64> constants{};
  for (std::size_t n = 0; n < constants.size(); ++n) constants[n] = root_fraction<3>(primes[n]);
  return constants;
}();

void add_block(const unsigned char* bytes, std::array<std::uint32_t, 8>& hash) {
  std::array<std::uint32_t, 64> w{};
  for (std::size_t n = 0; n < 16; ++n) {
    for (std::size_t b = 0; b < 4; ++b) w[n] = w[n] << 8 | bytes[4 * n + b];
  }
  for (std::size_t n = 16; n < 64; ++n) {
    const std::uint32_t a = w[n - 15], b = w[n - 2];
    w[n] = w[n - 16] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3) + w[n - 7] +
           (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10);
  }
  auto [a, b, c, d, e, f, g, h] = hash;
  for (std::size_t n = 0; n < 64; ++n) {
    const std::uint32_t first = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                                ((e & f) ^ (~e & g)) + round_constants[n] + w[n];
    const std::uint32_t second =
        (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    h = g, g = f, f = e, e = d + first;
    d = c, c = b, b = a, a = first + second;
  }
  const std::array<std::uint32_t, 8> added = {a, b, c, d, e, f, g, h};
  for (std::size_t n = 0; n < 8; ++n) hash[n] += added[n];
}

}  // namespace

std::string sha256_hex(std::string_view text) {
  std::string padded(text);
  padded += '\x80';
  padded.resize((padded.size() + 8 + block - 1) / block * block);
  for (std::size_t n = 0; n < 8; ++n) {
    padded[padded.size() - 1 - n] = static_cast<char>(8 * text.size() >> (8 * n));
  }
  std::array<std::uint32_t, 8> hash{};
  for (std::size_t n = 0; n < 8; ++n) hash[n] = root_fraction<2>(primes[n]);
  for (std::size_t at = 0; at < padded.size(); at += block) {
    add_block(reinterpret_cast<const unsigned char*>(padded.data()) + at, hash);
  }
  std::string hex;
  for (const std::uint32_t word : hash) hex += fmt::format("{:08x}", word);
  return hex;
}

}  // namespace vicinity::ros2
