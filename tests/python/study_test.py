# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated operators from Python: the numbers of the command line, to the byte."""

import json
import os
import pathlib
import subprocess
import tempfile
import threading
import unittest

import numpy as np

import vicinity

PROGRAM = os.environ.get("VICINITY_PROGRAM", "")
TASKS = """tasks:
  - {name: down, path: [[0, 0, 0.2], [0, 0, 0.04]], points: [0, 0, 1], sight: [0, 0, 1],
     stop: feel, limit: 1.5}
"""
SCENE = """voxel_size: 0.01
defaults: {m: 2, q: 3}
objects:
  - name: block
    primitive: {box: {size: [0.3, 0.3, 0.2]}}
    pose: {xyz: [0.002, 0.002, -0.1]}
"""
INERTIA = (
    '<inertial><mass value="1"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/>'
    "</inertial>"
)


def gantry(inertia=INERTIA):
    """Three slides with a ball for a tool."""
    text, parent = '<robot name="gantry"><link name="frame"/>', "frame"
    for name, axis in [("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1")]:
        ball = '<collision><geometry><sphere radius="0.02"/></geometry></collision>'
        text += (
            f'<joint name="{name}" type="prismatic"><parent link="{parent}"/>'
            f'<child link="{name}_slide"/><axis xyz="{axis}"/>'
            '<limit lower="-1" upper="1" velocity="2" effort="2000"/></joint>'
            f'<link name="{name}_slide">{inertia}{ball if name == "z" else ""}</link>'
        )
        parent = f"{name}_slide"
    return text + "</robot>"


class Studies(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.asked = {"robot": self.folder / "gantry.urdf", "tasks": self.folder / "tasks.yaml"}
        (self.folder / "cell.yaml").write_text(SCENE)
        (self.folder / "gantry.urdf").write_text(gantry())
        (self.folder / "tasks.yaml").write_text(TASKS)

    @unittest.skipUnless(PROGRAM, "there is no vicinity command in this build")
    def test_the_same_seed_gives_the_same_bytes_as_the_command_line(self):
        told = []
        study = vicinity.simulate(
            self.folder / "cell.yaml",
            **self.asked,
            X_WB=vicinity.pose_from_rpy([0.01, 0, 0.01], [0, 0, 0]),
            methods=["none", "rising"],
            delays_s=[0.05],
            trials=2,
            seed=7,
            progress=lambda what, done: told.append((what, done, threading.get_ident())),
        )
        command = [PROGRAM, "simulate", "cell.yaml", "--robot", "gantry.urdf", "--tasks", "tasks.yaml"]
        command += ["--base", "0.01,0,0.01,0,0,0", "--method", "none,rising", "--delays", "50"]
        command += ["--trials", "2", "--seed", "7", "-o", "s"]
        subprocess.run(command, cwd=self.folder, check=True, capture_output=True)
        for file, text in [
            ("trials.csv", study.trials_csv()),
            ("study.json", study.as_json()),
            ("tables.md", study.tables()),
        ]:
            self.assertEqual((self.folder / "s" / file).read_text(encoding="utf-8"), text, file)

        self.assertEqual({what for what, _, _ in told[:1]}, {"building the workplace"})
        shares = [done for _, done, _ in told]
        self.assertEqual(shares, sorted(shares))
        self.assertEqual({thread for _, _, thread in told}, {threading.get_ident()})

        rows = study.trials_csv().splitlines()[1:]
        self.assertEqual(len(rows), sum(len(cell.trials) for cell in study.cells))
        cell = study.cells[0]
        self.assertEqual((cell.part, cell.task, cell.method, cell.delay_s), ("tasks", "down", "none", 0))
        self.assertAlmostEqual(
            cell.summary.time_s.value, np.mean([trial.time_s for trial in cell.trials])
        )
        self.assertEqual(json.loads(study.as_json())["settings"], study.settings)
        self.assertIn("rising", study.settings)

    def test_the_defaults_are_those_of_the_command_line(self):
        said = vicinity.simulate.__doc__
        for default in ["trials: int = 200", "seed: int = 1", "step_s: float = 0.002", "0.02, 0.05, 0.1, 0.2"]:
            self.assertIn(default, said)
        if not PROGRAM:
            return
        help_text = subprocess.run(
            [PROGRAM, "simulate", "--help"], capture_output=True, text=True, check=True
        ).stdout
        for default in ["--trials INT=200", "NONNEGATIVE=1", "TEXT=20,50,100,200", "FLOAT=2 "]:
            self.assertIn(default, help_text)

    def test_what_cannot_be_simulated_is_refused_with_a_sentence(self):
        scene = vicinity.parse_scene(SCENE, self.folder, "cell.yaml")
        (self.folder / "light.urdf").write_text(gantry(inertia=""))
        for says, options in [
            ("no robot", {"robot": None}),
            ("rising", {"methods": ["risng"]}),
            ("delay", {"delays_s": [-5]}),
            ("trials", {"trials": 0}),
            ("time step", {"step_s": 0.05}),
            ("z_slide", {"tool": "z_slid"}),
            ("no inertia", {"robot": self.folder / "light.urdf"}),
            ("nowhere.yaml", {"tasks": self.folder / "nowhere.yaml"}),
        ]:
            with self.assertRaises(vicinity.Error) as raised:
                vicinity.simulate(scene, **{**self.asked, **options})
            self.assertIn(says, str(raised.exception))

    def test_what_progress_raises_stops_the_study(self):
        def progress(what, done):
            if done > 0:
                raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            vicinity.simulate(
                self.folder / "cell.yaml", **self.asked, methods=["none"], progress=progress
            )


if __name__ == "__main__":
    unittest.main()
