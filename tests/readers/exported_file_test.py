# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""What `vicinity export` writes, opened by the program it is written for: nothing of ours is in here.

    exported_file_test.py PROGRAM KIND READER [PICTURE.pgm]

KIND: npy (numpy), vdb (OpenVDB) or vti (VTK, in JavaScript, which the folder READER has). Every value
is held against what `vicinity query` says at the voxel's centre. Leaves a picture of one slice where
asked. Exits with 77 where the reader is not installed.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77
MISSING = "skipped: {}; scripts/install_packages.sh --readers --viewer installs it"
try:
    import numpy as np
except ImportError as missing:
    print(MISSING.format(missing))
    sys.exit(SKIPPED)

SCENE = """voxel_size: 0.02
objects:
  - name: post
    primitive: {cylinder: {radius: 0.05, height: 0.2}}
    m: 2
    q: 3
  - name: ball
    primitive: {sphere: {radius: 0.06}}
    pose: {xyz: [0.21, 0.13, 0.07]}
    m: 1
    q: 4
"""


def from_numpy(path, _):
    beside = json.loads(path.with_suffix(".json").read_text())
    return np.load(path), np.array(beside["origin"]), beside["voxel_size"]


def from_openvdb(path, _):
    import pyopenvdb

    rank, metadata = pyopenvdb.read(str(path), "rank"), pyopenvdb.readAllGridMetadata(str(path))
    assert {grid.name for grid in metadata} == {"rank", "viscosity"}, metadata
    low, high = rank.evalActiveVoxelBoundingBox()
    values = np.full([b + 2 - a for a, b in zip((0, 0, 0), high)], rank.background, np.float32)
    assert min(low) >= 0, low
    rank.copyToArray(values)
    size = rank.transform.voxelSize()[0]
    return values.astype(np.int16), np.array(rank.transform.indexToWorld((-0.5, -0.5, -0.5))), size


def from_vtk(path, reader):
    script = pathlib.Path(reader) / "read.mjs"
    if not script.exists():
        raise ImportError("npm did not install VTK for JavaScript")
    done = subprocess.run(["node", script, path], check=True, capture_output=True, text=True)
    image = json.loads(done.stdout)
    values = np.array(image["rank"]).reshape(image["cells"][::-1]).transpose()
    return values, np.array(image["origin"]), image["spacing"][0]


READERS = {"npy": from_numpy, "vdb": from_openvdb, "vti": from_vtk}


def draw(values, path):
    """The middle slice, surfaces dark and layers from dark to light, ten pixels a voxel."""
    cut = np.flipud(values[:, :, values.shape[2] // 2].T)
    shade = np.where(cut == -2, 90, np.where(cut == -1, 255, np.where(cut == 0, 0, 110 + 30 * cut)))
    pixels = np.kron(shade, np.ones((10, 10), int)).clip(0, 255).astype(np.uint8)
    pathlib.Path(path).write_bytes(
        b"P5 %d %d 255\n" % (pixels.shape[1], pixels.shape[0]) + pixels.tobytes()
    )


def main(program, kind, reader, picture=None):
    with tempfile.TemporaryDirectory() as folder:

        def run(*words, **more):
            command = [program, *words]
            options = {"cwd": folder, "check": True, "capture_output": True, "text": True}
            return subprocess.run(command, **options, **more).stdout

        (pathlib.Path(folder) / "scene.yaml").write_text(SCENE)
        run("build", "scene.yaml", "-o", "f.vicinity")
        run("export", "f.vicinity", "-o", f"f.{kind}")
        try:
            values, origin, size = READERS[kind](pathlib.Path(folder) / f"f.{kind}", reader)
        except ImportError as missing:
            print(MISSING.format(missing))
            return SKIPPED
        values = np.asarray(values)
        voxels = np.argwhere(np.ones(values.shape, bool))
        centres = origin + size * (voxels + 0.5)
        text = "".join(f"{x:.9f},{y:.9f},{z:.9f}\n" for x, y, z in centres)
        said = [json.loads(line) for line in run("query", "f.vicinity", "--json", input=text).splitlines()]
    codes = {"boundary": 0, "empty": -1, "inner": -2}
    expected = np.array([codes.get(one["kind"], one["rank"]) for one in said]).reshape(values.shape)
    np.testing.assert_array_equal(values, expected)
    assert set(np.unique(values)) == {-2, -1, 0, 1, 2, 3, 4}, np.unique(values)
    print(f"{kind}: {values.size} voxels as vicinity query has them")
    if picture:
        draw(values, picture)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
