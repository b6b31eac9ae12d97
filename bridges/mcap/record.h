// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What an MCAP file is made of: records, each an opcode, a length and little-endian fields.
///
///   magic | header | schemas, channels, chunks of messages and their index | data end
///         | summary: schemas, channels, where the chunks are, counts | where the groups are
///         | footer | magic
///
/// The public specification, mcap.dev/spec, says what is in each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace vicinity::mcap {

inline constexpr std::string_view magic{"\x89MCAP0\r\n", 8};

enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

inline constexpr std::size_t record_head = 9;   ///< opcode and length
inline constexpr std::size_t footer_body = 20;  ///< the footer's fields

/// How messages of a channel are laid out. Id 0: nothing is known of that.
struct Schema {
  std::uint16_t id = 0;
  std::string name, encoding, data;
  bool operator==(const Schema&) const = default;
};

/// A stream of messages.
struct Channel {
  std::uint16_t id = 0, schema_id = 0;
  std::string topic, message_encoding;
  bool operator==(const Channel&) const = default;
};

struct Message {
  std::uint32_t sequence = 0;  ///< within its channel
  std::uint64_t log_time_ns = 0, publish_time_ns = 0;
  std::span<const std::byte> data;  ///< valid while it is looked at
};

/// Puts fields behind one another.
class Fields {
 public:
  Fields& u8(std::uint8_t x) { return raw(&x, sizeof x); }
  Fields& u16(std::uint16_t x) { return raw(&x, sizeof x); }
  Fields& u32(std::uint32_t x) { return raw(&x, sizeof x); }
  Fields& u64(std::uint64_t x) { return raw(&x, sizeof x); }
  Fields& bytes(std::string_view x) { return raw(x.data(), x.size()); }
  /// Its length in 4 bytes, then the text.
  Fields& text(std::string_view x) { return u32(static_cast<std::uint32_t>(x.size())).bytes(x); }

  const std::string& all() const noexcept { return all_; }
  std::string& all() noexcept { return all_; }

 private:
  Fields& raw(const void* from, std::size_t size) {
    all_.append(static_cast<const char*>(from), size);
    return *this;
  }
  std::string all_;
};

/// Takes fields one after the other. Where they end too soon it says so, and gives zeros.
class FieldReader {
 public:
  explicit FieldReader(std::string_view bytes) noexcept : bytes_(bytes) {}

  bool ok() const noexcept { return ok_; }
  std::string_view left() const noexcept { return bytes_; }

  std::uint8_t u8() noexcept { return number<std::uint8_t>(); }
  std::uint16_t u16() noexcept { return number<std::uint16_t>(); }
  std::uint32_t u32() noexcept { return number<std::uint32_t>(); }
  std::uint64_t u64() noexcept { return number<std::uint64_t>(); }
  std::string_view text() noexcept { return take(u32()); }
  std::string_view take(std::uint64_t size) noexcept {
    ok_ = ok_ && size <= bytes_.size();
    if (!ok_) return {};
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

 private:
  template <class T>
  T number() noexcept {
    T value = 0;
    const std::string_view from = take(sizeof value);
    if (ok_) std::memcpy(&value, from.data(), sizeof value);
    return value;
  }

  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace vicinity::mcap
