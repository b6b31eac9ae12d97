// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/slice.h"

#include <fmt/format.h>

#include <array>

#include "arguments.h"
#include "outputs.h"
#include "picture/slice_picture.h"
#include "vicinity/viscosity/field_file.h"

namespace vicinity::cli {

int slice(const SliceOptions& options, std::ostream& out, std::ostream&) {
  const std::array positions{options.x, options.y, options.z};
  Slice plane;
  int planes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& position = positions[static_cast<std::size_t>(axis)];
    if (!position) continue;
    plane.axis = axis;
    plane.position = *position;
    ++planes;
  }
  if (planes != 1) {
    throw Error({.where = "slice",
                 .what = "needs one plane",
                 .found = fmt::format("{} of --x, --y and --z", planes),
                 .expected = "one",
                 .hint = "--z 0.04"});
  }
  if (!options.box.empty()) {
    plane.part = box_from("--box", options.box);
    const double lo = plane.part->min()[plane.axis], hi = plane.part->max()[plane.axis];
    if (plane.position < lo || plane.position > hi) {
      throw Error({.where = "--box",
                   .what = "the plane does not pass through it",
                   .found = fmt::format("{} from {:.10g} to {:.10g} m", "xyz"[plane.axis], lo, hi),
                   .expected = fmt::format("{:.10g} m in between", plane.position)});
    }
  }
  check_outputs({{"-o", options.output}}, {options.field});
  draw_slice(open_field(options.field), plane, options.output);
  out << fmt::format("{}: the layers at {} = {:g} m\n", options.output.string(), "xyz"[plane.axis],
                     plane.position);
  return 0;
}

}  // namespace vicinity::cli
