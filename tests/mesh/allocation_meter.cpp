// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "allocation_meter.h"

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <new>

namespace {

struct Counts {
  bool on = false;
  std::ptrdiff_t held = 0, peak = 0;
  std::size_t largest = 0;
};
thread_local Counts counts;

void* counted(void* memory, std::size_t size) {
  if (memory == nullptr) throw std::bad_alloc();
  if (counts.on) {
    counts.largest = std::max(counts.largest, size);
    counts.held += static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
    counts.peak = std::max(counts.peak, counts.held);
  }
  return memory;
}

void release(void* memory) noexcept {
  if (counts.on) counts.held -= static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(std::malloc(std::max<std::size_t>(size, 1)), size);
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new(std::size_t size, std::align_val_t align) {
  const auto alignment = static_cast<std::size_t>(align);
  return counted(std::aligned_alloc(alignment, (size + alignment) / alignment * alignment), size);
}
void* operator new[](std::size_t size, std::align_val_t align) { return operator new(size, align); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace vicinity {

AllocationMeter::AllocationMeter() { counts = {.on = true}; }
AllocationMeter::~AllocationMeter() { counts.on = false; }
std::size_t AllocationMeter::largest() const { return counts.largest; }
std::size_t AllocationMeter::peak() const { return static_cast<std::size_t>(counts.peak); }

}  // namespace vicinity
