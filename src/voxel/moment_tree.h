// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Tree of small pieces that act from afar through the sum of their moments.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vicinity/geometry/vec3.h"

namespace vicinity {

/// A piece of a surface (moment: its area times its normal) or of a curve (moment: its length times
/// its direction).
struct MomentPiece {
  Vec3 centre;
  Vec3 moment;
  double radius;         ///< of a ball about the centre that holds the piece
  double weight;         ///< size without direction: area or length
  std::uint32_t source;  ///< whose piece it is
};

class MomentTree {
 public:
  struct Node {
    Vec3 centre;                 // of the pieces by weight
    Vec3 moment;                 // sum
    double radius;               // of a ball about the centre that holds all pieces
    double weight;               // sum
    std::uint32_t first, count;  // pieces
    std::uint32_t skip;          // the node after this one's last descendant
    bool leaf;
  };

  /// The same tree for any order of the pieces.
  explicit MomentTree(std::vector<MomentPiece> pieces);

  /// Visits nodes from the root down: enough(node) says whether the node can act as a whole; where
  /// it cannot, its children are visited or, in a leaf, piece(MomentPiece) for each of its pieces.
  template <class Enough, class Piece>
  void visit(Enough&& enough, Piece&& piece) const {
    for (std::size_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      if (enough(node)) {
        n = node.skip;
        continue;
      }
      if (node.leaf) {
        for (const MomentPiece& p : std::span(pieces_).subspan(node.first, node.count)) piece(p);
      }
      ++n;
    }
  }

 private:
  void build(std::uint32_t first, std::uint32_t count);

  std::vector<MomentPiece> pieces_;
  std::vector<Node> nodes_;  // each before its descendants
};

}  // namespace vicinity
