// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/field_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstddef>

#include "geometry/file_beside.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
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
