// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Functions compiled twice on x86-64, of which the one that the processor knows is taken when the
/// program is loaded: one binary runs everywhere. Only for results that do not depend on it.
#pragma once

// The thread sanitizer is not ready yet when the choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_THREAD__)
#define VICINITY_FOR_THIS_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define VICINITY_FOR_THIS_PROCESSOR
#endif
