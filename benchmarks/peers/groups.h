// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The comparisons, one function for each group of targets.
#pragma once

#include <filesystem>

#include "peers/report.h"

namespace vicinity::peers {

struct GroupOptions {
  std::filesystem::path scratch;  ///< a folder for files of its own
  bool scale = false;             ///< also what takes many minutes
};

void measure_ranks(Report& report, const GroupOptions& options);    ///< target 1
void measure_voxels(Report& report, const GroupOptions& options);   ///< target 2
void measure_stl(Report& report, const GroupOptions& options);      ///< target 3
void measure_scale(Report& report, const GroupOptions& options);    ///< target 4
void measure_lookup(Report& report, const GroupOptions& options);   ///< target 5
void measure_rebuild(Report& report, const GroupOptions& options);  ///< target 6
void measure_cores(Report& report, const GroupOptions& options);    ///< target 7
/// No target: what asking a mesh for its distance costs, beside asking a field.
void measure_nearest(Report& report, const GroupOptions& options);

/// For the program's own child: reads one STL file and prints by how much memory grew [bytes].
int print_memory_of_reading(const std::filesystem::path& stl);

}  // namespace vicinity::peers
