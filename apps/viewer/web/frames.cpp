// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web/frames.h"

#include <algorithm>

namespace vicinity::viewer {
namespace {

constexpr std::uint64_t longest_control = 125;

bool is_known(Opcode opcode) {
  switch (opcode) {
    case Opcode::more:
    case Opcode::text:
    case Opcode::binary:
    case Opcode::close:
    case Opcode::ping:
    case Opcode::pong:
      return true;
  }
  return false;
}

bool is_control(Opcode opcode) { return static_cast<int>(opcode) >= 8; }

std::uint64_t big_endian(const char* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t n = 0; n < count; ++n) value = value << 8 | static_cast<unsigned char>(bytes[n]);
  return value;
}

}  // namespace

FrameReader::Result FrameReader::refuse(CloseCode why) noexcept {
  close_code_ = why;
  return Result::refused;
}

// Whether the header is whole: two bytes, the length where it is long, and the mask.
bool FrameReader::take_header(std::string_view& bytes) {
  const auto wanted = [this]() -> std::size_t {
    if (header_.size() < 2) return 2;
    const int length = header_[1] & 0x7F;
    const std::size_t mask = (header_[1] & 0x80) != 0 ? 4 : 0;
    return 2 + (length == 126 ? 2u : length == 127 ? 8u : 0u) + mask;
  };
  while (header_.size() < wanted()) {
    if (bytes.empty()) return false;
    header_ += bytes.front();
    bytes.remove_prefix(1);
  }
  return true;
}

FrameReader::Result FrameReader::begin_frame() {
  final_ = (header_[0] & 0x80) != 0;
  frame_ = static_cast<Opcode>(header_[0] & 0x0F);
  const int length = header_[1] & 0x7F;
  left_ = length == 126   ? big_endian(&header_[2], 2)
          : length == 127 ? big_endian(&header_[2], 8)
                          : static_cast<std::uint64_t>(length);
  at_ = 0;
  control_ = is_control(frame_);
  // Reserved bits mean extensions, and none was agreed on; a client must mask.
  if ((header_[0] & 0x70) != 0 || !is_known(frame_) || (header_[1] & 0x80) == 0) {
    return refuse(CloseCode::protocol_error);
  }
  std::copy_n(header_.end() - 4, 4, mask_);
  header_.clear();
  if (control_) {
    if (!final_ || left_ > longest_control) return refuse(CloseCode::protocol_error);
    control_payload_.clear();
    return Result::need_more;
  }
  if ((frame_ == Opcode::more) != in_message_) return refuse(CloseCode::protocol_error);
  if (frame_ != Opcode::more) {
    message_.clear();
    message_opcode_ = frame_;
    fragments_ = 0;
  }
  if (left_ > limits_.message_bytes - message_.size() || ++fragments_ > limits_.fragments) {
    return refuse(CloseCode::too_big);
  }
  return Result::need_more;
}

FrameReader::Result FrameReader::read(std::string_view& bytes) {
  while (true) {
    if (!in_payload_) {
      if (!take_header(bytes)) return Result::need_more;
      if (begin_frame() == Result::refused) return Result::refused;
      in_payload_ = true;
    }
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size()));
    std::string& into = control_ ? control_payload_ : message_;
    for (std::size_t n = 0; n < count; ++n, ++at_) {
      into += static_cast<char>(static_cast<unsigned char>(bytes[n]) ^ mask_[at_ % 4]);
    }
    bytes.remove_prefix(count);
    left_ -= count;
    if (left_ > 0) return Result::need_more;
    in_payload_ = false;
    if (control_) {
      opcode_ = frame_;
      return Result::message;
    }
    in_message_ = !final_;
    if (final_) {
      opcode_ = message_opcode_;
      return Result::message;
    }
  }
}

std::string frame_header(Opcode opcode, std::uint64_t payload_bytes) {
  std::string header(1, static_cast<char>(0x80 | static_cast<int>(opcode)));
  const auto append = [&](int bytes) {
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
      header += static_cast<char>(payload_bytes >> shift & 0xFF);
    }
  };
  if (payload_bytes < 126) {
    append(1);
  } else if (payload_bytes < 65'536) {
    header += static_cast<char>(126);
    append(2);
  } else {
    header += static_cast<char>(127);
    append(8);
  }
  return header;
}

std::string close_frame(CloseCode code, std::string_view why) {
  const auto number = static_cast<unsigned>(code);
  const std::string_view said = why.substr(0, longest_control - 2);
  std::string frame = frame_header(Opcode::close, 2 + said.size());
  frame += static_cast<char>(number >> 8);
  frame += static_cast<char>(number & 0xFF);
  frame += said;
  return frame;
}

}  // namespace vicinity::viewer
