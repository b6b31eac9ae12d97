// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "file_beside.h"

#include <fcntl.h>
#include <fmt/format.h>

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

FileBeside::FileBeside(const std::filesystem::path& path)
    : path_(path),
      beside_(fmt::format("{}.{}-{}.part", path.string(), ::getpid(), next_number())),
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
  if (::rename(beside_.c_str(), path_.c_str()) != 0) fail(path_, "cannot be replaced", errno);
  in_place_ = true;
  // The new name survives a power cut only once its folder is on disk. A file system that cannot
  // do that has still renamed the file.
  const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.get() >= 0) ::fsync(opened.get());
}

}  // namespace vicinity
