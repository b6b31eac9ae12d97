// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What an HTTP request is answered with.
#pragma once

#include <string>
#include <string_view>

#include "web/outbox.h"

namespace vicinity::viewer {

struct HttpResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  SharedBytes body;
};

/// A refusal, or any other sentence.
HttpResponse sentence(int status, std::string words);

/// Status line and headers, blank line included. The connection is closed behind the body.
std::string response_head(const HttpResponse& response);

/// By the ending of a file's name: "text/html; charset=utf-8" for .html, ...
std::string_view content_type(std::string_view name);

}  // namespace vicinity::viewer
