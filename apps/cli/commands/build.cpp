// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/build.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "arguments.h"
#include "field_summary.h"
#include "interruption.h"
#include "outputs.h"
#include "progress_bar.h"
#include "readable.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::cli {
namespace {

using Json = nlohmann::ordered_json;

std::uint64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

bool is_scene(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".yaml" || extension == ".yml";
}

Scene scene_of_one_mesh(const BuildOptions& options) {
  if (!options.meshes.empty()) {
    throw Error(
        {.where = "--meshes", .what = "is for a scene; a single mesh has a path of its own"});
  }
  if (options.units.empty()) {
    throw Error({.where = options.input.string(),
                 .what = "has no unit: none is stated, and none is read from mesh files",
                 .found = size_in_units(read_mesh(options.input).bounds()),
                 .hint = "--units with the reading that is right"});
  }
  Scene scene;
  scene.objects.push_back({.name = options.input.stem().string(),
                           .shape = MeshFile{options.input, unit_from("--units", options.units)}});
  return scene;
}

Scene scene_from_file(const BuildOptions& options) {
  if (!options.units.empty()) {
    throw Error({.where = "--units",
                 .what = "is for a single mesh; a scene states the units of each of its meshes"});
  }
  if (options.meshes.empty()) return read_scene(options.input);
  std::ifstream file(options.input);
  if (!file) {
    throw Error({.where = options.input.string(),
                 .what = "cannot be opened",
                 .hint = "a path that exists"});
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return parse_scene(text, options.meshes, options.input.string());
}

Coding coding_from(const std::string& text, int q) {
  const bool is_name = !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) != 0;
  return is_name ? named_coding(text, q) : Coding{.mu = numbers_from("--coding", text)};
}

void apply(const BuildOptions& given, Scene& scene) {
  constexpr std::array shapes = {std::pair{"cube", LayerShape::cube},
                                 std::pair{"sphere", LayerShape::sphere},
                                 std::pair{"distance", LayerShape::distance}};
  constexpr std::array boundaries = {std::pair{"exact", BoundaryMethod::exact},
                                     std::pair{"probe", BoundaryMethod::probe}};
  constexpr std::array inners = {std::pair{"winding", InnerMethod::winding},
                                 std::pair{"raster", InnerMethod::raster},
                                 std::pair{"none", InnerMethod::none}};
  if (given.voxel_size) scene.voxel_size = *given.voxel_size;
  if (given.bounds && *given.bounds == "auto") {
    scene.bounds.reset();
  } else if (given.bounds) {
    scene.bounds = box_from("--bounds", *given.bounds);
  }
  for (SceneObject& object : scene.objects) {
    if (given.m) object.m = *given.m;
    if (given.q) object.q = *given.q;
    if (given.shape) object.layers = one_of("--shape", *given.shape, shapes);
    if (given.boundary) object.boundary = one_of("--boundary", *given.boundary, boundaries);
    if (given.inner) object.inner = one_of("--inner", *given.inner, inners);
    if (given.coding) {
      const double skin = object.coding.skin;
      object.coding = coding_from(*given.coding, object.q);
      object.coding.skin = skin;
    }
    if (given.skin) object.coding.skin = *given.skin;
    if (object.q > 0 && object.coding.mu.size() < static_cast<std::size_t>(object.q)) {
      throw Error({.where = "object " + object.name,
                   .what = "has more ranks than viscosities",
                   .found = fmt::format("q = {} and {} values", object.q, object.coding.mu.size()),
                   .hint = "--coding jnd, which fits any q, or a longer list"});
    }
  }
}

Json as_json(const BuildOptions& options, const BuildResult& result, double seconds_writing) {
  const ViscosityField& field = result.field;
  const BuildReport& report = result.report;
  Json json = {{"field", options.output.string()}};
  add_grid(json, field.workspace());
  json["objects"] = Json::array();
  for (const FieldObject& object : field.objects()) {
    json["objects"].push_back({{"name", object.name},
                               {"triangles", object.triangles},
                               {"closed", object.closed},
                               {"boundary", object.boundary},
                               {"inner", object.inner},
                               {"ranks", object.ranks}});
  }
  json["voxels"] = {
      {"boundary", report.boundary}, {"inner", report.inner}, {"neighbour", report.neighbour}};
  json["file_bytes"] = field.image().size();
  json["peak_rss_bytes"] = peak_rss_bytes();
  json["threads"] = report.threads;
  json["seconds"] = {{"read", report.seconds.read},
                     {"voxelise", report.seconds.voxelise},
                     {"fill", report.seconds.fill},
                     {"rank", report.seconds.rank},
                     {"merge", report.seconds.merge},
                     {"write", seconds_writing},
                     {"total", report.seconds.total + seconds_writing}};
  json["remarks"] = report.remarks;
  return json;
}

std::string in_words(const BuildOptions& options, const BuildResult& result,
                     double seconds_writing) {
  const ViscosityField& field = result.field;
  const BuildReport& report = result.report;
  const Workspace& grid = field.workspace();
  std::string text = fmt::format("{}\n  {}\n\n{}\n", options.output.string(), grid_in_words(grid),
                                 objects_table(field));
  text += fmt::format("  voxels   {} boundary, {} inner, {} neighbour\n", grouped(report.boundary),
                      grouped(report.inner), grouped(report.neighbour));
  text += fmt::format("  bound    no point is more than {:.3g} mm nearer than its rank says\n",
                      largest_bound_mm(field));
  text += fmt::format("  file     {}\n", bytes(field.image().size()));
  text += fmt::format(
      "  time     {} on {} thread{}: read {}, voxelise {}, fill {}, rank {}, merge {}, "
      "write {}\n",
      seconds(report.seconds.total + seconds_writing), report.threads,
      report.threads == 1 ? "" : "s", seconds(report.seconds.read),
      seconds(report.seconds.voxelise), seconds(report.seconds.fill), seconds(report.seconds.rank),
      seconds(report.seconds.merge), seconds(seconds_writing));
  text += fmt::format("  memory   {} at most\n", bytes(peak_rss_bytes()));
  if (!report.remarks.empty()) text += "\n";
  for (const std::string& remark : report.remarks) text += fmt::format("  note: {}\n", remark);
  const double middle = grid.origin.z() + 0.5 * grid.voxel_size * grid.dims.k;
  text += fmt::format("\nLook at it:  vicinity slice {} --z {:.3g} -o slice.png\n",
                      options.output.string(), middle);
  return text;
}

std::vector<std::filesystem::path> files_read(const BuildOptions& options, const Scene& scene) {
  std::vector<std::filesystem::path> files = {options.input};
  for (const SceneObject& object : scene.objects) {
    if (const auto* mesh = std::get_if<MeshFile>(&object.shape)) files.push_back(mesh->path);
  }
  return files;
}

}  // namespace

int build(const BuildOptions& options, std::ostream& out, std::ostream& err) {
  Scene scene = is_scene(options.input) ? scene_from_file(options) : scene_of_one_mesh(options);
  apply(options, scene);
  check_outputs({{"-o", options.output}}, files_read(options, scene));

  double seconds_writing = 0;
  const BuildResult result = [&] {
    ProgressBar bar(err);
    BuildResult built = build_field(
        scene, {.threads = options.threads,
                .progress = [&](std::string_view stage, double done) { bar.show(stage, done); }});
    bar.show("write", 1);
    const auto start = std::chrono::steady_clock::now();
    const WhileWriting finish_first;
    save_field(built.field, options.output);
    seconds_writing =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return built;
  }();

  if (options.json) {
    out << as_json(options, result, seconds_writing).dump(2) << '\n';
  } else {
    out << in_words(options, result, seconds_writing);
  }
  return 0;
}

}  // namespace vicinity::cli
