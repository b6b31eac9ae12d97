// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/layer_fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "reproduce/workshop.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/layers/shaping_element.h"

namespace vicinity::report {
namespace {

constexpr std::array<VoxelIndex, 6> face_neighbours{
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

// Rank, with 0 for the body and q + 1 for empty space.
class Ranks {
 public:
  explicit Ranks(const ViscosityField& field) : field_(field), q_(field.objects().front().q) {}

  int at(const VoxelIndex& v) const {
    const VoxelRecord& record = field_.records()[field_.code_at(v)];
    return record.kind == VoxelKind::empty ? q_ + 1 : record.rank;
  }
  bool is_inner(const VoxelIndex& v) const {
    return field_.records()[field_.code_at(v)].kind == VoxelKind::inner;
  }
  int q() const { return q_; }

  // Calls visit(voxel, rank) for every voxel of the workspace that is not at its edge.
  template <class Visit>
  void for_each(Visit&& visit) const {
    const VoxelIndex& dims = field_.workspace().dims;
    for (std::int32_t k = 1; k + 1 < dims.k; ++k) {
      for (std::int32_t j = 1; j + 1 < dims.j; ++j) {
        for (std::int32_t i = 1; i + 1 < dims.i; ++i) visit(VoxelIndex{i, j, k}, at({i, j, k}));
      }
    }
  }

  // The highest rank across a face.
  int highest_beside(const VoxelIndex& v) const {
    int highest = 0;
    for (const VoxelIndex& d : face_neighbours) {
      highest = std::max(highest, at({v.i + d.i, v.j + d.j, v.k + d.k}));
    }
    return highest;
  }

 private:
  const ViscosityField& field_;
  int q_;
};

int cells_of(const FieldObject& object) {
  return ShapingElement(object.layers, object.m).cell_count();
}

std::uint64_t ranked_voxels(const FieldObject& object) {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : object.ranks) sum += count;
  return sum;
}

}  // namespace

std::vector<LayerReach> layer_reaches(const ViscosityField& field,
                                      const ViscosityField& distances) {
  const Ranks ranks(field);
  struct Sum {
    double least = INFINITY, most = 0, sum = 0, count = 0;
  };
  std::vector<Sum> sums(static_cast<std::size_t>(ranks.q()) + 1);
  ranks.for_each([&](const VoxelIndex& v, int rank) {
    if (rank < 1 || rank > ranks.q()) return;
    const double distance = distances.distance_vox_at(v);
    if (distance < 0) return;
    // It ends layer n for every n from its own rank to below that of its neighbour.
    for (int n = rank; n < ranks.highest_beside(v); ++n) {
      Sum& sum = sums[static_cast<std::size_t>(n)];
      sum.least = std::min(sum.least, distance);
      sum.most = std::max(sum.most, distance);
      sum.sum += distance;
      ++sum.count;
    }
  });
  std::vector<LayerReach> reaches;
  for (int n = 1; n <= ranks.q(); ++n) {
    const Sum& sum = sums[static_cast<std::size_t>(n)];
    if (sum.count == 0) continue;
    reaches.push_back({n, sum.least + 0.5, sum.sum / sum.count + 0.5, sum.most + 0.5});
  }
  return reaches;
}

RankFit rank_fit(const std::string& name, const ViscosityField& field,
                 const ViscosityField& distances, int m) {
  const Ranks ranks(field);
  const LayerShape shape = field.objects().front().layers;
  RankFit fit{.name = name, .is_cube = shape == LayerShape::cube, .m = m};
  const double stretch = fit.is_cube ? std::sqrt(3.0) : 1;
  std::vector<double> nearest = nearest_by_rank_vox(shape, m, ranks.q());
  nearest.insert(nearest.begin(), 0);  // rank 0 is the boundary
  double sum = 0;
  ranks.for_each([&](const VoxelIndex& v, int rank) {
    if (rank < 1 || rank > ranks.q()) return;
    const double distance = distances.distance_vox_at(v);
    ++fit.ranked;
    if (distance < 0) {
      ++fit.too_far;
      return;
    }
    sum += distance - (rank - 0.5) * m;
    fit.too_near += distance < nearest[static_cast<std::size_t>(rank)] ? 1 : 0;
    fit.too_far += distance > rank * m * stretch + half_diagonal_vox ? 1 : 0;
  });
  if (fit.ranked > 0) fit.off_middle = sum / static_cast<double>(fit.ranked);
  return fit;
}

Check ranks_follow_distance(const std::vector<RankFit>& fits) {
  Check check{"each rank stands for its layer of true distance", "", !fits.empty()};
  std::uint64_t ranked = 0, near = 0, far = 0;
  double worst = 0;
  for (const RankFit& fit : fits) {
    ranked += fit.ranked;
    near += fit.too_near;
    far += fit.too_far;
    const bool in_middle = fit.is_cube || std::abs(fit.off_middle) < 0.5 * fit.m;
    if (!fit.is_cube) worst = std::max(worst, std::abs(fit.off_middle) / fit.m);
    const bool fits_well = fit.ranked > 0 && fit.too_near == 0 && fit.too_far == 0 && in_middle;
    if (!fits_well) check.measured += fit.name + " does not fit; ";
    check.holds &= fits_well;
  }
  check.measured += fmt::format(
      "of {} ranked voxels {} lie nearer and {} farther than their rank allows", ranked, near, far);
  if (worst > 0) {
    check.measured += fmt::format(
        "; around spheres off the middle of their layer by {:.2f} layers in the mean at most",
        worst);
  }
  return check;
}

Visits visits_of_plain_loop(const ViscosityField& field) {
  const FieldObject& object = field.objects().front();
  const std::uint64_t changed = ranked_voxels(object);
  // The last rank grows nothing any more.
  const std::uint64_t sources = object.boundary + changed - object.ranks.back();
  return {sources * static_cast<std::uint64_t>(cells_of(object)), changed};
}

Visits visits_of_frontier(const ViscosityField& field) {
  const Ranks ranks(field);
  const FieldObject& object = field.objects().front();
  std::uint64_t sources = 0;
  ranks.for_each([&](const VoxelIndex& v, int rank) {
    if (rank >= ranks.q() || ranks.is_inner(v)) return;
    const bool beside_inner = std::ranges::any_of(face_neighbours, [&](const VoxelIndex& d) {
      return ranks.is_inner({v.i + d.i, v.j + d.j, v.k + d.k});
    });
    sources += beside_inner || ranks.highest_beside(v) > rank ? 1 : 0;
  });
  return {sources * static_cast<std::uint64_t>(cells_of(object)), ranked_voxels(object)};
}

std::vector<double> contour(const ViscosityField& field, double axis_x, double axis_y, int z,
                            int n) {
  constexpr double step = 0.05;
  const Ranks ranks(field);
  const VoxelIndex& dims = field.workspace().dims;
  const double farthest = std::hypot(dims.i, dims.j);
  std::vector<double> radii;
  for (int degree = 0; degree < 360; ++degree) {
    const double angle = degree * std::numbers::pi / 180;
    double reached = 0;
    for (double r = 0; r < farthest; r += step) {
      const VoxelIndex v{static_cast<std::int32_t>(std::floor(axis_x + r * std::cos(angle))),
                         static_cast<std::int32_t>(std::floor(axis_y + r * std::sin(angle))), z};
      if (ranks.at(v) <= n) reached = r;
    }
    radii.push_back(reached);
  }
  return radii;
}

std::vector<Concavity> concavities(const ViscosityField& field, double axis_x, double axis_y, int z,
                                   double radius) {
  constexpr double below_rim = 1.5;  // voxels may be off by as much
  std::vector<std::vector<double>> contours;
  for (int n = 0; n <= field.objects().front().q; ++n) {
    contours.push_back(contour(field, axis_x, axis_y, z, n));
  }
  const auto at = [](const std::vector<double>& radii, int degree) {
    return radii[static_cast<std::size_t>((degree + 360) % 360)];
  };
  const std::vector<double>& body = contours.front();
  std::vector<Concavity> found;
  for (int degree = 0; degree < 360; ++degree) {
    if (at(body, degree) >= radius - below_rim || at(body, degree - 1) < radius - below_rim)
      continue;
    Concavity concavity{.from = degree - 1, .to = degree, .dip_by_rank = {}};
    while (at(body, concavity.to) < radius - below_rim) ++concavity.to;
    const double width = (concavity.to - concavity.from) * std::numbers::pi / 180;
    concavity.mouth = 2 * radius * std::sin(width / 2);
    for (const std::vector<double>& radii : contours) {
      double lowest = INFINITY;
      for (int d = concavity.from; d <= concavity.to; ++d) lowest = std::min(lowest, at(radii, d));
      const double lips = std::min(at(radii, concavity.from), at(radii, concavity.to));
      concavity.dip_by_rank.push_back(lips - lowest);
    }
    concavity.depth = concavity.dip_by_rank.front();
    found.push_back(std::move(concavity));
  }
  std::ranges::sort(found, {}, &Concavity::mouth);
  return found;
}

}  // namespace vicinity::report
