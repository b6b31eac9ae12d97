// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web/connection.h"

#include <unistd.h>

#include <algorithm>
#include <system_error>

namespace vicinity::viewer {

bool Allowance::take(double now_s) noexcept {
  left_ = std::min(burst_, left_ + rate_ * (now_s - last_s_));
  last_s_ = now_s;
  if (left_ < 1) return false;
  left_ -= 1;
  return true;
}

Socket::~Socket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Connection::~Connection() {
  if (upload_file >= 0) ::close(upload_file);
  std::error_code ignored;
  if (!upload_path.empty()) std::filesystem::remove(upload_path, ignored);
}

}  // namespace vicinity::viewer
