/* SPDX-FileCopyrightText: The Vicinity authors */
/* SPDX-License-Identifier: Apache-2.0 */

#include "c/in_c.h"

#include <math.h>
#include <string.h>

const double in_c_base[6] = {-0.1, 0.02, 0.03, 0.1, -0.2, 0.3};

void in_c_motion(int k, double* q) {
  const double t = 1e-3 * k;
  q[0] = 0.9 * sin(3 * t);
  q[1] = 0.4 + 0.3 * cos(2 * t);
}

void in_c_replay(vicinity_arm* arm, int ticks, vicinity_output* outputs) {
  double q[2];
  vicinity_input input = vicinity_empty_input();
  input.q = q;
  input.joint_count = vicinity_joint_count(arm);
  input.base = in_c_base;
  input.tau2 = 0.25;
  for (int k = 0; k < ticks; ++k) {
    in_c_motion(k, q);
    input.time_s = 1e-3 * k;
    outputs[k] = vicinity_empty_output();
    vicinity_tick(arm, &input, &outputs[k]);
  }
}

int in_c_misuse(vicinity_arm* arm, const char** first) {
  int wrong = 0;
#define PROMISED(claim) \
  if (!(claim) && wrong++ == 0) *first = #claim

  vicinity_input input = vicinity_empty_input();
  vicinity_output output = vicinity_empty_output();
  double q[VICINITY_MAX_JOINTS] = {0};

  PROMISED(vicinity_create(NULL, NULL, NULL) == NULL);
  PROMISED(strstr(vicinity_last_error(), "null pointer") != NULL);
  PROMISED(vicinity_create("nowhere.vicinity", "nowhere.urdf", NULL) == NULL);
  PROMISED(strstr(vicinity_last_error(), "nowhere.vicinity") != NULL);
  vicinity_destroy(NULL);
  PROMISED(vicinity_joint_count(NULL) == 0);
  PROMISED(vicinity_joint_name(NULL, 0) == NULL);
  PROMISED(vicinity_joint_name(arm, -1) == NULL);
  PROMISED(vicinity_joint_name(arm, 2) == NULL);
  PROMISED(vicinity_link_name(arm, 1000) == NULL);
  PROMISED(vicinity_object_name(arm, 1000) == NULL);
  PROMISED(vicinity_swap_field(NULL, "nowhere.vicinity") == -1);
  PROMISED(vicinity_swap_field(arm, NULL) == -1);
  PROMISED(vicinity_swap_field(arm, "nowhere.vicinity") == -1);
  PROMISED(strstr(vicinity_last_error(), "nowhere.vicinity") != NULL);

  PROMISED(vicinity_tick(NULL, &input, &output) == VICINITY_BAD_CALL);
  PROMISED(output.status == VICINITY_BAD_CALL && output.reason_link == -1);
  PROMISED(vicinity_tick(arm, NULL, &output) == VICINITY_BAD_CALL);
  PROMISED(vicinity_tick(arm, &input, NULL) == VICINITY_BAD_CALL);
  input.struct_size -= sizeof(double);
  PROMISED(vicinity_tick(arm, &input, &output) == VICINITY_BAD_CALL);
  input = vicinity_empty_input();
  output.struct_size += sizeof(double);
  PROMISED(vicinity_tick(arm, &input, &output) == VICINITY_BAD_CALL);
  output = vicinity_empty_output();

  input.joint_count = 2; /* but no positions */
  PROMISED(vicinity_tick(arm, &input, &output) == VICINITY_WRONG_SIZE);
  input.q = q;
  input.joint_count = 1;
  PROMISED(vicinity_tick(arm, &input, &output) == VICINITY_WRONG_SIZE);
  PROMISED(output.joint_count == 2 && output.torque[0] == 0 && output.torque[1] == 0);
  input.joint_count = 2;
  q[1] = NAN;
  PROMISED(vicinity_tick(arm, &input, &output) == VICINITY_NOT_FINITE);

  PROMISED(strcmp(vicinity_status_name(VICINITY_OK), "ok") == 0);
  PROMISED(strcmp(vicinity_status_name(VICINITY_NOT_PASSIVE), "not passive") == 0);
  PROMISED(strcmp(vicinity_status_name(VICINITY_BAD_CALL), "bad call") == 0);
  PROMISED(strcmp(vicinity_status_name(99), "unknown") == 0);
#undef PROMISED
  return wrong;
}
