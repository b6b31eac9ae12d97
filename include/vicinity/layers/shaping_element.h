// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The mask inside the floating analyser zone (§4.2, §5.1.1).
#pragma once

#include <cstdint>
#include <vector>

namespace vicinity {

/// How the layers around an object are shaped.
enum class LayerShape : std::uint8_t {
  cube,      ///< the whole floating analyser zone, (2m+1)^3 cells
  sphere,    ///< its cells with i^2 + j^2 + k^2 <= m^2
  distance,  ///< no mask: the exact Euclidean distance to the surface, kept with the rank
};

/// "cube", "sphere" or "distance".
const char* to_string(LayerShape shape) noexcept;

/// The shaping element of radius m as runs along x: a row at (j,k) off the centre holds the cells
/// -reach <= i <= reach.
class ShapingElement {
 public:
  struct Row {
    std::int32_t j, k, reach;
  };

  /// Errors: throws Error unless 1 <= m <= 8 and shape is `cube` or `sphere`.
  ShapingElement(LayerShape shape, int m);

  int radius() const noexcept { return m_; }
  LayerShape shape() const noexcept { return shape_; }
  /// Every row that holds a cell, in order of k, then j.
  const std::vector<Row>& rows() const noexcept { return rows_; }
  /// Whether the cell (i,j,k) off the centre is in the mask.
  bool contains(int i, int j, int k) const noexcept;
  /// Number of cells: 27, 125, ... for a cube; 7, 33, 123, 257 for a sphere of m = 1..4.
  int cell_count() const noexcept;

 private:
  LayerShape shape_;
  int m_;
  std::vector<Row> rows_;
};

/// How near to the surface a point of a voxel of each rank can be, in voxels, shape (q,): the
/// smallest gap between a voxel of rank n and a boundary voxel. Rank n says "at least (n-1)*m
/// voxels away", and that is so for `cube` and `distance`; a sphere's layers grow thinner than m
/// along some directions.
///
/// A lone boundary voxel attains it. It holds where no inner voxel has a face in common with an
/// empty one, as around every closed mesh with InnerMethod::winding. Where some do (`raster`, open
/// meshes), ranks behind them can be formed late and say more than is true.
///
/// Errors: throws Error for q outside 0..32 and, but for `distance`, for m outside 1..8.
std::vector<double> nearest_by_rank_vox(LayerShape shape, int m, int q);

/// The bound of all ranks: how much nearer to the surface than its rank says a point of a ranked
/// voxel can be, in voxels, the largest of (n-1)*m - nearest_by_rank_vox(). Errors: as that.
double rank_bound_vox(LayerShape shape, int m, int q);

}  // namespace vicinity
