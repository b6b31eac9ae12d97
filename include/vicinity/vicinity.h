/* SPDX-FileCopyrightText: The Vicinity authors */
/* SPDX-License-Identifier: Apache-2.0 */

/* The tick for C: joint angles in, drag on the whole arm out. The same core as
 * vicinity/teleop/tick.h, where everything is described in full.
 *
 *   vicinity_options options = vicinity_default_options();
 *   vicinity_arm* arm = vicinity_create("cell.vicinity", "arm.urdf", &options);
 *   if (arm == NULL) { puts(vicinity_last_error()); ... }
 *   vicinity_input in = vicinity_empty_input();
 *   vicinity_output out = vicinity_empty_output();
 *   every millisecond:
 *     in.time_s = ...; in.q = ...; in.joint_count = vicinity_joint_count(arm);
 *     vicinity_status status = vicinity_tick(arm, &in, &out);
 *     command out.torque: zero, and safe, for every status from VICINITY_DEADLINE_MISSED on
 *   vicinity_destroy(arm);
 *
 * SI units: m, s, N, rad. Frames: W is the workspace that the field was built in.
 *
 * Every struct states its own size in its first member, as the functions vicinity_default_options()
 * and vicinity_empty_...() do: a program that was compiled with another version of this header is
 * refused, not misread.
 */
#ifndef VICINITY_VICINITY_H
#define VICINITY_VICINITY_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Joints that an arm can have. */
#define VICINITY_MAX_JOINTS 16

/* One arm in one field. Its functions may be called by one thread at a time, but for
 * vicinity_swap_field(), which another thread may call while one ticks. */
typedef struct vicinity_arm vicinity_arm;

/* What became of a tick. From VICINITY_DEADLINE_MISSED on the force is zero. With a limiter, what
 * follows grows back smoothly; without one it is back at once. */
typedef enum vicinity_status {
  VICINITY_OK = 0,
  VICINITY_STARTED,             /* the first tick: no drag */
  VICINITY_BEYOND_JOINT_LIMITS, /* drag as usual */
  VICINITY_OUTSIDE_FIELD,       /* nothing to feel */
  VICINITY_DEADLINE_MISSED,     /* more than longest_period_s since the last tick */
  VICINITY_TIME_STOOD_STILL,
  VICINITY_TIME_RAN_BACKWARDS,
  VICINITY_NOT_FINITE,  /* NaN or infinity in the input */
  VICINITY_WRONG_SIZE,  /* joint_count is not the arm's, or q is null */
  VICINITY_JUMPED,      /* farther than a motion can go in one tick */
  VICINITY_NOT_PASSIVE, /* the limiter refused */
  VICINITY_BAD_CALL     /* a null pointer, or a struct of another version: nothing was ticked */
} vicinity_status;

/* "ok", "started", ...; "unknown" for a number that is no status. */
const char* vicinity_status_name(int status);

typedef enum vicinity_direction {
  VICINITY_ALL = 0, /* drag opposes the whole velocity */
  VICINITY_CLOSING  /* only the part that comes nearer to a surface */
} vicinity_direction;

typedef enum vicinity_traversal {
  VICINITY_SWEPT = 0, /* every voxel on a point's path counts */
  VICINITY_SAMPLED    /* only those it stops in */
} vicinity_traversal;

typedef enum vicinity_mode {
  VICINITY_STRICT = 0, /* within the device's own damping: provably passive */
  VICINITY_DEVICE      /* within a ceiling known from practice */
} vicinity_mode;

typedef struct vicinity_options {
  size_t struct_size;
  double points_per_m2;       /* body points per square metre of the arm's surface; 2000 */
  size_t points;              /* body points in all instead, unless 0 */
  const char* const* exclude; /* names of links that feel nothing, shape (exclude_count,) */
  size_t exclude_count;
  const char* tool;   /* link that force and moment are about; null: the last one */
  const char* memory; /* "none", "sustained", "fading", "short", "rising"; null: "none" */
  int direction;      /* vicinity_direction */
  int traversal;      /* vicinity_traversal */
  const char* device; /* name of a known device, or a .yaml file; null: no limiter, no promise */
  int mode;           /* vicinity_mode, of the limiter */
  double longest_period_s; /* between ticks: beyond it the deadline was missed; 0.0015 */
  double gain, attenuation, lever, torque_constant; /* G, A, L [m], lambda of eq. 8-10; 1 */
} vicinity_options;

