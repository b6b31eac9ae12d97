// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Scenes for Python, and what is built from them.

#include "vicinity/viscosity/scene.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "beside_interpreter.h"
#include "casters.h"
#include "docstrings.h"
#include "parts.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/scene_file.h"

namespace py = pybind11;
using namespace py::literals;

namespace vicinity::python {
namespace {

MeshFile mesh_file(std::filesystem::path path, const std::optional<std::string>& units) {
  MeshFile file{std::move(path), std::nullopt};
  if (!units) return file;
  file.units = length_unit(*units);
  if (file.units) return file;
  throw Error({.where = "units",
               .what = "is not a unit of length",
               .found = "'" + *units + "'",
               .expected = "mm, cm, m or in"});
}

// A scene whose objects are a list of Python's own, to be changed in place.
struct SceneInPython {
  double voxel_size;
  std::optional<Box> bounds;
  py::list objects;
  std::optional<SceneRobot> robot;

  explicit SceneInPython(const Scene& scene)
      : voxel_size(scene.voxel_size), bounds(scene.bounds), robot(scene.robot) {
    for (const SceneObject& object : scene.objects) objects.append(object);
  }

  // A copy, so that another Python thread may change its own meanwhile.
  Scene scene() const {
    Scene copy{voxel_size, bounds, {}, robot};
    for (const py::handle& object : objects) {
      if (!py::isinstance<SceneObject>(object)) {
        throw py::type_error("Scene.objects: not a SceneObject: " + std::string(py::repr(object)));
      }
      copy.objects.push_back(object.cast<const SceneObject&>());
    }
    return copy;
  }
};

// Python threads may share one; it builds one scene at a time.
struct SharedBuilder {
  FieldBuilder builder;
  std::mutex building;
};

BuildResult build(SharedBuilder& shared, const SceneInPython& given, int threads,
                  const py::object& progress) {
  const Scene scene = given.scene();
  return beside_interpreter(progress, [&](const Report& report) {
    const std::lock_guard one_at_a_time(shared.building);
    return shared.builder.build(scene, {.threads = threads, .progress = report});
  });
}

BuildResult build_once(const SceneInPython& scene, int threads, const py::object& progress) {
  SharedBuilder builder;
  return build(builder, scene, threads, progress);
}

template <class Read>
SceneInPython read_unlocked(Read&& read) {
  const Scene scene = [&] {
    const py::gil_scoped_release unlocked;
    return read();
  }();
  return SceneInPython(scene);
}

void add_objects(py::module_& module) {
  py::enum_<BoundaryMethod>(module, "BoundaryMethod")
      .value(VICINITY_VALUE(BoundaryMethod, exact))
      .value(VICINITY_VALUE(BoundaryMethod, probe));
  py::enum_<InnerMethod>(module, "InnerMethod")
      .value(VICINITY_VALUE(InnerMethod, winding))
      .value(VICINITY_VALUE(InnerMethod, raster))
      .value(VICINITY_VALUE(InnerMethod, none));
  py::class_<MeshFile>(module, "MeshFile", doc::MeshFile)
      .def(py::init(&mesh_file), "path"_a, "units"_a = py::none(), "units: mm, cm, m or in.")
      .def_readonly(VICINITY_PLAIN_MEMBER(MeshFile, path));

  const SceneObject usual;
  py::class_<SceneObject>(module, "SceneObject", doc::SceneObject)
      .def(py::init([](std::string name, std::variant<MeshFile, TriangleMesh> shape,
                       const Pose& X_WO, double scale, int m, int q, LayerShape layers,
                       BoundaryMethod boundary, InnerMethod inner, Coding coding) {
             return SceneObject{
                 std::move(name), std::move(shape), X_WO, scale, m, q, layers, boundary,
                 inner,           std::move(coding)};
           }),
           "name"_a, "shape"_a, py::kw_only(), py::arg_v("X_WO", usual.X_WO, "identity"),
           "scale"_a = usual.scale, "m"_a = usual.m, "q"_a = usual.q, "layers"_a = usual.layers,
           "boundary"_a = usual.boundary, "inner"_a = usual.inner, "coding"_a = usual.coding)
      .def_readwrite(VICINITY_PLAIN_MEMBER(SceneObject, name))
      // A copy: what one alternative is made of goes when another takes its place.
      .def_property(
          "shape", [](const SceneObject& object) { return object.shape; },
          [](SceneObject& object, std::variant<MeshFile, TriangleMesh> shape) {
            object.shape = std::move(shape);
          },
          "A copy: assigned anew where it is to change.")
      .def_readwrite(VICINITY_PLAIN_MEMBER(SceneObject, X_WO))
      .def_readwrite(VICINITY_PLAIN_MEMBER(SceneObject, scale))
      .def_readwrite(VICINITY_MEMBER(SceneObject, m))
      .def_readwrite(VICINITY_MEMBER(SceneObject, q))
      .def_readwrite(VICINITY_PLAIN_MEMBER(SceneObject, layers))
      .def_readwrite(VICINITY_PLAIN_MEMBER(SceneObject, boundary))
      .def_readwrite(VICINITY_PLAIN_MEMBER(SceneObject, inner))
      .def_readwrite(VICINITY_PLAIN_MEMBER(SceneObject, coding));
}

void add_scenes(py::module_& module) {
  py::class_<SceneRobot>(module, "SceneRobot", doc::SceneRobot)
      .def_readonly(VICINITY_PLAIN_MEMBER(SceneRobot, urdf))
      .def_readonly(VICINITY_MEMBER(SceneRobot, X_WB))
      .def_readonly(VICINITY_PLAIN_MEMBER(SceneRobot, points_per_m2))
      .def_readonly(VICINITY_MEMBER(SceneRobot, exclude))
      .def_readonly(VICINITY_MEMBER(SceneRobot, tool));
  const Scene usual;
  py::class_<SceneInPython>(module, "Scene", doc::Scene)
      .def(py::init([](const py::iterable& objects, double voxel_size,
                       const std::optional<Box>& bounds) {
             SceneInPython scene(Scene{voxel_size, bounds, {}, std::nullopt});
             scene.objects = py::list(objects);
             return scene;
           }),
           "objects"_a = py::tuple(), py::kw_only(), "voxel_size"_a = usual.voxel_size,
           "bounds"_a = usual.bounds)
      .def_readwrite("voxel_size", &SceneInPython::voxel_size, doc::Scene_voxel_size)
      .def_readwrite("bounds", &SceneInPython::bounds, doc::Scene_bounds)
      .def_readwrite("objects", &SceneInPython::objects, "A list of SceneObject.")
      .def_readonly("robot", &SceneInPython::robot, "The arm that the scene file states, or None.");

  module.def(
      "read_scene",
      [](const std::filesystem::path& path) {
        return read_unlocked([&] { return read_scene(path); });
      },
      "path"_a, doc::read_scene);
  module.def(
      "parse_scene",
      [](const std::string& text, const std::filesystem::path& base_folder,
         const std::string& where) {
        return read_unlocked([&] { return parse_scene(text, base_folder, where); });
      },
      "text"_a, "base_folder"_a, "where"_a, doc::parse_scene);
}

}  // namespace

std::optional<Scene> scene_from(py::handle scene) {
  if (!py::isinstance<SceneInPython>(scene)) return std::nullopt;
  return scene.cast<const SceneInPython&>().scene();
}

void add_scene(py::module_& module) {
  add_objects(module);
  add_scenes(module);

  py::class_<BuildReport> report(module, "BuildReport", doc::BuildReport);
  using Seconds = BuildReport::Seconds;
  py::class_<Seconds>(report, "Seconds", doc::BuildReport_Seconds)
      .def_readonly("read", &Seconds::read)
      .def_readonly("voxelise", &Seconds::voxelise)
      .def_readonly("fill", &Seconds::fill)
      .def_readonly("rank", &Seconds::rank)
      .def_readonly("merge", &Seconds::merge)
      .def_readonly("total", &Seconds::total);
  report.def_readonly(VICINITY_PLAIN_MEMBER(BuildReport, seconds))
      .def_readonly(VICINITY_MEMBER(BuildReport, boundary))
      .def_readonly(VICINITY_PLAIN_MEMBER(BuildReport, inner))
      .def_readonly(VICINITY_PLAIN_MEMBER(BuildReport, neighbour))
      .def_readonly(VICINITY_PLAIN_MEMBER(BuildReport, threads))
      .def_readonly(VICINITY_MEMBER(BuildReport, objects_ranked))
      .def_readonly(VICINITY_MEMBER(BuildReport, remarks));
  py::class_<BuildResult>(module, "BuildResult", "A field, and what its build did.")
      .def_readonly(VICINITY_PLAIN_MEMBER(BuildResult, field))
      .def_readonly(VICINITY_PLAIN_MEMBER(BuildResult, report));

  const int threads = BuildOptions().threads;
  const std::string options =
      "\n\nthreads: " + std::string(doc::BuildOptions_threads) +
      "\nprogress: called now and then from this thread as progress(stage, done), done 0..1. What\n"
      "it raises stops the build, as Ctrl-C does; other Python threads go on meanwhile.";
  py::class_<SharedBuilder>(module, "FieldBuilder", doc::FieldBuilder)
      .def(py::init())
      .def("build", &build, "scene"_a, "threads"_a = threads, "progress"_a = py::none(),
           (doc::FieldBuilder_build + options).c_str());
  module.def("build_field", &build_once, "scene"_a, "threads"_a = threads,
             "progress"_a = py::none(), (doc::build_field + options).c_str());
}

}  // namespace vicinity::python
