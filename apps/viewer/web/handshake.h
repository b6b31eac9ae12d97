// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a server answers to show that it speaks WebSocket (RFC 6455, 4.2.2).
#pragma once

#include <string>
#include <string_view>

namespace vicinity::viewer {

/// Value of Sec-WebSocket-Accept: base64 of SHA-1 of the key and the protocol's own GUID.
std::string websocket_accept(std::string_view key);

}  // namespace vicinity::viewer
