// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The viscosity field: what the build half leaves behind and the tick reads.
///
///   root      one entry per region of 64 x 64 x 64 voxels
///     |       uniform: the code itself                          load 1
///   region    one entry per brick of 8 x 8 x 8 voxels
///     |       uniform: the code itself                          load 2
///   brick     512 short codes of 1, 2, 4, 8 or 16 bits          load 3
///     |       and the brick's own table of codes                load 4
///   code      kind, object, rank, viscosity                     load 5
///
/// Equal bricks and equal regions are stored once. A lookup is five loads at most, wherever it
/// lands.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/layers/shaping_element.h"
#include "vicinity/viscosity/coding.h"
#include "vicinity/viscosity/sparse_codes.h"
#include "vicinity/voxel/voxel.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

/// What one code stands for.
struct VoxelRecord {
  VoxelKind kind = VoxelKind::empty;
  std::uint8_t rank = 0;     ///< 1..q for a neighbour, else 0
  std::uint16_t object = 0;  ///< index into objects(); no meaning where empty
};

/// One object as the field knows it.
struct FieldObject {
  std::string name;
  LayerShape layers = LayerShape::sphere;
  int m = 4, q = 6;
  Coding coding;
  double bound_mm = 0;  ///< how much nearer than its rank says a point of a voxel can be [mm]
  bool closed = true;   ///< whether its mesh was closed
  std::uint64_t triangles = 0;
  std::uint64_t boundary = 0, inner = 0;  ///< voxels in its own array, other objects absent
  std::vector<std::uint64_t> ranks;       ///< voxels of rank 1..q in its own array
};

/// Voxels of a finished field by kind; overlaps count once, for the object that won.
struct VoxelCounts {
  std::uint64_t boundary = 0, inner = 0, neighbour = 0;
};

/// What a point of space holds.
struct FieldSample {
  VoxelRecord record;      ///< of the voxel that holds the point
  double viscosity = 0;    ///< mu [N·s/m³]; interpolated between voxels where distance is kept
  double distance_m = -1;  ///< at least this far from the surface [m]; below zero: not kept
};

/// Sparse, read-only and shared: copies are cheap and refer to the same memory, which is a file's
/// mapping or the build's own. All lookups are noexcept, allocate nothing, and may be made from
/// many threads at once. A default-constructed field holds nothing: assign one before asking it.
class ViscosityField {
 public:
  const Workspace& workspace() const noexcept;
  const std::vector<FieldObject>& objects() const noexcept;
  const VoxelCounts& voxel_counts() const noexcept;
  /// Records by code; records()[0] is empty space.
  std::span<const VoxelRecord> records() const noexcept;
  /// Viscosity by code [N·s/m³].
  std::span<const double> viscosities() const noexcept;
  /// Whether any object keeps distances.
  bool keeps_distance() const noexcept;

  /// Code of a voxel; 0 outside the workspace.
  VoxelCode code_at(const VoxelIndex& v) const noexcept { return codes_.code_at(v); }
  /// The codes of many voxels at once, the same as one by one: faster where they lie far apart.
  /// @param codes  where they go, shape (voxels.size(),)
  void codes_at(std::span<const VoxelIndex> voxels, std::span<VoxelCode> codes) const noexcept {
    codes_.codes_at(voxels, codes.data());
  }
  /// Whether the 8 x 8 x 8 voxels around v that are stored as one brick are all empty; true outside
  /// the workspace. Two loads; a mixed brick counts as not empty.
  bool brick_is_empty(const VoxelIndex& v) const noexcept;
  /// Whether any of those voxels may have a code that is wanted: false where none has; true where
  /// one has, and seldom elsewhere. Outside the workspace false.
  /// @param wanted  by code, shape (records().size(),)
  bool brick_may_hold(const VoxelIndex& v, std::span<const bool> wanted) const noexcept {
    return codes_.holds(v) && codes_.brick_may_hold(v, wanted);
  }
  /// Stored distance of a voxel's centre from the nearest surface of the object that the voxel
  /// belongs to, in voxels, rounded down; below zero where none is kept.
  double distance_vox_at(const VoxelIndex& v) const noexcept;
  /// What is at p_W [m]. Outside the workspace and for a position that is not finite: empty.
  ///
  /// Objects with ranks are looked up as they are, stepped, and keep no distance. Around objects
  /// in `distance` mode viscosity and distance are interpolated between the eight nearest voxel
  /// centres, so that viscosity has no step outside the skin and fades to zero beyond the last
  /// rank; distance_m is then never more than the true distance to the object felt there, and zero
  /// in its boundary and inner voxels.
  FieldSample at(const Vec3& p_W) const noexcept;

  /// The same voxels with other codings, one per object, in the order of objects(). Shares the
  /// image, which goes on to hold the codings of the build; so does a file saved from it. Where
  /// objects overlap, each voxel stays with the object that won in the build.
  /// Errors: throws Error where a coding has fewer than q values or one that is not a viscosity.
  ViscosityField with_codings(const std::vector<Coding>& codings) const;

  /// The bytes of the field, exactly as they stand in its file.
  std::span<const std::byte> image() const noexcept;
  /// A field over bytes that were read or built. Verifies checksums and that no reference leaves
  /// its section, so that no lookup can leave the image. `where` names the source in errors;
  /// `bytes` is aligned as memory from new or mmap is.
  /// Errors: throws Error for anything but a whole, undamaged field of this version.
  static ViscosityField from_image(std::shared_ptr<const std::byte[]> bytes, std::size_t size,
                                   const std::string& where);

 private:
  struct Index;  // where the sections start; see field.cpp
  std::shared_ptr<const Index> index_;
  SparseCodes codes_;  // into the image that index_ keeps
};

}  // namespace vicinity
