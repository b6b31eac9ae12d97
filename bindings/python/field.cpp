// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The field for Python: asked for many points at once, traced, exported.

#include "vicinity/viscosity/field.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "beside_interpreter.h"
#include "casters.h"
#include "docstrings.h"
#include "parts.h"
#include "vdb/vdb_file.h"
#include "vicinity/drag/trace.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/npy_file.h"
#include "vicinity/viscosity/vti_file.h"

namespace py = pybind11;
using namespace py::literals;

namespace vicinity::python {
namespace {

constexpr std::int32_t no_object = -1;

std::int32_t object_of(const VoxelRecord& record) {
  return record.kind == VoxelKind::empty ? no_object : record.object;
}

// FieldSample for many points, each of its parts an array of shape (N,).
struct FieldSamples {
  explicit FieldSamples(py::ssize_t n) : kind(n), object(n), rank(n), viscosity(n), distance_m(n) {}

  py::array_t<std::uint8_t> kind;
  py::array_t<std::int32_t> object;
  py::array_t<std::uint8_t> rank;
  py::array_t<double> viscosity, distance_m;
};

FieldSamples query(const ViscosityField& field, const Numbers& points) {
  const auto points_W = points_of(points, "points");
  FieldSamples samples(points.shape(0));
  std::uint8_t* const kind = samples.kind.mutable_data();
  std::int32_t* const object = samples.object.mutable_data();
  std::uint8_t* const rank = samples.rank.mutable_data();
  double* const viscosity = samples.viscosity.mutable_data();
  double* const distance_m = samples.distance_m.mutable_data();
  const py::gil_scoped_release unlocked;
  for (std::size_t n = 0; n < points_W.size(); ++n) {
    const FieldSample sample = field.at(points_W[n]);
    kind[n] = static_cast<std::uint8_t>(sample.record.kind);
    object[n] = object_of(sample.record);
    rank[n] = sample.record.rank;
    viscosity[n] = sample.viscosity;
    distance_m[n] = sample.distance_m;
  }
  return samples;
}

// TraceSample for many instants, each of its parts an array of shape (N,) or (N, 3).
struct Trace {
  explicit Trace(const std::vector<TraceSample>& samples)
      : Trace(static_cast<py::ssize_t>(samples.size())) {
    auto p = p_WR.mutable_unchecked<2>(), F = force_W.mutable_unchecked<2>();
    for (py::ssize_t n = 0; n < t.size(); ++n) {
      const TraceSample& sample = samples[static_cast<std::size_t>(n)];
      t.mutable_at(n) = sample.t;
      kind.mutable_at(n) = static_cast<std::uint8_t>(sample.record.kind);
      object.mutable_at(n) = object_of(sample.record);
      rank.mutable_at(n) = sample.record.rank;
      mu.mutable_at(n) = sample.mu;
      mu_e.mutable_at(n) = sample.mu_e;
      for (py::ssize_t axis = 0; axis < 3; ++axis) {
        p(n, axis) = sample.p_WR[axis];
        F(n, axis) = sample.force_W[axis];
      }
    }
  }

  py::array_t<double> t, p_WR;
  py::array_t<std::uint8_t> kind;
  py::array_t<std::int32_t> object;
  py::array_t<std::uint8_t> rank;
  py::array_t<double> mu, mu_e, force_W;

