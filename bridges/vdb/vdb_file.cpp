// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vdb/vdb_file.h"

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "geometry/file_beside.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

float value_of(const std::byte* at, VoxelQuantity quantity) {
  if (size_of(quantity) == 2) {
    std::int16_t value;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
  float value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// Whole blocks of one value become one tile, now and then, so that the tree never holds the whole
// volume voxel by voxel. A multiple of the 8 x 16 planes of the tree's nodes.
constexpr std::int32_t planes_between_prunings = 128;

float background(VoxelQuantity quantity) {
  return size_of(quantity) == 2 || quantity == VoxelQuantity::distance ? -1.0f : 0.0f;
}

// As openvdb::io::File, which does not ask whether the disk took what was written.
class SeekableArchive : public openvdb::io::Archive {
 public:
  void write_file(const std::string& path, const openvdb::GridPtrVec& grids) const {
    std::ofstream out;
    out.exceptions(std::ios::failbit | std::ios::badbit);
    out.open(path, std::ios::binary);
    Archive::write(out, grids, /*seekable=*/true);
    out.close();
  }
};

}  // namespace

void write_vdb(const ViscosityField& field, const VoxelBox& box,
               const std::vector<VoxelQuantity>& quantities, const std::filesystem::path& path,
               const std::function<void(double)>& progress) {
  openvdb::initialize();
  const Workspace& grid = field.workspace();
  openvdb::GridPtrVec grids;
  double done = 0;
  FileBeside file(path);
  for (const VoxelQuantity quantity : quantities) {
    const float empty = background(quantity);
    auto volume = openvdb::FloatGrid::create(empty);
    volume->setName(to_string(quantity));
    // OpenVDB's whole indices are voxel centres.
    auto transform = openvdb::math::Transform::createLinearTransform(grid.voxel_size);
    const Vec3 centre = grid.centre_of({0, 0, 0});
    transform->postTranslate({centre.x(), centre.y(), centre.z()});
    volume->setTransform(transform);
    auto accessor = volume->getAccessor();
    VoxelPlanes planes(field, box, quantity, Fastest::x);
    for (std::int32_t k = 0; k < planes.count(); ++k) {
      const std::byte* at = planes.plane(k).data();
      for (std::int32_t j = box.lo.j; j < box.hi.j; ++j) {
        for (std::int32_t i = box.lo.i; i < box.hi.i; ++i, at += size_of(quantity)) {
          const float value = value_of(at, quantity);
          if (value != empty && !std::isnan(value)) accessor.setValue({i, j, box.lo.k + k}, value);
        }
      }
      if ((k + 1) % planes_between_prunings == 0) openvdb::tools::prune(volume->tree());
      progress((done + static_cast<double>(k + 1) / planes.count()) /
               static_cast<double>(quantities.size()));
    }
    done += 1;
    openvdb::tools::prune(volume->tree());
    grids.push_back(volume);
  }
  try {
    SeekableArchive().write_file(file.beside(), grids);
  } catch (const openvdb::Exception& error) {
    throw Error({.where = path.string(), .what = "cannot be written", .found = error.what()});
  } catch (const std::ios_base::failure&) {
    fail(path, "cannot be written", errno);
  }
  file.move_into_place();
}

}  // namespace vicinity
