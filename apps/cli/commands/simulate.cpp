// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/simulate.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <sstream>
#include <system_error>
#include <utility>

#include "arguments.h"
#include "demo/hot_cell.h"
#include "fresh_file.h"
#include "interruption.h"
#include "progress_bar.h"
#include "readable.h"
#include "simulate/study_report.h"
#include "simulation/study.h"
#include "vicinity/geometry/error.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::cli {
namespace {

constexpr std::size_t body_points = 150;
constexpr std::uint64_t tasks_seed = 20;
constexpr int log_every = 10;  // ms between two lines of a recording

// Lengths of the demo's arm that no task brings near anything: their points would only cost time.
const std::vector<std::string> demo_excludes = {"shoulder", "upper_arm", "elbow"};

struct Prepared {
  Workplace place;
  std::vector<Task> tasks;
  std::string words, urdf_text;
  std::filesystem::path urdf;  // empty: urdf_text
};

Scene scene_of(const SimulateOptions& options) {
  if (options.demo) return parse_scene(hot_cell_scene, {}, "the hot cell");
  Scene scene = read_scene(options.arm.scene);
  if (options.meshes.empty()) return scene;
  for (SceneObject& object : scene.objects) {
    auto* const mesh = std::get_if<MeshFile>(&object.shape);
    if (mesh == nullptr) continue;
    mesh->path = options.meshes / mesh->path.lexically_relative(options.arm.scene.parent_path());
  }
  return scene;
}

Arm arm_of(const SimulateOptions& options, const Scene& scene) {
  if (options.demo && options.arm.robot.empty()) return hot_cell_arm(options.arm);
  ArmOptions arm = options.arm;
  // A robot that is given needs none of the scene's; what it stands on may be a scene without one.
  if (!options.demo && !scene.robot && !arm.robot.empty()) arm.scene.clear();
  return read_arm(arm);
}

std::vector<std::string> excluded(const SimulateOptions& options, const Scene& scene) {
  if (!options.arm.exclude.empty()) {
    std::vector<std::string> names;
    std::istringstream list(options.arm.exclude);
    for (std::string name; std::getline(list, name, ',');) names.push_back(name);
    return names;
  }
  if (options.demo && options.arm.robot.empty()) return demo_excludes;
  return scene.robot && options.arm.robot.empty() ? scene.robot->exclude
                                                  : std::vector<std::string>();
}

Prepared prepare(const SimulateOptions& options) {
  if (options.demo == !options.arm.scene.empty()) {
    throw Error({.where = "vicinity simulate",
                 .what = options.demo ? "it has its own scene in --demo" : "no scene is given",
                 .hint = "SCENE, or --demo"});
  }
  const Scene scene = scene_of(options);
  Arm arm = arm_of(options, scene);
  const int links = static_cast<int>(arm.robot.links.size());
  const int tool = arm.teleoperation.tool_link < 0 ? links - 1 : arm.teleoperation.tool_link;
  Prepared prepared;
  prepared.words = fmt::format("{} in {}", arm.robot.name,
                               options.demo ? "the demo's hot cell" : options.arm.scene.string());
  // Whether the arm can be simulated at all is known before anything is built.
  (void)arm_as_mjcf(arm.robot, {});
  if (!(options.step_ms >= 1 && options.step_ms <= 5) ||
      options.step_ms != std::floor(options.step_ms)) {
    throw Error({.where = "--step-ms",
                 .what = "the time step of the physics cannot be used",
                 .found = fmt::format("{:g} ms", options.step_ms),
                 .expected = "1, 2, 3, 4 or 5 ms: beyond, contacts gain energy"});
  }
  prepared.place = build_workplace(scene, std::move(arm.robot), arm.X_WB, tool,
                                   excluded(options, scene), body_points, 1e-3 * options.step_ms);
  prepared.tasks = !options.tasks.empty() ? read_tasks(options.tasks)
                   : options.demo         ? parse_tasks(hot_cell_tasks, "the demo's tasks")
                                          : tasks_for(prepared.place, tasks_seed);
  fit_tasks(prepared.place, prepared.tasks, tasks_seed);
  if (options.demo && options.arm.robot.empty()) {
    prepared.urdf_text = hot_cell_arm_urdf;
  } else {
    prepared.urdf = options.arm.robot.empty() ? scene.robot->urdf : options.arm.robot;
  }
  return prepared;
}

void write_text(const std::string& text, const std::filesystem::path& path) {
  FreshFile file(path);
  file.write(text);
  file.commit();
}

// Joint logs of the first operator, one for each aid and task.
std::vector<std::string> record(const Prepared& prepared, const StudyResult& study,
                                std::uint64_t seed, const std::filesystem::path& folder) {
  std::vector<std::string> files;
  for (const CellResult& result : study.cells) {
    if (result.cell.part != Part::tasks) continue;
    const Task& task = prepared.tasks[result.cell.task];
    std::string text = "t";
    for (std::size_t c = 0; c < prepared.place.robot.coordinates.size(); ++c) {
      text += ',' + joint_name(prepared.place.robot, c);
    }
    text += '\n';
    long tick = 0;
    Trial trial(prepared.place, task, result.cell.method, result.cell.condition);
    trial.run(seed_for(seed, 0), result.trained, [&](double time_s, const AxisVector& q) {
      if (tick++ % log_every != 0) return;
      text += fmt::format("{:.6g}", time_s);
      for (const double angle : q) text += fmt::format(",{:.9g}", angle);
      text += '\n';
    });
    files.push_back("recordings/" + task.name + "_" + result.cell.method.name + ".csv");
    write_text(text, folder / files.back());
  }
  return files;
}

std::string line_of(const CellResult& result, const std::vector<Task>& tasks) {
  const Summary& s = result.summary;
  const Condition& condition = result.cell.condition;
  std::string where = tasks[result.cell.task].name;
  if (condition.delay_s > 0 || result.cell.part == Part::strict) {
    where += fmt::format(", {:.0f} ms {}", 1e3 * condition.delay_s, to_string(condition.placement));
  }
  if (result.cell.part == Part::strict) where += ", strict";
  if (result.cell.part == Part::devices) where += ", " + condition.device.name;
  return fmt::format(
      "{:<28} {:<17} touched {:>3.0f} %  {:5.2f} s  {:5.1f} N·s  {:5.1f} mm clear{}\n", where,
      result.cell.method.name, 100 * s.touched.value, s.time_s.value, s.effort.value,
      1e3 * s.clearance_m.value,
      s.most_given_j > 1e-4 ? fmt::format("  gave up to {:.2g} J", s.most_given_j) : "");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return;
  throw Error({.where = folder.string(),
               .what = "cannot be made",
               .found = error.message(),
               .hint = "another folder with -o"});
}

std::string command_of(const SimulateOptions& options) {
  std::string command =
      "vicinity simulate " + (options.demo ? "--demo" : options.arm.scene.string());
  if (!options.arm.robot.empty()) command += " --robot " + options.arm.robot.string();
  if (!options.arm.base.empty()) command += " --base " + options.arm.base;
  if (!options.tasks.empty()) command += " --tasks " + options.tasks.string();
  if (!options.methods.empty()) command += " --method " + options.methods;
  const SimulateOptions usual;
  for (const auto& folder : options.arm.packages) command += " --packages " + folder.string();
  if (!options.arm.exclude.empty()) command += " --exclude " + options.arm.exclude;
  if (!options.arm.tool.empty()) command += " --tool " + options.arm.tool;
  if (!options.meshes.empty()) command += " --meshes " + options.meshes.string();
  if (options.delays_ms != usual.delays_ms) command += " --delays " + options.delays_ms;
  if (options.step_ms != usual.step_ms) command += fmt::format(" --step-ms {:g}", options.step_ms);
  return command + fmt::format(" --trials {} --seed {} -o DIR", options.trials, options.seed);
}

StudyOptions study_options(const SimulateOptions& options) {
  StudyOptions study;
  study.trials = options.trials;
  study.seed = static_cast<std::uint64_t>(options.seed);
  study.threads = options.threads;
  study.delays_s.clear();
  for (const double ms : numbers_from("--delays", options.delays_ms)) {
    study.delays_s.push_back(1e-3 * ms);
  }
  std::istringstream list(options.methods);
  for (std::string name; std::getline(list, name, ',');) {
    study.methods.push_back(method_named(name).name);
  }
  return study;
}

}  // namespace

