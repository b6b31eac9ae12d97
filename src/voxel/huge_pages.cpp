// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/voxel/huge_pages.h"

#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace vicinity {

void* take_pages(std::size_t bytes) {
  constexpr std::size_t huge_page = std::size_t{2} << 20, line = 64;
  const bool huge = bytes >= huge_page / 2;
  const std::size_t unit = huge ? huge_page : line;
  if (bytes > static_cast<std::size_t>(-1) - unit) throw std::bad_alloc();
  const std::size_t size = (bytes + unit - 1) / unit * unit;
  void* const memory = std::aligned_alloc(unit, size == 0 ? unit : size);
  if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__)
  if (huge) madvise(memory, size, MADV_HUGEPAGE);  // advice: may be refused
#endif
  return memory;
}

void give_back_pages(void* memory) noexcept { std::free(memory); }

}  // namespace vicinity
