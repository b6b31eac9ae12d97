// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "peers/groups.h"

namespace vicinity::peers {

void measure_rebuild(Report& report, const GroupOptions&) {
  report.not_measured("rebuild: times a full build, one object of fifty moved",
                      Report::Sense::at_least, 20, "nothing rebuilds a part yet");
}

}  // namespace vicinity::peers
