// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "moment_tree.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace vicinity {
namespace {

constexpr std::uint32_t leaf_pieces = 8;

// Pieces that are equal in all of these act alike, so that their order does not matter.
auto key(const MomentPiece& p) {
  return std::tuple(p.centre.x(), p.centre.y(), p.centre.z(), p.moment.x(), p.moment.y(),
                    p.moment.z());
}

}  // namespace

MomentTree::MomentTree(std::vector<MomentPiece> pieces) : pieces_(std::move(pieces)) {
  if (!pieces_.empty()) build(0, static_cast<std::uint32_t>(pieces_.size()));
}

void MomentTree::build(std::uint32_t first, std::uint32_t count) {
  const std::span here = std::span(pieces_).subspan(first, count);
  Box bounds;
  for (const MomentPiece& p : here) bounds.extend(p.centre);
  const bool leaf = count <= leaf_pieces;
  int axis = 0;
  bounds.sizes().maxCoeff(&axis);
  if (leaf) {
    std::sort(here.begin(), here.end(),
              [](const MomentPiece& a, const MomentPiece& b) { return key(a) < key(b); });
  } else {
    std::nth_element(here.begin(), here.begin() + count / 2, here.end(),
                     [axis](const MomentPiece& a, const MomentPiece& b) {
                       return std::pair(a.centre[axis], key(a)) < std::pair(b.centre[axis], key(b));
                     });
  }
  const std::size_t self = nodes_.size();
  nodes_.push_back({Vec3::Zero(), Vec3::Zero(), 0, 0, first, count, 0, leaf});
  Node node = nodes_.back();
  const auto gather = [&node](const Vec3& centre, const Vec3& moment, double weight) {
    node.centre += weight * centre;
    node.moment += moment;
    node.weight += weight;
  };
  if (leaf) {
    for (const MomentPiece& p : here) gather(p.centre, p.moment, p.weight);
  } else {
    const std::size_t lower = nodes_.size();
    build(first, count / 2);
    const std::size_t upper = nodes_.size();
    build(first + count / 2, count - count / 2);
    for (const std::size_t child : {lower, upper}) {
      gather(nodes_[child].centre, nodes_[child].moment, nodes_[child].weight);
    }
  }
  node.centre = node.weight > 0 ? Vec3(node.centre / node.weight) : Vec3(bounds.center());
  // Partition leaves the pieces of a half in any order; a maximum does not mind.
  for (const MomentPiece& p : std::span(pieces_).subspan(first, count)) {
    node.radius = std::max(node.radius, (p.centre - node.centre).norm() + p.radius);
  }
  node.skip = static_cast<std::uint32_t>(nodes_.size());
  nodes_[self] = node;
}

}  // namespace vicinity
