# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""Puts what CMake builds into a wheel.

With VICINITY_BUILD set to the folder of a build that has VICINITY_PYTHON on, the wheel is made from
that one; else a build of its own is made, beside setuptools' own files.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
PROJECT = re.search(
    r'project\(vicinity VERSION (?P<version>\S+).*?DESCRIPTION "(?P<description>[^"]+)"',
    (REPOSITORY / "CMakeLists.txt").read_text(),
    re.DOTALL,
)


class BuildByCMake(build_ext):
    def build_extension(self, extension):
        build = os.environ.get("VICINITY_BUILD")
        if build is None:
            build = str(pathlib.Path(self.build_temp).resolve())
            options = ["-DCMAKE_BUILD_TYPE=Release", "-DVICINITY_PYTHON=ON", "-DVICINITY_CLI=OFF"]
            options += ["-DVICINITY_TESTS=OFF", f"-DPython_EXECUTABLE={sys.executable}"]
            subprocess.check_call(["cmake", "-S", REPOSITORY, "-B", build, *options])
        subprocess.check_call(["cmake", "--build", build, "--target", "vicinity_python"])
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).parent
        target.mkdir(parents=True, exist_ok=True)
        for file in (pathlib.Path(build) / "bindings/python/vicinity").iterdir():
            if file.is_file():
                shutil.copy2(file, target)


setup(
    version=PROJECT["version"],
    description=PROJECT["description"],
    packages=[],
    ext_modules=[Extension("vicinity._vicinity", sources=[])],
    cmdclass={"build_ext": BuildByCMake},
)
