// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/voxel_boxes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

constexpr double cell_size = 0.1;  // [m]: an arm's reach has a few thousand, a box fills few

// The voxels of a box that are solid, one byte each.
class Solid {
 public:
  Solid(const ViscosityField& field, const VoxelBox& box)
      : lo_(box.lo),
        nx_(static_cast<std::size_t>(box.hi.i - box.lo.i)),
        ny_(static_cast<std::size_t>(box.hi.j - box.lo.j)),
        nz_(static_cast<std::size_t>(box.hi.k - box.lo.k)),
        solid_(nx_ * ny_ * nz_, false) {
    constexpr std::int32_t brick = 8;
    const auto records = field.records();
    const auto start = [](std::int32_t at) { return at / brick * brick; };
    for (std::int32_t k = start(box.lo.k); k < box.hi.k; k += brick) {
      for (std::int32_t j = start(box.lo.j); j < box.hi.j; j += brick) {
        for (std::int32_t i = start(box.lo.i); i < box.hi.i; i += brick) {
          if (field.brick_is_empty({i, j, k})) continue;
          for (std::int32_t n = 0; n < brick * brick * brick; ++n) {
            const VoxelIndex v{i + n % 8, j + n / 8 % 8, k + n / 64};
            if (!box.contains(v)) continue;
            const VoxelKind kind = records[field.code_at(v)].kind;
            solid_[at(v)] = kind == VoxelKind::boundary || kind == VoxelKind::inner;
          }
        }
      }
    }
  }

  // Takes box after box out of what is left.
  template <class Take>
  void merge(const Take& take) {
    for (std::size_t z = 0; z < nz_; ++z) {
      for (std::size_t y = 0; y < ny_; ++y) {
        for (std::size_t x = 0; x < nx_; ++x) {
          if (!solid_[(z * ny_ + y) * nx_ + x]) continue;
          std::size_t x1 = x + 1, y1 = y + 1, z1 = z + 1;
          while (x1 < nx_ && full(x1, x1 + 1, y, y1, z, z1)) ++x1;
          while (y1 < ny_ && full(x, x1, y1, y1 + 1, z, z1)) ++y1;
          while (z1 < nz_ && full(x, x1, y, y1, z1, z1 + 1)) ++z1;
          for (std::size_t c = z; c < z1; ++c) {
            for (std::size_t b = y; b < y1; ++b) {
              std::fill_n(solid_.begin() + static_cast<std::ptrdiff_t>((c * ny_ + b) * nx_ + x),
                          x1 - x, false);
            }
          }
          const auto index = [](std::int32_t lo, std::size_t n) {
            return lo + static_cast<std::int32_t>(n);
          };
          take(VoxelBox{{index(lo_.i, x), index(lo_.j, y), index(lo_.k, z)},
                        {index(lo_.i, x1), index(lo_.j, y1), index(lo_.k, z1)}});
        }
      }
    }
  }

 private:
  std::size_t at(const VoxelIndex& v) const {
    return (static_cast<std::size_t>(v.k - lo_.k) * ny_ + static_cast<std::size_t>(v.j - lo_.j)) *
               nx_ +
           static_cast<std::size_t>(v.i - lo_.i);
  }

  bool full(std::size_t x0, std::size_t x1, std::size_t y0, std::size_t y1, std::size_t z0,
            std::size_t z1) const {
    for (std::size_t z = z0; z < z1; ++z) {
      for (std::size_t y = y0; y < y1; ++y) {
        for (std::size_t x = x0; x < x1; ++x) {
          if (!solid_[(z * ny_ + y) * nx_ + x]) return false;
        }
      }
    }
    return true;
  }

  VoxelIndex lo_;
  std::size_t nx_, ny_, nz_;
  std::vector<char> solid_;
};

