// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// `vicinity simulate` in a build without MuJoCo: says so.
#include "commands/simulate.h"
#include "simulation/not_built.h"

namespace vicinity::cli {

int simulate(const SimulateOptions&, std::ostream&, std::ostream&) { refuse_to_simulate(); }

}  // namespace vicinity::cli
