// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The command line: words in, one command called, an exit code out.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "command_line.h"
#include "commands/bench_tick.h"
#include "commands/bridge.h"
#include "commands/build.h"
#include "commands/check.h"
#include "commands/demo.h"
#include "commands/export.h"
#include "commands/info.h"
#include "commands/query.h"
#include "commands/replay.h"
#include "commands/reproduce.h"
#include "commands/simulate.h"
#include "commands/slice.h"
#include "commands/trace.h"
#include "exit_code.h"
#ifdef VICINITY_VIEWER
#include "serve.h"
#endif
#include "vicinity/geometry/error.h"

namespace vicinity::cli {
namespace {

constexpr const char* welcome =
    R"(Vicinity lets the operator of a remote arm feel how close the arm is to things.

  vicinity demo                 see all of it at once, on a small hot cell; takes seconds
  vicinity check MESH           what is wrong with a mesh
  vicinity build SCENE -o F     meshes into a viscosity field
  vicinity info F               what is in a field
  vicinity query F X Y Z        what is at a point
  vicinity trace F ...          the drag on a point along a straight track
  vicinity replay F ...         a joint log of an arm: what its operator would feel
  vicinity slice F ...          a picture of the layers
  vicinity serve F              see the layers and drive an arm through them, in a browser
  vicinity bridge F ...         feel for an arm in ROS 2, or on two machines, over DDS
  vicinity export F -o ...      for numpy, ParaView, Blender
  vicinity simulate ...         operators in simulation: does any of it help?
  vicinity reproduce -o DIR     the paper's figures and tables, ours beside theirs
  vicinity bench tick           what the tick of an arm costs on this machine

Each of them explains itself with --help, and shows an example.
)";

using Run = std::function<int()>;

// Something to write. An empty name would be taken for one that was not said.
CLI::Option* add_output(CLI::App& app, const std::string& option, std::filesystem::path& path,
                        const std::string& does) {
  return app.add_option(option, path, does)->check([](const std::string& name) {
    return name.empty() ? std::string("an empty name names nothing to write") : std::string();
  });
}

// A subcommand whose options live as long as it may run.
template <class Options>
struct Command {
  CLI::App& app;
  std::shared_ptr<Options> options = std::make_shared<Options>();

  Command(CLI::App& parent, const char* name, const char* does, const char* example)
      : app(*parent.add_subcommand(name, does)) {
    app.footer(std::string("Example:\n  ") + example);
  }

