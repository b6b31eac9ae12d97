// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A file of the command line: whole or not at all, whatever signal comes.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "interruption.h"

namespace vicinity {
class FileBeside;
}

namespace vicinity::cli {

/// Writes beside the file that `path` names, a symbolic link followed. commit() renames it into
/// place; without commit() the destructor removes it.
/// Errors: every function throws Error where the disk is full or the folder cannot be written; the
/// constructor also for an empty path, and where there is something that is no regular file.
class FreshFile {
 public:
  explicit FreshFile(const std::filesystem::path& path);
  ~FreshFile();
  FreshFile(const FreshFile&) = delete;
  FreshFile& operator=(const FreshFile&) = delete;

  void write(std::string_view text);
  void commit();

 private:
  WhileWriting while_writing_;
  std::unique_ptr<FileBeside> file_;
};

}  // namespace vicinity::cli
