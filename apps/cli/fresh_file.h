// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A file that appears whole or not at all: written beside, then renamed into place.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include "interruption.h"

namespace vicinity::cli {

/// Writes to a temporary file in the same folder. commit() renames it; without commit() the
/// destructor removes it.
/// Errors: every function throws Error where the disk is full or the folder cannot be written.
class FreshFile {
 public:
  explicit FreshFile(std::filesystem::path path);
  ~FreshFile();
  FreshFile(const FreshFile&) = delete;
  FreshFile& operator=(const FreshFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void commit();

  /// The temporary file, for libraries that open files themselves.
  const std::filesystem::path& beside() const noexcept { return beside_; }

 private:
  [[noreturn]] void fail(const char* doing) const;

  WhileWriting while_writing_;
  std::filesystem::path path_, beside_;
  std::FILE* file_ = nullptr;
};

}  // namespace vicinity::cli
