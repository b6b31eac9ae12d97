// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/geometry/error.h"

#include <utility>

namespace vicinity {
namespace {

std::string sentence(const ErrorParts& parts) {
  std::string text = parts.where.empty() ? parts.what : parts.where + ": " + parts.what;
  if (!parts.found.empty()) text += "; found " + parts.found;
  if (!parts.expected.empty())
    text += (parts.found.empty() ? "; expected " : ", expected ") + parts.expected;
  if (!parts.hint.empty()) text += "; try " + parts.hint;
  return text;
}

}  // namespace

Error::Error(ErrorParts parts) : std::runtime_error(sentence(parts)), parts_(std::move(parts)) {}

}  // namespace vicinity
