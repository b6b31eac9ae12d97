// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web/listener.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "vicinity/geometry/error.h"

namespace vicinity::viewer {
namespace {

constexpr int backlog = 64;

std::uint16_t port_of(int socket) {
  sockaddr_storage at{};
  socklen_t size = sizeof at;
  getsockname(socket, reinterpret_cast<sockaddr*>(&at), &size);
  return at.ss_family == AF_INET6 ? ntohs(reinterpret_cast<const sockaddr_in6&>(at).sin6_port)
                                  : ntohs(reinterpret_cast<const sockaddr_in&>(at).sin_port);
}

}  // namespace

Listener listen_at(const std::string& address, std::uint16_t port) {
  addrinfo hints{};
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_STREAM;
  if (address == "localhost") hints.ai_family = AF_INET;
  addrinfo* found = nullptr;
  if (getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
    throw Error({.where = "--bind",
                 .what = "not an address of this machine",
                 .found = "'" + address + "'",
                 .expected = "127.0.0.1, or another address of its own"});
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> holds(found, freeaddrinfo);
  Socket socket(::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (bind(socket.get(), found->ai_addr, found->ai_addrlen) != 0 ||
      listen(socket.get(), backlog) != 0) {
    const bool taken = errno == EADDRINUSE;
    throw Error({.where = fmt::format("{}, port {}", address, port),
                 .what = "cannot be listened at",
                 .found = std::strerror(errno),
                 .hint = taken ? "--port 0 takes one that is free" : "another --bind or --port"});
  }
  const std::uint16_t taken = port_of(socket.get());
  const std::string host = found->ai_family == AF_INET6 ? "[" + address + "]" : address;
  return {std::move(socket), taken, fmt::format("http://{}:{}/", host, taken)};
}

}  // namespace vicinity::viewer
