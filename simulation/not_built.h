// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a build without MuJoCo says when it is asked to simulate.
#pragma once

#include "vicinity/geometry/error.h"

namespace vicinity {

[[noreturn]] inline void refuse_to_simulate() {
  throw Error({.where = "simulate",
               .what = "this was built without the simulation",
               .hint = "building it with -DVICINITY_SIMULATION=ON, which needs libmujoco-dev, "
                       "libqhull-dev, libgl-dev and libopengl-dev"});
}

}  // namespace vicinity
