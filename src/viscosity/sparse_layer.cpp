// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "sparse_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "vicinity/geometry/error.h"

namespace vicinity {

std::uint32_t short_hash(std::span<const std::byte> bytes) noexcept {
  return static_cast<std::uint32_t>(checksum_of(bytes));
}

std::uint32_t SharedBytes::put(std::span<const std::byte> string, std::uint32_t width,
                               std::uint32_t hash) {
  if (count_ * 2 >= slots_.size()) rehash(slots_.size() * 2);
  std::size_t at = hash & (slots_.size() - 1);
  for (; slots_[at].taken; at = (at + 1) & (slots_.size() - 1)) {
    if (slots_[at].hash == hash && equal(slots_[at].reference, width, string)) {
      return slots_[at].reference;
    }
  }
  const std::size_t number = bytes_.size() / unit_;
  if (number > FieldReference::number_mask) {
    throw Error({.where = "field",
                 .what = "too large for its file format",
                 .expected = fmt::format("at most {} MiB of distinct voxels",
                                         (FieldReference::number_mask + 1ull) * unit_ >> 20),
                 .hint = "larger voxels, fewer ranks or smaller bounds"});
  }
  bytes_.insert(bytes_.end(), string.begin(), string.end());
  slots_[at] = {hash, true,
                width << FieldReference::width_shift | static_cast<std::uint32_t>(number)};
  ++count_;
  return slots_[at].reference;
}

bool SharedBytes::equal(std::uint32_t reference, std::uint32_t width,
                        std::span<const std::byte> string) const noexcept {
  const std::size_t at = (reference & FieldReference::number_mask) * unit_;
  // A shorter string at the end of the pool cannot be equal; one further in that is equal over the
  // whole length is the same brick, for its packed codes tell how long it is.
  return reference >> FieldReference::width_shift == width && string.size() <= bytes_.size() - at &&
         std::memcmp(bytes_.data() + at, string.data(), string.size()) == 0;
}

void SharedBytes::reserve(std::size_t bytes, std::size_t strings) {
  bytes_.reserve(bytes);
  if (strings * 2 > slots_.size()) rehash(std::bit_ceil(strings * 2));
}

void SharedBytes::rehash(std::size_t slots) {
  HugeVector<Slot> old(slots);
  old.swap(slots_);
  for (const Slot& slot : old) {
    if (!slot.taken) continue;
    std::size_t at = slot.hash & (slots_.size() - 1);
    while (slots_[at].taken) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = slot;
  }
}

SparseLayer::SparseLayer(std::size_t cells, std::size_t brick_unit, std::uint16_t nothing)
    : brick_unit_(brick_unit),
      root_(cells, FieldReference::uniform(nothing)),
      regions_(region_size),
      bricks_(brick_unit) {}

void SparseLayer::reserve(std::size_t region_bytes, std::size_t brick_bytes) {
  // A little more: what is built next is mostly what was built last. Bricks take 64 bytes at least.
  const auto and_more = [](std::size_t bytes) { return bytes + bytes / 16; };
  regions_.reserve(and_more(region_bytes), and_more(region_bytes) / region_size);
  bricks_.reserve(and_more(brick_bytes), and_more(brick_bytes) / 96);
}

std::uint32_t SparseLayer::put(const RegionDraft::Layer& draft) {
  if (draft.is_uniform()) return draft.references[0];
  const auto place_of = [&](std::size_t b) {
    return (draft.references[b] & FieldReference::number_mask) * FieldReference::brick_unit;
  };
  std::array<std::uint32_t, 512> region;
  for (std::size_t b = 0; b < 512; ++b) {
    const std::uint32_t reference = draft.references[b];
    if (FieldReference::is_uniform(reference)) {
      region[b] = reference;
      continue;
    }
    const std::size_t start = place_of(b);
    std::size_t next = b + 1;  // bricks lie in the draft one behind the other
    while (next < 512 && FieldReference::is_uniform(draft.references[next])) ++next;
    const std::size_t end = next < 512 ? place_of(next) : draft.bytes.size();
    region[b] = bricks_.put(std::span(draft.bytes).subspan(start, end - start),
                            reference >> FieldReference::width_shift, draft.hashes[b]);
  }
  return put(region);
}

std::uint32_t SparseLayer::put(std::span<const std::uint32_t, 512> region) {
  const auto bytes = std::as_bytes(region);
  return regions_.put(bytes, 0, short_hash(bytes));
}

}  // namespace vicinity
