// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "peers/groups.h"
#include "plant_room/plant_room.h"
#include "vicinity/geometry/error.h"

namespace vicinity::peers {
namespace {

using Sense = Report::Sense;

struct LargeScene {
  std::string name;
  std::string arguments;  ///< for vicinity build
};

struct Build {
  double seconds = 0, cpu_seconds = 0, peak_bytes = 0, file_bytes = 0, voxels = 0;
};

double seconds_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// A build in a process of its own, so that its memory is its own. The shell forks for it, and does
/// not become it: a process inherits the peak memory of what it was before.
Build build(const LargeScene& scene, double h, const std::filesystem::path& scratch) {
  const auto field = scratch / "field.vicinity";
  const std::string command =
      fmt::format("'{}' build {} --voxel-size {} -o '{}' --json 2>/dev/null; exit $?",
                  VICINITY_PROGRAM, scene.arguments, h, field.string());
  std::fprintf(stderr, "  %s at %g mm\n", scene.name.c_str(), 1000 * h);
  std::string text;
  const double before = seconds_of_children();
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw Error({.where = command, .what = "cannot be started"});
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  if (pclose(pipe) != 0) throw Error({.where = command, .what = "failed"});
  std::filesystem::remove(field);
  const auto json = nlohmann::json::parse(text);
  double voxels = 0;
  for (const auto& [kind, count] : json.at("voxels").items()) voxels += count.get<double>();
  return {json.at("seconds").at("total").get<double>(), seconds_of_children() - before,
          json.at("peak_rss_bytes").get<double>(), json.at("file_bytes").get<double>(), voxels};
}

}  // namespace

void measure_scale(Report& report, const GroupOptions& options) {
  benchmarks::write_scene(benchmarks::plant_room(), options.scratch / "plant_room");
  std::vector<LargeScene> scenes = {
      {"plant room",
       fmt::format("'{}'", (options.scratch / "plant_room" / "scene.yaml").string())}};
  if (const char* data = std::getenv("VICINITY_DATA")) {
    scenes.push_back({"ARIAC work cell",
                      fmt::format("'{}/ariac_workcell.yaml' --meshes '{}/scenes/ariac_workcell'",
                                  VICINITY_SCENES, data)});
  } else {
    std::fputs("  no VICINITY_DATA, so no ARIAC work cell\n", stderr);
  }
  const std::vector<double> sizes =
      options.scale ? std::vector{0.008, 0.004, 0.002, 0.001} : std::vector{0.016, 0.008};
  constexpr double gib = 1024.0 * 1024 * 1024;
  for (const LargeScene& scene : scenes) {
    std::optional<Build> coarser;
    for (const double h : sizes) {
      const Build built = build(scene, h, options.scratch);
      report.line("scale", "scene,voxel_mm,wall_s,cpu_s,peak_rss_bytes,file_bytes,voxels_not_empty",
                  fmt::format("{},{:g},{:.4g},{:.4g},{:.0f},{:.0f},{:.0f}", scene.name, 1000 * h,
                              built.seconds, built.cpu_seconds, built.peak_bytes, built.file_bytes,
                              built.voxels));
      if (h == 0.001) {
        report.target("scale, 1 mm: peak memory [GiB]", Sense::at_most, 8, built.peak_bytes / gib,
                      scene.name);
        report.target("scale, 1 mm: file [GiB]", Sense::at_most, 2, built.file_bytes / gib,
                      scene.name);
        report.target("scale, 1 mm: minutes to build", Sense::at_most, 60, built.seconds / 60,
                      scene.name);
        report.target("scale: CPU time grows from 2 to 1 mm (surface 4, volume 8)", Sense::at_most,
                      5, built.cpu_seconds / coarser->cpu_seconds, scene.name);
      }
      coarser = built;
    }
  }
  if (!options.scale) {
    for (const auto& [name, goal] :
         {std::pair{"scale, 1 mm: peak memory [GiB]", 8.0},
          std::pair{"scale, 1 mm: file [GiB]", 2.0},
          std::pair{"scale, 1 mm: minutes to build", 60.0},
          std::pair{"scale: CPU time grows from 2 to 1 mm (surface 4, volume 8)", 5.0}}) {
      report.not_measured(name, Sense::at_most, goal, "takes minutes: --scale");
    }
  }
}

}  // namespace vicinity::peers
