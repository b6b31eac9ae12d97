// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "file_beside.h"

#include <fcntl.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

unsigned next_number() {
  static std::atomic<unsigned> number{0};
  return number++;
}

}  // namespace

void fail(const std::filesystem::path& path, const std::string& what, int error) {
  throw Error({.where = path.string(),
               .what = what,
               .found = std::generic_category().message(error),
               .hint = error == ENOSPC || error == EDQUOT ? "freeing space or another disk" : ""});
}

std::filesystem::path file_to_write(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  if (path.empty()) {
    throw Error({.what = "a file to write has no name", .found = "''", .expected = "a file name"});
  }
  std::error_code error;
  const fs::file_status there = fs::status(path, error);  // of what links lead to
  if (there.type() == fs::file_type::none) fail(path, "cannot be written", error.value());
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    throw Error({.where = path.string(),
                 .what = fs::is_directory(there) ? "is a folder"
                                                 : "is a device or a pipe, and not replaced",
                 .expected = "the name of a new file, or of one to replace"});
  }
  fs::path place = path;
  while (fs::is_symlink(fs::symlink_status(place, error))) {
    const fs::path target = fs::read_symlink(place, error);
    if (error) fail(path, "cannot be written", error.value());
    place = place.parent_path() / target;
  }
  // In /proc, links lead to files that have lost their name.
  if (fs::exists(there) && !fs::exists(place, error)) fail(path, "cannot be written", ENOENT);
  return place;
}

FileBeside::FileBeside(const std::filesystem::path& path)
    : path_(path),
      place_(file_to_write(path)),
      beside_(place_.string() + '.' + std::to_string(::getpid()) + '-' +
              std::to_string(next_number()) + ".part"),
      file_(::open(beside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
  if (file_.get() < 0) fail(path_, "cannot be written", errno);
}

FileBeside::~FileBeside() {
  if (!in_place_) ::unlink(beside_.c_str());
}

void FileBeside::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, "cannot be written", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void FileBeside::move_into_place() {
  if (::fsync(file_.get()) != 0 || !file_.close()) fail(path_, "cannot be written", errno);
  if (::rename(beside_.c_str(), place_.c_str()) != 0) fail(path_, "cannot be replaced", errno);
  in_place_ = true;
  // The new name survives a power cut only once its folder is on disk. A file system that cannot
  // do that has still renamed the file.
  const std::filesystem::path folder = place_.has_parent_path() ? place_.parent_path() : ".";
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.get() >= 0) ::fsync(opened.get());
}

}  // namespace vicinity
