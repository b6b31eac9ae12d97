// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Off the surface the winding number of an open mesh is smooth: it satisfies Laplace's equation,
// and only open edges make it vary. In a box that no open edge comes near, the voxels of one
// connected part so differ little, and none lies outside what its surroundings span. A few voxels
// of the part are asked; where they agree by more than they differ among themselves, the part is
// decided as a whole. Otherwise its box is cut, down to single voxels. Only the surroundings of
// open edges, and of the surface where the winding number is one half, are looked at closely.

#include "open_inner.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "free_regions.h"
#include "geometry/whole_loops.h"
#include "moment_tree.h"
#include "solid_angle.h"

namespace vicinity {
namespace {

// From how many of its radii a node acts as a whole, and how far off the winding number is then at
// most in practice. Where the first is not enough the second is asked.
struct Accuracy {
  double radii, error;
};
constexpr Accuracy rough{2, 0.02}, fine{6, 0.002};

// In the plane of a missing lid the winding number is one half but for rounding, which must not
// decide.
constexpr double half = 0.5 - 1e-9;

// An open edge is far from a box where it stays out of a ball this much larger than the box. At
// 1 an edge could touch a corner, where the winding number is anything.
constexpr double clear_radii = 1.25;

// So few voxels are asked one by one: asking for all of them would take as many samples.
constexpr int few = 12;

// Long open edges are cut, so that nodes stay small.
constexpr double edge_piece_vox = 8;

std::vector<MomentPiece> surface_pieces(const GridMesh& mesh) {
  std::vector<MomentPiece> pieces(mesh.triangle_count());
  for (std::uint32_t t = 0; t < pieces.size(); ++t) {
    // From the lowest corner on, so that a turned triangle gives the same piece to the last bit.
    std::array<Vec3, 3> p = mesh.corners(t);
    std::rotate(
        p.begin(),
        std::min_element(p.begin(), p.end(),
                         [](const Vec3& a, const Vec3& b) {
                           return std::array{a.x(), a.y(), a.z()} < std::array{b.x(), b.y(), b.z()};
                         }),
        p.end());
    const Vec3 centre = (p[0] + p[1] + p[2]) / 3;
    const Vec3 moment = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]);
    const double radius =
        std::sqrt(std::max({(p[0] - centre).squaredNorm(), (p[1] - centre).squaredNorm(),
                            (p[2] - centre).squaredNorm()}));
    pieces[t] = {centre, moment, radius, moment.norm(), t};
  }
  return pieces;
}

std::vector<MomentPiece> edge_pieces(const std::vector<OpenEdge>& edges) {
  std::vector<MomentPiece> pieces;
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    const Vec3 along = edges[e].to - edges[e].from;
    const auto count = std::max(1, static_cast<int>(std::ceil(along.norm() / edge_piece_vox)));
    for (int n = 0; n < count; ++n) {
      const Vec3 moment = along * edges[e].surplus / count;
      pieces.push_back({edges[e].from + (n + 0.5) / count * along, moment, along.norm() / count / 2,
                        moment.norm(), e});
    }
  }
  return pieces;
}

Vec3 centre_of(const VoxelIndex& v) { return {v.i + 0.5, v.j + 0.5, v.k + 0.5}; }

}  // namespace

class OpenWinding {
 public:
  OpenWinding(const GridMesh& mesh, const std::vector<OpenEdge>& edges)
      : mesh_(mesh), surface_(surface_pieces(mesh)), edges_(edge_pieces(edges)) {}

  // Winding number about p; nodes act as a whole from `radii` of their radii.
  double at(const Vec3& p, double radii) const {
    double far = 0;
    SolidAngleSum near;
    surface_.visit(
        [&](const MomentTree::Node& node) {
          const Vec3 r = node.centre - p;
          const double squared = r.squaredNorm();
          if (squared <= radii * radii * node.radius * node.radius) return false;
          far += node.moment.dot(r) / (squared * std::sqrt(squared));
          return true;
        },
        [&](const MomentPiece& piece) {
          const std::array<Vec3, 3> corners = mesh_.corners(piece.source);
          near.add(corners[0] - p, corners[1] - p, corners[2] - p);
        });
    return (far + near.value()) / (4 * std::numbers::pi);
  }

  bool is_inner(const VoxelIndex& v) const {
    double size = std::abs(at(centre_of(v), rough.radii));
    if (std::abs(size - 0.5) < rough.error) size = std::abs(at(centre_of(v), fine.radii));
    return size >= half;
  }

