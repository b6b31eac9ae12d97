// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/figures.h"

#include "picture/slice_picture.h"

namespace vicinity::report {

Figure section(const Workshop& workshop, const std::string& file, const ViscosityField& field,
               int axis, int at_vox, const std::string& title, const std::string& says,
               const std::optional<Box>& part) {
  const std::filesystem::path path = workshop.file(file);
  cli::Slice slice{.axis = axis, .position = (at_vox + 0.5) * voxel_m, .part = {}};
  if (part) slice.part = Box(voxel_m * part->min(), voxel_m * part->max());
  draw_slice(field, slice, path);
  return {path, title, says};
}

Figure chart(const Workshop& workshop, const std::string& file, const cli::Chart& drawing,
             const std::string& title, const std::string& says) {
  const std::filesystem::path path = workshop.file(file);
  draw_chart(drawing, path);
  return {path, title, says};
}

}  // namespace vicinity::report
