// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// WebSocket frames (RFC 6455, 5): bytes of a socket into messages, and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vicinity::viewer {

enum class Opcode : std::uint8_t { more = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

/// Why a connection is closed (RFC 6455, 7.4.1).
enum class CloseCode : std::uint16_t {
  normal = 1000,
  protocol_error = 1002,
  policy = 1008,
  too_big = 1009,
};

struct FrameLimits {
  std::size_t message_bytes = 262'144;
  int fragments = 64;
};

/// Puts what comes from a client together. Never holds more than one message and one header, and
/// refuses a frame by its header: what it announces is not taken in first.
class FrameReader {
 public:
  explicit FrameReader(const FrameLimits& limits) : limits_(limits) {}

  enum class Result : std::uint8_t {
    need_more,  ///< all bytes are used up
    message,    ///< opcode() and payload() hold one
    refused,    ///< close_code() says why; nothing can be read any more
  };

  /// Takes bytes off the front of `bytes` until there is a message. Fragments are joined;
  /// control frames come in between, each as a message of its own.
  Result read(std::string_view& bytes);

  Opcode opcode() const noexcept { return opcode_; }
  /// Unmasked; stays until the next read().
  const std::string& payload() const noexcept { return control_ ? control_payload_ : message_; }
  CloseCode close_code() const noexcept { return close_code_; }

 private:
  Result refuse(CloseCode why) noexcept;
  bool take_header(std::string_view& bytes);
  Result begin_frame();

  FrameLimits limits_;
  std::string header_;
  bool in_payload_ = false, in_message_ = false, final_ = false, control_ = false;
  Opcode frame_ = Opcode::more, opcode_ = Opcode::binary, message_opcode_ = Opcode::binary;
  std::uint64_t left_ = 0, at_ = 0;
  unsigned char mask_[4] = {};
  int fragments_ = 0;
  std::string message_, control_payload_;
  CloseCode close_code_ = CloseCode::normal;
};

/// Header of one whole frame from a server, without a mask.
std::string frame_header(Opcode opcode, std::uint64_t payload_bytes);

/// A whole close frame.
std::string close_frame(CloseCode code, std::string_view why = {});

}  // namespace vicinity::viewer
