// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity demo: everything the program can do, on a scene of its own.
#pragma once

#include <filesystem>
#include <ostream>

namespace vicinity::cli {

struct DemoOptions {
  std::filesystem::path folder = "vicinity-demo";
};

/// Writes scene, meshes, field, traces, pictures and index.html into the folder, over what an
/// earlier demo left there.
/// @return 0
/// Errors: throws Error where the folder cannot be written.
int demo(const DemoOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
