// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// `vicinity simulate` in a build without MuJoCo: says so.
#include "commands/simulate.h"
#include "vicinity/geometry/error.h"

namespace vicinity::cli {

int simulate(const SimulateOptions&, std::ostream&, std::ostream&) {
  throw Error({.where = "vicinity simulate",
               .what = "this program was built without the simulation",
               .hint = "building it with -DVICINITY_SIMULATION=ON, which needs libmujoco-dev and "
                       "libqhull-dev"});
}

}  // namespace vicinity::cli
