// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What waits to be sent to one client: bounded, and without anybody waiting for it.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>

namespace vicinity::viewer {

/// Bytes that several clients are sent: made once, and never changed.
using SharedBytes = std::shared_ptr<const std::string>;

/// Answers wait in a queue. Of snapshots only the newest waits, and it goes when the queue is
/// empty: a slow client misses snapshots, and nothing else.
class Outbox {
 public:
  /// @param most_waiting  bytes; overfull() beyond them
  explicit Outbox(std::size_t most_waiting) : most_waiting_(most_waiting) {}

  void add(SharedBytes bytes);
  void add(std::string bytes) { add(std::make_shared<const std::string>(std::move(bytes))); }
  /// A whole WebSocket message: its header and its payload.
  void add_message(const SharedBytes& payload);
  /// Takes the place of the one that waits.
  void offer_snapshot(SharedBytes payload) noexcept { snapshot_ = std::move(payload); }
  void drop_snapshot() noexcept { snapshot_.reset(); }

  bool empty() const noexcept { return queue_.empty() && snapshot_ == nullptr; }
  bool overfull() const noexcept { return waiting_ > most_waiting_; }

  enum class Sent { all, some, none, broken };
  /// Writes as much as the socket takes at once, and at most about a megabyte.
  Sent send_to(int socket);

 private:
  std::size_t most_waiting_, waiting_ = 0, sent_of_first_ = 0;
  std::deque<SharedBytes> queue_;
  SharedBytes snapshot_;
};

}  // namespace vicinity::viewer
