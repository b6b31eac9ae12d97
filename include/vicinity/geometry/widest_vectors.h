// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Functions compiled once for each generation of processor, the best chosen at run time.
#pragma once

/// Before a function whose result does not depend on it: on x86-64 it is compiled plainly, for AVX2
/// and for AVX-512, and the loader picks the widest vectors that the processor has. Elsewhere, as
/// on ARM, the compiler's own target does. Sanitizers do not bear code that runs before them, which
/// is how the loader picks.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define VICINITY_WIDEST_VECTORS __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define VICINITY_WIDEST_VECTORS
#endif
