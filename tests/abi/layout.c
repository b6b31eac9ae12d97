/* SPDX-FileCopyrightText: The Vicinity authors */
/* SPDX-License-Identifier: Apache-2.0 */

/* Prints where everything lies that programs compiled with vicinity.h have built in: for each member
 * its offset and size, and the number of each enumerator. */

#include <stdio.h>

#include "vicinity/vicinity.h"

#define STRUCT(type) printf("%s %zu\n", #type, sizeof(type))
#define MEMBER(type, member) \
  printf("%s.%s %zu %zu\n", #type, #member, offsetof(type, member), sizeof(((type*)0)->member))
#define NUMBER(name) printf("%s %d\n", #name, (int)(name))

int main(void) {
  NUMBER(VICINITY_MAX_JOINTS);
  NUMBER(VICINITY_OK);
  NUMBER(VICINITY_STARTED);
  NUMBER(VICINITY_BEYOND_JOINT_LIMITS);
  NUMBER(VICINITY_OUTSIDE_FIELD);
  NUMBER(VICINITY_DEADLINE_MISSED);
  NUMBER(VICINITY_TIME_STOOD_STILL);
  NUMBER(VICINITY_TIME_RAN_BACKWARDS);
  NUMBER(VICINITY_NOT_FINITE);
  NUMBER(VICINITY_WRONG_SIZE);
  NUMBER(VICINITY_JUMPED);
  NUMBER(VICINITY_NOT_PASSIVE);
  NUMBER(VICINITY_BAD_CALL);
  NUMBER(VICINITY_ALL);
  NUMBER(VICINITY_CLOSING);
  NUMBER(VICINITY_SWEPT);
  NUMBER(VICINITY_SAMPLED);
  NUMBER(VICINITY_STRICT);
  NUMBER(VICINITY_DEVICE);

  STRUCT(vicinity_options);
  MEMBER(vicinity_options, struct_size);
  MEMBER(vicinity_options, points_per_m2);
  MEMBER(vicinity_options, points);
  MEMBER(vicinity_options, exclude);
  MEMBER(vicinity_options, exclude_count);
  MEMBER(vicinity_options, tool);
  MEMBER(vicinity_options, memory);
  MEMBER(vicinity_options, direction);
  MEMBER(vicinity_options, traversal);
  MEMBER(vicinity_options, device);
  MEMBER(vicinity_options, mode);
  MEMBER(vicinity_options, longest_period_s);
  MEMBER(vicinity_options, gain);
  MEMBER(vicinity_options, attenuation);
  MEMBER(vicinity_options, lever);
  MEMBER(vicinity_options, torque_constant);

  STRUCT(vicinity_input);
  MEMBER(vicinity_input, struct_size);
  MEMBER(vicinity_input, time_s);
  MEMBER(vicinity_input, q);
  MEMBER(vicinity_input, qd);
  MEMBER(vicinity_input, joint_count);
  MEMBER(vicinity_input, base);
  MEMBER(vicinity_input, tau2);

  STRUCT(vicinity_output);
  MEMBER(vicinity_output, struct_size);
  MEMBER(vicinity_output, status);
  MEMBER(vicinity_output, joint_count);
  MEMBER(vicinity_output, torque);
  MEMBER(vicinity_output, force);
  MEMBER(vicinity_output, moment);
  MEMBER(vicinity_output, master_force);
  MEMBER(vicinity_output, power);
  MEMBER(vicinity_output, scale);
  MEMBER(vicinity_output, reason_link);
  MEMBER(vicinity_output, reason_object);
  MEMBER(vicinity_output, reason_rank);
  MEMBER(vicinity_output, reason_share);
  MEMBER(vicinity_output, reason_distance_m);
  MEMBER(vicinity_output, reason_time_to_contact_s);
  MEMBER(vicinity_output, points_felt);
  MEMBER(vicinity_output, energy_drag);
  MEMBER(vicinity_output, passive);
  MEMBER(vicinity_output, ticks);
  MEMBER(vicinity_output, refused);
  MEMBER(vicinity_output, missed_deadlines);
  return 0;
}
