// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/demo.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "commands/replay.h"
#include "commands/slice.h"
#include "commands/trace.h"
#include "demo/arm_motion.h"
#include "demo/scene_folder.h"
#include "field_summary.h"
#include "fresh_file.h"
#include "interruption.h"
#include "page.h"
#include "picture/chart.h"
#include "progress_bar.h"
#include "readable.h"
#include "scenes/hot_cell.h"
#include "vicinity/drag/trace.h"
#include "vicinity/mesh/inspection.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::cli {
namespace {

// Where the running program lies, so that a first command can be copied as it stands.
std::string this_program() {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? "the program that printed this" : path.string();
}

struct DemoTrack {
  const char* name;
  const char* title;
  const char* says;
  std::array<double, 3> from, to;
};

constexpr std::array tracks = {
    DemoTrack{"past_the_cone",
              "Past the cone",
              "A point passes 18 mm beside the cone. Drag rises in steps, one for each layer, and "
              "falls again behind it. Twice the speed is twice the drag; at rest there is none.",
              {0.96, 0.32, 0.76},
              {0.96, 0.68, 0.76}},
    DemoTrack{"along_the_complex_cylinder",
              "Along the complex cylinder",
              "Close along the side of the complex cylinder: two lips are felt, and between them "
              "the relief of the concavity.",
              {0.38, 0.412, 0.8},
              {0.68, 0.412, 0.8}},
    DemoTrack{
        "between_vessel_and_risers",
        "Between the vessel and the risers",
        "Through the gap of 120 mm between the vessel and the two riser pipes, where a camera "
        "sees little. Each riser is felt on its own, and the vessel between them.",
        {1.46, 0.84, 0.75},
        {1.46, 1.46, 0.75}},
};

constexpr std::array speeds = {0.05, 0.1, 0.2};  // [m/s]

struct DemoSlice {
  const char* file;
  char axis;
  double at;
  const char* box;  // of vicinity slice; empty: the whole cell
  const char* title;
  const char* says;
};

constexpr std::array slices = {
    DemoSlice{
        "bench_from_above.png", 'z', 0.76, "", "From above, through the things on the bench",
        "The cell 0.76 m above its floor: the window wall is below, with the bench before it. "
        "Each colour is a layer; the darker it is, the nearer the surface and the heavier "
        "the arm."},
    DemoSlice{"bench_close.png", 'z', 0.76, "0.12,0.3,0.7,1.48,0.7,0.9", "The paper's objects",
              "The circular, the complex and the hollow cylinder, the cone, and the wedge cut "
              "through its V. The narrow concavity of the complex cylinder fills up with the "
              "first layers; the wider ones let the arm in farther."},
    DemoSlice{"bench_across_y.png", 'y', 0.5, "", "Across y, through the bench and the valve",
              "Seen from the window: the five objects on the bench, the cone as a triangle and the "
              "wedge with its V, and on the right the valve with its handwheel."},
    DemoSlice{"vessel_across_x.png", 'x', 1.8, "", "Across x, through the middle of the vessel",
              "Dished ends, flanges with their gap, the nozzle and the vapour line that leaves it. "
              "The vessel is full: its inside needs no layers."},
    DemoSlice{"vessel_across_y.png", 'y', 1.15, "", "Across y, through the vessel",
              "Left the port in the wall and the drum, right the vessel. The cell is open at the "
              "top, for the crane."},
};

std::string coordinates(const std::array<double, 3>& p) {
  return fmt::format("{:g},{:g},{:g}", p[0], p[1], p[2]);
}

// One row per mesh, as vicinity check finds it.
std::vector<std::vector<std::string>> check_meshes(const std::vector<std::filesystem::path>& files,
                                                   ProgressBar& bar) {
  std::vector<std::vector<std::string>> rows = {{"mesh", "triangles", "verdict", "size [mm]"}};
  for (const auto& file : files) {
    bar.show("check " + file.stem().string(),
             static_cast<double>(rows.size()) / static_cast<double>(files.size()));
    const MeshInspection found = inspect(read_mesh(file));
    const Vec3 size = found.bounds.sizes();
    rows.push_back({file.filename().string(), grouped(found.triangles),
                    std::string(to_string(found.verdict)) + (found.closed ? ", closed" : ", open"),
                    fmt::format("{:.4g} x {:.4g} x {:.4g}", size.x(), size.y(), size.z())});
  }
  return rows;
}

BuildResult build_scene(const std::filesystem::path& scene, const std::filesystem::path& output,
                        ProgressBar& bar) {
  BuildResult result = build_field(
      read_scene(scene),
      {.progress = [&](std::string_view stage, double done) { bar.show(stage, done); }});
  const WhileWriting finish_first;
  save_field(result.field, output);
  return result;
}

struct Felt {
  double viscosity = 0;  // the most on the way [N·s/m³]
  double newtons = 0;    // at the highest speed
};

// A CSV file for each speed, and one picture over all of them.
Felt run_track(const DemoTrack& track, const ViscosityField& field,
               const std::filesystem::path& field_file, const std::filesystem::path& folder) {
  Felt most;
  Chart chart;
  chart.title = track.title;
  chart.caption =
      fmt::format("from ({}) to ({}) m, S = 1 m²", coordinates(track.from), coordinates(track.to));
  chart.x_label = "way along the track [m]";
  chart.panels.resize(2);
  chart.panels[0].y_label = "viscosity [N·s/m³]";
  chart.panels[1].y_label = "drag |F| [N]";
  for (const double speed : speeds) {
    std::ostringstream unheard;
    TraceOptions options;
    options.field = field_file;
    options.from = coordinates(track.from);
    options.to = coordinates(track.to);
    options.speed = speed;
    options.output = folder / fmt::format("{}_{:g}.csv", track.name, speed);
    cli::trace(options, unheard, unheard);

    Series drag{.name = fmt::format("{:g} m/s", speed), .points = {}, .steps = true};
    Series viscosity{.name = "μ", .points = {}, .steps = true};
    const Vec3 from(track.from.data()), to(track.to.data());
    for (const TraceSample& sample :
         vicinity::trace(field, {.from_W = from, .to_W = to, .speed = speed})) {
      const double way = (sample.p_WR - from).norm();
      drag.points.emplace_back(way, sample.force_W.norm());
      viscosity.points.emplace_back(way, sample.mu);
      most.viscosity = std::max(most.viscosity, sample.mu);
      most.newtons = std::max(most.newtons, sample.force_W.norm());
    }
    chart.panels[0].series = {viscosity};
    chart.panels[1].series.push_back(drag);
  }
  for (const char* extension : {".png", ".svg"}) {
    draw_chart(chart, folder / (std::string(track.name) + extension));
  }
  return most;
}

std::string command_of(const DemoTrack& track, double speed) {
  return fmt::format(
      "vicinity trace hot_cell.vicinity --from {} --to {} --speed {:g} -o {}_{:g}.csv "
      "--plot {}_{:g}.svg",
      coordinates(track.from), coordinates(track.to), speed, track.name, speed, track.name, speed);
}

std::string command_of(const DemoSlice& picture) {
  const std::string box = *picture.box == '\0' ? "" : fmt::format(" --box {}", picture.box);
  return fmt::format("vicinity slice hot_cell.vicinity --{} {:g}{} -o {}", picture.axis, picture.at,
                     box, picture.file);
}

void draw(const DemoSlice& picture, const std::filesystem::path& field_file,
          const std::filesystem::path& folder) {
  SliceOptions options;
  options.field = field_file;
  options.box = picture.box;
  options.output = folder / picture.file;
  (picture.axis == 'x' ? options.x : picture.axis == 'y' ? options.y : options.z) = picture.at;
  std::ostringstream unheard;
  slice(options, unheard, unheard);
}

// The arm's files, and what its operator would feel on the way to the vessel and back.
nlohmann::json run_arm(const std::filesystem::path& field_file,
                       const std::filesystem::path& folder) {
  FreshFile urdf(folder / "hot_cell_arm.urdf");
  urdf.write(hot_cell_arm_urdf);
  urdf.commit();
  write_arm_motion(folder / "arm_motion.csv");
  ReplayOptions options;
  options.field = field_file;
  options.arm.scene = folder / "scene.yaml";
  options.trajectory = folder / "arm_motion.csv";
  options.output = folder / "arm_felt.csv";
  options.plot = folder / "arm_felt.png";
  options.json = true;
  std::ostringstream summary, unheard;
  replay(options, summary, unheard);
  return nlohmann::json::parse(summary.str());
}

constexpr const char* arm_command =
    "vicinity replay hot_cell.vicinity --scene scene.yaml --trajectory arm_motion.csv "
    "-o arm_felt.csv --plot arm_felt.png";

Page page_of(const std::filesystem::path& folder, const BuildResult& built,
             std::vector<std::vector<std::string>> meshes) {
  Page page{.title = "A hot cell that can be felt",
            .says =
                "Vicinity wraps every object of a remote workplace in layers of viscosity. "
                "Whoever moves the arm feels them as drag: fast near a part is heavy, slow is "
                "light, standing still is free, and nothing ever pushes back. The commands below "
                "are for a shell in the folder of this page; vicinity is the program that made it, "
                "build/release/apps/cli/vicinity where it was not installed."};
  PageSection layers{
      .title = "The layers",
      .says = fmt::format("Cuts through the field of {}.", grid_in_words(built.field.workspace()))};
  for (const DemoSlice& each : slices) {
    layers.pictures.push_back({folder / each.file, each.title, each.says, command_of(each)});
  }
  PageSection drag{
      .title = "The drag",
      .says =
          "Three straight tracks, each at three speeds. The upper curve is the "
          "viscosity under the point, the lower ones the drag that it feels, "
          "F = -μ S v with a surface S of 1 m². The command makes the curve of one speed."};
  for (const DemoTrack& each : tracks) {
    drag.pictures.push_back({folder / (std::string(each.name) + ".png"), each.title, each.says,
                             command_of(each, speeds[1])});
  }
  const PageSection arm{
      .title = "The arm",
      .says =
          "From joint angles alone: every point of the arm's surface, 2000 to the square metre, "
          "feels the layer it is in, and the drag of all of them comes back as joint torques, as "
          "force at the tool, and with a reason.",
      .pictures = {{folder / "arm_felt.png", "To the vessel's flange and back",
                    "The arm swings round, reaches between the two risers to the flange, waits, "
                    "and goes back at half the speed. While it waits nothing is felt, however near "
                    "it is; the slow way back is light.",
                    arm_command}}};
  const PageSection scene{
      .title = "The scene",
      .says =
          "Every object is a mesh in millimetres, placed by scene.yaml. Move one, change a "
          "layer, and build it again.",
      .table = std::move(meshes),
      .commands = {"vicinity check meshes/vessel.stl --units mm",
                   "vicinity build scene.yaml -o hot_cell.vicinity",
                   "vicinity info hot_cell.vicinity"}};
  const PageSection next{
      .title = "What to try next",
      .says =
          "Ask for one point; let a retreat be free; let the filter smooth only what falls; "
          "take the field to another program; begin with a mesh of your own.",
      .commands = {"vicinity query hot_cell.vicinity 0.96 0.5 0.76",
                   command_of(tracks[0], speeds[1]) + " --direction closing",
                   command_of(tracks[2], speeds[1]) + " --memory rising",
                   std::string(arm_command) + " --direction closing",
                   "vicinity export hot_cell.vicinity -o hot_cell.vti",
                   "vicinity build PART.stl --units mm --voxel-size 0.002 -o part.vicinity"}};
  page.sections = {layers, drag, arm, scene, next};
  return page;
}

}  // namespace

