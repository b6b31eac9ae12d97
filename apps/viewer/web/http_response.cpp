// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web/http_response.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace vicinity::viewer {
namespace {

std::string_view reason_phrase(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 201:
      return "Created";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 413:
      return "Content Too Large";
    case 429:
      return "Too Many Requests";
    default:
      return "Internal Server Error";
  }
}

}  // namespace

HttpResponse sentence(int status, std::string words) {
  return {.status = status, .body = std::make_shared<const std::string>(std::move(words) + "\n")};
}

std::string response_head(const HttpResponse& response) {
  // The page is all that runs in it, and nobody frames it. The address may hold a token: it is told
  // to nobody.
  return fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n"
      "Cache-Control: no-cache\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: "
      "no-referrer\r\n"
      "Content-Security-Policy: default-src 'self'; style-src 'self' 'unsafe-inline'; "
      "img-src 'self' data: blob:; worker-src 'self' blob:; frame-ancestors 'none'\r\n\r\n",
      response.status, reason_phrase(response.status), response.type,
      response.body == nullptr ? 0 : response.body->size());
}

std::string_view content_type(std::string_view name) {
  using Pair = std::pair<std::string_view, std::string_view>;
  constexpr std::array types = {Pair{".html", "text/html; charset=utf-8"},
                                Pair{".js", "text/javascript; charset=utf-8"},
                                Pair{".css", "text/css; charset=utf-8"},
                                Pair{".svg", "image/svg+xml"},
                                Pair{".json", "application/json"},
                                Pair{".png", "image/png"},
                                Pair{".woff2", "font/woff2"},
                                Pair{".txt", "text/plain; charset=utf-8"}};
  for (const auto& [ending, type] : types) {
    if (name.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

}  // namespace vicinity::viewer
