# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""What a query of many points costs from Python, beside the loop that a C++ program would write.

    PYTHONPATH=build/release/bindings/python /usr/bin/python3 \
        benchmarks/python_query/python_query.py build/release/benchmarks/libpython_query_loop.so \
        scenes/hot_cell.yaml [--points N] [--rounds N]

Both ask one field the same points, turn by turn in one process, and keep every answer. Prints the
median of each and of the ratios of neighbouring turns, in time of the processor (both use one
thread, and other work on the machine does not count), for points at random and along lines, for
ranks and for kept distances.
"""

import argparse
import ctypes
import pathlib
import statistics
import tempfile
import time

import numpy as np

import vicinity


def timed(step):
    start = time.thread_time()
    step()
    return time.thread_time() - start


def points_in(field, count, along_lines):
    generator = np.random.default_rng(7)
    low = field.workspace.origin
    high = low + field.workspace.voxel_size * np.array(field.workspace.dims)
    if not along_lines:
        return generator.uniform(low, high, (count, 3))
    ends = generator.uniform(low, high, (2, count // 1000, 1, 3))
    way = np.linspace(0, 1, 1000)[:, None]
    return np.ascontiguousarray((ends[0] + way * (ends[1] - ends[0])).reshape(-1, 3))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("loop")
    parser.add_argument("scene")
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=15)
    arguments = parser.parse_args()

    loop = ctypes.CDLL(str(pathlib.Path(arguments.loop).resolve()))
    loop.loop_open.restype = ctypes.c_void_p
    loop.loop_query.restype = ctypes.c_double
    loop.loop_query.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t]
    loop.loop_close.argtypes = [ctypes.c_void_p]
    print(f"{arguments.points} points, {arguments.rounds} rounds; ns a point")
    print("layers    points     C++   Python  rate of Python / rate of C++")
    for layers in ("ranks", "distance"):
        scene = vicinity.read_scene(arguments.scene)
        if layers == "distance":
            for each in scene.objects:
                each.layers = vicinity.LayerShape.distance
        field = vicinity.build_field(scene).field
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "field"
            vicinity.save_field(field, path)
            field = vicinity.open_field(path)
            in_cpp = loop.loop_open(str(path).encode())
        for along_lines in (False, True):
            points = points_in(field, arguments.points, along_lines)
            assert np.isclose(
                field.query(points).viscosity.sum(),
                loop.loop_query(in_cpp, points.ctypes.data, len(points)),
                rtol=1e-9,
            )
            cpp, python = [], []
            for _ in range(arguments.rounds):
                cpp.append(timed(lambda: loop.loop_query(in_cpp, points.ctypes.data, len(points))))
                python.append(timed(lambda: field.query(points)))
            ratio = statistics.median(c / p for c, p in zip(cpp, python))
            ns = [1e9 * statistics.median(times) / len(points) for times in (cpp, python)]
            where = "in lines" if along_lines else "random"
            print(f"{layers:9} {where:8} {ns[0]:6.1f}   {ns[1]:6.1f}  {ratio:.2f}")
        loop.loop_close(in_cpp)


if __name__ == "__main__":
    main()
