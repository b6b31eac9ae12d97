// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The socket that a server listens at.
#pragma once

#include <cstdint>
#include <string>

#include "web/connection.h"

namespace vicinity::viewer {

struct Listener {
  Socket socket;
  std::uint16_t port = 0;  ///< as it came out
  std::string address;     ///< "http://127.0.0.1:8080/"
};

/// @param port  0: any that is free
/// Errors: throws Error where the address is none, or cannot be listened at.
Listener listen_at(const std::string& address, std::uint16_t port);

}  // namespace vicinity::viewer
