// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "free_regions.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "geometry/whole_loops.h"

namespace vicinity {
namespace {

using Words = std::array<std::uint64_t, 8>;

// Spreads seeds along a row to the whole runs of `free` that they lie in.
std::uint64_t fill_row(std::uint64_t seeds, std::uint64_t free) {
  // Upwards, an addition carries through each run from its lowest seed.
  seeds |= free & (free ^ (free + seeds));
  // Downwards, by doubling steps.
  std::uint64_t through = free;
  for (int step = 1; step < 64; step *= 2) {
    seeds |= through & (seeds >> step);
    through &= through >> step;
  }
  return seeds;
}

bool any(const Words& words) {
  return std::any_of(words.begin(), words.end(), [](std::uint64_t w) { return w != 0; });
}

bool meet(const Words& a, const Words& b) {
  for (std::size_t n = 0; n < 8; ++n) {
    if ((a[n] & b[n]) != 0) return true;
  }
  return false;
}

// Words of one side of a block: `first` row and every `stride` rows after it.
Words side(const BitBlock& block, std::size_t first, std::size_t stride) {
  Words words;
  for (std::size_t n = 0; n < 8; ++n) words[n] = block.words[first + n * stride];
  return words;
}

// The voxels at one end of the rows, one bit each, in place of a side along y or z.
std::uint64_t end_of_rows(const BitBlock& block, int bit) {
  std::uint64_t bits = 0;
  for (std::size_t row = 0; row < 64; ++row) bits |= ((block.words[row] >> bit) & 1) << row;
  return bits;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t node) {
  while (parents[node] != node) node = parents[node] = parents[parents[node]];
  return node;
}

// The lower root stays, so that the result does not depend on the order of links.
void unite(std::vector<std::uint32_t>& parents, std::uint32_t a, std::uint32_t b) {
  a = root_of(parents, a);
  b = root_of(parents, b);
  parents[std::max(a, b)] = std::min(a, b);
}

}  // namespace

BitBlock block_of_box(const BlockIndex& b, const VoxelBox& box) {
  const std::int32_t i_begin = std::max(box.lo.i - b.i * 64, 0);
  const std::int32_t i_end = std::min(box.hi.i - b.i * 64, 64);
  BitBlock voxels;
  if (i_begin >= i_end) return voxels;
  const std::uint64_t columns = (~std::uint64_t{0} >> (64 - (i_end - i_begin))) << i_begin;
  for (std::int32_t k = std::max(box.lo.k, b.k * 8); k < std::min(box.hi.k, b.k * 8 + 8); ++k) {
    for (std::int32_t j = std::max(box.lo.j, b.j * 8); j < std::min(box.hi.j, b.j * 8 + 8); ++j) {
      voxels.words[BitBlock::row(j, k)] = columns;
    }
  }
  return voxels;
}

std::vector<BitBlock> connected_parts(const BitBlock& voxels) {
  std::vector<BitBlock> parts;
  BitBlock rest = voxels;
  for (std::size_t seed_row = 0; seed_row < 64; ++seed_row) {
    while (rest.words[seed_row] != 0) {
      BitBlock& part = parts.emplace_back();
      part.words[seed_row] =
          fill_row(rest.words[seed_row] & -rest.words[seed_row], rest.words[seed_row]);
      // Rows are swept to and fro until nothing more is reached.
      const auto grow = [&](std::size_t row) {
        std::uint64_t seeds = part.words[row];
        if ((row & 7) != 0) seeds |= part.words[row - 1];
        if ((row & 7) != 7) seeds |= part.words[row + 1];
        if (row >= 8) seeds |= part.words[row - 8];
        if (row < 56) seeds |= part.words[row + 8];
        seeds &= rest.words[row];
        if (seeds == part.words[row]) return false;
        part.words[row] = fill_row(seeds, rest.words[row]);
        return true;
      };
      for (bool grew = true; grew;) {
        grew = false;
        for (std::size_t row = seed_row; row < 64; ++row) grew |= grow(row);
        if (!grew) break;
        grew = false;
        for (std::size_t row = 64; row-- > seed_row;) grew |= grow(row);
      }
      for (std::size_t row = seed_row; row < 64; ++row) rest.words[row] &= ~part.words[row];
    }
  }
  return parts;
}

BitBlock FreeRegions::free_voxels(const BlockIndex& b) const {
  BitBlock free = block_of_box(b, box_);
  if (const BitBlock* taken = boundary_.blocks().find(b)) {
    for (std::size_t row = 0; row < 64; ++row) free.words[row] &= ~taken->words[row];
  }
  return free;
}

// What lies beyond the box is not known: a block that reaches there is no part of a run.
bool FreeRegions::is_free(const BlockIndex& b) const {
  return boundary_.blocks().find(b) == nullptr && b.i * 64 >= box_.lo.i && b.j * 8 >= box_.lo.j &&
         b.k * 8 >= box_.lo.k && b.i * 64 + 64 <= box_.hi.i && b.j * 8 + 8 <= box_.hi.j &&
         b.k * 8 + 8 <= box_.hi.k;
}

// Links the nodes of two neighbouring block rows. face_of_x(slab, entry, n) is the side of part n
// of a block that the other row sees.
template <class FaceOfA, class FaceOfB, class Link>
void FreeRegions::link_rows(const Slab& a, std::size_t row_a, FaceOfA&& face_of_a, const Slab& b,
                            std::size_t row_b, FaceOfB&& face_of_b, Link&& link) {
  std::size_t ea = a.rows[row_a], eb = b.rows[row_b];
  while (ea < a.rows[row_a + 1] && eb < b.rows[row_b + 1]) {
    const Entry& entry_a = a.entries[ea];
    const Entry& entry_b = b.entries[eb];
    for (std::uint32_t na = 0; na < entry_a.nodes; ++na) {
      for (std::uint32_t nb = 0; nb < entry_b.nodes; ++nb) {
        const bool a_is_run = entry_a.first_face == no_face;
        const bool b_is_run = entry_b.first_face == no_face;
        if (a_is_run   ? b_is_run || any(face_of_b(entry_b, nb))
            : b_is_run ? any(face_of_a(entry_a, na))
                       : meet(face_of_a(entry_a, na), face_of_b(entry_b, nb))) {
          link(entry_a.first_node + na, entry_b.first_node + nb);
        }
      }
    }
    if (entry_a.i_end <= entry_b.i_end) ++ea;
    if (entry_b.i_end <= entry_a.i_end) ++eb;
  }
}

// Finds the nodes of one slab and links them among themselves.
FreeRegions::Slab FreeRegions::scan(std::int32_t k) const {
  Slab slab;
  std::vector<BitBlock> parts;  // of all blocks of the slab with some boundary, in order
  for (std::int32_t j = lo_.j; j < lo_.j + size_.j; ++j) {
    slab.rows.push_back(slab.entries.size());
    for (std::int32_t i = lo_.i; i < lo_.i + size_.i; ++i) {
      const auto first_node = static_cast<std::uint32_t>(slab.voxels.size());
      const bool row_starts = slab.rows.back() == slab.entries.size();
      if (is_free({i, j, k})) {
        if (!row_starts && slab.entries.back().first_face == no_face) {
          ++slab.entries.back().i_end;
          continue;
        }
        slab.entries.push_back({i, i + 1, first_node, 1, no_face});
        slab.voxels.push_back(
            {std::max(i * 64, box_.lo.i), std::max(j * 8, box_.lo.j), std::max(k * 8, box_.lo.k)});
        continue;
      }
      const std::vector<BitBlock> found = connected_parts(free_voxels({i, j, k}));
      slab.entries.push_back({i, i + 1, first_node, static_cast<std::uint32_t>(found.size()),
                              static_cast<std::uint32_t>(parts.size())});
      for (const BitBlock& part : found) {
        const auto row = std::find_if(part.words.begin(), part.words.end(),
                                      [](std::uint64_t w) { return w != 0; }) -
                         part.words.begin();
        slab.voxels.push_back({i * 64 + std::countr_zero(part.words[static_cast<std::size_t>(row)]),
                               j * 8 + static_cast<std::int32_t>(row & 7),
                               k * 8 + static_cast<std::int32_t>(row >> 3)});
        slab.faces.push_back({side(part, 0, 1), side(part, 56, 1)});
      }
      parts.insert(parts.end(), found.begin(), found.end());
    }
  }
  slab.rows.push_back(slab.entries.size());

  slab.parents.resize(slab.voxels.size());
  std::iota(slab.parents.begin(), slab.parents.end(), std::uint32_t{0});
  const auto link = [&](std::uint32_t a, std::uint32_t b) { unite(slab.parents, a, b); };
  for (std::size_t row = 0; row + 1 < slab.rows.size(); ++row) {
    for (std::size_t e = slab.rows[row]; e + 1 < slab.rows[row + 1]; ++e) {
      const Entry& left = slab.entries[e];
      const Entry& right = slab.entries[e + 1];
      for (std::uint32_t nl = 0; nl < left.nodes; ++nl) {
        const std::uint64_t left_end = left.first_face == no_face
                                           ? ~std::uint64_t{0}
                                           : end_of_rows(parts[left.first_face + nl], 63);
        for (std::uint32_t nr = 0; nr < right.nodes; ++nr) {
          const std::uint64_t right_end = right.first_face == no_face
                                              ? ~std::uint64_t{0}
                                              : end_of_rows(parts[right.first_face + nr], 0);
          if ((left_end & right_end) != 0) link(left.first_node + nl, right.first_node + nr);
        }
      }
    }
    if (row + 2 < slab.rows.size()) {
      link_rows(
          slab, row,
          [&](const Entry& e, std::uint32_t n) { return side(parts[e.first_face + n], 7, 8); },
          slab, row + 1,
          [&](const Entry& e, std::uint32_t n) { return side(parts[e.first_face + n], 0, 8); },
          link);
    }
  }
  return slab;
}

FreeRegions::FreeRegions(const VoxelSet& boundary) : boundary_(boundary), box_(boundary.box()) {
  if (box_.empty()) return;
  lo_ = block_of(box_.lo);
  const BlockIndex last = block_of({box_.hi.i - 1, box_.hi.j - 1, box_.hi.k - 1});
  size_ = {last.i - lo_.i + 1, last.j - lo_.j + 1, last.k - lo_.k + 1};
  slabs_.resize(static_cast<std::size_t>(size_.k));
  whole::parallel_for(std::int32_t{0}, size_.k, [&](std::int32_t s) {
    slabs_[static_cast<std::size_t>(s)] = scan(lo_.k + s);
  });

  std::vector<std::uint32_t> parents;
  for (Slab& slab : slabs_) {
    slab.offset = parents.size();
    for (const std::uint32_t parent : slab.parents) {
      parents.push_back(static_cast<std::uint32_t>(slab.offset) + parent);
    }
    slab.parents = {};
  }
  for (std::size_t s = 0; s + 1 < slabs_.size(); ++s) {
    const Slab& below = slabs_[s];
    const Slab& above = slabs_[s + 1];
    for (std::size_t row = 0; row + 1 < below.rows.size(); ++row) {
      link_rows(
          below, row,
          [&](const Entry& e, std::uint32_t n) -> const Words& {
            return below.faces[e.first_face + n].top;
          },
          above, row,
          [&](const Entry& e, std::uint32_t n) -> const Words& {
            return above.faces[e.first_face + n].bottom;
          },
          [&](std::uint32_t a, std::uint32_t b) {
            unite(parents, static_cast<std::uint32_t>(below.offset) + a,
                  static_cast<std::uint32_t>(above.offset) + b);
          });
    }
  }

  // Roots come before the nodes they stand for.
  region_.resize(parents.size());
  for (Slab& slab : slabs_) {
    for (std::size_t n = 0; n < slab.voxels.size(); ++n) {
      const auto node = static_cast<std::uint32_t>(slab.offset + n);
      const std::uint32_t root = root_of(parents, node);
      if (root == node) {
        region_[node] = static_cast<std::uint32_t>(voxels_.size());
        voxels_.push_back(slab.voxels[n]);
      } else {
        region_[node] = region_[root];
      }
    }
    slab.voxels = {};
    slab.faces = {};
  }
}

}  // namespace vicinity
