// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web/handshake.h"

#include <array>
#include <bit>
#include <cstdint>

namespace vicinity::viewer {
namespace {

constexpr std::string_view websocket_guid = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";

using Digest = std::array<std::uint32_t, 5>;

void digest_block(const unsigned char* block, Digest& digest) {
  std::array<std::uint32_t, 80> w;
  for (std::size_t n = 0; n < 16; ++n) {
    w[n] = std::uint32_t{block[4 * n]} << 24 | std::uint32_t{block[4 * n + 1]} << 16 |
           std::uint32_t{block[4 * n + 2]} << 8 | block[4 * n + 3];
  }
  for (std::size_t n = 16; n < 80; ++n) {
    w[n] = std::rotl(w[n - 3] ^ w[n - 8] ^ w[n - 14] ^ w[n - 16], 1);
  }
  auto [a, b, c, d, e] = digest;
  for (std::size_t n = 0; n < 80; ++n) {
    std::uint32_t mixed = 0;
    if (n < 20) {
      mixed = ((b & c) | (~b & d)) + 0x5A827999;
    } else if (n < 40) {
      mixed = (b ^ c ^ d) + 0x6ED9EBA1;
    } else if (n < 60) {
      mixed = ((b & c) | (b & d) | (c & d)) + 0x8F1BBCDC;
    } else {
      mixed = (b ^ c ^ d) + 0xCA62C1D6;
    }
    const std::uint32_t next = std::rotl(a, 5) + mixed + e + w[n];
    e = d;
    d = c;
    c = std::rotl(b, 30);
    b = a;
    a = next;
  }
  digest = {digest[0] + a, digest[1] + b, digest[2] + c, digest[3] + d, digest[4] + e};
}

// SHA-1 (FIPS 180-4). It guards nothing here: it only shows that a WebSocket was meant.
std::array<unsigned char, 20> sha1(std::string text) {
  Digest digest{0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476, 0xC3D2E1F0};
  const std::uint64_t bits = std::uint64_t{text.size()} * 8;
  text += '\x80';
  while (text.size() % 64 != 56) text += '\0';
  for (int shift = 56; shift >= 0; shift -= 8) text += static_cast<char>(bits >> shift & 0xFF);
  for (std::size_t at = 0; at < text.size(); at += 64) {
    digest_block(reinterpret_cast<const unsigned char*>(text.data()) + at, digest);
  }
  std::array<unsigned char, 20> bytes;
  for (std::size_t n = 0; n < 20; ++n) {
    bytes[n] = static_cast<unsigned char>(digest[n / 4] >> (24 - 8 * (n % 4)) & 0xFF);
  }
  return bytes;
}

std::string base64(const std::array<unsigned char, 20>& bytes) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t left = bytes.size() - at;
    const std::uint32_t three = std::uint32_t{bytes[at]} << 16 |
                                (left > 1 ? std::uint32_t{bytes[at + 1]} << 8 : 0) |
                                (left > 2 ? std::uint32_t{bytes[at + 2]} : 0);
    text += letters[three >> 18];
    text += letters[three >> 12 & 63];
    text += left > 1 ? letters[three >> 6 & 63] : '=';
    text += left > 2 ? letters[three & 63] : '=';
  }
  return text;
}

}  // namespace

std::string websocket_accept(std::string_view key) {
  return base64(sha1(std::string(key) + std::string(websocket_guid)));
}

}  // namespace vicinity::viewer