  // Whether no open edge comes near the box.
  bool is_clear(const VoxelBox& box) const {
    const Vec3 low = centre_of(box.lo);
    const Vec3 high = centre_of({box.hi.i - 1, box.hi.j - 1, box.hi.k - 1});
    const Vec3 centre = 0.5 * (low + high);
    const double radius = clear_radii * 0.5 * (high - low).norm();
    bool clear = true;
    edges_.visit(
        [&](const MomentTree::Node& node) {
          return !clear || (node.centre - centre).norm() > radius + node.radius;
        },
        [&](const MomentPiece& piece) {
          clear &= (piece.centre - centre).norm() > radius + piece.radius;
        });
    return clear;
  }

  // Whether all of a part is inner, of which these are a few voxels; nothing where that is unsure.
  std::optional<bool> decide(std::span<const VoxelIndex> samples) const {
    for (const Accuracy& accuracy : {rough, fine}) {
      double low = std::numeric_limits<double>::infinity(), high = -low, margin = low;
      for (const VoxelIndex& v : samples) {
        const double w = at(centre_of(v), accuracy.radii);
        low = std::min(low, w);
        high = std::max(high, w);
        margin = std::min(margin, std::abs(std::abs(w) - 0.5));
        if (margin + accuracy.error <= 0.5 * (high - low)) return std::nullopt;
      }
      if (margin > 0.5 * (high - low) + accuracy.error) return std::abs(low) > 0.5;
    }
    return std::nullopt;
  }

 private:
  const GridMesh& mesh_;
  MomentTree surface_, edges_;
};

namespace {

// The box cut in two along every side that is not much shorter than the longest.
std::vector<VoxelBox> quartered(const VoxelBox& box) {
  std::vector<VoxelBox> pieces{box};
  const std::array sides{&VoxelIndex::i, &VoxelIndex::j, &VoxelIndex::k};
  std::int32_t longest = 0;
  for (const auto side : sides) longest = std::max(longest, box.hi.*side - box.lo.*side);
  for (const auto side : sides) {
    if (2 * (box.hi.*side - box.lo.*side) <= longest) continue;
    const std::int32_t middle = box.lo.*side + (box.hi.*side - box.lo.*side) / 2;
    for (std::size_t n = pieces.size(); n-- > 0;) {
      pieces.push_back(pieces[n]);
      pieces[n].hi.*side = pieces.back().lo.*side = middle;
    }
  }
  return pieces;
}

// Both ends of four rows, evenly spread over the rows that have any voxel.
std::vector<VoxelIndex> samples_of(const BitBlock& voxels, const BlockIndex& b) {
  std::vector<std::int32_t> rows;
  for (std::int32_t row = 0; row < 64; ++row) {
    if (voxels.words[static_cast<std::size_t>(row)] != 0) rows.push_back(row);
  }
  std::vector<VoxelIndex> samples;
  for (std::size_t n = 0; n < 4; ++n) {
    const std::int32_t row = rows[n * (rows.size() - 1) / 3];
    const std::uint64_t word = voxels.words[static_cast<std::size_t>(row)];
    for (const int bit : {std::countr_zero(word), 63 - std::countl_zero(word)}) {
      samples.push_back({b.i * 64 + bit, b.j * 8 + (row & 7), b.k * 8 + (row >> 3)});
    }
  }
  return samples;
}

int count(const BitBlock& voxels) {
  int sum = 0;
  for (const std::uint64_t word : voxels.words) sum += std::popcount(word);
  return sum;
}

void put(BitBlock& into, const BitBlock& voxels) {
  for (std::size_t row = 0; row < 64; ++row) into.words[row] |= voxels.words[row];
}

// Voxels of a block that lie in a box.
BitBlock within(const BitBlock& voxels, const BlockIndex& b, const VoxelBox& box) {
  BitBlock kept = block_of_box(b, box);
  for (std::size_t row = 0; row < 64; ++row) kept.words[row] &= voxels.words[row];
  return kept;
}

// Puts those of `voxels`, which lie in `box` within block b, that are inner into `inner`.
void decide(const OpenWinding& winding, const BlockIndex& b, const VoxelBox& box,
            const BitBlock& voxels, BitBlock& inner) {
  if (count(voxels) <= few) {
    for (std::size_t row = 0; row < 64; ++row) {
      for (std::uint64_t bits = voxels.words[row]; bits != 0; bits &= bits - 1) {
        const VoxelIndex v{b.i * 64 + std::countr_zero(bits),
                           b.j * 8 + static_cast<std::int32_t>(row & 7),
                           b.k * 8 + static_cast<std::int32_t>(row >> 3)};
        if (winding.is_inner(v)) inner.words[row] |= bits & -bits;
      }
    }
    return;
  }
  BitBlock unsure;
  if (winding.is_clear(box)) {
    for (const BitBlock& part : connected_parts(voxels)) {
      const std::optional<bool> is_inner = winding.decide(samples_of(part, b));
      if (!is_inner) {
        put(unsure, part);
      } else if (*is_inner) {
        put(inner, part);
      }
    }
  } else {
    unsure = voxels;
  }
  for (const VoxelBox& piece : quartered(box)) {
    decide(winding, b, piece, within(unsure, b, piece), inner);
  }
}

VoxelBox box_of(const BlockIndex& b, std::int32_t blocks, const VoxelBox& bounds) {
  return {{std::max(b.i * 64, bounds.lo.i), std::max(b.j * 8, bounds.lo.j),
           std::max(b.k * 8, bounds.lo.k)},
          {std::min((b.i + blocks) * 64, bounds.hi.i), std::min(b.j * 8 + 8, bounds.hi.j),
           std::min(b.k * 8 + 8, bounds.hi.k)}};
}

std::array<VoxelIndex, 8> corners_of(const VoxelBox& box) {
  std::array<VoxelIndex, 8> corners;
  for (std::size_t c = 0; c < 8; ++c) {
    corners[c] = {c & 1 ? box.hi.i - 1 : box.lo.i, c & 2 ? box.hi.j - 1 : box.lo.j,
                  c & 4 ? box.hi.k - 1 : box.lo.k};
  }
  return corners;
}

// The same for a run of `blocks` blocks from b on without any boundary.
void decide_run(const OpenWinding& winding, const BlockIndex& b, std::int32_t blocks,
                VoxelSet& inner) {
  const VoxelBox box = box_of(b, blocks, inner.box());
  std::optional<bool> is_inner;
  if (winding.is_clear(box)) is_inner = winding.decide(corners_of(box));
  if (is_inner) {
    for (std::int32_t n = 0; *is_inner && n < blocks; ++n) {
      const BlockIndex here{b.i + n, b.j, b.k};
      inner.blocks().make(here) = block_of_box(here, inner.box());
    }
  } else if (blocks > 1) {
    decide_run(winding, b, blocks / 2, inner);
    decide_run(winding, {b.i + blocks / 2, b.j, b.k}, blocks - blocks / 2, inner);
  } else {
    BitBlock found;
    const BitBlock all = block_of_box(b, inner.box());
    for (const VoxelBox& piece : quartered(box)) {
      decide(winding, b, piece, within(all, b, piece), found);
    }
    if (count(found) != 0) inner.blocks().make(b) = found;
  }
}

}  // namespace