int demo(const DemoOptions& options, std::ostream& out, std::ostream& err) {
  const auto start = std::chrono::steady_clock::now();
  const std::filesystem::path& folder = options.folder;
  const std::filesystem::path field_file = folder / "hot_cell.vicinity";
  std::string felt;

  auto bar = std::make_unique<ProgressBar>(err);
  const auto files = write_scene_folder(hot_cell_scene, folder);
  auto meshes = check_meshes(files, *bar);
  const BuildResult built = build_scene(folder / "scene.yaml", field_file, *bar);
  for (std::size_t n = 0; n < tracks.size(); ++n) {
    bar->show(tracks[n].title, static_cast<double>(n) / tracks.size());
    const WhileWriting finish_first;
    const Felt most = run_track(tracks[n], built.field, field_file, folder);
    felt += fmt::format("    {:<36} up to {:g} N·s/m³: {:.3g} N at {:g} m/s\n", tracks[n].title,
                        most.viscosity, most.newtons, speeds.back());
  }
  bar->show("the arm", 0);
  {
    const WhileWriting finish_first;
    const nlohmann::json summary = run_arm(field_file, folder);
    const nlohmann::json& most = summary["strongest"];
    felt += fmt::format("    {:<36} {:.3g} N by its {}, near the {}\n", "The arm, to the flange",
                        most["force"].get<double>(), most["link"].get<std::string>(),
                        most["object"].get<std::string>());
  }
  for (std::size_t n = 0; n < slices.size(); ++n) {
    bar->show(slices[n].title, static_cast<double>(n) / slices.size());
    const WhileWriting finish_first;
    draw(slices[n], field_file, folder);
  }
  write_page(page_of(folder, built, std::move(meshes)), folder / "index.html");
  bar.reset();

  std::uint64_t triangles = 0;
  for (const FieldObject& object : built.field.objects()) triangles += object.triangles;
  const BuildReport& report = built.report;
  out << fmt::format(
      R"(A small hot cell that can be felt, in {folder}/

  built   {objects} objects, {triangles} triangles, each mesh checked
          {boundary} boundary, {inner} inner and {neighbour} ranked voxels of {h:g} mm, in {file}
          {build} on {threads} threads; all of the demo {total}

  felt    the most on the way:
{felt}
  Look first at
    {folder}/index.html

  What lies beside it
    scene.yaml, meshes/    the cell, to copy and edit; its arm is hot_cell_arm.urdf
    arm_motion.csv         a log of the arm's joints; arm_felt.csv is what was felt
    hot_cell.vicinity      its field
    *.png, *.svg, *.csv    layers, drag, numbers

  Then type, with vicinity for {program}
    vicinity query {folder}/hot_cell.vicinity 0.96 0.5 0.76
    vicinity slice {folder}/hot_cell.vicinity --z 0.98 -o flange.png
    vicinity bench tick
    vicinity build PART.stl --units mm --voxel-size 0.002 -o part.vicinity
)",
      fmt::arg("program", this_program()), fmt::arg("folder", folder.string()),
      fmt::arg("objects", built.field.objects().size()), fmt::arg("triangles", grouped(triangles)),
      fmt::arg("boundary", grouped(report.boundary)), fmt::arg("inner", grouped(report.inner)),
      fmt::arg("neighbour", grouped(report.neighbour)),
      fmt::arg("h", 1000 * built.field.workspace().voxel_size),
      fmt::arg("file", bytes(built.field.image().size())),
      fmt::arg("build", seconds(report.seconds.total)), fmt::arg("threads", report.threads),
      fmt::arg(
          "total",
          seconds(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count())),
      fmt::arg("felt", felt));
  return 0;
}

}  // namespace vicinity::cli
