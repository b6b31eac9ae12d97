// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a study says, as a page.
#pragma once

#include <filesystem>

#include "simulation/study_report.h"

namespace vicinity::cli {

/// Writes pictures and index.html. Errors: throws Error where the folder cannot be written.
void write_study_page(const StudyReport& report, const std::filesystem::path& folder);

}  // namespace vicinity::cli
