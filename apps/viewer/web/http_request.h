// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The head of an HTTP/1.1 request, as much of it as the viewer has use for.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace vicinity::viewer {

struct HttpRequest {
  std::string method;                         ///< as it came: "GET"
  std::string path;                           ///< decoded, begins with '/'
  std::map<std::string, std::string> query;   ///< decoded; of two values for one key the first
  std::map<std::string, std::string> header;  ///< names in lower case, values without blanks around

  /// The header's value, or empty.
  std::string_view operator[](const std::string& lower_case_name) const;
};

/// The longest head that is read [bytes].
inline constexpr std::size_t longest_head = 8192;

/// Reads a head: the request line and headers up to the blank line.
/// @param text  without the blank line
/// @return      nothing for what is no such head: a line that is none, a target that does not begin
///              with '/', a bad escape, a control character, a header that comes twice
std::optional<HttpRequest> parse_request(std::string_view text);

/// Content-Length; nothing where it is not stated or no number.
std::optional<std::uint64_t> content_length(const HttpRequest& request);

}  // namespace vicinity::viewer
