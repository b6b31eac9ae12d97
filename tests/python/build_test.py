# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes, scenes and builds from Python."""

import os
import pathlib
import signal
import tempfile
import threading
import unittest

import numpy as np

import vicinity

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
CUBE_SIDES = [
    [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
]  # fmt: skip


def post(**layers):
    return vicinity.SceneObject("post", vicinity.primitive.cylinder(0.05, 0.3), **layers)


def endless_scene():
    """A build that ends within a test only where it is stopped."""
    ball = vicinity.SceneObject("ball", vicinity.primitive.sphere(1.0), m=8, q=6)
    return vicinity.Scene([ball], voxel_size=0.001)


class Meshes(unittest.TestCase):
    def test_arrays_become_a_mesh_that_shows_them_without_copies(self):
        mesh = vicinity.TriangleMesh(CUBE, CUBE_SIDES)
        np.testing.assert_array_equal(mesh.vertices, CUBE)
        np.testing.assert_array_equal(mesh.triangles, CUBE_SIDES)
        self.assertTrue(np.shares_memory(mesh.vertices, mesh.vertices))
        self.assertFalse(mesh.vertices.flags.writeable)
        vertices = mesh.vertices
        del mesh
        np.testing.assert_array_equal(vertices, CUBE)  # the view keeps its mesh alive

    def test_inspection_finds_the_hole_that_a_missing_side_leaves(self):
        Verdict = vicinity.MeshInspection.Verdict
        whole = vicinity.inspect(vicinity.TriangleMesh(CUBE, CUBE_SIDES))
        self.assertEqual((whole.verdict, whole.closed, whole.shells), (Verdict.ok, True, 1))
        np.testing.assert_array_equal(whole.bounds, [[0, 0, 0], [1, 1, 1]])
        holed = vicinity.inspect(vicinity.TriangleMesh(CUBE, CUBE_SIDES[1:]))
        self.assertEqual((holed.verdict, holed.open_edges), (Verdict.usable, 3))
        self.assertIn("open edges", [problem.what for problem in holed.problems])

    def test_arrays_that_are_no_mesh_are_refused(self):
        for vertices, triangles in [
            (CUBE[:, :2], CUBE_SIDES),
            (CUBE, [[0, 1]]),
            (CUBE, [[0, 1, 8]]),
            (CUBE, [[0, 1, -1]]),
        ]:
            with self.assertRaises(vicinity.Error):
                vicinity.TriangleMesh(vertices, triangles)


class Errors(unittest.TestCase):
    def test_an_error_is_the_sentence_of_the_core_and_its_parts(self):
        with self.assertRaises(vicinity.Error) as raised:
            vicinity.named_coding("linaer", 6)
        error = raised.exception
        self.assertIsInstance(error, ValueError)
        sentence = f"{error.where}: {error.what}" if error.where else error.what
        if error.found:
            sentence += f"; found {error.found}"
        if error.expected:
            sentence += (", " if error.found else "; ") + f"expected {error.expected}"
        if error.hint:
            sentence += f"; try {error.hint}"
        self.assertEqual(str(error), sentence)
        self.assertIn("linaer", sentence)
        self.assertIn("linear", sentence)

    def test_a_scene_file_that_cannot_be_used_names_its_line(self):
        with self.assertRaises(vicinity.Error) as raised:
            vicinity.parse_scene("voxel_size: 0.01\nobjekts: []\n", ".", "cell.yaml")
        self.assertIn("cell.yaml", raised.exception.where)
        self.assertIn("objects", str(raised.exception))

    def test_a_shape_that_was_seen_outlives_the_one_that_takes_its_place(self):
        item = vicinity.SceneObject("a", vicinity.MeshFile("/a/" + "x" * 200))
        file = item.shape
        item.shape = vicinity.primitive.sphere(1.0)
        self.assertEqual(str(file.path), "/a/" + "x" * 200)
        vertices = item.shape.vertices
        before = vertices.copy()
        item.shape = vicinity.primitive.box([1, 1, 1])
        np.testing.assert_array_equal(vertices, before)
        self.assertEqual(item.shape.vertices.shape, (8, 3))

    def test_a_pose_that_is_not_rigid_is_refused(self):
        with self.assertRaises(vicinity.Error):
            post(X_WO=2 * np.eye(4))
        mirrored = np.diag([1.0, 1, -1, 1])
        with self.assertRaises(vicinity.Error):
            post(X_WO=mirrored)

    def test_what_is_no_object_is_no_part_of_a_scene(self):
        with self.assertRaises(TypeError):
            vicinity.build_field(vicinity.Scene(["post"]))


class Builds(unittest.TestCase):
    def test_a_scene_file_and_the_same_scene_in_python_give_the_same_bytes(self):
        text = (
            "voxel_size: 0.01\n"
            "objects:\n"
            "  - name: post\n"
            "    primitive: {cylinder: {radius: 0.05, height: 0.3}}\n"
            "    pose: {xyz: [0.1, 0.2, 0.3], rpy: [0.1, 0, 0]}\n"
        )
        read = vicinity.parse_scene(text, ".", "text")
        self.assertEqual([o.name for o in read.objects], ["post"])
        self.assertIsNone(read.robot)
        made = vicinity.Scene(voxel_size=0.01)
        made.objects.append(post(X_WO=vicinity.pose_from_rpy([0.1, 0.2, 0.3], [0.1, 0, 0])))
        images = [vicinity.build_field(scene).field.image for scene in (read, made)]
        np.testing.assert_array_equal(*images)

    def test_objects_are_changed_in_place_and_a_builder_does_again_only_what_changed(self):
        scene = vicinity.Scene([post(m=2)], bounds=[[-0.3, -0.3, -0.4], [0.3, 0.3, 0.4]])
        ball = vicinity.SceneObject("ball", vicinity.primitive.sphere(0.05), m=2)
        scene.objects.append(ball)
        builder = vicinity.FieldBuilder()
        self.assertEqual(builder.build(scene).report.objects_ranked, 2)
        ball.X_WO = vicinity.pose_from_rpy([0.1, 0, 0], [0, 0, 0])
        moved = builder.build(scene)
        self.assertEqual(moved.report.objects_ranked, 1)
        np.testing.assert_array_equal(moved.field.image, vicinity.build_field(scene).field.image)

    def test_progress_never_falls_ends_whole_and_comes_in_the_callers_thread(self):
        told, threads = [], set()

        def progress(stage, done):
            told.append((stage, done))
            threads.add(threading.get_ident())

        vicinity.build_field(vicinity.Scene([post()], voxel_size=0.002), progress=progress)
        shares = [done for _, done in told]
        self.assertEqual(shares, sorted(shares))
        self.assertEqual(told[-1], ("merge", 1.0))
        self.assertEqual(threads, {threading.get_ident()})

    def test_what_progress_raises_stops_the_build(self):
        def progress(stage, done):
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            vicinity.build_field(endless_scene(), progress=progress)

    def test_ctrl_c_stops_a_build(self):
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()  # a build keeps no other Python thread waiting
        with self.assertRaises(KeyboardInterrupt):
            vicinity.build_field(endless_scene())
        timer.join()

    def test_a_saved_field_is_opened_as_it_was_and_a_damaged_one_is_refused(self):
        field = vicinity.build_field(vicinity.Scene([post()])).field
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "post.vicinity"
            vicinity.save_field(field, path)
            np.testing.assert_array_equal(vicinity.open_field(str(path)).image, field.image)
            path.write_bytes(path.read_bytes()[:-1])
            with self.assertRaises(vicinity.Error) as raised:
                vicinity.open_field(path)
            self.assertIn("post.vicinity", raised.exception.where)


if __name__ == "__main__":
    unittest.main()