VoxelBox voxels_in(const Workspace& workspace, const Box& within) {
  const auto refuse = [&](const char* what) {
    throw Error({.where = "boxes of the workplace",
                 .what = what,
                 .hint = "a base of the robot that stands in the scene, or larger voxels"});
  };
  if (within.isEmpty()) refuse("there is no space to look in");
  const Vec3 lo = workspace.to_grid(within.min()), hi = workspace.to_grid(within.max());
  const auto clip = [](double at, std::int32_t most) {
    return static_cast<std::int32_t>(std::clamp(at, 0.0, static_cast<double>(most)));
  };
  const VoxelIndex& dims = workspace.dims;
  const VoxelBox box{{clip(std::floor(lo.x()), dims.i), clip(std::floor(lo.y()), dims.j),
                      clip(std::floor(lo.z()), dims.k)},
                     {clip(std::ceil(hi.x()), dims.i), clip(std::ceil(hi.y()), dims.j),
                      clip(std::ceil(hi.z()), dims.k)}};
  if (box.empty()) refuse("the arm's reach and the scene have nothing in common");
  const double count = static_cast<double>(box.hi.i - box.lo.i) * (box.hi.j - box.lo.j) *
                       static_cast<double>(box.hi.k - box.lo.k);
  if (count > 2147483648.0) refuse("too many voxels within the arm's reach");
  return box;
}

}  // namespace

VoxelBoxes::VoxelBoxes(const ViscosityField& field, const Box& within) {
  const Workspace& workspace = field.workspace();
  const auto corner = [&](const VoxelIndex& v) -> Vec3 {
    return workspace.origin + workspace.voxel_size * Vec3(v.i, v.j, v.k);
  };
  Solid solid(field, voxels_in(workspace, within));
  solid.merge([&](const VoxelBox& box) { boxes_.emplace_back(corner(box.lo), corner(box.hi)); });
  sort_into_cells();
}

std::size_t VoxelBoxes::cell_of(const Vec3& p_W, int axis) const noexcept {
  const double cell = (p_W[axis] - hull_.min()[axis]) / cell_size;
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(cells_[axis] - 1)));
}

void VoxelBoxes::sort_into_cells() {
  if (boxes_.empty()) {
    hull_ = Box(Vec3::Zero(), Vec3::Zero());
  }
  for (const Box& box : boxes_) hull_.extend(box);
  for (int axis = 0; axis < 3; ++axis) {
    cells_[axis] = static_cast<std::size_t>(hull_.sizes()[axis] / cell_size) + 1;
  }
  in_cell_.resize(cells_[0] * cells_[1] * cells_[2]);
  for (std::size_t n = 0; n < boxes_.size(); ++n) {
    for (std::size_t z = cell_of(boxes_[n].min(), 2); z <= cell_of(boxes_[n].max(), 2); ++z) {
      for (std::size_t y = cell_of(boxes_[n].min(), 1); y <= cell_of(boxes_[n].max(), 1); ++y) {
        for (std::size_t x = cell_of(boxes_[n].min(), 0); x <= cell_of(boxes_[n].max(), 0); ++x) {
          in_cell_[(z * cells_[1] + y) * cells_[0] + x].push_back(static_cast<std::uint32_t>(n));
        }
      }
    }
  }
}

void VoxelBoxes::near(const std::vector<Capsule>& capsules, double reach, std::size_t most,
                      std::vector<std::uint32_t>& found) const {
  std::vector<std::pair<double, std::uint32_t>> near;
  for (const Capsule& capsule : capsules) {
    const Vec3 margin = Vec3::Constant(capsule.radius + reach);
    const Vec3 lo = capsule.from.cwiseMin(capsule.to) - margin;
    const Vec3 hi = capsule.from.cwiseMax(capsule.to) + margin;
    if (!hull_.intersects(Box(lo, hi))) continue;
    for (std::size_t z = cell_of(lo, 2); z <= cell_of(hi, 2); ++z) {
      for (std::size_t y = cell_of(lo, 1); y <= cell_of(hi, 1); ++y) {
        for (std::size_t x = cell_of(lo, 0); x <= cell_of(hi, 0); ++x) {
          for (const std::uint32_t n : in_cell_[(z * cells_[1] + y) * cells_[0] + x]) {
            double nearest = reach + capsule.radius;
            for (int part = 0; part <= 4; ++part) {
              const Vec3 p_W = capsule.from + 0.25 * part * (capsule.to - capsule.from);
              nearest = std::min(nearest, boxes_[n].exteriorDistance(p_W));
            }
            if (nearest < reach + capsule.radius) near.emplace_back(nearest - capsule.radius, n);
          }
        }
      }
    }
  }
  // Boxes of one nearness are told apart by their number: the choice is the same everywhere.
  std::sort(near.begin(), near.end());
  found.clear();
  for (const auto& [distance, n] : near) {
    if (found.size() == most) break;
    if (std::find(found.begin(), found.end(), n) == found.end()) found.push_back(n);
  }
}

}  // namespace vicinity
