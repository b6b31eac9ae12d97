/* SPDX-FileCopyrightText: The Vicinity authors */
/* SPDX-License-Identifier: Apache-2.0 */

/* What a C program that knows nothing of C++ does with the installed shared library. */

#include <stdio.h>
#include <vicinity/vicinity.h>

int main(int argc, char** argv) {
  if (argc != 3) return puts("usage: c_example FIELD URDF"), 2;
  vicinity_arm* arm = vicinity_create(argv[1], argv[2], NULL);
  if (arm == NULL) return puts(vicinity_last_error()), 1;
  vicinity_input in = vicinity_empty_input();
  vicinity_output out = vicinity_empty_output();
  const double q[2] = {0.4, 0.5};
  in.q = q;
  in.joint_count = vicinity_joint_count(arm);
  printf("%d joints, %s\n", in.joint_count, vicinity_status_name(vicinity_tick(arm, &in, &out)));
  vicinity_destroy(arm);
  return 0;
}
