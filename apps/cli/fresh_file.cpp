// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "fresh_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "vicinity/geometry/error.h"

namespace vicinity::cli {

FreshFile::FreshFile(std::filesystem::path path) : path_(std::move(path)), beside_(path_) {
  beside_ += ".part" + std::to_string(getpid());
  const int descriptor = open(beside_.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0666);
  file_ = descriptor < 0 ? nullptr : fdopen(descriptor, "wb");
  if (file_ == nullptr) fail("cannot be opened for writing");
}

FreshFile::~FreshFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  unlink(beside_.c_str());
}

void FreshFile::write(const void* data, std::size_t bytes) {
  if (std::fwrite(data, 1, bytes, file_) != bytes) fail("cannot be written");
}

void FreshFile::commit() {
  if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0) fail("cannot be written");
  if (std::rename(beside_.c_str(), path_.c_str()) != 0) fail("cannot be renamed into place");
  std::fclose(std::exchange(file_, nullptr));
}

void FreshFile::fail(const char* doing) const {
  throw Error({.where = path_.string(),
               .what = doing,
               .found = std::strerror(errno),
               .hint = "another folder, or free some space"});
}

}  // namespace vicinity::cli