/* All as the comments above say. */
vicinity_options vicinity_default_options(void);

/* Opens a field (made by `vicinity build`) and a URDF file. Allocates all that ticks will need.
 * Null, with vicinity_last_error(), for files and options that cannot be used. options may be null:
 * the defaults. */
vicinity_arm* vicinity_create(const char* field_file, const char* urdf_file,
                              const vicinity_options* options);

/* Null is allowed. */
void vicinity_destroy(vicinity_arm* arm);

/* Joints that move, in the order of q; 0 for null. */
int vicinity_joint_count(const vicinity_arm* arm);
/* Null where there is no such joint, link or object. Valid as long as the arm; an object's name
 * until the next vicinity_swap_field(), and not while that runs. */
const char* vicinity_joint_name(const vicinity_arm* arm, int joint);
const char* vicinity_link_name(const vicinity_arm* arm, int link);
const char* vicinity_object_name(const vicinity_arm* arm, int object);

typedef struct vicinity_input {
  size_t struct_size;
  double time_s;
  const double* q;  /* joint positions, shape (joint_count,) [rad or m] */
  const double* qd; /* joint velocities, same shape, or null: they are differenced */
  int joint_count;
  const double* base; /* x, y, z, roll, pitch, yaw of the arm's base in W; null: at its origin */
  double tau2;        /* the slave's own torque of eq. 10 [N·m] */
} vicinity_input;

typedef struct vicinity_output {
  size_t struct_size;
  vicinity_status status;
  int joint_count;
  double torque[VICINITY_MAX_JOINTS]; /* on the joints, the first joint_count of them [N·m or N] */
  double force[3], moment[3];         /* all drag, about the tool link's origin, in W [N], [N·m] */
  double master_force;                /* third term of eq. 10 [N] */
  double power;                       /* taken out of the motion, >= 0 [W] */
  double scale;                       /* of the limiter, 0 to 1 */
  /* The point that contributed most. -1: nothing is felt, or the point only remembers. */
  int reason_link, reason_object, reason_rank;
  double reason_share;             /* of the power that all points take out, 0 to 1 */
  double reason_distance_m;        /* at least so far from the surface */
  double reason_time_to_contact_s; /* at this speed, at the earliest */
  uint32_t points_felt;
  /* The exact energy account, since the first tick. */
  double energy_drag; /* taken out of the motion [J] */
  int passive;        /* 1: more never came out than had gone in */
  uint64_t ticks, refused, missed_deadlines;
} vicinity_output;

/* struct_size is set, an output has no reason, and everything else is zero. */
vicinity_input vicinity_empty_input(void);
vicinity_output vicinity_empty_output(void);

/* One period. Writes the whole output whatever happens, but for VICINITY_BAD_CALL with an output
 * that is null or of another version. Takes no memory, no lock, makes no system call; sets no error
 * text. */
vicinity_status vicinity_tick(vicinity_arm* arm, const vicinity_input* input,
                              vicinity_output* output);

/* Puts another field in place of this one from the next tick on, whole or not at all; the tick
 * never waits. Not for the thread that ticks, and for one caller at a time.
 * 0, or -1 with vicinity_last_error(): the arm keeps the field it has. */
int vicinity_swap_field(vicinity_arm* arm, const char* field_file);

/* Why the last vicinity_create() or vicinity_swap_field() of this thread failed, in one sentence;
 * "" where it did not. Valid until the next of them. */
const char* vicinity_last_error(void);

#ifdef __cplusplus
}
#endif

#endif
