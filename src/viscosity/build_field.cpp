// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/build_field.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <ranges>
#include <utility>

#include "geometry/whole_loops.h"
#include "merge.h"
#include "object_voxel_array.h"
#include "object_work.h"
#include "vicinity/geometry/error.h"
#include "vicinity/layers/layer_bricks.h"
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

/// Refuses a mesh without extent, and one that no memory would hold at this voxel size: mostly a
/// wrong unit.
void check_usable(const ObjectWork& work, double h) {
  if (work.inspection.verdict == MeshInspection::Verdict::unusable) {
    throw Error({.what = "the mesh has no triangle with any extent",
                 .hint = "vicinity check, which says what is wrong with it"});
  }
  constexpr double most_voxels = 1e11;        // of boundary: hours, and a file of many GiB
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
  // What lies beyond the scene's bounds is ranked too, and arrays are as large as an object.
  const double regions = ((size / (64 * h)).array() + 1).prod();
  if (area / (h * h) <= most_voxels && reach / h <= farthest_voxel && regions <= most_regions) {
    return;
  }
  throw Error({.what = "too large for this voxel size",
               .found = fmt::format("{:.6g} x {:.6g} x {:.6g} m, up to {:.6g} m from the origin",
                                    size.x(), size.y(), size.z(), reach),
               .expected = fmt::format("at most {:g} voxels on the surface and {:g} in its box",
                                       most_voxels, most_regions * 64 * 64 * 64),
               .hint = "the right units, or larger voxels"});
}

/// Bounds that hold every object with all its layers, from a multiple of the voxel size, so that a
/// scene that grows keeps its grid.
Box bounds_around(const std::vector<ObjectWork>& works, double h) {
  Box bounds;
  for (const ObjectWork& work : works) {
    const Vec3 margin = Vec3::Constant(h * reach_vox(*work.object));
    const Box& box = work.inspection.bounds;
    bounds.extend(Box(box.min() - margin, box.max() + margin));
  }
  return {((bounds.min() / h).array().floor() * h).matrix(), bounds.max()};
}

