/* SPDX-FileCopyrightText: The Vicinity authors */
/* SPDX-License-Identifier: Apache-2.0 */

/* What a program in C does with vicinity.h; compiled as C11. */
#pragma once

#include "vicinity/vicinity.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Joint positions at tick k, shape (2,). */
void in_c_motion(int k, double* q);

/* Where the arm stands. */
extern const double in_c_base[6];

/* Ticks an arm `ticks` times, a millisecond apart, into outputs, shape (ticks,). Takes no memory of
 * its own. */
void in_c_replay(vicinity_arm* arm, int ticks, vicinity_output* outputs);

/* Calls every function with null pointers, and tick() with structs of other sizes. Returns the
 * number of answers that are not as promised, and the first of them. */
int in_c_misuse(vicinity_arm* arm, const char** first);

#ifdef __cplusplus
}
#endif
