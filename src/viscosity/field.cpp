// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "verified_image.h"
#include "vicinity/geometry/error.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/viscosity/field_image.h"
#include "vicinity/viscosity/packed_brick.h"

namespace vicinity {

static_assert(std::endian::native == std::endian::little,
              "A field is read where it lies, and its numbers are little-endian.");
static_assert(sizeof(VoxelRecord) == 4 && std::is_trivially_copyable_v<VoxelRecord>);

namespace {

std::vector<double> viscosities_of(const std::vector<FieldObject>& objects,
                                   const std::vector<VoxelRecord>& records) {
  std::vector<double> viscosities;
  viscosities.reserve(records.size());
  for (const VoxelRecord& record : records) {
    const Coding* coding =
        record.kind == VoxelKind::empty ? nullptr : &objects[record.object].coding;
    viscosities.push_back(coding == nullptr                     ? 0
                          : record.kind == VoxelKind::neighbour ? coding->of_rank(record.rank)
                                                                : coding->skin);
  }
  return viscosities;
}

}  // namespace

struct ViscosityField::Index : VerifiedImage {
  std::shared_ptr<const std::byte[]> bytes;
  std::size_t size = 0;
  std::vector<double> viscosities;   // by code
  std::vector<char> keeps_distance;  // by code

  SparseCodes sparse_codes;      // what codes and distances point to
  SparseCodes sparse_distances;  // of these, only the references

  std::uint16_t distance_steps(const VoxelIndex& v) const noexcept {
    const std::uint32_t at = sparse_distances.reference(v);
    if (FieldReference::is_uniform(at)) return static_cast<std::uint16_t>(at);
    return load_16(distances.bricks + (std::size_t{at} * 512 + voxel_in_brick(v)) * 2);
  }

