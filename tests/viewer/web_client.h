// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A client of the web server, written from RFC 6455 and RFC 9112 alone: nothing of it is shared
/// with the server.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <string_view>

namespace vicinity::viewer_test {

/// A TCP connection to the loopback address.
class Connected {
 public:
  explicit Connected(std::uint16_t port);
  ~Connected();
  Connected(const Connected&) = delete;
  Connected& operator=(const Connected&) = delete;

  /// False where the other side does not listen any more.
  bool send(std::string_view bytes);
  /// What has come, at least one byte; empty at the end of the stream or after the time.
  std::string receive(std::chrono::milliseconds longest);
  int socket() const noexcept { return socket_; }

 private:
  int socket_ = -1;
};

struct HttpAnswer {
  int status = 0;  ///< 0: none came
  std::string head, body;
};

/// Sends text as it stands, and reads to the end of the stream.
HttpAnswer exchange(std::uint16_t port, std::string_view text);
HttpAnswer get(std::uint16_t port, const std::string& target, const std::string& headers = "");
HttpAnswer put(std::uint16_t port, const std::string& target, std::string_view body,
               const std::string& headers = "");

/// A whole frame from a client: masked.
std::string client_frame(int opcode, std::string_view payload, bool last = true,
                         std::uint32_t mask = 0x12345678);

/// A WebSocket.
class PageClient {
 public:
  /// Errors: throws std::runtime_error where it is not let in.
  explicit PageClient(std::uint16_t port, const std::string& target = "/ws");

  bool send(std::string_view message) { return connected_.send(client_frame(2, message)); }
  bool send_raw(std::string_view bytes) { return connected_.send(bytes); }

  struct Message {
    int opcode = 0;
    std::string payload;

    std::uint16_t type() const { return number<std::uint16_t>(0); }
    std::uint32_t id() const { return number<std::uint32_t>(4); }
    std::string_view text() const { return std::string_view(payload).substr(8); }
    template <class T>
    T number(std::size_t offset) const {
      T value{};
      if (payload.size() >= offset + sizeof value) {
        std::memcpy(&value, payload.data() + offset, sizeof value);
      }
      return value;
    }
  };

  /// The next message; nothing when the connection has ended or the time is over. Pings are
  /// answered on the way.
  std::optional<Message> next(std::chrono::milliseconds longest = std::chrono::seconds(20));
  /// The next message of a type, whatever comes before.
  std::optional<Message> next_of(std::uint16_t type,
                                 std::chrono::milliseconds longest = std::chrono::seconds(20));
  /// The next answer to a command.
  std::optional<Message> answer(std::uint32_t id,
                                std::chrono::milliseconds longest = std::chrono::seconds(20));
  Connected& connected() noexcept { return connected_; }

 private:
  std::optional<Message> take_frame();

  Connected connected_;
  std::string read_;
};

/// Header and payload of a command.
std::string command(std::uint16_t type, std::uint32_t id, std::string_view payload = {});

/// Numbers as they lie in memory, one behind the other.
template <class... T>
std::string bytes_of(T... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return bytes;
}

}  // namespace vicinity::viewer_test
