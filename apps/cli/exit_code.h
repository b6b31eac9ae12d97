// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a program of ours ends with: exit codes that scripts may rely on, and a sentence.
#pragma once

#include <functional>

namespace vicinity::cli {

/// Runs all of a program.
/// @return what `run` returns; 2, with the sentence on standard error, for an Error; 130 where it
/// was Interrupted; and 1, with a sentence, for anything else that is thrown and for output that
/// could not be written
int exit_code_of(const std::function<int()>& run) noexcept;

}  // namespace vicinity::cli
