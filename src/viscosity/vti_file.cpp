// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/vti_file.h"

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>

#include "geometry/file_beside.h"

namespace vicinity {

void write_vti(const ViscosityField& field, const VoxelBox& box, VoxelQuantity quantity,
               const std::filesystem::path& path, const std::function<void(double)>& progress) {
  const Workspace& grid = field.workspace();
  const auto& [lo, hi] = box;
  const std::string extent = fmt::format("{} {} {} {} {} {}", lo.i, hi.i, lo.j, hi.j, lo.k, hi.k);
  FileBeside file(path);
  file.write(fmt::format(
      R"(<?xml version="1.0"?>
<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <ImageData WholeExtent="{0}" Origin="{1:.17g} {2:.17g} {3:.17g}" Spacing="{4:.17g} {4:.17g} {4:.17g}">
    <Piece Extent="{0}">
      <CellData Scalars="{5}">
        <DataArray type="{6}" Name="{5}" format="appended" offset="0"/>
      </CellData>
    </Piece>
  </ImageData>
  <AppendedData encoding="raw">
   _)",
      extent, grid.origin.x(), grid.origin.y(), grid.origin.z(), grid.voxel_size,
      to_string(quantity), size_of(quantity) == 2 ? "Int16" : "Float32"));
  const std::uint64_t bytes_of_data = size_of(quantity) * static_cast<std::uint64_t>(hi.i - lo.i) *
                                      static_cast<std::uint64_t>(hi.j - lo.j) *
                                      static_cast<std::uint64_t>(hi.k - lo.k);
  file.write(std::as_bytes(std::span(&bytes_of_data, 1)));
  VoxelPlanes planes(field, box, quantity, Fastest::x);
  for (std::int32_t k = 0; k < planes.count(); ++k) {
    file.write(planes.plane(k));
    progress(static_cast<double>(k + 1) / planes.count());
  }
  file.write("\n  </AppendedData>\n</VTKFile>\n");
  file.move_into_place();
}

}  // namespace vicinity
