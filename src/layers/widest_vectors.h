// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// One binary for every x86-64: a function marked so is compiled for several instruction sets, and
/// the loader picks the widest vectors that the processor has.
#pragma once

// Sanitizers do not bear code that runs before them, which is how the loader picks.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define VICINITY_WIDEST_VECTORS __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define VICINITY_WIDEST_VECTORS
#endif
