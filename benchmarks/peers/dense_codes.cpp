// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "peers/dense_codes.h"

#include <sys/mman.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

namespace vicinity::peers {
namespace {

std::shared_ptr<std::uint8_t[]> take(std::size_t size, DenseCodes::Pages pages) {
  constexpr std::size_t huge_page = std::size_t{2} << 20;
  size = (size + huge_page - 1) / huge_page * huge_page;
  void* const memory = std::aligned_alloc(huge_page, size);
  if (memory == nullptr) throw std::bad_alloc();
  madvise(memory, size, pages == DenseCodes::Pages::huge ? MADV_HUGEPAGE : MADV_NOHUGEPAGE);
  return {static_cast<std::uint8_t*>(memory), [](std::uint8_t* p) { std::free(p); }};
}

}  // namespace

DenseCodes::DenseCodes(const ViscosityField& field, Pages pages) {
  const VoxelIndex dims = field.workspace().dims;
  dim_i_ = static_cast<std::size_t>(dims.i);
  dim_j_ = static_cast<std::size_t>(dims.j);
  size_ = dim_i_ * dim_j_ * static_cast<std::size_t>(dims.k);
  bytes_ = take(size_, pages);
  tbb::parallel_for(0, dims.k, [&](int k) {
    for (VoxelIndex v{0, 0, k}; v.j < dims.j; ++v.j) {
      for (v.i = 0; v.i < dims.i; ++v.i) {
        bytes_[place(v)] = static_cast<std::uint8_t>(field.code_at(v));
      }
    }
  });
}

DenseCodes::DenseCodes(const DenseCodes& other, Pages pages)
    : dim_i_(other.dim_i_), dim_j_(other.dim_j_), size_(other.size_), bytes_(take(size_, pages)) {
  std::memcpy(bytes_.get(), other.bytes_.get(), size_);
}

void DenseCodes::at(std::span<const VoxelIndex> voxels, std::uint8_t* codes) const noexcept {
  constexpr std::size_t group = 64;
  for (std::size_t first = 0; first < voxels.size(); first += group) {
    const std::size_t end = std::min(first + group, voxels.size());
    for (std::size_t n = first; n < end; ++n) __builtin_prefetch(&bytes_[place(voxels[n])]);
    for (std::size_t n = first; n < end; ++n) codes[n] = at(voxels[n]);
  }
}

}  // namespace vicinity::peers
