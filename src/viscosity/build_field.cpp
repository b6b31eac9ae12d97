// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/build_field.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <utility>

#include "merge.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/inspection.h"
#include "vicinity/mesh/mesh_file.h"

namespace vicinity {
namespace {

std::string title(const SceneObject& object) { return fmt::format("object '{}'", object.name); }

/// The objects by name, so that their order in the scene does not matter.
std::vector<const SceneObject*> sorted_objects(const Scene& scene) {
  if (scene.objects.empty()) {
    throw Error({.where = "scene", .what = "no objects", .expected = "at least one"});
  }
  std::vector<const SceneObject*> objects;
  for (const SceneObject& object : scene.objects) {
    check_object(object, title(object));
    objects.push_back(&object);
  }
  std::sort(objects.begin(), objects.end(),
            [](const auto* a, const auto* b) { return a->name < b->name; });
  const auto twin =
      std::adjacent_find(objects.begin(), objects.end(),
                         [](const auto* a, const auto* b) { return a->name == b->name; });
  if (twin != objects.end()) {
    throw Error({.where = title(**twin), .what = "two objects have this name"});
  }
  return objects;
}

/// The mesh of an object, in W [m].
TriangleMesh read_and_place(const SceneObject& object) {
  if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
    for (const auto& triangle : mesh->triangles) {
      for (const std::uint32_t vertex : triangle) {
        if (vertex >= mesh->vertices.size() || !mesh->vertices[vertex].allFinite()) {
          throw Error({.what = "a triangle has a corner that is missing or not finite"});
        }
      }
    }
    return place(*mesh, object.scale, object.X_WO);
  }
  const auto& file = std::get<MeshFile>(object.shape);
  TriangleMesh mesh = read_mesh(file.path);
  if (!file.units) throw missing_unit(mesh, file.path.string());
  return place(std::move(mesh), object.scale * metres_per(*file.units), object.X_WO);
}

/// How far, in voxels, the layers of an object reach beyond its mesh. A voxel in `distance` mode
/// takes a rank by its centre, which may lie half a diagonal further out than the last layer.
int reach_vox(const SceneObject& object) {
  return object.q * object.m + (object.layers == LayerShape::distance ? 2 : 1);
}

/// One object on its way through the stages.
struct Work {
  explicit Work(const SceneObject& o) : object(&o) {}

  const SceneObject* object;
  TriangleMesh mesh;
  MeshInspection inspection;
  ObjectVoxelArray array;
};

/// Refuses a mesh without extent, and one that no memory would hold at this voxel size: mostly a
/// wrong unit.
void check_usable(const Work& work, double h) {
  if (work.inspection.verdict == MeshInspection::Verdict::unusable) {
    throw Error({.what = "the mesh has no triangle with any extent",
                 .hint = "vicinity check, which says what is wrong with it"});
  }
  constexpr double most_voxels = 1e9;         // of boundary, about a byte each for every layer
  constexpr double farthest_voxel = 1 << 30;  // an index of 32 bits, with room for layers
  const TriangleMesh& mesh = work.mesh;
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& p = mesh.vertices[a];
    area += 0.5 * (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).norm();
  }
  const Box bounds = mesh.bounds();
  const Vec3 size = bounds.sizes();
  const double reach =
      std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  if (area / (h * h) <= most_voxels && reach / h <= farthest_voxel) return;
  throw Error({.what = "too large for this voxel size",
               .found = fmt::format("{:.6g} x {:.6g} x {:.6g} m, up to {:.6g} m from the origin",
                                    size.x(), size.y(), size.z(), reach),
               .expected = fmt::format("at most {:g} voxels on the surface", most_voxels),
               .hint = "the right units, or larger voxels"});
}

/// Bounds that hold every object with all its layers, from a multiple of the voxel size, so that a
/// scene that grows keeps its grid.
Box bounds_around(const std::vector<Work>& works, double h) {
  Box bounds;
  for (const Work& work : works) {
    const Vec3 margin = Vec3::Constant(h * reach_vox(*work.object));
    const Box box = work.mesh.bounds();
    bounds.extend(Box(box.min() - margin, box.max() + margin));
  }
  return {((bounds.min() / h).array().floor() * h).matrix(), bounds.max()};
}

DistanceLayers layers_of(const Work& work, const Workspace& workspace) {
  const SceneObject& object = *work.object;
  if (object.layers == LayerShape::distance) {
    return distance_layers(work.mesh, work.array.boundary, work.array.inner, workspace, object.m,
                           object.q);
  }
  const ShapingElement element(object.layers, object.m);
  DistanceLayers layers;
  layers.neighbours = ranked_neighbours(work.array.boundary, work.array.inner, element, object.q);
  return layers;
}

FieldObject describe(const Work& work, double h) {
  const SceneObject& object = *work.object;
  FieldObject described{.name = object.name,
                        .layers = object.layers,
                        .m = object.m,
                        .q = object.q,
                        .coding = object.coding,
                        .bound_mm = rank_bound_vox(object.layers, object.m, object.q) * h * 1000,
                        .closed = work.inspection.closed,
                        .triangles = work.inspection.triangles,
                        .boundary = work.array.boundary.count(),
                        .inner = work.array.inner.count(),
                        .ranks = {}};
  for (const VoxelSet& rank : work.array.layers.neighbours.ranks) {
    described.ranks.push_back(rank.count());
  }
  return described;
}

const char* words_for(InnerMethod method) {
  switch (method) {
    case InnerMethod::winding:
      return "decided by winding number";
    case InnerMethod::raster:
      return "filled slice by slice";
    case InnerMethod::none:
      return "not asked for";
  }
  return "";
}

