// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web/outbox.h"

#include <sys/socket.h>

#include <cerrno>

#include "web/frames.h"

namespace vicinity::viewer {
namespace {

// One client at a time gets no more than this, so that all others come to their turn.
constexpr std::size_t turn_bytes = std::size_t{1} << 20;

}  // namespace

void Outbox::add(SharedBytes bytes) {
  if (bytes->empty()) return;
  waiting_ += bytes->size();
  queue_.push_back(std::move(bytes));
}

void Outbox::add_message(const SharedBytes& payload) {
  add(frame_header(Opcode::binary, payload->size()));
  add(payload);
}

Outbox::Sent Outbox::send_to(int socket) {
  std::size_t sent = 0;
  while (sent < turn_bytes) {
    if (queue_.empty() && snapshot_ != nullptr) {
      add_message(snapshot_);
      snapshot_.reset();
    }
    if (queue_.empty()) return Sent::all;
    const std::string& first = *queue_.front();
    // Header and payload leave in one packet.
    const int more = queue_.size() > 1 ? MSG_MORE : 0;
    const ssize_t count = ::send(socket, first.data() + sent_of_first_,
                                 first.size() - sent_of_first_, MSG_NOSIGNAL | MSG_DONTWAIT | more);
    if (count < 0) {
      if (errno == EINTR) continue;
      if (errno != EAGAIN && errno != EWOULDBLOCK) return Sent::broken;
      return sent > 0 ? Sent::some : Sent::none;
    }
    sent += static_cast<std::size_t>(count);
    waiting_ -= static_cast<std::size_t>(count);
    sent_of_first_ += static_cast<std::size_t>(count);
    if (sent_of_first_ == first.size()) {
      queue_.pop_front();
      sent_of_first_ = 0;
    }
  }
  return Sent::some;
}

}  // namespace vicinity::viewer
