// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A message as its bytes, on the wire and in a recording: XCDR1, as ROS 2 sends it.
///
/// Four bytes say the byte order; then every number stands at a multiple of its own size, counted
/// from behind those four. Strings and lists are their length, then what is in them.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace vicinity::ros2 {

static_assert(std::endian::native == std::endian::little, "written bytes are little-endian");

template <class T>
inline constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_same_v<T, std::byte>;
template <class T>
inline constexpr bool is_list = false;
template <class T>
inline constexpr bool is_list<std::vector<T>> = true;

/// Behind the byte order's four bytes.
inline constexpr std::size_t cdr_origin = 4;

class CdrWriter {
 public:
  /// Appends to `bytes`, which it empties first: a buffer that is used again takes no memory.
  explicit CdrWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {
    bytes_.assign({std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}});
  }

  template <class T>
  void operator()(const char*, const T& field) {
    put(field);
  }

  template <class T>
  void put(const T& value) {
    if constexpr (is_plain<T>) {
      align(sizeof(T));
      raw(&value, sizeof(T));
    } else if constexpr (std::is_same_v<T, std::string>) {
      put(static_cast<std::uint32_t>(value.size() + 1));
      raw(value.c_str(), value.size() + 1);
    } else if constexpr (is_list<T>) {
      put(static_cast<std::uint32_t>(value.size()));
      if constexpr (is_plain<typename T::value_type>) {
        if (value.empty()) return;
        align(sizeof(typename T::value_type));
        raw(value.data(), value.size() * sizeof(typename T::value_type));
      } else {
        for (const auto& each : value) put(each);
      }
    } else {
      T::fields(value, *this);
    }
  }

 private:
  void align(std::size_t size) {
    bytes_.resize(bytes_.size() + (size - (bytes_.size() - cdr_origin) % size) % size);
  }
  void raw(const void* from, std::size_t size) {
    const auto* begin = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }

  std::vector<std::byte>& bytes_;
};

/// Reads what anybody may have sent, in either byte order. Once something does not fit, nothing
/// more is read.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {
    // Plain CDR alone: 0 big-endian, 1 little-endian.
    ok_ = bytes.size() >= cdr_origin && bytes[0] == std::byte{0} && bytes[1] <= std::byte{1};
    swap_ = ok_ && bytes[1] == std::byte{0};
  }

  bool ok() const noexcept { return ok_; }

  template <class T>
  void operator()(const char*, T& field) {
    take(field);
  }

  template <class T>
  void take(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      plain(byte);
      value = byte != 0;
    } else if constexpr (is_plain<T>) {
      plain(value);
    } else if constexpr (std::is_same_v<T, std::string>) {
      text(value);
    } else if constexpr (is_list<T>) {
      list(value);
    } else {
      T::fields(value, *this);
    }
  }

 private:
  std::size_t left() const noexcept { return bytes_.size() - at_; }

  // Where the next `size` bytes begin, or null.
  const std::byte* next(std::size_t alignment, std::size_t size) noexcept {
    const std::size_t gap = (alignment - (at_ - cdr_origin) % alignment) % alignment;
    ok_ = ok_ && gap <= left() && size <= left() - gap;
    if (!ok_) return nullptr;
    at_ += gap + size;
    return &bytes_[at_ - size];
  }

  template <class T>
  void plain(T& value) noexcept {
    const std::byte* from = next(sizeof(T), sizeof(T));
    if (from != nullptr) copy(value, from);
  }

  template <class T>
  void copy(T& value, const std::byte* from) const noexcept {
    std::byte turned[sizeof(T)];
    std::copy_n(from, sizeof(T), turned);
    if (swap_) std::reverse(turned, turned + sizeof(T));
    std::memcpy(&value, turned, sizeof(T));
  }

  void text(std::string& value) {
    std::uint32_t length = 0;  // with the zero at its end; some send none for an empty string
    plain(length);
    value.clear();
    if (!ok_ || length == 0) return;
    const std::byte* from = next(1, length);
    if (from == nullptr) return;
    ok_ = from[length - 1] == std::byte{0};
    if (ok_) value.assign(reinterpret_cast<const char*>(from), length - 1);
  }

  template <class T>
  void list(std::vector<T>& value) {
    std::uint32_t count = 0;
    plain(count);
    value.clear();
    if constexpr (is_plain<T>) {
      if (!ok_ || count == 0) return;
      const std::byte* from = next(sizeof(T), std::size_t{count} * sizeof(T));
      if (from == nullptr) return;
      value.resize(count);
      for (std::uint32_t n = 0; n < count; ++n) copy(value[n], from + n * sizeof(T));
    } else {
      // Grows with what is really there: a length that lies takes no memory.
      for (std::uint32_t n = 0; n < count && ok_; ++n) {
        ok_ = left() > 0;
        if (ok_) take(value.emplace_back());
      }
    }
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = cdr_origin;
  bool ok_ = false, swap_ = false;
};

/// @param bytes  out; its memory is used again
template <class Message>
void write_cdr(const Message& message, std::vector<std::byte>& bytes) {
  CdrWriter(bytes).put(message);
}

/// False for bytes that are no such message; then `message` holds rubbish. Bytes behind it are not
/// looked at: whoever pads does so there.
template <class Message>
[[nodiscard]] bool read_cdr(std::span<const std::byte> bytes, Message& message) {
  CdrReader reader(bytes);
  reader.take(message);
  return reader.ok();
}

}  // namespace vicinity::ros2
