// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web/http_request.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace vicinity::viewer {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

std::optional<std::string> decoded(std::string_view text) {
  std::string plain;
  for (std::size_t n = 0; n < text.size(); ++n) {
    char c = text[n];
    if (c == '%') {
      if (n + 2 >= text.size()) return {};
      const int high = hex_digit(text[n + 1]), low = hex_digit(text[n + 2]);
      if (high < 0 || low < 0) return {};
      c = static_cast<char>(16 * high + low);
      n += 2;
    }
    if (is_control(c)) return {};
    plain += c;
  }
  return plain;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

// Takes the next piece off the front of the text.
std::string_view take(std::string_view& text, std::string_view until) {
  const std::size_t end = std::min(text.find(until), text.size());
  const std::string_view piece = text.substr(0, end);
  text.remove_prefix(std::min(end + until.size(), text.size()));
  return piece;
}

bool read_target(std::string_view target, HttpRequest& request) {
  std::string_view query = target;
  const auto path = decoded(take(query, "?"));
  if (!path || !path->starts_with('/')) return false;
  request.path = *path;
  while (!query.empty()) {
    std::string_view value = take(query, "&");
    const auto key = decoded(take(value, "=")), text = decoded(value);
    if (!key || !text) return false;
    request.query.try_emplace(*key, *text);
  }
  return true;
}

bool read_header(std::string_view line, HttpRequest& request) {
  const std::size_t colon = line.find(':');
  if (colon == 0 || colon == std::string_view::npos) return false;
  std::string name(line.substr(0, colon));
  for (char& c : name) {
    if (is_control(c) || c == ' ') return false;
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (std::ranges::any_of(value, [](char c) { return is_control(c) && c != '\t'; })) return false;
  return request.header.try_emplace(name, value).second;
}

}  // namespace

std::string_view HttpRequest::operator[](const std::string& lower_case_name) const {
  const auto found = header.find(lower_case_name);
  return found == header.end() ? std::string_view{} : std::string_view(found->second);
}

std::optional<HttpRequest> parse_request(std::string_view text) {
  HttpRequest request;
  std::string_view line = take(text, "\r\n");
  request.method = take(line, " ");
  const std::string_view target = take(line, " ");
  if (request.method.empty() || (line != "HTTP/1.1" && line != "HTTP/1.0")) return {};
  if (!read_target(target, request)) return {};
  while (!text.empty()) {
    if (!read_header(take(text, "\r\n"), request)) return {};
  }
  return request;
}

std::optional<std::uint64_t> content_length(const HttpRequest& request) {
  const std::string_view text = request["content-length"];
  std::uint64_t length = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return {};
  return length;
}

}  // namespace vicinity::viewer
