# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The folder that a reader of README and docs works in: programs, a mesh, scenes, an arm and its log."""

import math
import pathlib
import re
import shutil

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
BUILT = "build/release/apps/cli/"

# What scripts call to build and to install does neither here: all is built, and a test installs nothing.
DOUBLES = {
    "cmake": "exit 0",
    "sudo": '"$@"',
    "apt-get": 'echo "$*" >>would_install; exit 1',
}


def box_mesh(size, path):
    """An STL of a box in millimetres, as text."""
    x, y, z = (side / 2 for side in size)
    corner = lambda n: (x if n & 1 else -x, y if n & 2 else -y, z if n & 4 else -z)
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    lines = ["solid vessel"]
    for a, b, c, d in sides:
        for triangle in ((a, b, c), (a, c, d)):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex {} {} {}".format(*corner(n)) for n in triangle]
            lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid vessel"]) + "\n")


def joint_log(path):
    joints = [f"joint_{n}" for n in range(1, 8)]
    lines = ["t," + ",".join(joints) + ",Time,Position1"]
    for ms in range(0, 500):
        angles = [0.1 * math.sin(0.01 * ms + n) for n in range(7)]
        row = [0.001 * ms, *angles, ms, angles[0]]
        lines.append(",".join(f"{number:.6f}" for number in row))
    path.write_text("\n".join(lines) + "\n")


def dds_on_this_machine(document):
    """The configuration that a document shows, for the loopback address in place of its own."""
    text = document.read_text(encoding="utf-8")
    (shown,) = re.findall(r"^```xml\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    return re.sub(r"\d+\.\d+\.\d+\.\d+", "127.0.0.1", shown.replace("eth0", "lo"))


def make(folder, program):
    """All that is there before the first command. `program` is the vicinity that was built."""
    (folder / BUILT).mkdir(parents=True)
    (folder / BUILT / "vicinity").symlink_to(program)
    (folder / "build/release/tests").symlink_to(program.parents[2] / "tests")
    (folder / "scenes").symlink_to(REPOSITORY / "scenes")
    (folder / "scripts").symlink_to(REPOSITORY / "scripts")
    (folder / "doubles").mkdir()
    for name, does in DOUBLES.items():
        (folder / "doubles" / name).write_text(f"#!/bin/sh\n{does}\n")
        (folder / "doubles" / name).chmod(0o755)
    box_mesh((300, 300, 1000), folder / "vessel.stl")
    shutil.copy(REPOSITORY / "scenes/hot_cell_arm.urdf", folder / "arm.urdf")
    for name in ("cell.yaml", "scene.yaml"):
        (folder / name).write_text(
            "voxel_size: 0.01\nobjects:\n"
            "  - {name: vessel, mesh: vessel.stl, units: mm, pose: {xyz: [0.7, 0, 0.9]}}\n"
            "robot: {urdf: arm.urdf, base: {xyz: [0, 0, 0.8]}, points_per_m2: 500}\n"
        )
    joint_log(folder / "log.csv")
    for side in ("master", "slave"):
        configuration = dds_on_this_machine(REPOSITORY / "docs/bridge.md")
        (folder / f"{side}.xml").write_text(configuration)