int simulate(const SimulateOptions& options, std::ostream& out, std::ostream& err) {
  const auto start = std::chrono::steady_clock::now();
  StudyOptions study_wanted = study_options(options);
  check(study_wanted);
  make_folder(options.folder / "recordings");
  auto bar = std::make_unique<ProgressBar>(err);
  bar->show("building the workplace", 0);
  const Prepared prepared = prepare(options);
  const WhileWriting to_the_end;  // a signal ends the study at the next trial
  study_wanted.stop = interruption_asked;
  study_wanted.progress = [&](std::string_view what, double done) { bar->show(what, done); };
  const StudyResult study = run_study(prepared.place, prepared.tasks, study_wanted);
  if (study.stopped) return 0;  // and leaves with what a signal asks for
  bar->show("recording", 1);

  StudyReport report{.study = study, .tasks = prepared.tasks, .options = study_wanted};
  report.place = prepared.words;
  report.command = command_of(options);
  report.recordings = record(prepared, study, study_wanted.seed, options.folder);
  save_field(prepared.place.ranked, options.folder / "field.vicinity");
  std::string urdf = prepared.urdf.string();
  if (urdf.empty()) {
    write_text(prepared.urdf_text, options.folder / "arm.urdf");
    urdf = "arm.urdf";
  }
  const Vec3 at = prepared.place.X_WB.translation();
  // Plus zero: minus zero is not how a person would write it.
  const Vec3 turn = prepared.place.X_WB.linear().eulerAngles(2, 1, 0) + Vec3::Zero();
  report.replay = fmt::format(
      "vicinity replay field.vicinity --robot {} --base {:g},{:g},{:g},{:g},{:g},{:g} --trajectory "
      "{} -o felt.csv --plot felt.png",
      urdf, at.x(), at.y(), at.z(), turn[2], turn[1], turn[0],
      report.recordings.empty() ? "LOG.csv" : report.recordings.front());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_text(as_json(report).dump(2) + '\n', options.folder / "study.json");
  write_text(trials_csv(report), options.folder / "trials.csv");
  write_text(as_markdown(report), options.folder / "tables.md");
  write_study_page(report, options.folder);
  bar.reset();

  if (options.json) {
    out << as_json(report).dump(2) << '\n';
  } else {
    for (const CellResult& result : study.cells) out << line_of(result, prepared.tasks);
    for (const Claim& claim : claims_of(report)) {
      out << fmt::format("{:<14} {}: {}\n",
                         claim.verdict == Claim::Verdict::holds   ? "holds"
                         : claim.verdict == Claim::Verdict::fails ? "DOES NOT HOLD"
                                                                  : "not shown",
                         claim.claim, claim.measured);
    }
    out << fmt::format("{}: {} cells of {} trials in {}\n",
                       (options.folder / "index.html").string(), study.cells.size(), options.trials,
                       seconds(report.seconds));
  }
  return 0;
}

}  // namespace vicinity::cli