OpenInner::OpenInner(const GridMesh& mesh, const std::vector<OpenEdge>& edges)
    : winding_(std::make_unique<const OpenWinding>(mesh, edges)) {}

OpenInner::~OpenInner() = default;

std::optional<bool> OpenInner::throughout(const VoxelBox& box) const {
  if (!winding_->is_clear(box)) return std::nullopt;
  return winding_->decide(corners_of(box));
}

bool OpenInner::is_inner(const VoxelIndex& v) const { return winding_->is_inner(v); }

VoxelSet OpenInner::inner(const VoxelSet& boundary) const {
  const OpenWinding& winding = *winding_;
  VoxelSet inner(boundary.box());
  const BlockIndex lo = inner.blocks().lo(), size = inner.blocks().size();
  whole::parallel_for(lo.k, lo.k + size.k, [&](std::int32_t k) {
    for (std::int32_t j = lo.j; j < lo.j + size.j; ++j) {
      for (std::int32_t i = lo.i; i < lo.i + size.i; ++i) {
        const BlockIndex b{i, j, k};
        if (const BitBlock* taken = boundary.blocks().find(b)) {
          BitBlock free = block_of_box(b, inner.box());
          for (std::size_t row = 0; row < 64; ++row) free.words[row] &= ~taken->words[row];
          BitBlock found;
          decide(winding, b, box_of(b, 1, inner.box()), free, found);
          if (count(found) != 0) inner.blocks().make(b) = found;
          continue;
        }
        std::int32_t end = i + 1;
        while (end < lo.i + size.i && boundary.blocks().find({end, j, k}) == nullptr) ++end;
        decide_run(winding, b, end - i, inner);
        i = end - 1;
      }
    }
  });
  return inner;
}

}  // namespace vicinity
