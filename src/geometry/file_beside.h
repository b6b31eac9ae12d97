// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A file that appears whole or not at all: written beside, then renamed into place.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace vicinity {

/// An open file, closed when it goes out of scope.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  int get() const noexcept { return fd_; }
  /// Whether all went well; some file systems report a full disk only here.
  bool close() noexcept { return fd_ < 0 || ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

/// Errors: throws Error with the system's own words.
[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int error);

/// The file that a write to `path` makes or replaces: where a symbolic link leads, so that the link
/// stays one; else `path`.
/// Errors: throws Error for an empty path, and for a folder, a device, a pipe or anything else that
/// is there and is no regular file: renaming would take its place.
std::filesystem::path file_to_write(const std::filesystem::path& path);

/// A new file beside file_to_write(path), removed unless it is moved into its place.
/// Errors: every function throws Error where the disk is full or the folder cannot be written; the
/// constructor also as file_to_write().
class FileBeside {
 public:
  explicit FileBeside(const std::filesystem::path& path);
  FileBeside(const FileBeside&) = delete;
  FileBeside& operator=(const FileBeside&) = delete;
  ~FileBeside();

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  void move_into_place();

  /// Where it is until then, for libraries that open files themselves.
  const std::string& beside() const noexcept { return beside_; }

 private:
  std::filesystem::path path_;   // as errors call it
  std::filesystem::path place_;  // where it will be
  std::string beside_;
  Descriptor file_;
  bool in_place_ = false;
};

}  // namespace vicinity
