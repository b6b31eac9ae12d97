# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The wheel installs into a clean environment, works there, and leaves again."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

BINDINGS = pathlib.Path(__file__).parents[2] / "bindings" / "python"
USE = """
import vicinity
ball = vicinity.SceneObject("ball", vicinity.primitive.sphere(0.1))
field = vicinity.build_field(vicinity.Scene([ball], voxel_size=0.01)).field
print(vicinity.__version__, vicinity.__file__, field.query([[0.12, 0, 0]]).rank[0])
"""


def run(*command, **environment):
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(command, capture_output=True, text=True, env={**clean, **environment})
    if done.returncode != 0:
        raise AssertionError(f"{command}\n{done.stdout}{done.stderr}")
    return done.stdout


class Wheel(unittest.TestCase):
    def test_it_is_built_installed_used_and_removed(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            source = folder / "repository" / "bindings" / "python"
            shutil.copytree(BINDINGS, source)  # setuptools writes beside what it builds
            shutil.copy2(BINDINGS.parents[1] / "CMakeLists.txt", folder / "repository")
            pip = ["-m", "pip", "--disable-pip-version-check"]
            wheel = ["wheel", "--no-index", "--no-build-isolation", "--no-deps", "-w", scratch]
            run(sys.executable, *pip, *wheel, str(source))
            (wheel,) = folder.glob("vicinity-*.whl")
            with zipfile.ZipFile(wheel) as archive:
                names = {name for name in archive.namelist() if name.startswith("vicinity/")}
            plain = ("__init__.py", "__init__.pyi", "primitive.pyi", "py.typed")
            self.assertTrue({f"vicinity/{name}" for name in plain} <= names, names)
            self.assertEqual(len(names), len(plain) + 1, names)  # and the module

            # Debian's numpy is looked through to: there is no index to fetch another from.
            run(sys.executable, "-m", "venv", "--system-site-packages", str(folder / "venv"))
            python = str(folder / "venv" / "bin" / "python")
            run(python, *pip, "install", "-q", "--no-index", str(wheel))
            version, place, rank = run(python, "-c", USE).split()
            self.assertTrue(place.startswith(str(folder / "venv")), place)
            self.assertEqual((version, rank), (wheel.name.split("-")[1], "1"))
            run(python, *pip, "uninstall", "-q", "-y", "vicinity")
            with self.assertRaisesRegex(AssertionError, "No module named 'vicinity'"):
                run(python, "-c", USE)


if __name__ == "__main__":
    unittest.main()
