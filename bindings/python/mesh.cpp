// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Meshes for Python: read, made from arrays or from primitives, and inspected.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "casters.h"
#include "docstrings.h"
#include "parts.h"
#include "vicinity/mesh/inspection.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/placement.h"
#include "vicinity/mesh/primitive.h"

namespace py = pybind11;
using namespace py::literals;

namespace vicinity::python {
namespace {

TriangleMesh mesh_from(const Numbers& vertices, const py::array_t<std::int64_t>& triangles) {
  const auto points = points_of(vertices, "vertices");
  TriangleMesh mesh{.vertices = {points.begin(), points.end()}, .triangles = {}};
  if (triangles.ndim() != 2 || triangles.shape(1) != 3) {
    throw Error({.where = "triangles",
                 .what = "are no list of corners",
                 .found = "shape " + shape_of(triangles),
                 .expected = "shape (M, 3)"});
  }
  const auto corners = triangles.unchecked<2>();
  for (py::ssize_t t = 0; t < corners.shape(0); ++t) {
    auto& triangle = mesh.triangles.emplace_back();
    for (py::ssize_t c = 0; c < 3; ++c) {
      const std::int64_t corner = corners(t, c);
      if (corner < 0 || corner >= static_cast<std::int64_t>(mesh.vertices.size())) {
        throw Error({.where = "triangles",
                     .what = "triangle " + std::to_string(t) + " names a vertex that is not there",
                     .found = std::to_string(corner),
                     .expected = "less than " + std::to_string(mesh.vertices.size())});
      }
      triangle[static_cast<std::size_t>(c)] = static_cast<std::uint32_t>(corner);
    }
  }
  return mesh;
}

void add_primitives(py::module_& module) {
  py::module_ primitives = module.def_submodule(
      "primitive",
      "Closed meshes of simple shapes, in metres, wound outward. Shapes with a height have their\n"
      "axis along z and the origin at mid-height; round ones are inscribed. Each raises Error for "
      "a\n"
      "size that is not positive and finite.");
  const int segments = primitive::usual_segments;
  primitives.def("box", &primitive::box, "size"_a, doc::box);
  primitives.def("sphere", &primitive::sphere, "radius"_a, "segments"_a = segments);
  primitives.def("cylinder", &primitive::cylinder, "radius"_a, "height"_a, "segments"_a = segments);
  primitives.def("capsule", &primitive::capsule, "radius"_a, "height"_a, "segments"_a = segments,
                 doc::capsule);
  primitives.def("cone", &primitive::cone, "base_radius"_a, "height"_a, "segments"_a = segments,
                 doc::cone);
  primitives.def("torus", &primitive::torus, "radius"_a, "tube_radius"_a, "segments"_a = segments,
                 doc::torus);
  primitives.def("tube", &primitive::tube, "outer_radius"_a, "inner_radius"_a, "height"_a,
                 "segments"_a = segments, doc::tube);
  primitives.def("extrusion", &primitive::extrusion, "outline"_a, "height"_a, doc::extrusion);
  primitives.def("revolution", &primitive::revolution, "profile"_a, "segments"_a = segments,
                 doc::revolution);
  primitives.def("pipe", &primitive::pipe, "path"_a, "radius"_a, "bend_radius"_a,
                 "segments"_a = primitive::usual_pipe_segments, doc::pipe);
  primitives.def("v_block", &primitive::v_block, "size"_a, "depth"_a, doc::v_block);
  primitives.def("complex_cylinder", &primitive::complex_cylinder, "radius"_a, "height"_a,
                 doc::complex_cylinder);
}

}  // namespace

void add_mesh(py::module_& module) {
  module.def("pose_from_rpy", &pose_from_rpy, "xyz"_a, "rpy"_a, doc::pose_from_rpy);
  module.def("pose_from_quaternion", &pose_from_quaternion, "xyz"_a, "xyzw"_a,
             doc::pose_from_quaternion);

  py::class_<TriangleMesh>(module, "TriangleMesh", doc::TriangleMesh)
      .def(py::init(&mesh_from), "vertices"_a, "triangles"_a,
           "Copies vertices, shape (N, 3), and triangles, shape (M, 3), indices of vertices.\n"
           "Raises Error for other shapes, and for an index without a vertex.")
      .def_property_readonly(
          "vertices",
          [](const py::object& self) {
            const auto& vertices = self.cast<const TriangleMesh&>().vertices;
            return view<double>({static_cast<py::ssize_t>(vertices.size()), 3},
                                vertices.empty() ? nullptr : vertices.front().data(), self);
          },
          "Shape (N, 3), read-only, where they lie.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            const auto& triangles = self.cast<const TriangleMesh&>().triangles;
            return view<std::uint32_t>({static_cast<py::ssize_t>(triangles.size()), 3},
                                       triangles.empty() ? nullptr : triangles.front().data(),
                                       self);
          },
          doc::TriangleMesh_triangles)
      .def("bounds", &TriangleMesh::bounds, doc::TriangleMesh_bounds);

  py::class_<MeshProblem>(module, "MeshProblem", doc::MeshProblem)
      .def_readonly(VICINITY_MEMBER(MeshProblem, what))
      .def_readonly(VICINITY_MEMBER(MeshProblem, count))
      .def_readonly(VICINITY_MEMBER(MeshProblem, means))
      .def("__repr__", [](const MeshProblem& problem) {
        return std::to_string(problem.count) + " " + problem.what + ": " + problem.means;
      });

  py::class_<MeshInspection> inspection(module, "MeshInspection", doc::MeshInspection);
  using Verdict = MeshInspection::Verdict;
  py::enum_<Verdict>(inspection, "Verdict")
      .value("ok", Verdict::ok, doc::MeshInspection_Verdict_ok)
      .value("usable", Verdict::usable, doc::MeshInspection_Verdict_usable)
      .value("unusable", Verdict::unusable, doc::MeshInspection_Verdict_unusable);
  inspection.def_readonly(VICINITY_PLAIN_MEMBER(MeshInspection, verdict))
      .def_readonly(VICINITY_PLAIN_MEMBER(MeshInspection, triangles))
      .def_readonly(VICINITY_MEMBER(MeshInspection, closed))
      .def_readonly(VICINITY_MEMBER(MeshInspection, shells))
      .def_readonly(VICINITY_MEMBER(MeshInspection, open_edges))
      .def_readonly(VICINITY_MEMBER(MeshInspection, holes))
      .def_readonly(VICINITY_MEMBER(MeshInspection, crack_edges))
      .def_readonly(VICINITY_MEMBER(MeshInspection, non_manifold_edges))
      .def_readonly(VICINITY_MEMBER(MeshInspection, inconsistent_edges))
      .def_readonly(VICINITY_MEMBER(MeshInspection, duplicate_triangles))
      .def_readonly(VICINITY_MEMBER(MeshInspection, degenerate_triangles))
      .def_readonly(VICINITY_MEMBER(MeshInspection, bounds))
      .def_readonly(VICINITY_PLAIN_MEMBER(MeshInspection, problems));

  using Unlocked = py::call_guard<py::gil_scoped_release>;
  module.def("read_mesh", &read_mesh, "path"_a, Unlocked(), doc::read_mesh);
  module.def("inspect", &inspect, "mesh"_a, Unlocked(), doc::inspect);
  add_primitives(module);
}

}  // namespace vicinity::python
