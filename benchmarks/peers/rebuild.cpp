// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <string>
#include <vector>

#include "peers/groups.h"
#include "plant_room/plant_room.h"
#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity::peers {

void measure_rebuild(Report& report, const GroupOptions&) {
  using Sense = Report::Sense;
  constexpr double step = 0.03;  // [m], there and back
  Scene scene = benchmarks::plant_room({.voxel_size = 0.005});
  // The room's own bounds, so that what moves does not move the grid.
  scene.bounds = Box(Vec3::Zero(), Vec3(10, 8, 4));
  // Something small in a corner, and something that runs along a whole wall.
  for (const std::string moved : {"pump_1", "pipes_north_low"}) {
    const auto object = std::find_if(scene.objects.begin(), scene.objects.end(),
                                     [&](const SceneObject& o) { return o.name == moved; });
    if (object == scene.objects.end()) throw Error({.where = moved, .what = "not in the room"});
    FieldBuilder builder;
    builder.build(scene);
    double sign = 1;
    const auto move = [&] {
      object->X_WO.translation().z() += sign * step;
      sign = -sign;
    };
    const std::vector<Timing> t = side_by_side({{"build the room",
                                                 [&] {
                                                   move();
                                                   build_field(scene);
                                                 },
                                                 3},
                                                {"build it again, one object of fifty moved",
                                                 [&] {
                                                   move();
                                                   builder.build(scene);
                                                 },
                                                 6}});
    report.timings("rebuild", moved, t);
    report.target("rebuild: times a full build, one object of fifty moved", Sense::at_least, 20,
                  t[0].wall / t[1].wall, moved);
    if (!std::ranges::equal(builder.build(scene).field.image(), build_field(scene).field.image()))
      throw Error({.where = moved, .what = "built again, the field is not the same to the byte"});
  }
}

}  // namespace vicinity::peers
