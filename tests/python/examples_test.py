# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The examples, and the lines in README and docs, run as they stand; type checked where mypy is there."""

import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import vicinity

REPOSITORY = pathlib.Path(__file__).parents[2]
EXAMPLES = REPOSITORY / "examples" / "python"
PACKAGE = pathlib.Path(vicinity.__file__).parent


def shown():
    """The Python that README and docs show."""
    for document in [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").glob("*.md"))]:
        text = document.read_text(encoding="utf-8")
        yield from re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


class Examples(unittest.TestCase):
    def run_file(self, path, *arguments, folder):
        done = subprocess.run(
            [sys.executable, "-B", "-W", "error", path, *arguments],
            cwd=folder,
            capture_output=True,
            text=True,
        )
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout

    def run_example(self, name, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            return self.run_file(EXAMPLES / name, *arguments, folder=folder)

    def test_a_query_of_a_million_points_finds_every_rank_in_its_place(self):
        text = self.run_example("01_build_and_query.py")
        reach = [int(mm) for mm in re.findall(r"rank \d: up to (\d+) mm", text)]
        self.assertEqual(len(reach), 6)
        self.assertEqual(reach, sorted(reach))
        self.assertLess(reach[-1], 6 * 4 * 5 + 15)  # q m h, and what lies within a voxel

    def test_an_approach_is_heavy_both_ways_unless_only_closing_counts(self):
        text = self.run_example("02_approach.py")
        lines = re.findall(r"(\w+) +at most ([\d.]+) mN.*?, ([\d.]+) out", text)
        felt = {name: (float(coming), float(going)) for name, coming, going in lines}
        self.assertGreater(felt["all"][1], 0)
        self.assertGreater(felt["closing"][0], 0)
        self.assertEqual(felt["closing"][1], 0)

    def test_a_logged_motion_is_ticked_from_end_to_end(self):
        text = self.run_example("03_tick_a_logged_motion.py")
        self.assertIn("2000 ticks, 0 refused", text)
        self.assertRegex(text, r"half-way: forearm near (post|bench), \d+ mm at least")
        self.assertIn("passive: True", text)

    def test_a_slice_is_a_picture_that_is_dark_on_the_surface(self):
        with tempfile.TemporaryDirectory() as folder:
            self.run_file(EXAMPLES / "04_slice_picture.py", folder=folder)
            data = (pathlib.Path(folder) / "slice.ppm").read_bytes()
            header, pixels = data.split(b"\n", 1)
            magic, width, height, most = header.split()
            self.assertEqual((magic, most), (b"P6", b"255"))
            picture = np.frombuffer(pixels, np.uint8).reshape(int(height), int(width), 3)
            self.assertTrue((picture == 40).all(axis=2).any() and (picture[0, 0] == 255).all())

    def test_readme_and_docs_show_what_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "shown.py"
            printed = ""
            for block in shown():
                path.write_text(block, encoding="utf-8")
                printed += self.run_file(path, folder=folder)
            self.assertIn("rank", printed)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_stubs_and_examples_are_type_correct(self):
        with tempfile.TemporaryDirectory() as cache:
            mypy = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", cache]
            files = sorted(PACKAGE.glob("*.pyi")) + sorted(EXAMPLES.glob("*.py"))
            done = subprocess.run([*mypy, *files], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
