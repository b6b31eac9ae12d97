# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""Replays a log of an arm's joints, tick by tick, as a loop of 1 kHz would."""

import pathlib

import numpy as np

import vicinity

here = pathlib.Path(__file__).parent
arm_folder = here.parent / "02_arm_tick"
field = vicinity.build_field(vicinity.read_scene(arm_folder / "cell.yaml")).field
robot = vicinity.read_urdf(arm_folder / "arm.urdf").robot
device = vicinity.find_device(str(arm_folder / "device.yaml"))
arm = vicinity.Teleoperation(
    robot,
    vicinity.sample_body_points(robot),
    field,
    memory="rising",
    limiter=vicinity.limiter_options(device, vicinity.LimiterMode.strict),
)

log = np.loadtxt(here / "joint_log.csv", delimiter=",", skiprows=1)  # t, shoulder, elbow
times = np.arange(log[0, 0], log[-1, 0], 1e-3)
q = np.stack([np.interp(times, log[:, 0], log[:, joint]) for joint in (1, 2)], axis=1)

out = vicinity.Output()  # written over by each tick: the loop takes no memory
torques = np.empty_like(q)
for n, time_s in enumerate(times):
    arm.tick(time_s, q[n], out=out)
    torques[n] = out.torque
    if n == len(times) // 2:
        why = out.reason
        link, near = robot.links[why.link], field.objects[why.object].name
        print(f"half-way: {link} near {near}, {1e3 * why.distance_m:.0f} mm at least")

print(f"{out.counts.ticks} ticks, {out.counts.refused} refused")
print(f"most torque: {np.abs(torques).max(axis=0).round(4)} N·m")
print(f"taken out of the motion: {out.energy.drag:.4f} J; passive: {out.energy.passive}")
