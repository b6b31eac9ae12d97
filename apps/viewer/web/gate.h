// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Who is let in: origin, host and token of a request.
#pragma once

#include <optional>
#include <string>

#include "web/http_request.h"

namespace vicinity::viewer {

/// Whether an address is one that only this machine reaches.
bool is_loopback(const std::string& address);

/// Whether a request comes from the server's own page, or from no page at all.
///
/// Every browser states the origin of a page that opens a WebSocket or sends an upload, and pages
/// of other sites may do both: without this check any site that is open in the same browser could
/// drive the arm. On the loopback address the host must be the loopback's own name too, so that a
/// name of somebody else's that has been pointed at it is no way in.
///
/// @param token         empty: none is asked for
/// @param on_loopback   whether only this machine reaches the server
/// @return              why not, as a sentence; nothing: it is let in
std::optional<std::string> why_refused(const HttpRequest& request, const std::string& token,
                                       bool on_loopback);

}  // namespace vicinity::viewer
