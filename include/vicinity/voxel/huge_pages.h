// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Memory in huge pages, where there is much of it.
///
/// The first touch of a page costs more than all that is then done with 4 KiB: up to 10 us on a
/// virtual machine. A huge page (2 MiB on x86-64) costs little more than one of them.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace vicinity {

/// Uninitialised memory, aligned to 64 bytes at least. From 1 MiB on it starts at a huge page, and
/// the system is asked for such; where it has none, the memory is ordinary.
/// Errors: throws std::bad_alloc.
void* take_pages(std::size_t bytes);
void give_back_pages(void* memory) noexcept;

/// Lets a standard container live there.
template <class T>
struct HugePages {
  using value_type = T;
  HugePages() = default;
  template <class U>
  HugePages(const HugePages<U>&) noexcept {}

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(take_pages(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) noexcept { give_back_pages(memory); }
  friend bool operator==(const HugePages&, const HugePages&) noexcept { return true; }
};

template <class T>
using HugeVector = std::vector<T, HugePages<T>>;

}  // namespace vicinity
