// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Functions compiled once for each generation of processor, the best chosen at run time.
#pragma once

/// Before a function: on x86-64 it is compiled plainly, for AVX2 and for AVX-512, and the program
/// takes what the machine has when it starts. Elsewhere, as on ARM, the compiler's own target does.
/// The thread sanitizer is not ready when such a choice is made: under it there is none.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define VICINITY_MACHINE_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define VICINITY_MACHINE_CLONES
#endif