FieldObject describe(const ObjectWork& work, double h) {
  const SceneObject& object = *work.object;
  FieldObject described{.name = object.name,
                        .layers = object.layers,
                        .m = object.m,
                        .q = object.q,
                        .coding = object.coding,
                        .bound_mm = rank_bound_vox(object.layers, object.m, object.q) * h * 1000,
                        .closed = work.inspection.closed,
                        .triangles = work.inspection.triangles,
                        .boundary = work.array->counts()[object_code::boundary],
                        .inner = work.array->counts()[object_code::inner],
                        .ranks = {}};
  for (int n = 1; n <= object.q; ++n)
    described.ranks.push_back(work.array->counts()[object_code::of_rank(n)]);
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

std::vector<std::string> remarks_on(const ObjectWork& work, const FieldObject& described,
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
  const Box& box = work.inspection.bounds;
  const Vec3 far_corner =
      workspace.origin +
      workspace.voxel_size * Vec3(workspace.dims.i, workspace.dims.j, workspace.dims.k);
  if (!Box(box.min() - margin, box.max() + margin).intersects(Box(workspace.origin, far_corner))) {
    remarks.push_back(
        fmt::format("{} lies outside the workspace, and so do its layers.", title(object)));
  }
  return remarks;
}

[[noreturn]] void rethrow_naming(const SceneObject& object, std::exception_ptr error) {
  try {
    std::rethrow_exception(error);
  } catch (const Error& e) {
    ErrorParts parts = e.parts();
    parts.where = parts.where.empty() ? title(object) : title(object) + ", " + parts.where;
    throw Error(parts);
  }
}

/// Runs `step(work)` for every object at once. Of several errors, the first object's is thrown.
template <class Step>
void for_each_work(std::vector<ObjectWork>& works, Step&& step) {
  std::vector<std::exception_ptr> errors(works.size());
  whole::parallel_for(std::size_t{0}, works.size(), [&](std::size_t w) {
    try {
      step(works[w]);
    } catch (...) {
      errors[w] = std::current_exception();
    }
  });
  for (std::size_t w = 0; w < works.size(); ++w) {
    if (errors[w]) rethrow_naming(*works[w].object, errors[w]);
  }
}

/// Tells how far a build is. Parts of a stage report by themselves; nobody reports at the same time
/// as another, and what is told never falls.
class Progress {
 public:
  explicit Progress(const BuildOptions& options) : options_(options) {}

  /// Starts a stage that takes `share` of the build and consists of `parts` of the same weight.
  void start(const char* stage, double share, std::size_t parts) {
    begun_ += share_;
    stage_ = stage;
    share_ = share;
    done_.assign(parts, 0);
    sum_ = 0;
  }
  /// Part `part` of the stage is done to this degree, 0..1.
  void onward(std::size_t part, double done) {
    if (!options_.progress) return;
    const std::lock_guard lock(mutex_);
    sum_ += done - done_[part];
    done_[part] = done;
    const double all = sum_ / static_cast<double>(done_.size());
    told_ = std::max(told_, std::min(1.0, begun_ + share_ * all));
    options_.progress(stage_, told_);
  }

 private:
  const BuildOptions& options_;
  std::mutex mutex_;
  const char* stage_ = "";
  double begun_ = 0, share_ = 0, sum_ = 0, told_ = 0;
  std::vector<double> done_;
};

class Seconds {
 public:
  double since_last() {
    const auto now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

/// Shares the wall time of the tiles out to the stages that they went through.
void share_out(double wall, const StageTimes& times, BuildReport::Seconds& seconds) {
  const double all = static_cast<double>(times.voxelise + times.fill + times.rank);
  const auto part = [&](std::int64_t time) {
    return all > 0 ? wall * static_cast<double>(time) / all : 0;
  };
  seconds.voxelise = part(times.voxelise);
  seconds.fill = part(times.fill);
  seconds.rank = part(times.rank);
}

}  // namespace

struct FieldBuilder::Kept {
  Workspace workspace;
  std::vector<ObjectWork> works;  // without their meshes, by name
  std::vector<FieldObject> objects;
  MergedField merged;

  /// What is kept of an object that is the same as then; null where nothing is.
  const ObjectWork* same(const ObjectWork& work) const {
    const auto found = std::find_if(works.begin(), works.end(), [&](const ObjectWork& w) {
      return w.identity == work.identity;
    });
    return found == works.end() ? nullptr : &*found;
  }

  /// Marks the regions that hold other voxels than they did, or other winners: where an object that
  /// is not the same now was or is. Nothing where all is to be merged anew.
  std::optional<std::vector<char>> changed_regions(
      const Workspace& now, const std::vector<ObjectWork>& new_works,
      const std::vector<FieldObject>& new_objects) const;
};

namespace {

bool same_grid(const Workspace& a, const Workspace& b) {
  return a.origin == b.origin && a.voxel_size == b.voxel_size;
}

/// Marks the regions of the workspace in which an array has any voxel.
void mark(const ObjectVoxelArray& array, const VoxelIndex& dims, std::vector<char>& marked) {
  const VoxelIndex lo = array.lo(), size = array.size();
  const VoxelBox regions =
      VoxelBox{lo, {lo.i + size.i, lo.j + size.j, lo.k + size.k}}.within({{0, 0, 0}, dims});
  for (std::int32_t k = regions.lo.k; k < regions.hi.k; ++k) {
    for (std::int32_t j = regions.lo.j; j < regions.hi.j; ++j) {
      for (std::int32_t i = regions.lo.i; i < regions.hi.i; ++i) {
        if (array.codes().root()[array.cell_of({i, j, k})] == FieldReference::uniform(0)) continue;
        marked[(static_cast<std::size_t>(k) * static_cast<std::size_t>(dims.j) +
                static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(dims.i) +
               static_cast<std::size_t>(i)] = 1;
      }
    }
  }
}

}  // namespace

std::optional<std::vector<char>> FieldBuilder::Kept::changed_regions(
    const Workspace& now, const std::vector<ObjectWork>& new_works,
    const std::vector<FieldObject>& new_objects) const {
  const VoxelIndex& d = now.dims;
  // Codes of voxels are those of the earlier field only where the table of codes is the same.
  const auto same_codes = [](const FieldObject& a, const FieldObject& b) {
    return a.name == b.name && a.q == b.q && a.layers == b.layers;
  };
  if (!same_grid(workspace, now) || !(workspace.dims == d) ||
      !std::ranges::equal(objects, new_objects, same_codes)) {
    return std::nullopt;
  }
  const VoxelIndex dims = {(d.i + 63) >> 6, (d.j + 63) >> 6, (d.k + 63) >> 6};
  std::vector<char> changed(static_cast<std::size_t>(dims.i) * static_cast<std::size_t>(dims.j) *
                            static_cast<std::size_t>(dims.k));
  for (std::size_t o = 0; o < works.size(); ++o) {
    const bool same = works[o].array == new_works[o].array &&
                      objects[o].coding.mu == new_objects[o].coding.mu &&
                      objects[o].coding.skin == new_objects[o].coding.skin;
    if (same) continue;
    mark(*works[o].array, dims, changed);
    mark(*new_works[o].array, dims, changed);
  }
  return changed;
}

FieldBuilder::FieldBuilder() = default;
FieldBuilder::~FieldBuilder() = default;
FieldBuilder::FieldBuilder(FieldBuilder&&) noexcept = default;
FieldBuilder& FieldBuilder::operator=(FieldBuilder&&) noexcept = default;

BuildResult FieldBuilder::build(const Scene& scene, const BuildOptions& options) {
  if (options.threads < 0) {
    throw Error({.where = "threads",
                 .what = "not a number of threads",
                 .found = fmt::format("{}", options.threads),
                 .expected = "1 or more, or 0 for as many as the machine has"});
  }
  tbb::task_arena arena(options.threads == 0 ? tbb::task_arena::automatic : options.threads);
  return arena.execute([&] { return build_in_arena(scene, options); });
}

BuildResult FieldBuilder::build_in_arena(const Scene& scene, const BuildOptions& options) {
  Seconds all, stage;
  // Refuses a voxel size that is none before any mesh is read.
  Workspace workspace = Workspace::covering(Box(Vec3::Zero(), Vec3::Zero()), scene.voxel_size);
  std::vector<ObjectWork> works;
  for (const SceneObject* object : sorted_objects(scene)) works.emplace_back(*object);
  const double h = scene.voxel_size;
  BuildReport report;
  Progress progress(options);
  const auto index_of = [&](const ObjectWork& work) {
    return static_cast<std::size_t>(&work - works.data());
  };

  progress.start("read", 0.1, works.size());
  const auto read = [&](ObjectWork& work) {
    work.mesh = read_and_place(*work.object);
    work.inspection = inspect(work.mesh);
    check_usable(work, h);
  };
  for_each_work(works, [&](ObjectWork& work) {
    const ObjectWork* same = kept_ ? kept_->same(work) : nullptr;
    if (same != nullptr) {
      work.inspection = same->inspection;
      work.array = same->array;
    } else {
      read(work);
    }
    progress.onward(index_of(work), 1);
  });
  workspace = Workspace::covering(scene.bounds.value_or(bounds_around(works, h)), h);
  check_region_count(workspace);
  if (kept_ && !same_grid(kept_->workspace, workspace)) {
    for_each_work(works, [&](ObjectWork& work) {
      if (std::exchange(work.array, nullptr)) read(work);
    });
  }
  report.seconds.read = stage.since_last();

  progress.start("rank", 0.7, works.size());
  StageTimes times;
  report.objects_ranked = static_cast<int>(std::count_if(
      works.begin(), works.end(), [](const ObjectWork& w) { return w.array == nullptr; }));
  for_each_work(works, [&](ObjectWork& work) {
    const auto onward = [&](double done) { progress.onward(index_of(work), done); };
    if (!work.array) {
      work.array = std::make_shared<const ObjectVoxelArray>(
          object_voxel_array(*work.object, work.mesh, workspace, times, onward));
      work.mesh = {};
    }
    onward(1);
  });
  share_out(stage.since_last(), times, report.seconds);

  progress.start("merge", 0.2, 1);
  std::vector<FieldObject> objects;
  std::vector<const ObjectVoxelArray*> arrays;
  for (const ObjectWork& work : works) {
    objects.push_back(describe(work, h));
    for (auto& r : remarks_on(work, objects.back(), workspace)) report.remarks.push_back(r);
    arrays.push_back(work.array.get());
  }
  const auto changed = kept_ ? kept_->changed_regions(workspace, works, objects) : std::nullopt;
  const auto earlier =
      changed ? std::optional(EarlierMerge{kept_->merged, *changed}) : std::nullopt;
  MergedField merged = merge(workspace, objects, arrays, earlier ? &*earlier : nullptr,
                             [&](double done) { progress.onward(0, done); });
  report.seconds.merge = stage.since_last();

  const ViscosityField field = merged.field;
  report.boundary = field.voxel_counts().boundary;
  report.inner = field.voxel_counts().inner;
  report.neighbour = field.voxel_counts().neighbour;
  report.threads = tbb::this_task_arena::max_concurrency();
  for (ObjectWork& work : works) work.object = nullptr;  // the scene is the caller's
  kept_ = std::make_unique<Kept>(
      Kept{workspace, std::move(works), std::move(objects), std::move(merged)});
  report.seconds.total = all.since_last();
  return {field, report};
}

BuildResult build_field(const Scene& scene, const BuildOptions& options) {
  return FieldBuilder().build(scene, options);
}

}  // namespace vicinity
