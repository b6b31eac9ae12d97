// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web/gate.h"

#include <arpa/inet.h>

#include <string_view>

namespace vicinity::viewer {
namespace {

std::string_view without_port(std::string_view host) {
  const std::size_t end = host.find_last_not_of("0123456789");
  return end != std::string_view::npos && host[end] == ':' ? host.substr(0, end) : host;
}

bool names_loopback(std::string_view host) {
  const std::string_view name = without_port(host);
  return name == "[::1]" || is_loopback(std::string(name));
}

// As long for a wrong token as for a right one, whatever of it is right.
bool same(std::string_view token, std::string_view other) {
  unsigned difference = token.size() == other.size() ? 0 : 1;
  for (std::size_t n = 0; n < token.size(); ++n) {
    const char c = n < other.size() ? other[n] : '\0';
    difference |= static_cast<unsigned>(token[n] ^ c);
  }
  return difference == 0;
}

}  // namespace

// Numbers only: "127.0.0.1.example" is somebody's name, which may lead anywhere.
bool is_loopback(const std::string& address) {
  in_addr numbers{};
  if (inet_pton(AF_INET, address.c_str(), &numbers) == 1) return ntohl(numbers.s_addr) >> 24 == 127;
  return address == "localhost" || address == "::1";
}

std::optional<std::string> why_refused(const HttpRequest& request, const std::string& token,
                                       bool on_loopback) {
  const std::string_view host = request["host"], origin = request["origin"];
  if (host.empty()) return "the request names no host";
  if (on_loopback && !names_loopback(host)) {
    return "this server is on the loopback address and goes by no other name";
  }
  if (request.header.contains("origin") && origin != "http://" + std::string(host) &&
      origin != "https://" + std::string(host)) {
    return "another page's request: its origin is not this server";
  }
  if (token.empty()) return {};
  const auto given = request.query.find("token");
  if (given == request.query.end()) return "a token is asked for: ?token=...";
  if (!same(token, given->second)) return "the token is another one";
  return {};
}

}  // namespace vicinity::viewer
