// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <vector>

#include "arguments.h"
#include "interruption.h"
#include "outputs.h"
#include "progress_bar.h"
#include "readable.h"
#include "vdb/vdb_file.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/npy_file.h"
#include "vicinity/viscosity/vti_file.h"

namespace vicinity::cli {
namespace {

// More than this is a plant room by mistake: no viewer opens it.
constexpr std::uint64_t most_bytes = 16'000'000'000;

void refuse_absurd_size(const ExportOptions& options, const VoxelBox& box, std::uint64_t size) {
  std::error_code no_matter;
  const auto folder = std::filesystem::absolute(options.output).parent_path();
  const auto space = std::filesystem::space(folder, no_matter);
  const bool too_much = size > most_bytes;
  if (!too_much && (no_matter || size < space.available)) return;
  throw Error({.where = options.output.string(),
               .what = too_much ? "would be absurdly large" : "would not fit on its disk",
               .found = fmt::format("{} for {} x {} x {} voxels", bytes(size), box.hi.i - box.lo.i,
                                    box.hi.j - box.lo.j, box.hi.k - box.lo.k),
               .expected = "at most " + bytes(too_much ? most_bytes : space.available),
               .hint = "--box x,y,z,x,y,z to cut out a part, or .vdb, which is sparse"});
}

}  // namespace

int export_field(const ExportOptions& options, std::ostream& out, std::ostream& err) {
  constexpr std::array choices = {
      std::pair{"rank", VoxelQuantity::rank}, std::pair{"viscosity", VoxelQuantity::viscosity},
      std::pair{"object", VoxelQuantity::object}, std::pair{"distance", VoxelQuantity::distance}};
  enum class Format { npy, vdb, vti };
  constexpr std::array formats = {std::pair{".npy", Format::npy}, std::pair{".vdb", Format::vdb},
                                  std::pair{".vti", Format::vti}};
  const Format format = one_of("-o", options.output.extension().string(), formats);
  std::vector<VoxelQuantity> quantities = {VoxelQuantity::rank};
  if (!options.what.empty()) {
    quantities = {one_of("--what", options.what, choices)};
  } else if (format == Format::vdb) {
    quantities = usual_vdb_quantities;
  }

  std::vector<Output> outputs = {{"-o", options.output}};
  if (format == Format::npy) {
    outputs.push_back({"-o", std::filesystem::path(options.output).replace_extension(".json")});
  }
  check_outputs(outputs, {options.field});

  const ViscosityField field = open_field(options.field);
  const Workspace& grid = field.workspace();
  const VoxelBox box =
      options.box.empty() ? grid.box() : voxels_within(grid, box_from("--box", options.box));
  if (box.empty()) {
    throw Error({.where = "--box",
                 .what = "lies outside the workspace",
                 .found = options.box,
                 .hint = "vicinity info " + options.field.string() + " to see its corners"});
  }
  const std::uint64_t voxels = static_cast<std::uint64_t>(box.hi.i - box.lo.i) *
                               static_cast<std::uint64_t>(box.hi.j - box.lo.j) *
                               static_cast<std::uint64_t>(box.hi.k - box.lo.k);
  if (format != Format::vdb) {
    refuse_absurd_size(options, box, voxels * size_of(quantities.front()));
  }
  {
    ProgressBar bar(err);
    const WhileWriting finish_first;
    const auto progress = [&](double done) {
      stop_if_interrupted();
      bar.show("export", done);
    };
    switch (format) {
      case Format::npy:
        write_npy(field, box, quantities.front(), options.output, progress);
        break;
      case Format::vti:
        write_vti(field, box, quantities.front(), options.output, progress);
        break;
      case Format::vdb:
#ifdef VICINITY_OPENVDB
        write_vdb(field, box, quantities, options.output, progress);
        break;
#else
        throw Error({.where = options.output.string(),
                     .what = "this program was built without OpenVDB",
                     .hint = "-o with .npy or .vti"});
#endif
    }
  }
  std::string exported;
  for (const VoxelQuantity quantity : quantities) {
    exported += (exported.empty() ? "" : " and ") + std::string(to_string(quantity));
  }
  out << fmt::format("{}: {} of {} x {} x {} voxels, {}\n", options.output.string(), exported,
                     box.hi.i - box.lo.i, box.hi.j - box.lo.j, box.hi.k - box.lo.k,
                     bytes(std::filesystem::file_size(options.output)));
  return 0;
}

}  // namespace vicinity::cli