  void interpolate(const Vec3& p_grid, FieldSample& sample) const noexcept;
};

/// Viscosity and distance in the free space around objects that keep distances: trilinear between
/// the eight voxel centres c_i around p, with weights w_i.
///
/// The distance is never optimistic. With d the true distance from the surface, in voxels, the
/// stored D_i <= d(c_i) <= d(p) + |p - c_i|, for d is 1-Lipschitz. And sum w_i |p - c_i| is at most
/// the root of sum w_i |p - c_i|^2 = sum over axes of t(1-t) <= 3/4, which is half the diagonal of
/// a voxel; so sum w_i D_i - half diagonal <= d(p). A centre beyond the workspace is replaced by
/// the nearest one within, for which the same sum holds. A centre beyond the last rank is at least
/// q*m + half diagonal away, or it would have a rank.
///
/// Each centre contributes its own viscosity, f(D_i - half diagonal): eq. (3) with the same margin.
/// That is not less than f(d(p)) wherever f is convex around p; where a coding drops faster beyond
/// a rank than before it, the corner is rounded by less than a voxel.
void ViscosityField::Index::interpolate(const Vec3& p_grid, FieldSample& sample) const noexcept {
  const Vec3 shifted = p_grid - Vec3::Constant(0.5);
  const Vec3 base = shifted.array().floor();
  const Vec3 t = shifted - base;
  const auto clamped = [](double x, std::int32_t dim) {
    return std::clamp(static_cast<std::int32_t>(x), 0, dim - 1);
  };
  const VoxelIndex lo = {clamped(base.x(), workspace.dims.i), clamped(base.y(), workspace.dims.j),
                         clamped(base.z(), workspace.dims.k)};
  const VoxelIndex hi = {clamped(base.x() + 1, workspace.dims.i),
                         clamped(base.y() + 1, workspace.dims.j),
                         clamped(base.z() + 1, workspace.dims.k)};

  const bool one_brick = ((lo.i ^ hi.i) >> 3 | (lo.j ^ hi.j) >> 3 | (lo.k ^ hi.k) >> 3) == 0;
  const std::uint32_t shared = sparse_codes.reference(lo);
  if (one_brick && shared == FieldReference::uniform(0)) return;

  struct Corner {
    VoxelIndex v;
    VoxelCode code;
    double weight;
  };
  std::array<Corner, 8> corners;
  bool any_distance = false;
  double band_vox = 256;  // of the thinnest layers around p; 256 is beyond every layer
  for (std::size_t c = 0; c < 8; ++c) {
    const VoxelIndex v = {c & 1 ? hi.i : lo.i, c & 2 ? hi.j : lo.j, c & 4 ? hi.k : lo.k};
    const VoxelCode code_of_v =
        sparse_codes.code(one_brick ? shared : sparse_codes.reference(v), v);
    corners[c] = {
        v, code_of_v,
        (c & 1 ? t.x() : 1 - t.x()) * (c & 2 ? t.y() : 1 - t.y()) * (c & 4 ? t.z() : 1 - t.z())};
    if (keeps_distance[code_of_v]) {
      const FieldObject& object = objects[records[code_of_v].object];
      any_distance = true;
      band_vox = std::min<double>(band_vox, object.m * object.q);
    }
  }
  if (!any_distance) return;

  double viscosity = 0;
  double distance_vox = 0;
  for (const Corner& corner : corners) {
    const VoxelRecord& record = records[corner.code];
    if (record.kind == VoxelKind::empty) {
      distance_vox += corner.weight * (band_vox + half_diagonal_vox);
    } else if (!keeps_distance[corner.code]) {
      // Ranked layers hide how far the other object is: count it as near.
      viscosity += corner.weight * viscosities[corner.code];
    } else {
      const FieldObject& object = objects[record.object];
      const std::uint16_t steps = distance_steps(corner.v);
      const double D =
          record.kind == VoxelKind::inner || steps == no_distance ? 0 : steps * distance_step_vox;
      viscosity +=
          corner.weight * object.coding.at_distance(D - half_diagonal_vox, object.m, object.q);
      distance_vox += corner.weight * D;
    }
  }
  sample.viscosity = viscosity;
  sample.distance_m = std::max(0.0, distance_vox - half_diagonal_vox) * workspace.voxel_size;
}

const Workspace& ViscosityField::workspace() const noexcept { return index_->workspace; }
const std::vector<FieldObject>& ViscosityField::objects() const noexcept { return index_->objects; }
const VoxelCounts& ViscosityField::voxel_counts() const noexcept { return index_->counts; }
std::span<const VoxelRecord> ViscosityField::records() const noexcept { return index_->records; }
std::span<const double> ViscosityField::viscosities() const noexcept { return index_->viscosities; }
bool ViscosityField::keeps_distance() const noexcept { return index_->distances.root != nullptr; }
std::span<const std::byte> ViscosityField::image() const noexcept {
  return {index_->bytes.get(), index_->size};
}

bool ViscosityField::brick_is_empty(const VoxelIndex& v) const noexcept {
  return !codes_.holds(v) || codes_.reference(v) == FieldReference::uniform(0);
}

double ViscosityField::distance_vox_at(const VoxelIndex& v) const noexcept {
  const Index& field = *index_;
  if (field.distances.root == nullptr || !codes_.holds(v)) return -1;
  const std::uint16_t steps = field.distance_steps(v);
  return steps == no_distance ? -1 : steps * distance_step_vox;
}

FieldSample ViscosityField::at(const Vec3& p_W) const noexcept {
  const Index& field = *index_;
  FieldSample sample;
  const Vec3 p_grid = field.workspace.to_grid(p_W);
  const VoxelIndex& dims = field.workspace.dims;
  // Written so that NaN is outside.
  const bool inside = p_grid.x() >= 0 && p_grid.x() < dims.i && p_grid.y() >= 0 &&
                      p_grid.y() < dims.j && p_grid.z() >= 0 && p_grid.z() < dims.k;
  if (!inside) return sample;

  const VoxelIndex v = {static_cast<std::int32_t>(p_grid.x()),
                        static_cast<std::int32_t>(p_grid.y()),
                        static_cast<std::int32_t>(p_grid.z())};
  const VoxelCode code = codes_.code(codes_.reference(v), v);
  sample.record = field.records[code];
  sample.viscosity = field.viscosities[code];
  if (field.distances.root == nullptr) return sample;

  const bool is_empty = sample.record.kind == VoxelKind::empty;
  if (!is_empty && !field.keeps_distance[code]) return sample;
  if (is_empty || sample.record.kind == VoxelKind::neighbour) {
    field.interpolate(p_grid, sample);
  } else {
    sample.distance_m = 0;
  }
  return sample;
}

ViscosityField ViscosityField::with_codings(const std::vector<Coding>& codings) const {
  if (codings.size() != index_->objects.size()) {
    throw Error({.where = "codings",
                 .what = "not one for each object",
                 .found = fmt::format("{}", codings.size()),
                 .expected = fmt::format("{}", index_->objects.size())});
  }
  auto index = std::make_shared<Index>(*index_);
  for (std::size_t o = 0; o < codings.size(); ++o) {
    FieldObject& object = index->objects[o];
    check_coding(codings[o], object.q, fmt::format("object '{}'", object.name));
    object.coding = codings[o];
  }
  index->viscosities = viscosities_of(index->objects, index->records);
  ViscosityField field = *this;
  field.index_ = std::move(index);
  return field;
}

ViscosityField ViscosityField::from_image(std::shared_ptr<const std::byte[]> bytes,
                                          std::size_t size, const std::string& where) {
  auto index = std::make_shared<Index>();
  static_cast<VerifiedImage&>(*index) = verify_image({bytes.get(), size}, where);
  index->bytes = std::move(bytes);
  index->size = size;
  index->viscosities = viscosities_of(index->objects, index->records);
  for (const VoxelRecord& record : index->records) {
    index->keeps_distance.push_back(record.kind != VoxelKind::empty &&
                                    index->objects[record.object].layers == LayerShape::distance);
  }
  const auto sparse = [&](const VerifiedImage::Layer& layer) {
    return SparseCodes(index->workspace.dims, layer.root, layer.regions, layer.bricks);
  };
  index->sparse_codes = sparse(index->codes);
  index->sparse_distances = sparse(index->distances);
  ViscosityField field;
  field.codes_ = index->sparse_codes;
  field.index_ = std::move(index);
  return field;
}

}  // namespace vicinity