 private:
  explicit Trace(py::ssize_t n)
      : t(n),
        p_WR({n, py::ssize_t{3}}),
        kind(n),
        object(n),
        rank(n),
        mu(n),
        mu_e(n),
        force_W({n, py::ssize_t{3}}) {}
};

DragOptions drag_options(double area, const std::optional<std::string>& memory,
                         DragDirection direction, Traversal traversal) {
  DragOptions options{.area = area, .direction = direction, .traversal = traversal};
  if (memory) options.memory = named_memory(*memory);
  return options;
}

std::vector<TraceSample> unlocked_trace(const auto&... arguments) {
  const py::gil_scoped_release unlocked;
  return vicinity::trace(arguments...);
}

VoxelBox voxels_asked(const ViscosityField& field, const std::optional<Box>& box) {
  if (!box) return field.workspace().box();
  const VoxelBox voxels = voxels_within(field.workspace(), *box);
  if (!voxels.empty()) return voxels;
  throw Error({.where = "box", .what = "is empty, or lies outside the workspace"});
}

py::array voxels(const ViscosityField& field, VoxelQuantity what, const std::optional<Box>& box) {
  const VoxelBox asked = voxels_asked(field, box);
  VoxelPlanes planes(field, asked, what, Fastest::z);
  const py::dtype number =
      size_of(what) == 2 ? py::dtype::of<std::int16_t>() : py::dtype::of<float>();
  py::array array(number, std::vector<py::ssize_t>{asked.hi.i - asked.lo.i, asked.hi.j - asked.lo.j,
                                                   asked.hi.k - asked.lo.k});
  auto* to = static_cast<std::byte*>(array.mutable_data());
  const py::gil_scoped_release unlocked;
  for (std::int32_t i = 0; i < planes.count(); ++i) {
    const auto& plane = planes.plane(i);
    std::memcpy(to, plane.data(), plane.size());
    to += plane.size();
  }
  return array;
}

// The file that a path asks for by its extension, as one function of what is to be written.
using Write = std::function<void(const VoxelBox&, const std::function<void(double)>&)>;
Write writer_of(const ViscosityField& field, const std::filesystem::path& path,
                const std::optional<VoxelQuantity>& what) {
  const VoxelQuantity one = what.value_or(VoxelQuantity::rank);
  if (path.extension() == ".npy") {
    return [&field, path, one](const VoxelBox& box, const auto& progress) {
      write_npy(field, box, one, path, progress);
    };
  }
  if (path.extension() == ".vti") {
    return [&field, path, one](const VoxelBox& box, const auto& progress) {
      write_vti(field, box, one, path, progress);
    };
  }
  if (path.extension() == ".vdb") {
#ifdef VICINITY_OPENVDB
    const auto several = what ? std::vector{*what} : usual_vdb_quantities;
    return [&field, path, several](const VoxelBox& box, const auto& progress) {
      write_vdb(field, box, several, path, progress);
    };
#else
    throw Error({.where = path.string(),
                 .what = "this module was built without OpenVDB",
                 .hint = ".npy or .vti"});
#endif
  }
  throw Error({.where = path.string(),
               .what = "is of no kind that can be written",
               .expected = ".npy, .vti or .vdb"});
}

void export_field(const ViscosityField& field, const std::filesystem::path& path,
                  const std::optional<VoxelQuantity>& what, const std::optional<Box>& box,
                  const py::object& progress) {
  const VoxelBox asked = voxels_asked(field, box);
  const Write write = writer_of(field, path, what);
  beside_interpreter(progress, [&](const Report& report) {
    write(asked, [&](double done) { report("export", done); });
    return true;
  });
}

py::tuple dims_of(const Workspace& workspace) {
  return py::make_tuple(workspace.dims.i, workspace.dims.j, workspace.dims.k);
}

std::string as_text(const Coding& coding) {
  return "Coding(" + std::string(py::repr(py::cast(coding.mu))) +
         ", skin=" + std::string(py::repr(py::float_(coding.skin))) + ")";
}

void add_nouns(py::module_& module) {
  py::enum_<VoxelKind> kinds(module, "VoxelKind", doc::VoxelKind);
  // So that numpy compares an array of kinds with one, and not each of its numbers with an object.
  kinds.def("__array__", [](VoxelKind kind, const py::args&) {
    return py::array_t<std::uint8_t>({}, {}, reinterpret_cast<const std::uint8_t*>(&kind));
  });
  kinds.value(VICINITY_VALUE(VoxelKind, empty))
      .value(VICINITY_VALUE(VoxelKind, neighbour))
      .value(VICINITY_VALUE(VoxelKind, inner))
      .value(VICINITY_VALUE(VoxelKind, boundary));
  py::enum_<LayerShape>(module, "LayerShape", doc::LayerShape)
      .value(VICINITY_VALUE(LayerShape, cube))
      .value(VICINITY_VALUE(LayerShape, sphere))
      .value(VICINITY_VALUE(LayerShape, distance));
  py::enum_<DragDirection>(module, "DragDirection", doc::DragDirection)
      .value(VICINITY_VALUE(DragDirection, all))
      .value(VICINITY_VALUE(DragDirection, closing));
  py::enum_<Traversal>(module, "Traversal", doc::Traversal)
      .value(VICINITY_VALUE(Traversal, swept))
      .value(VICINITY_VALUE(Traversal, sampled));
  py::enum_<VoxelQuantity>(module, "VoxelQuantity", doc::VoxelQuantity)
      .value(VICINITY_VALUE(VoxelQuantity, rank))
      .value(VICINITY_VALUE(VoxelQuantity, viscosity))
      .value(VICINITY_VALUE(VoxelQuantity, object))
      .value(VICINITY_VALUE(VoxelQuantity, distance));

  py::class_<Coding>(module, "Coding", doc::Coding)
      .def(py::init([](std::vector<double> mu, double skin) {
             return Coding{std::move(mu), skin};
           }),
           "mu"_a, "skin"_a = Coding().skin)
      .def_readonly(VICINITY_MEMBER(Coding, mu))
      .def_readonly(VICINITY_MEMBER(Coding, skin))
      .def("__repr__", &as_text);
  module.def("named_coding", &named_coding, "name"_a, "q"_a, doc::named_coding);

  py::class_<Workspace>(module, "Workspace", doc::Workspace)
      .def_readonly(VICINITY_MEMBER(Workspace, origin))
      .def_readonly(VICINITY_MEMBER(Workspace, voxel_size))
      .def_property_readonly("dims", &dims_of, doc::Workspace_dims);
  py::class_<VoxelCounts>(module, "VoxelCounts", doc::VoxelCounts)
      .def_readonly(VICINITY_PLAIN_MEMBER(VoxelCounts, boundary))
      .def_readonly(VICINITY_PLAIN_MEMBER(VoxelCounts, inner))
      .def_readonly(VICINITY_PLAIN_MEMBER(VoxelCounts, neighbour));
  py::class_<FieldObject>(module, "FieldObject", doc::FieldObject)
      .def_readonly(VICINITY_PLAIN_MEMBER(FieldObject, name))
      .def_readonly(VICINITY_PLAIN_MEMBER(FieldObject, layers))
      .def_readonly(VICINITY_PLAIN_MEMBER(FieldObject, m))
      .def_readonly(VICINITY_PLAIN_MEMBER(FieldObject, q))
      .def_readonly(VICINITY_PLAIN_MEMBER(FieldObject, coding))
      .def_readonly(VICINITY_MEMBER(FieldObject, bound_mm))
      .def_readonly(VICINITY_MEMBER(FieldObject, closed))
      .def_readonly(VICINITY_PLAIN_MEMBER(FieldObject, triangles))
      .def_readonly(VICINITY_MEMBER(FieldObject, boundary))
      .def_readonly(VICINITY_PLAIN_MEMBER(FieldObject, inner))
      .def_readonly(VICINITY_MEMBER(FieldObject, ranks));
}

void add_samples(py::module_& module) {
  const std::string kind = "VoxelKind as a number, uint8.";
  const std::string object = "Index into ViscosityField.objects, int32; -1 in empty space.";
  py::class_<FieldSamples>(module, "FieldSamples",
                           "What many points of space hold: arrays of shape (N,).")
      .def_readonly("kind", &FieldSamples::kind, kind.c_str())
      .def_readonly("object", &FieldSamples::object, object.c_str())
      .def_readonly("rank", &FieldSamples::rank, doc::VoxelRecord_rank)
      .def_readonly("viscosity", &FieldSamples::viscosity, doc::FieldSample_viscosity)
      .def_readonly("distance_m", &FieldSamples::distance_m, doc::FieldSample_distance_m);
  py::class_<Trace>(module, "Trace",
                    "Instants of a track: arrays of shape (N,), positions and forces (N, 3).")
      .def_readonly("t", &Trace::t, doc::TraceSample_t)
      .def_readonly("p_WR", &Trace::p_WR, doc::TraceSample_p_WR)
      .def_readonly("kind", &Trace::kind, kind.c_str())
      .def_readonly("object", &Trace::object, object.c_str())
      .def_readonly("rank", &Trace::rank, doc::VoxelRecord_rank)
      .def_readonly("mu", &Trace::mu, doc::TraceSample_mu)
      .def_readonly("mu_e", &Trace::mu_e, doc::TraceSample_mu_e)
      .def_readonly("force_W", &Trace::force_W, doc::TraceSample_force_W);
}

void add_traces(py::module_& module) {
  const Track track;
  const DragOptions drag;
  const std::string options = "\n\narea: " + std::string(doc::DragOptions_area) +
                              "\nmemory: none, sustained, fading, short or rising; None is none.\n"
                              "The interpreter lock is released meanwhile.";
  module.def(
      "trace",
      [](const ViscosityField& field, const Vec3& from_W, const Vec3& to_W, double speed,
         double rate, double area, const std::optional<std::string>& memory,
         DragDirection direction, Traversal traversal) {
        return Trace(unlocked_trace(field, Track{from_W, to_W, speed, rate},
                                    drag_options(area, memory, direction, traversal)));
      },
      "field"_a, "from_W"_a, "to_W"_a, py::kw_only(), "speed"_a = track.speed,
      "rate"_a = track.rate, "area"_a = drag.area, "memory"_a = py::none(),
      "direction"_a = drag.direction, "traversal"_a = drag.traversal,
      (doc::trace + options).c_str());
  module.def(
      "trace",
      [](const ViscosityField& field, const Numbers& path_W, double rate, double area,
         const std::optional<std::string>& memory, DragDirection direction, Traversal traversal) {
        return Trace(unlocked_trace(field, points_of(path_W, "path_W"), rate,
                                    drag_options(area, memory, direction, traversal)));
      },
      "field"_a, "path_W"_a, py::kw_only(), "rate"_a = track.rate, "area"_a = drag.area,
      "memory"_a = py::none(), "direction"_a = drag.direction, "traversal"_a = drag.traversal,
      (doc::trace_2 + options).c_str());
}

}  // namespace

void add_field(py::module_& module) {
  add_nouns(module);
  add_samples(module);
  const std::string query_says =
      std::string(doc::ViscosityField_at) +
      "\n\nFor many points, shape (N, 3) [m]: an array of float64 that lies as C has it is read "
      "where it\nis, anything else is converted first. The interpreter lock is released meanwhile.";
  const std::string voxels_says =
      "All voxels as one array, shape (nx, ny, nz), of the quantity asked for: what\n"
      "`vicinity export` writes to .npy. box: only those with a share in it, shape (2, 3) [m].";
  py::class_<ViscosityField>(module, "ViscosityField", doc::ViscosityField)
      .def_property_readonly("workspace", &ViscosityField::workspace)
      .def_property_readonly("objects", &ViscosityField::objects)
      .def_property_readonly("voxel_counts", &ViscosityField::voxel_counts)
      .def_property_readonly("keeps_distance", &ViscosityField::keeps_distance,
                             doc::ViscosityField_keeps_distance)
      .def_property_readonly(
          "image",
          [](const py::object& self) {
            const auto image = self.cast<const ViscosityField&>().image();
            return view<std::uint8_t>({static_cast<py::ssize_t>(image.size())},
                                      reinterpret_cast<const std::uint8_t*>(image.data()), self);
          },
          doc::ViscosityField_image)
      .def("query", &query, "points"_a, query_says.c_str())
      .def("voxels", &voxels, "what"_a = VoxelQuantity::rank, "box"_a = py::none(),
           voxels_says.c_str())
      .def("with_codings", &ViscosityField::with_codings, "codings"_a,
           doc::ViscosityField_with_codings);

  using Unlocked = py::call_guard<py::gil_scoped_release>;
  module.def("save_field", &save_field, "field"_a, "path"_a, Unlocked(), doc::save_field);
  module.def("open_field", &open_field, "path"_a, Unlocked(), doc::open_field);
  const std::string export_says =
      std::string("By the path's extension, .npy:\n") + doc::write_npy +
      "\n\n.vti, an image for ParaView, the same values as cell data; .vdb:\n" + doc::write_vdb +
      "\n\nwhat: None: rank, and in a .vdb viscosity too.\n"
      "progress: called as progress(\"export\", done), done 0..1; what it raises stops the "
      "export,\n"
      "as Ctrl-C does, and leaves nothing half done.";
  module.def("export_field", &export_field, "field"_a, "path"_a, "what"_a = py::none(),
             "box"_a = py::none(), "progress"_a = py::none(), export_says.c_str());
  add_traces(module);
}

}  // namespace vicinity::python
