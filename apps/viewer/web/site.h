// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a web server serves: who answers its clients.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "web/http_response.h"

namespace vicinity::viewer {

/// Number of a connection. None is used twice.
using ClientId = std::uint64_t;

/// Everything here is called by the server's own thread, which serves all clients: it must not
/// wait. What takes time is handed on, and answered by WebServer::send() or respond().
class Site {
 public:
  virtual ~Site() = default;

  /// A file of the page, or nothing. @param path  begins with '/'
  virtual std::optional<HttpResponse> page_file(std::string_view path) = 0;
  /// GET /file: answered by respond().
  virtual void file_wanted(ClientId connection, const std::string& name) = 0;
  /// PUT /upload: where its bytes are to be written meanwhile, or a refusal.
  virtual std::variant<std::filesystem::path, HttpResponse> upload_begins(
      const std::string& name) = 0;
  /// All bytes are there; answered by respond(). The file is the site's now.
  virtual void upload_came(ClientId connection, const std::string& name,
                           const std::filesystem::path& file) = 0;

  /// WebSockets.
  virtual void opened(ClientId client) = 0;
  virtual void closed(ClientId client) = 0;
  virtual void message(ClientId client, std::string_view payload) = 0;
  /// Said once a second to a client whose messages are dropped because they are too many.
  virtual SharedBytes too_many_messages(std::uint64_t dropped) = 0;
  /// A client that sent text.
  virtual SharedBytes text_not_understood() = 0;
  /// The newest snapshot; null where it is the one of the last call.
  virtual SharedBytes newest_snapshot() = 0;
};

}  // namespace vicinity::viewer
