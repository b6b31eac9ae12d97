// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

namespace vicinity::viewer_test {
namespace {

using Clock = std::chrono::steady_clock;

std::chrono::milliseconds until(Clock::time_point end) {
  return std::max(std::chrono::milliseconds(0),
                  std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()));
}

}  // namespace

Connected::Connected(std::uint16_t port)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
    ::close(socket_);
    throw std::runtime_error("nobody listens");
  }
}

Connected::~Connected() { ::close(socket_); }

bool Connected::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

std::string Connected::receive(std::chrono::milliseconds longest) {
  pollfd ready{.fd = socket_, .events = POLLIN, .revents = 0};
  if (::poll(&ready, 1, static_cast<int>(longest.count())) <= 0) return {};
  std::string bytes(65'536, '\0');
  const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

HttpAnswer exchange(std::uint16_t port, std::string_view text) {
  Connected connected(port);
  connected.send(text);
  std::string all;
  while (true) {
    const std::string more = connected.receive(std::chrono::seconds(20));
    if (more.empty()) break;
    all += more;
  }
  const std::size_t end = all.find("\r\n\r\n");
  if (end == std::string::npos || !all.starts_with("HTTP/1.1 ")) return {};
  return {.status = std::stoi(all.substr(9, 3)),
          .head = all.substr(0, end),
          .body = all.substr(end + 4)};
}

HttpAnswer get(std::uint16_t port, const std::string& target, const std::string& headers) {
  return exchange(port, "GET " + target + " HTTP/1.1\r\nHost: localhost:" + std::to_string(port) +
                            "\r\n" + headers + "\r\n");
}

HttpAnswer put(std::uint16_t port, const std::string& target, std::string_view body,
               const std::string& headers) {
  return exchange(port, "PUT " + target + " HTTP/1.1\r\nHost: localhost:" + std::to_string(port) +
                            "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
                            headers + "\r\n" + std::string(body));
}

std::string client_frame(int opcode, std::string_view payload, bool last, std::uint32_t mask) {
  std::string frame;
  frame += static_cast<char>((last ? 0x80 : 0) | opcode);
  const std::size_t size = payload.size();
  if (size < 126) {
    frame += static_cast<char>(0x80 | size);
  } else if (size < 65'536) {
    frame += static_cast<char>(0x80 | 126);
    for (const int shift : {8, 0}) frame += static_cast<char>(size >> shift & 0xFF);
  } else {
    frame += static_cast<char>(0x80 | 127);
    for (int shift = 56; shift >= 0; shift -= 8) frame += static_cast<char>(size >> shift & 0xFF);
  }
  char key[4];
  std::memcpy(key, &mask, 4);
  frame.append(key, 4);
  for (std::size_t n = 0; n < size; ++n) frame += static_cast<char>(payload[n] ^ key[n % 4]);
  return frame;
}

PageClient::PageClient(std::uint16_t port, const std::string& target) : connected_(port) {
  const std::string host = "localhost:" + std::to_string(port);
  connected_.send(
      "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host +
      "\r\nUpgrade: websocket\r\nConnection: keep-alive, Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  while (read_.find("\r\n\r\n") == std::string::npos) {
    const std::string more = connected_.receive(std::chrono::seconds(20));
    if (more.empty()) throw std::runtime_error("no answer: " + read_);
    read_ += more;
  }
  // The answer to the RFC's own example key, as the RFC prints it.
  if (!read_.starts_with("HTTP/1.1 101") ||
      read_.find("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=") == std::string::npos) {
    throw std::runtime_error("not let in: " + read_);
  }
  read_.erase(0, read_.find("\r\n\r\n") + 4);
}

std::optional<PageClient::Message> PageClient::take_frame() {
  if (read_.size() < 2) return {};
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(read_[n]); };
  std::uint64_t size = byte(1) & 0x7F;
  std::size_t header = 2;
  const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
  if (read_.size() < 2 + more) return {};
  if (more > 0) {
    size = 0;
    for (std::size_t n = 0; n < more; ++n) size = size << 8 | byte(2 + n);
    header += more;
  }
  if (read_.size() < header + size) return {};
  Message message{.opcode = byte(0) & 0x0F, .payload = read_.substr(header, size)};
  read_.erase(0, header + size);
  return message;
}

std::optional<PageClient::Message> PageClient::next(std::chrono::milliseconds longest) {
  const auto end = Clock::now() + longest;
  while (true) {
    if (auto message = take_frame()) {
      if (message->opcode == 9) {
        connected_.send(client_frame(10, message->payload));
        continue;
      }
      return message;
    }
    const std::string more = connected_.receive(until(end));
    if (more.empty()) return {};
    read_ += more;
  }
}

std::optional<PageClient::Message> PageClient::next_of(std::uint16_t type,
                                                       std::chrono::milliseconds longest) {
  const auto end = Clock::now() + longest;
  while (auto message = next(until(end))) {
    if (message->opcode == 2 && message->type() == type) return message;
  }
  return {};
}

std::optional<PageClient::Message> PageClient::answer(std::uint32_t id,
                                                      std::chrono::milliseconds longest) {
  const auto end = Clock::now() + longest;
  while (auto message = next(until(end))) {
    if (message->opcode == 2 && message->id() == id) return message;
  }
  return {};
}

std::string command(std::uint16_t type, std::uint32_t id, std::string_view payload) {
  return bytes_of(type, std::uint16_t{1}, id) + std::string(payload);
}

}  // namespace vicinity::viewer_test
