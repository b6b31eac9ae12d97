// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/field_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <string>
#include <system_error>
#include <utility>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int error) {
  throw Error({.where = path.string(),
               .what = what,
               .found = std::generic_category().message(error),
               .hint = error == ENOSPC || error == EDQUOT ? "freeing space or another disk" : ""});
}

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

/// A new file beside another, removed unless it is moved into place.
class FileBeside {
 public:
  explicit FileBeside(const std::filesystem::path& path)
      : path_(path),
        beside_(fmt::format("{}.{}-{}.part", path.string(), ::getpid(), next_number())),
        file_(::open(beside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
    if (file_.get() < 0) fail(path_, "cannot be written", errno);
  }
  FileBeside(const FileBeside&) = delete;
  FileBeside& operator=(const FileBeside&) = delete;
  ~FileBeside() {
    if (!in_place_) ::unlink(beside_.c_str());
  }

  void write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(file_.get(), bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path_, "cannot be written", errno);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  void move_into_place() {
    if (::fsync(file_.get()) != 0 || !file_.close()) fail(path_, "cannot be written", errno);
    if (::rename(beside_.c_str(), path_.c_str()) != 0) fail(path_, "cannot be replaced", errno);
    in_place_ = true;
    // The new name survives a power cut only once its folder is on disk. A file system that cannot
    // do that has still renamed the file.
    const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
    const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (opened.get() >= 0) ::fsync(opened.get());
  }

 private:
  static unsigned next_number() {
    static std::atomic<unsigned> number{0};
    return number++;
  }

  std::filesystem::path path_;
  std::string beside_;
  Descriptor file_;
  bool in_place_ = false;
};

}  // namespace

void save_field(const ViscosityField& field, const std::filesystem::path& path) {
  FileBeside file(path);
  file.write(field.image());
  file.move_into_place();
}

ViscosityField open_field(const std::filesystem::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) fail(path, "cannot be opened", errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail(path, "cannot be read", errno);
  if (!S_ISREG(status.st_mode) || status.st_size == 0) {
    throw Error({.where = path.string(),
                 .what = "not a viscosity field",
                 .found = S_ISREG(status.st_mode) ? "an empty file" : "something not a file",
                 .expected = "a file that vicinity build has written"});
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const mapping = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.get(), 0);
  if (mapping == MAP_FAILED) fail(path, "cannot be mapped into memory", errno);
  const std::shared_ptr<const std::byte[]> bytes(
      static_cast<const std::byte*>(mapping),
      [mapping, size](const std::byte*) { ::munmap(mapping, size); });
  return ViscosityField::from_image(bytes, size, path.string());
}

}  // namespace vicinity