  void runs(int (*function)(const Options&, std::ostream&, std::ostream&), Run& run) {
    app.callback([function, &run, held = options] {
      run = [function, held] { return function(*held, std::cout, std::cerr); };
    });
  }
};

void add_check(CLI::App& parent, Run& run) {
  Command<CheckOptions> command(parent, "check", "Say what is wrong with a mesh, in words",
                                "vicinity check vessel.stl --units mm");
  auto& [app, options] = command;
  app.add_option("MESH", options->mesh, "STL, OBJ, PLY, glTF, 3MF or DAE file")->required();
  app.add_option("--units", options->units,
                 "mm, cm, m or in: what one unit of the file means; a unit that it states itself "
                 "is not read");
  app.add_flag("--json", options->json, "for programs");
  command.runs(check, run);
}

void add_build(CLI::App& parent, Run& run) {
  Command<BuildOptions> command(
      parent, "build", "Build the viscosity field of a scene, or of one mesh",
      "vicinity build cell.yaml -o cell.vicinity\n"
      "  vicinity build vessel.stl --units mm --voxel-size 0.002 -o vessel.vicinity");
  auto& [app, options] = command;
  app.add_option("INPUT", options->input, "scene (.yaml, .yml) or mesh file")->required();
  add_output(app, "-o,--output", options->output, "the field to write")->required();
  app.add_option("--units", options->units,
                 "of a single mesh, whatever it states itself: mm, cm, m or in");
  app.add_option("--meshes", options->meshes,
                 "folder that relative mesh paths start at; default: that of the scene file");
  app.add_option("--voxel-size", options->voxel_size, "edge of a voxel [m]");
  app.add_option("--m", options->m, "voxels per rank, 1 to 8, for every object");
  app.add_option("--q", options->q, "number of ranks, 0 to 32, for every object");
  app.add_option("--shape", options->shape, "of the layers: cube, sphere or distance");
  app.add_option("--coding", options->coding,
                 "viscosity by rank: 32,25,20,... or linear, nonlinear, jnd, paper");
  app.add_option("--skin", options->skin, "viscosity of boundary and inner voxels");
  app.add_option("--boundary", options->boundary, "boundary voxels: exact or probe");
  app.add_option("--inner", options->inner, "inner voxels: winding, raster or none");
  app.add_option("--bounds", options->bounds, "of the workspace: x,y,z,x,y,z [m] or auto");
  app.add_option("--threads", options->threads, "0: as many as the machine has")
      ->check(CLI::Range(0, 1024));
  app.add_flag("--json", options->json, "for programs");
  command.runs(build, run);
}

void add_info(CLI::App& parent, Run& run) {
  Command<InfoOptions> command(parent, "info", "Say what is in a field",
                               "vicinity info cell.vicinity");
  auto& [app, options] = command;
  app.add_option("FIELD", options->field, "made by vicinity build")->required();
  app.add_flag("--json", options->json, "for programs");
  command.runs(info, run);
}

void add_export(CLI::App& parent, Run& run) {
  Command<ExportOptions> command(
      parent, "export", "Write a field for numpy (.npy), OpenVDB (.vdb) or ParaView (.vti)",
      "vicinity export cell.vicinity -o cell.npy --what rank --box 0,0,0,0.5,0.5,0.5");
  auto& [app, options] = command;
  app.add_option("FIELD", options->field, "made by vicinity build")->required();
  add_output(app, "-o,--output", options->output,
             "file to write; its ending says the format; beside NAME.npy, NAME.json is "
             "written too, with origin and voxel size")
      ->required();
  app.add_option("--what", options->what,
                 "rank (boundary 0, empty -1, inner -2), viscosity, object or distance; default: "
                 "rank, and in a .vdb viscosity too");
  app.add_option("--box", options->box, "only this part: x,y,z,x,y,z [m]");
  command.runs(export_field, run);
}

void add_query(CLI::App& parent, Run& run) {
  Command<QueryOptions> command(parent, "query", "Say what is at a point",
                                "vicinity query cell.vicinity 0.4 0.1 -0.25\n"
                                "  vicinity query cell.vicinity --json < points.csv");
  auto& [app, options] = command;
  app.add_option("FIELD", options->field, "made by vicinity build")->required();
  app.add_option("POINT", options->point, "x y z [m]; without it, lines x,y,z on standard input")
      ->expected(3);
  app.add_flag("--json", options->json, "for programs");
  command.runs(query, run);
}

void add_trace(CLI::App& parent, Run& run) {
  Command<TraceOptions> command(
      parent, "trace", "Move a point along a straight track and write the drag it feels",
      "vicinity trace cell.vicinity --from 0,0,0.1 --to 1,0,0.1 --speed 0.2 -o t.csv --plot t.svg");
  auto& [app, options] = command;
  app.add_option("FIELD", options->field, "made by vicinity build")->required();
  app.add_option("--from", options->from, "x,y,z [m]")->required();
  app.add_option("--to", options->to, "x,y,z [m]")->required();
  app.add_option("--speed", options->speed, "[m/s]")->capture_default_str();
  app.add_option("--rate", options->rate, "samples per second")->capture_default_str();
  app.add_option("--area", options->area, "surface S of the point [m²]")->capture_default_str();
  app.add_option("--memory", options->memory, "none, sustained, fading, short or rising")
      ->capture_default_str();
  app.add_option("--direction", options->direction,
                 "all: oppose the whole velocity; closing: only what comes nearer")
      ->capture_default_str();
  app.add_option("--traversal", options->traversal,
                 "swept: record every voxel passed; sampled: end points only")
      ->capture_default_str();
  app.add_option("--coding", options->coding,
                 "try another one: 32,25,20,... or linear, nonlinear, jnd, paper");
  add_output(app, "-o,--output", options->output, "CSV file; default: standard output");
  add_output(app, "--plot", options->plot, "draw it too: .svg or .png");
  command.runs(trace, run);
}

void add_replay(CLI::App& parent, Run& run) {
  Command<ReplayOptions> command(
      parent, "replay", "Replay a joint log: torques, force and the reason for every tick",
      "vicinity replay cell.vicinity --robot arm.urdf --base 0,0,0.8,0,0,0 --trajectory log.csv "
      "\\\n"
      "      --columns 't=Time*0.001,joint_1=Position1' -o felt.csv --plot felt.svg");
  auto& [app, options] = command;
  app.add_option("FIELD", options->field, "made by vicinity build")->required();
  add_arm(app, options->arm);
  CLI::Option* const density = add_density(app, options->arm);
  app.add_option("--points", options->arm.points, "body points in all, in place of a density")
      ->check(CLI::Range(std::size_t{1}, BodyPoints::most))
      ->excludes(density);
  add_feel(app, options->arm);
  app.add_option("--trajectory", options->trajectory,
                 "joint log: CSV with a header, or .mcap with ROS 2 joint states; positions run "
                 "smoothly between its lines");
  app.add_option("--columns", options->columns,
                 "which column is what, with a factor for its unit: t=Time*0.001,joint_1=Position1,"
                 "qd_joint_1=Velocity1; default: t or time, and the joints' names");
  app.add_option("--coding", options->coding,
                 "try another one: 32,25,20,... or linear, nonlinear, jnd, paper");
  app.add_option("--duration", options->duration,
                 "go there and back for so long [s]; default: once");
  app.add_flag("--realtime", options->real_time, "at the rate's pace, not as fast as it can");
  app.add_flag("--check-only", options->check_only,
               "load field and robot (and log), say what is odd, tick nothing");
  add_output(app, "-o,--output", options->output, "what came out, by tick: CSV, .jsonl or .mcap");
  add_output(app, "--plot", options->plot, "draw it: .svg or .png");
  app.add_flag("--json", options->json, "the summary, for programs");
  command.runs(replay, run);
}

#ifdef VICINITY_VIEWER
void add_serve(CLI::App& parent, Run& run) {
  Command<viewer::ServeOptions> command(
      parent, "serve", "Show a field and an arm in a browser, to be looked at and driven",
      "vicinity serve cell.vicinity --robot arm.urdf --base 0,0,0.8,0,0,0\n"
      "  vicinity serve scene.yaml");
  auto& [app, options] = command;
  app.add_option("INPUT", options->input, "made by vicinity build, or a scene (.yaml, .yml)")
      ->required();
  add_arm(app, options->arm);
  add_density(app, options->arm);
  add_feel(app, options->arm);
  app.add_option("--start", options->start, "where its joints are at first: q,q,... [rad or m]");
  app.add_option("--port", options->port, "0 takes one that is free")->capture_default_str();
  app.add_option("--bind", options->bind,
                 "address to listen at; any but the loopback needs --token")
      ->capture_default_str();
  app.add_option("--token", options->token, "what a page must know to be let in");
  add_output(app, "--folder", options->folder, "for uploads, saved scenes and fields")
      ->capture_default_str();
  app.add_option("--recording", options->recordings,
                 "outputs of vicinity replay, and joint logs, that the page can play");
  add_output(app, "--shot", options->shot, "draw the page into this .png, and end");
  app.add_option("--shot-view", options->shot_view,
                 "what of it: key=value&key=value, as in the page's address");
  app.add_option("--seconds", options->seconds, "end after so long; default: Ctrl-C")
      ->check(CLI::PositiveNumber);
  command.runs(viewer::serve, run);
}
#endif

void add_slice(CLI::App& parent, Run& run) {
  Command<SliceOptions> command(parent, "slice", "Draw the layers in a plane, as a picture",
                                "vicinity slice cell.vicinity --z 0.04 -o s.png");
  auto& [app, options] = command;
  app.add_option("FIELD", options->field, "made by vicinity build")->required();
  app.add_option("--x", options->x, "plane across x [m]");
  app.add_option("--y", options->y, "plane across y [m]");
  app.add_option("--z", options->z, "plane across z [m]");
  app.add_option("--box", options->box,
                 "only this part, which the plane passes through: x,y,z,x,y,z [m]");
  add_output(app, "-o,--output", options->output, "picture to write: .png or .svg")->required();
  command.runs(slice, run);
}

void add_bench(CLI::App& parent, Run& run) {
  CLI::App& bench = *parent.add_subcommand("bench", "Measure what things cost on this machine");
  bench.require_subcommand(1);
  bench.footer("Example:\n  vicinity bench tick");
  Command<BenchTickOptions> command(bench, "tick", "Time the tick of an arm with many body points",
                                    "vicinity bench tick --points 1000,100000\n"
                                    "  vicinity bench tick cell.vicinity --robot arm.urdf");
  auto& [app, options] = command;
  app.add_option("FIELD", options->field,
                 "made by vicinity build; default: the demo's hot cell, with its arm");
  add_arm(app, options->arm);
  app.add_option("--points", options->points, "how many body points, one number or several")
      ->capture_default_str();
  app.add_option("--seconds", options->seconds, "to measure each of them for")
      ->capture_default_str();
  add_feel(app, options->arm);
  app.add_flag("--json", options->json, "for programs");
  command.runs(bench_tick, run);
}

void add_demo(CLI::App& parent, Run& run) {
  Command<DemoOptions> command(parent, "demo",
                               "Build, trace and picture a small hot cell; needs nothing of yours",
                               "vicinity demo -o my-demo");
  auto& [app, options] = command;
  add_output(app, "-o,--output", options->folder, "folder to leave everything in")
      ->capture_default_str();
  command.runs(demo, run);
}

void add_simulate(CLI::App& parent, Run& run) {
  Command<SimulateOptions> command(
      parent, "simulate", "Let simulated operators work with and without aids, and say which help",
      "vicinity simulate --demo -o study\n"
      "  vicinity simulate cell.yaml --trials 20 --method none,closing,rising -o study");
  auto& [app, options] = command;
  app.add_option("SCENE", options->scene, "scene with a 'robot' block, or with --robot");
  app.add_flag("--demo", options->demo, "the demo's hot cell, its arm and six tasks");
  add_output(app, "-o,--output", options->folder, "folder to leave everything in")->required();
  app.add_option("--trials", options->trials, "operators in each cell")->capture_default_str();
  app.add_option("--seed", options->seed, "same seed, same numbers")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  app.add_option("--method", options->methods,
                 "only these aids: none, potential_field, virtual_fixture, speed_scaling, "
                 "all_I_none ... all_II_short, closing, distance, jnd, rising");
  app.add_option("--tasks", options->tasks,
                 "YAML file of tasks; default: approaches and retreats made for the scene");
  app.add_option("--delays", options->delays_ms, "there and back [ms]")->capture_default_str();
  app.add_option("--step-ms", options->step_ms, "of the physics and the slave's servo, 1 to 5 [ms]")
      ->capture_default_str();
  app.add_option("--threads", options->threads, "0: as many as the machine has")
      ->check(CLI::Range(0, 1024));
  app.add_option("--robot", options->robot, "URDF file of the arm, with inertia");
  app.add_option("--base", options->base, "where it stands: x,y,z,roll,pitch,yaw [m, rad]");
  app.add_option("--packages", options->packages,
                 "folders for the package:// addresses of its meshes");
  app.add_option("--exclude", options->exclude, "links that feel nothing: base_link,...");
  app.add_option("--tool", options->tool, "link that the hand leads; default: the last one");
  app.add_option("--meshes", options->meshes,
                 "folder that relative mesh paths start at; default: that of the scene file");
  app.add_flag("--json", options->json, "for programs");
  command.runs(simulate, run);
}

void add_reproduce(CLI::App& parent, Run& run) {
  Command<ReproduceOptions> command(
      parent, "reproduce", "Make every figure and table of the paper, ours beside theirs",
      "vicinity reproduce -o report\n  vicinity reproduce --only fig22 -o report");
  auto& [app, options] = command;
  add_output(app, "-o,--output", options->folder, "folder to leave the report in")->required();
  app.add_option("--only", options->only, "one item, as fig22 or table1");
  command.runs(reproduce, run);
}

#ifndef VICINITY_VIEWER
void refuse_serve(int argc, char** argv) {
  if (argc < 2 || std::string_view(argv[1]) != "serve") return;
  throw Error({.where = "serve",
               .what = "this vicinity was built without the viewer",
               .hint = "building it with -DVICINITY_VIEWER=ON"});
}
#endif

int run(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "bridge") become_bridge(argv + 2);
  CLI::App app("Feel how close a remote arm is to things before it touches them.", "vicinity");
  app.set_version_flag("--version", "vicinity " VICINITY_VERSION);
  app.require_subcommand(0, 1);
  Run chosen;
  add_demo(app, chosen);
  add_check(app, chosen);
  add_build(app, chosen);
  add_info(app, chosen);
  add_query(app, chosen);
  add_trace(app, chosen);
  add_replay(app, chosen);
  add_slice(app, chosen);
  add_export(app, chosen);
  add_simulate(app, chosen);
  add_reproduce(app, chosen);
  add_bench(app, chosen);
#ifdef VICINITY_VIEWER
  add_serve(app, chosen);
#else
  refuse_serve(argc, argv);
#endif
  app.add_subcommand("bridge", bridge_does);
  app.footer("Example:\n  vicinity demo");

  return run_words(app, argc, argv, [&] {
    if (chosen) return chosen();
    std::cout << welcome;
    return 0;
  });
}

}  // namespace
}  // namespace vicinity::cli

int main(int argc, char** argv) {
  return vicinity::cli::exit_code_of([&] { return vicinity::cli::run(argc, argv); });
}
