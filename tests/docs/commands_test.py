# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The commands that README and docs show are run as they stand, in a workplace made for them.

    commands_test.py PROGRAM

What is not run is listed below with the reason; of that, and of commands within sentences, at least
every option is one that the program has. Real data is looked for in VICINITY_DATA.
"""

import functools
import json
import math
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("VICINITY_DATA", "")).resolve()
DOCUMENTS = [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").glob("*.md"))]

# How a command that is not run begins, and why.
NOT_RUN = [
    (r"scripts/", "installs packages, builds or measures for minutes: CI is scripts/test.sh itself"),
    (r"cmake --preset", "builds all of it anew"),
    (r"(\S*/)?vicinity serve ", "serves until Ctrl-C: tests/viewer drives it"),
    (r"(\S*/)?vicinity bridge ", "bridges until Ctrl-C: tests/bridge drives it"),
    (r"pip wheel |python3 -m venv |venv/bin/pip ", "tests/python/wheel_test.py does just that"),
    (r"VICINITY_STORM=", "takes minutes; viewer_test runs it shorter"),
    (r"\(cd apps/viewer/page ", "measures in a browser"),
]
# What takes minutes as it stands, and how it is made short.
SHORTER = [
    ("vicinity simulate --demo -o study", "vicinity simulate --demo --trials 1 --method none -o study"),
    ("--trials 50 --method none,closing,rising", "--trials 1 --method none"),
    ("--voxel-size 0.01 ", "--voxel-size 0.02 "),
]
NEEDS_DATA = "$DATA"
BUILT = "build/release/apps/cli/"


def blocks(document, language):
    text = document.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def commands(block):
    """Whole commands: lines that are continued, and loops to their end, are one."""
    whole, depth = "", 0
    for line in block.splitlines():
        whole += line + "\n"
        depth += len(re.findall(r"^\s*for ", line)) - len(re.findall(r"\bdone\b", line))
        if line.rstrip().endswith("\\") or depth > 0:
            continue
        if whole.strip() and not whole.lstrip().startswith("#"):
            yield whole
        whole = ""
    assert not whole.strip(), f"not a whole command: {whole}"


def why_not_run(command):
    return next((why for start, why in NOT_RUN if re.match(start, command)), None)


@functools.cache
def options_of(*words):
    done = subprocess.run([PROGRAM, *words, "--help"], capture_output=True, text=True)
    return re.findall(r"-{1,2}[a-z][\w-]*", done.stdout) if done.returncode == 0 else None


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


def workplace(folder):
    """What a reader has before the first command: a mesh, a scene, an arm and a log of it."""
    program = folder / BUILT
    program.mkdir(parents=True)
    (program / "vicinity").symlink_to(PROGRAM)
    (folder / "scenes").symlink_to(REPOSITORY / "scenes")
    box_mesh((300, 300, 1000), folder / "vessel.stl")
    (folder / "cell.yaml").write_text(
        "voxel_size: 0.01\nobjects:\n"
        "  - {name: vessel, mesh: vessel.stl, units: mm, pose: {xyz: [0.7, 0, 0.9]}}\n"
    )
    shutil.copy(REPOSITORY / "scenes/hot_cell_arm.urdf", folder / "arm.urdf")
    joints = [f"joint_{n}" for n in range(1, 8)]
    lines = ["t," + ",".join(joints) + ",Time,Position1"]
    for ms in range(0, 500):
        angles = [0.1 * math.sin(0.01 * ms + n) for n in range(7)]
        row = [0.001 * ms, *angles, ms, angles[0]]
        lines.append(",".join(f"{number:.6f}" for number in row))
    (folder / "log.csv").write_text("\n".join(lines) + "\n")


class Documents(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        workplace(self.folder)
        self.environment = {
            **os.environ,
            "PATH": f"{self.folder / BUILT}:{os.environ['PATH']}",
            "DATA": str(DATA),
        }

    def run_in_workplace(self, script):
        return subprocess.run(
            ["bash", "-euc", script],
            cwd=self.folder,
            env=self.environment,
            capture_output=True,
            text=True,
        )

    def test_every_block_of_commands_runs(self):
        ran, seen = 0, set()
        for document in DOCUMENTS:
            for block in blocks(document, "sh"):
                if NEEDS_DATA in block and not (DATA / "scenes").is_dir():
                    print(f"not run, no real data in VICINITY_DATA: {block.split(maxsplit=4)[:3]}")
                    continue
                script = ""
                for command in commands(block):
                    for usual, short in SHORTER:
                        command = command.replace(usual, short)
                    words = " ".join(re.sub(r"\s#.*", "", command).split()).removeprefix(BUILT)
                    if not why_not_run(command) and words not in seen:
                        script += command
                    seen.add(words)
                if not script:
                    continue
                if "cell.vicinity" in script and not (self.folder / "cell.vicinity").exists():
                    build = "vicinity build cell.yaml -o cell.vicinity"
                    script = script if build in script else f"{build}\n{script}"
                for command in commands(script):
                    self.assertRegex(command, r"^(\S*/)?vicinity |^columns=|^for |^\n*$", document.name)
                done = self.run_in_workplace(script)
                if "built without the simulation" in done.stderr:
                    continue
                self.assertEqual(done.returncode, 0, f"{document.name}\n{script}\n{done.stderr}")
                ran += 1
        self.assertGreaterEqual(ran, 4)

    def test_every_option_that_is_shown_is_there(self):
        shown = []
        for document in DOCUMENTS:
            text = document.read_text(encoding="utf-8")
            text = re.sub(r"^```(?!sh).*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
            shown += re.findall(rf"`((?:{BUILT})?vicinity [a-z][^`]*)`", text)
            shown += [c for block in blocks(document, "sh") for c in commands(block)]
        asked = 0
        for command in shown:
            for call in re.findall(r"(?:^|[\s/])vicinity ((?:[^\n\\]|\\\n)+)", command):
                words = shlex.split(call.replace("\\\n", " "), comments=True)
                known = options_of(words[0])
                if known is None and words[0] in ("serve", "bridge"):
                    continue  # this build is without it
                self.assertIsNotNone(known, command)
                if words[0] == "bench":
                    known = options_of(*words[:2])
                for word in words:
                    if re.match(r"-{1,2}[a-z]", word):
                        self.assertIn(word.split("=")[0], known, command)
                asked += 1
        self.assertGreater(asked, 15)

    def test_every_line_of_cpp_is_one_of_an_example_that_is_compiled(self):
        examples = sorted((REPOSITORY / "examples").glob("*/main.cpp"))
        lines = {line.strip() for e in examples for line in e.read_text().splitlines()}
        for document in DOCUMENTS:
            for block in blocks(document, "cpp"):
                for line in block.splitlines():
                    if line.strip():
                        self.assertIn(line.strip(), lines, document.name)

    def test_every_json_is_json(self):
        for document in DOCUMENTS:
            for block in blocks(document, "json"):
                json.loads(block)

    def test_every_block_is_of_a_kind_that_is_looked_at(self):
        for document in DOCUMENTS:
            text = document.read_text(encoding="utf-8")
            kinds = re.findall(r"^```(\w*)\n.*?^```", text, re.DOTALL | re.MULTILINE)
            # Python is run by tests/python/examples_test.py; yaml and xml are other programs' own.
            self.assertLessEqual(set(kinds), {"sh", "cpp", "python", "json", "xml", "yaml", ""})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
