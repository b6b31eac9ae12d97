# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The field as numpy sees it."""

import importlib.util
import json
import pathlib
import sys
import tempfile
import threading
import tracemalloc
import unittest

import numpy as np

import vicinity

NEIGHBOUR, INNER = vicinity.VoxelKind.neighbour, vicinity.VoxelKind.inner


def block(**layers):
    return vicinity.SceneObject("block", vicinity.primitive.box([0.2, 0.2, 0.2]), **layers)


def field_of(*objects):
    return vicinity.build_field(vicinity.Scene(objects, voxel_size=0.01)).field


def points_around(field, count, seed=5):
    low = field.workspace.origin
    high = low + field.workspace.voxel_size * np.array(field.workspace.dims)
    return np.random.default_rng(seed).uniform(low - 0.02, high + 0.02, (count, 3))


class Queries(unittest.TestCase):
    def test_many_points_are_answered_as_the_voxels_that_hold_them(self):
        field = field_of(block(m=2, q=3))
        points = points_around(field, 20_000)
        found = field.query(points)
        grid = (points - field.workspace.origin) / field.workspace.voxel_size
        voxels = np.floor(grid).astype(int)
        inside = ((voxels >= 0) & (voxels < field.workspace.dims)).all(axis=1)
        self.assertTrue(0 < np.count_nonzero(~inside) < len(points))
        code = np.full(len(points), -1)
        code[inside] = field.voxels()[tuple(voxels[inside].T)]
        ranks = np.where(found.kind == NEIGHBOUR, found.rank, 0)
        np.testing.assert_array_equal(ranks, np.maximum(code, 0))
        np.testing.assert_array_equal(found.kind == INNER, code == -2)
        np.testing.assert_array_equal(found.kind == vicinity.VoxelKind.empty, code == -1)
        np.testing.assert_array_equal(found.object, np.where(code == -1, -1, 0))
        mu = np.array([100, *field.objects[0].coding.mu[:3], 100, 0])  # -2 and -1 from the end
        np.testing.assert_array_equal(found.viscosity, mu[code])
        np.testing.assert_array_equal(found.distance_m, -1)

    def test_kept_distances_are_never_more_than_the_true_ones(self):
        field = field_of(block(layers=vicinity.LayerShape.distance))
        points = points_around(field, 20_000)
        found = field.query(points)
        outside = np.maximum(np.abs(points) - 0.1, 0)
        true = np.linalg.norm(outside, axis=1)
        near = found.kind == NEIGHBOUR
        self.assertTrue(field.keeps_distance and near.any())
        self.assertTrue((found.distance_m[near] <= true[near] + 1e-12).all())
        self.assertTrue((found.distance_m[near] >= true[near] - 2 * 0.01).all())

    def test_any_array_of_points_gets_the_same_answer(self):
        field = field_of(block())
        points = points_around(field, 500)
        expected = field.query(points).viscosity
        wide = np.zeros((500, 7))
        wide[:, 2:5] = points
        odd = np.frombuffer(b"x" + points.tobytes(), np.uint8)[1:].view(np.float64).reshape(-1, 3)
        fortran, swapped = np.asfortranarray(points), points.astype(">f8")
        for same in (fortran, wide[:, 2:5], swapped, points.tolist(), odd):
            np.testing.assert_array_equal(field.query(same).viscosity, expected)
        self.assertEqual(field.query(np.empty((0, 3))).kind.shape, (0,))

    def test_what_is_no_list_of_points_is_refused(self):
        field = field_of(block())
        for wrong in (np.zeros(3), np.zeros((3, 2)), np.zeros((2, 3, 3)), 1.0):
            with self.assertRaises(vicinity.Error) as raised:
                field.query(wrong)
            self.assertIn("(N, 3)", raised.exception.expected)
        with self.assertRaises(TypeError):
            field.query("here")

    def test_points_that_are_not_finite_are_in_empty_space(self):
        found = field_of(block()).query([[np.nan, 0, 0], [0, np.inf, 0], [0, 0, -1e300]])
        self.assertEqual((found.kind.tolist(), found.viscosity.tolist()), ([0] * 3, [0.0] * 3))

    def test_points_are_read_where_they_lie(self):
        field = field_of(block())
        points = points_around(field, 1_000_000)
        tracemalloc.start()
        found = field.query(points)
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        parts = (found.kind, found.object, found.rank, found.viscosity, found.distance_m)
        answers = sum(part.nbytes for part in parts)
        self.assertLess(most, answers + points.nbytes // 10)

    def test_a_query_lets_other_threads_run(self):
        field = field_of(block())
        points = points_around(field, 1_000_000)
        ended = []

        def query():
            field.query(points)
            ended.append(True)

        interval = sys.getswitchinterval()
        sys.setswitchinterval(1000)  # so that a thread runs on until it gives the lock up itself
        try:
            thread = threading.Thread(target=query)
            thread.start()
            went_on_meanwhile = not ended
            thread.join()
        finally:
            sys.setswitchinterval(interval)
        self.assertTrue(went_on_meanwhile)

    def test_other_codings_need_no_other_build(self):
        field = field_of(block(m=2, q=3))
        points = points_around(field, 1000)
        recoded = field.with_codings([vicinity.Coding([3, 2, 1], skin=7)])
        found = recoded.query(points)
        near = found.kind == NEIGHBOUR
        np.testing.assert_array_equal(found.viscosity[near], 4 - found.rank[near])
        self.assertEqual(field.objects[0].coding.skin, 100)
        with self.assertRaises(vicinity.Error):
            field.with_codings([])


class Traces(unittest.TestCase):
    def test_drag_is_viscosity_times_area_times_velocity_backwards(self):
        field = field_of(block())
        felt = vicinity.trace(field, [0.4, 0, 0], [0.1, 0, 0], speed=0.2, rate=500, area=3e-4)
        self.assertEqual(felt.p_WR.shape, (751, 3))
        np.testing.assert_array_equal(felt.mu, field.query(felt.p_WR).viscosity)
        np.testing.assert_allclose(felt.force_W[:, 0], felt.mu_e * 3e-4 * 0.2, rtol=1e-12)
        np.testing.assert_array_equal(felt.force_W[:, 1:], 0)

    def test_a_path_feels_what_the_straight_track_along_it_feels(self):
        field = field_of(block())
        options = {"rate": 500, "memory": "fading", "direction": vicinity.DragDirection.closing}
        track = vicinity.trace(field, [0.4, 0, 0], [0.1, 0, 0], speed=0.2, **options)
        path = vicinity.trace(field, track.p_WR, **options)
        np.testing.assert_array_equal(path.mu_e, track.mu_e)
        np.testing.assert_allclose(path.force_W[1:], track.force_W[1:], atol=1e-9)
        np.testing.assert_array_equal(path.force_W[0], 0)

    def test_tracks_that_cannot_be_are_refused(self):
        field = field_of(block())
        for arguments, options in [
            (([0, 0, 0], [1, 0, 0]), {"speed": 0}),
            (([0, 0, np.nan], [1, 0, 0]), {}),
            (([[0, 0, 0], [np.inf, 0, 0]],), {}),
            (([0, 0, 0], [1, 0, 0]), {"memory": "elephant"}),
        ]:
            with self.assertRaises(vicinity.Error):
                vicinity.trace(field, *arguments, **options)


class Exports(unittest.TestCase):
    def test_an_exported_array_is_the_array_itself(self):
        field = field_of(block(layers=vicinity.LayerShape.distance))
        box = [[-0.15, -0.05, 0], [0.15, 0.05, 0.2]]
        with tempfile.TemporaryDirectory() as folder:
            kinds = {"rank": "i2", "viscosity": "f4", "object": "i2", "distance": "f4"}
            for what, kind in kinds.items():
                quantity = vicinity.VoxelQuantity.__members__[what]
                path = pathlib.Path(folder) / f"{what}.npy"
                shares = []
                vicinity.export_field(field, path, quantity, box, lambda _, done: shares.append(done))
                loaded = np.load(path)
                self.assertEqual((loaded.dtype, loaded.shape), (np.dtype(kind), (30, 10, 20)))
                np.testing.assert_array_equal(loaded, field.voxels(quantity, box))
                self.assertEqual(shares[-1], 1)
                beside = json.loads(path.with_suffix(".json").read_text())
                np.testing.assert_allclose(beside["origin"], box[0], atol=1e-12)
            vicinity.export_field(field, pathlib.Path(folder) / "ranks.vti")
            left = {path.suffix for path in pathlib.Path(folder).iterdir()}
            self.assertEqual(left, {".npy", ".json", ".vti"})

    @unittest.skipUnless(importlib.util.find_spec("pyopenvdb"), "python3-openvdb is not installed")
    def test_openvdb_reads_ranks_and_viscosities_where_nothing_else_is_asked_for(self):
        import pyopenvdb

        field = field_of(block(m=2, q=3))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "ranks.vdb"
            try:
                vicinity.export_field(field, path)
            except vicinity.Error as error:
                self.assertIn("without OpenVDB", error.what)
                self.skipTest(str(error))
            for what in (vicinity.VoxelQuantity.rank, vicinity.VoxelQuantity.viscosity):
                values = np.zeros(field.workspace.dims, np.float32)
                pyopenvdb.read(str(path), what.name).copyToArray(values)
                np.testing.assert_array_equal(values, field.voxels(what))

    def test_what_cannot_be_exported_is_refused_and_leaves_nothing(self):
        field = field_of(block())
        with tempfile.TemporaryDirectory() as folder:
            for name, options in [
                ("ranks.obj", {}),
                ("ranks.npy", {"box": [[5, 5, 5], [6, 6, 6]]}),
                ("ranks.npy", {"box": [[1, 1, 1], [0, 0, 0]]}),
                ("ranks.npy", {"what": vicinity.VoxelQuantity.distance}),
                ("none/ranks.npy", {}),
            ]:
                with self.assertRaises(vicinity.Error):
                    vicinity.export_field(field, pathlib.Path(folder) / name, **options)
            with self.assertRaises(vicinity.Error):
                field.voxels(vicinity.VoxelQuantity.distance)
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [])


if __name__ == "__main__":
    unittest.main()
