# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The tick from Python: one arm of two joints, whose kinematics are worked out here by hand."""

import pathlib
import sys
import threading
import tracemalloc
import unittest

import numpy as np

import vicinity

ARM = pathlib.Path(__file__).parents[2] / "examples" / "02_arm_tick"
Status = vicinity.Status
TIP = np.array([0.3, 0, 0])  # of the forearm, in its own frame


def turn(axis, angle):
    rpy = np.zeros(3)
    rpy[axis] = angle
    return vicinity.pose_from_rpy([0, 0, 0], rpy)


def shift(*xyz):
    return vicinity.pose_from_rpy(xyz, [0, 0, 0])


def tip_W(q):
    """The joints as the URDF states them: shoulder about z, 0.4 m up; elbow about y, 0.4 m on."""
    X_WF = shift(0, 0, 0.4) @ turn(2, q[0]) @ shift(0.4, 0, 0) @ turn(1, q[1])
    return (X_WF @ [*TIP, 1])[:3]


def motion(t):
    return np.array([0.8 * np.sin(2 * t), 0.5 + 0.2 * np.sin(t)])


def speed(t):
    return np.array([1.6 * np.cos(2 * t), 0.2 * np.cos(t)])


class Ticks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.field = vicinity.build_field(vicinity.read_scene(ARM / "cell.yaml")).field
        cls.robot = vicinity.read_urdf(ARM / "arm.urdf").robot

    def arm(self, points=None, **options):
        points = points or vicinity.sample_body_points(self.robot)
        return vicinity.Teleoperation(self.robot, points, self.field, **options)

    def test_one_point_feels_its_viscosity_times_area_times_velocity(self):
        point = vicinity.NamedPoint(TIP, 1e-3)
        points = vicinity.sample_body_points(self.robot, points_per_m2=0, named={"forearm": point})
        arm = self.arm(points, traversal=vicinity.Traversal.sampled)
        felt = 0
        for t in np.arange(1, 2, 1e-3):
            out = arm.tick(t, motion(t), speed(t))
            if out.status == Status.started:
                continue
            dt = 1e-6
            v_W = (tip_W(motion(t) + dt * speed(t)) - tip_W(motion(t) - dt * speed(t))) / (2 * dt)
            mu = self.field.query([tip_W(motion(t))]).viscosity[0]
            np.testing.assert_allclose(out.tool.force, -mu * 1e-3 * v_W, atol=1e-6 * (1e-3 + mu))
            felt += mu > 0
        self.assertGreater(felt, 100)

    def test_torques_take_out_the_power_that_the_tick_states(self):
        arm = self.arm(memory="rising")
        strongest = 0
        for t in np.arange(0, 2, 1e-3):
            out = arm.tick(t, motion(t), speed(t))
            if out.status != Status.started:
                slack = 1e-6 * (1 + out.power)
                self.assertAlmostEqual(-out.torque @ speed(t), out.power, delta=slack)
                self.assertGreaterEqual(out.power, 0)
            strongest = max(strongest, out.power)
        self.assertGreater(strongest, 0)
        self.assertTrue(out.energy.passive)

    def test_an_output_of_ones_own_is_written_over_and_no_memory_is_kept(self):
        arm, out = self.arm(), vicinity.Output()
        q = np.array([motion(t) for t in np.arange(0, 1, 1e-3)])
        self.assertIs(arm.tick(0.0, q[0], out=out), out)
        torque = out.torque
        self.assertTrue(np.shares_memory(torque, out.torque))
        tracemalloc.start()
        for n in range(1, len(q)):
            arm.tick(n * 1e-3, q[n], out=out)
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        self.assertLess(most, len(q) * sys.getsizeof(0.0))  # not even a number for each tick
        np.testing.assert_array_equal(torque, out.torque)
        self.assertIsNot(arm.tick(1.0, q[-1]), out)

    def test_input_that_no_arm_could_have_sent_is_a_status_and_zero_torque(self):
        arm = self.arm()
        q = motion(0)
        for n, (expected, arguments) in enumerate(
            [
                (Status.started, (q,)),
                (Status.not_finite, ([0, np.nan],)),
                (Status.wrong_size, ([0, 0, 0],)),
                (Status.wrong_size, ([q],)),
                (Status.wrong_size, (q, [0])),
                (Status.wrong_size, ([],)),
                (Status.ok, (q, np.zeros(2))),
            ]
        ):
            out = arm.tick(1 + n * 1e-4, *arguments)
            self.assertEqual(out.status, expected)
            np.testing.assert_array_equal(out.torque, [0, 0])
        self.assertEqual(arm.tick(0.5, q).status, Status.time_ran_backwards)
        with self.assertRaises(TypeError):
            arm.tick(1.0, "0, 0")
        with self.assertRaises(TypeError):
            arm.tick(1.0, q, out="out")

    def test_the_reason_names_what_is_near(self):
        arm, out = self.arm(), vicinity.Output()
        near = set()
        for t in np.arange(0, 2, 1e-3):
            arm.tick(t, motion(t), out=out)
            if out.reason.object >= 0:
                link, object = self.robot.links[out.reason.link], out.reason.object
                near.add((link, self.field.objects[object].name))
        self.assertIn(("forearm", "post"), near)

    def test_a_field_is_swapped_while_another_thread_ticks(self):
        arm = self.arm()
        heavier = self.field.with_codings(
            [vicinity.Coding([2 * mu for mu in o.coding.mu]) for o in self.field.objects]
        )
        interval = sys.getswitchinterval()
        sys.setswitchinterval(1e-4)
        swapper = threading.Thread(target=lambda: [arm.swap_field(heavier) for _ in range(20)])
        try:
            arm.tick(0, motion(0))
            swapper.start()
            t = 0.0
            while swapper.is_alive():
                t += 1e-3
                self.assertLess(arm.tick(t, motion(t)).status, Status.deadline_missed)
            swapper.join()
        finally:
            sys.setswitchinterval(interval)
        out = arm.tick(t + 1e-3, motion(t + 1e-3))
        self.assertGreaterEqual(out.counts.fields_taken, 1)

    def test_a_limiter_keeps_to_the_torques_of_its_device(self):
        device = vicinity.find_device(str(ARM / "device.yaml"))
        limiter = vicinity.limiter_options(device, vicinity.LimiterMode.strict)
        free, limited = self.arm(), self.arm(limiter=limiter)
        asked = given = 0
        for t in np.arange(0, 2, 1e-3):
            asked = max(asked, np.abs(free.tick(t, motion(t)).torque).max())
            out = limited.tick(t, motion(t))
            given = max(given, np.abs(out.torque).max())
            self.assertLessEqual(out.limiter.scale, 1)
        self.assertTrue(0 < given <= asked)
        self.assertTrue(out.energy.passive)
        with self.assertRaises(vicinity.Error) as raised:
            vicinity.find_device("no such device")
        self.assertIn("no such device", str(raised.exception))


if __name__ == "__main__":
    unittest.main()
