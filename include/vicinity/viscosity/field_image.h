// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The bytes of a field: how they are laid out, and how a build writes them.
///
///   FieldHeader            magic, version, where each section is, checksums
///   META                   JSON: grid, objects, codings, counts
///   RECORDS                VoxelRecord per code
///   ROOT                   one reference per region of 64 x 64 x 64 voxels
///   REGIONS                512 references each, one per brick of 8 x 8 x 8 voxels
///   BRICKS                 packed codes, then the brick's own table of codes
///   DISTANCE_ROOT          the last three once more for stored distances; present only where an
///   DISTANCE_REGIONS       object keeps them. Its bricks are 512 plain 16-bit steps of
///   DISTANCE_BRICKS        distance_step_vox.
///
/// Regions, bricks in a region and voxels in a brick are in order of z, y, x: x runs fastest.
/// Sections follow each other in this order, each from the next multiple of 64 bytes, with zeros
/// between. All numbers are little-endian.
///
/// Equal bricks and equal regions are stored once and numbered by first appearance, so that the
/// same field has one image only, whoever built it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "vicinity/viscosity/field.h"

namespace vicinity {

/// A section of the image.
struct FieldSection {
  std::uint32_t kind = 0;  ///< 1: META, 2: RECORDS, ... in the order above; 0: none
  std::uint32_t zero = 0;
  std::uint64_t offset = 0;    ///< from the start of the image, a multiple of 64
  std::uint64_t size = 0;      ///< [bytes]
  std::uint64_t checksum = 0;  ///< XXH3, 64 bits
};

/// The first 320 bytes.
struct FieldHeader {
  static constexpr std::array<char, 8> expected_magic = {'V', 'I', 'C', 'I', 'N', 'I', 'T', 'Y'};
  static constexpr std::uint32_t expected_version = 1;

  std::array<char, 8> magic = expected_magic;
  std::uint32_t version = expected_version;
  std::uint32_t section_count = 0;  ///< 5, or 8 where distances are kept
  std::uint64_t image_size = 0;     ///< [bytes]
  std::uint64_t checksum = 0;       ///< XXH3 of this header with this field zero
  std::array<std::uint64_t, 4> zero{};
  std::array<FieldSection, 8> sections{};
};
static_assert(sizeof(FieldHeader) == 320);

/// Stored where a voxel keeps no distance.
inline constexpr std::uint16_t no_distance = 0xFFFF;

/// XXH3, 64 bits, as the image's checksums.
std::uint64_t checksum_of(std::span<const std::byte> bytes) noexcept;

/// The records of a field with these objects, in the order of their codes: empty, then for each
/// object its boundary, its inner and its ranks 1..q.
/// Errors: throws Error where they do not fit 16 bits.
std::vector<VoxelRecord> records_of(const std::vector<FieldObject>& objects);

class CodeMasks;  // see src/viscosity/code_masks.h

/// One region on its way into a field: empty until bricks are put in, in rising order. Threads may
/// prepare different regions at the same time.
class RegionDraft {
 public:
  /// Bricks of codes, or of distances: 512 references, and what those that are not uniform refer
  /// to.
  struct Layer {
    std::array<std::uint32_t, 512> references;  // numbers count units within `bytes`
    std::array<std::uint32_t, 512> hashes;
    std::vector<std::byte> bytes;

    /// Whether every brick is the same uniform one.
    bool is_uniform() const noexcept;
  };

  RegionDraft();

  /// Puts the codes of one brick in, once at most.
  /// @param brick  0..511
  /// @param codes  of its voxels, shape (8, 8, 8) as z, y, x
  void put_codes(std::size_t brick, std::span<const VoxelCode, 512> codes);

  /// The same for a brick given by the voxels of each of its codes.
  void put_masks(std::size_t brick, const CodeMasks& masks);

  /// The same for a brick that is one code throughout, or packed already.
  /// @param packed  packed codes and their table, as they lie in an image
  void put_uniform(std::size_t brick, VoxelCode code);
  void put_packed(std::size_t brick, unsigned width, std::span<const std::byte> packed);

  /// Puts the stored distances of one brick in, in steps, with no_distance where none is kept.
  void put_distances(std::size_t brick, std::span<const std::uint16_t, 512> steps);

  const Layer& codes() const noexcept { return codes_; }
  const Layer& distances() const noexcept { return distances_; }

 private:
  Layer codes_, distances_;
};

class SparseLayer;

/// Regions of 64 x 64 x 64 voxels that a field, or one object's own array, may have: half a GiB of
/// root.
inline constexpr double most_regions = 1 << 27;
/// How many regions a workspace has along x, y, z.
VoxelIndex regions_along(const Workspace& workspace) noexcept;
/// Errors: throws Error for a workspace that has more regions than that.
void check_region_count(const Workspace& workspace);

/// Puts regions together into an image.
class FieldWriter {
 public:
  /// Errors: throws Error for more codes than 16 bits hold, or more regions than a root may have.
  FieldWriter(const Workspace& workspace, std::vector<FieldObject> objects);
  ~FieldWriter();

  /// How many regions there are along x, y, z.
  const VoxelIndex& region_dims() const noexcept { return region_dims_; }

  /// Appends the next region; all regions come in order, x fastest.
  /// Errors: throws Error where the field outgrows 2 GiB of bricks.
  void append(const RegionDraft& region);

  /// The sparse layers themselves, for who puts regions in faster than one by one: their cells are
  /// the regions of the root. No distances where no object keeps any.
  SparseLayer& codes() noexcept { return *codes_; }
  SparseLayer* distances() noexcept { return distances_.get(); }

  /// The field of everything appended. Call it last and once: the regions are given up.
  /// @param counts  voxels of the field by kind
  ViscosityField finish(const VoxelCounts& counts);

 private:
  Workspace workspace_;
  std::vector<FieldObject> objects_;
  std::vector<VoxelRecord> records_;
  VoxelIndex region_dims_;
  std::size_t next_ = 0;  // region to append
  std::unique_ptr<SparseLayer> codes_, distances_;
};

}  // namespace vicinity
