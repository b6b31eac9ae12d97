// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "failing_memory.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

struct Plan {
  std::atomic<bool> on = false;
  std::atomic<std::size_t> requests = 0;
  std::size_t first_refused = 0, last_refused = 0;
};
Plan plan;

bool is_refused(std::size_t size) {
  if (!plan.on || size < vicinity::test::FailingMemory::small_request) return false;
  const std::size_t request = plan.requests++;
  return request >= plan.first_refused && request <= plan.last_refused;
}

void* checked(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  if (is_refused(size)) throw std::bad_alloc();
  return checked(std::malloc(std::max<std::size_t>(size, 1)));
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return is_refused(size) ? nullptr : std::malloc(std::max<std::size_t>(size, 1));
}
void* operator new[](std::size_t size, const std::nothrow_t& none) noexcept {
  return operator new(size, none);
}
void* operator new(std::size_t size, std::align_val_t align) {
  if (is_refused(size)) throw std::bad_alloc();
  const auto alignment = static_cast<std::size_t>(align);
  return checked(std::aligned_alloc(alignment, (size + alignment) / alignment * alignment));
}
void* operator new[](std::size_t size, std::align_val_t align) { return operator new(size, align); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Pages are taken by this one; glibc's own goes by another name too.
extern "C" {
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return is_refused(size) ? nullptr : __libc_memalign(alignment, size);
}
}
#endif

namespace vicinity::test {

FailingMemory::FailingMemory(std::size_t request, Refuses refuses) {
  plan.first_refused = request;
  plan.last_refused = refuses == Refuses::one ? request : static_cast<std::size_t>(-1);
  plan.requests = 0;
  plan.on = true;
}
FailingMemory::~FailingMemory() { plan.on = false; }
std::size_t FailingMemory::requests() const { return plan.requests; }

}  // namespace vicinity::test