std::vector<std::string> remarks_on(const Work& work, const FieldObject& described,
                                    const Workspace& workspace) {
  const SceneObject& object = *work.object;
  std::vector<std::string> remarks;
  if (!work.inspection.closed) {
    remarks.push_back(
        fmt::format("{} is open: {} open edges, {} holes; its inside was {}: {} inner voxels.",
                    title(object), work.inspection.open_edges, work.inspection.holes,
                    words_for(object.inner), described.inner));
  }
  if (object.coding.mu.size() > static_cast<std::size_t>(object.q)) {
    remarks.push_back(fmt::format("{} has {} coding values for {} ranks: the last {} are ignored.",
                                  title(object), object.coding.mu.size(), object.q,
                                  object.coding.mu.size() - static_cast<std::size_t>(object.q)));
  }
  const Vec3 margin = Vec3::Constant(workspace.voxel_size * reach_vox(object));
  const Box box = work.mesh.bounds();
  const Vec3 far_corner =
      workspace.origin +
      workspace.voxel_size * Vec3(workspace.dims.i, workspace.dims.j, workspace.dims.k);
  if (!Box(box.min() - margin, box.max() + margin).intersects(Box(workspace.origin, far_corner))) {
    remarks.push_back(
        fmt::format("{} lies outside the workspace, and so do its layers.", title(object)));
  }
  return remarks;
}

/// The stages of a build: timed, announced, and run for all objects at once.
class Stages {
 public:
  Stages(const BuildOptions& options, std::vector<Work>& works)
      : options_(options), works_(works) {}

  /// Runs `step(work)` for every object. Of several errors, the first object's is thrown.
  template <class Step>
  void run(const char* stage, double share, double& seconds, Step&& step) {
    run_whole(stage, share, seconds, [&](const auto& progress) {
      std::vector<std::exception_ptr> errors(works_.size());
      std::mutex mutex;
      std::size_t finished = 0;
      tbb::parallel_for(std::size_t{0}, works_.size(), [&](std::size_t w) {
        try {
          step(works_[w]);
        } catch (...) {
          errors[w] = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        progress(static_cast<double>(++finished) / static_cast<double>(works_.size()));
      });
      for (std::size_t w = 0; w < works_.size(); ++w) {
        if (errors[w]) rethrow_naming(*works_[w].object, errors[w]);
      }
    });
  }

  /// Runs `step(progress)` once.
  template <class Step>
  void run_whole(const char* stage, double share, double& seconds, Step&& step) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    step([&](double done) {
      if (options_.progress) options_.progress(stage, std::min(1.0, done_ + share * done));
    });
    done_ += share;
    seconds = std::chrono::duration<double>(Clock::now() - start).count();
  }

 private:
  [[noreturn]] static void rethrow_naming(const SceneObject& object, std::exception_ptr error) {
    try {
      std::rethrow_exception(error);
    } catch (const Error& e) {
      ErrorParts parts = e.parts();
      parts.where = parts.where.empty() ? title(object) : title(object) + ", " + parts.where;
      throw Error(parts);
    }
  }

  const BuildOptions& options_;
  std::vector<Work>& works_;
  double done_ = 0;
};

BuildResult build_in_arena(const Scene& scene, const BuildOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  // Refuses a voxel size that is none before any mesh is read.
  Workspace workspace = Workspace::covering(Box(Vec3::Zero(), Vec3::Zero()), scene.voxel_size);
  std::vector<Work> works;
  for (const SceneObject* object : sorted_objects(scene)) works.emplace_back(*object);
  const double h = scene.voxel_size;
  BuildReport report;
  ViscosityField field;
  Stages stages(options, works);

  stages.run("read", 0.1, report.seconds.read, [&](Work& work) {
    work.mesh = read_and_place(*work.object);
    work.inspection = inspect(work.mesh);
    check_usable(work, h);
  });
  workspace = Workspace::covering(scene.bounds.value_or(bounds_around(works, h)), h);
  stages.run("voxelise", 0.2, report.seconds.voxelise, [&](Work& work) {
    work.array.boundary = boundary_voxels(work.mesh, workspace, work.object->boundary);
  });
  stages.run("fill", 0.2, report.seconds.fill, [&](Work& work) {
    work.array.inner = inner_voxels(work.mesh, work.array.boundary, workspace, work.object->inner);
  });
  stages.run("rank", 0.3, report.seconds.rank,
             [&](Work& work) { work.array.layers = layers_of(work, workspace); });
  stages.run_whole("merge", 0.2, report.seconds.merge, [&](const auto& progress) {
    std::vector<FieldObject> objects;
    std::vector<ObjectVoxelArray> arrays;
    for (Work& work : works) {
      objects.push_back(describe(work, h));
      for (auto& r : remarks_on(work, objects.back(), workspace)) report.remarks.push_back(r);
      arrays.push_back(std::move(work.array));
    }
    field = merge(workspace, objects, std::move(arrays), progress);
  });

  report.boundary = field.voxel_counts().boundary;
  report.inner = field.voxel_counts().inner;
  report.neighbour = field.voxel_counts().neighbour;
  report.threads = tbb::this_task_arena::max_concurrency();
  report.seconds.total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {field, report};
}

}  // namespace

BuildResult build_field(const Scene& scene, const BuildOptions& options) {
  if (options.threads < 0) {
    throw Error({.where = "threads",
                 .what = "not a number of threads",
                 .found = fmt::format("{}", options.threads),
                 .expected = "1 or more, or 0 for as many as the machine has"});
  }
  tbb::task_arena arena(options.threads == 0 ? tbb::task_arena::automatic : options.threads);
  return arena.execute([&] { return build_in_arena(scene, options); });
}

}  // namespace vicinity
