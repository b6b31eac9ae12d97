// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// One client of the web server: where it is in its request or its conversation.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "web/frames.h"
#include "web/http_request.h"
#include "web/outbox.h"
#include "web/site.h"

namespace vicinity::viewer {

/// How many messages may come: `rate` a second, and `burst` at once.
class Allowance {
 public:
  Allowance(double rate, double burst) : rate_(rate), burst_(burst), left_(burst) {}

  /// Whether one more is within it. @param now_s  of a steady clock, never falling
  bool take(double now_s) noexcept;

 private:
  double rate_, burst_, left_, last_s_ = 0;
};

/// A socket that is closed with its owner.
class Socket {
 public:
  explicit Socket(int descriptor = -1) noexcept : descriptor_(descriptor) {}
  ~Socket();
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  int get() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

struct Connection {
  enum class State : std::uint8_t {
    reading_head,
    reading_upload,
    awaiting_response,  ///< the site has the request
    open,               ///< a WebSocket
    leaving,            ///< what is in the outbox is all that is left to do
    lingering,          ///< all is sent: until the other side has read it
  };

  Connection(ClientId number, Socket connected, const FrameLimits& limits, double rate,
             double burst, std::size_t most_waiting)
      : id(number),
        socket(std::move(connected)),
        outbox(most_waiting),
        frames(limits),
        allowance(rate, burst) {}
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  ClientId id;
  Socket socket;
  State state = State::reading_head;
  std::string head;  ///< as far as it has come
  Outbox outbox;
  bool wants_to_write = false;  ///< the socket was full
  bool said_all = false;        ///< nothing more will come from it

  // An upload.
  std::string upload_name;
  std::filesystem::path upload_path;  ///< removed with the connection where it did not all come
  int upload_file = -1;
  std::uint64_t upload_left = 0;

  // A WebSocket.
  FrameReader frames;
  Allowance allowance;
  std::uint64_t dropped = 0;  ///< messages, since it was last said
  int snapshots_per_s = 0;
  double next_snapshot_s = 0;

  // Clocks [s].
  double began_s = 0;  ///< when it was accepted
  double heard_s = 0;  ///< when bytes last came
  double sent_s = 0;   ///< when bytes last went, or when there was nothing to send
  double pinged_s = 0;
  double said_s = 0;  ///< when it was last told about dropped messages
};

}  // namespace vicinity::viewer
