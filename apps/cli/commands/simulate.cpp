// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/simulate.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <system_error>
#include <utility>

#include "arguments.h"
#include "fresh_file.h"
#include "interruption.h"
#include "progress_bar.h"
#include "readable.h"
#include "replay/arm.h"
#include "simulate/study_page.h"
#include "simulation/study_setup.h"
#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::cli {
namespace {

constexpr int log_every = 10;  // ms between two lines of a recording

Scene scene_of(const SimulateOptions& options) {
  Scene scene = read_scene(options.scene);
  if (options.meshes.empty()) return scene;
  for (SceneObject& object : scene.objects) {
    auto* const mesh = std::get_if<MeshFile>(&object.shape);
    if (mesh == nullptr) continue;
    mesh->path = options.meshes / mesh->path.lexically_relative(options.scene.parent_path());
  }
  return scene;
}

StudySetup setup_of(const SimulateOptions& options) {
  if (options.demo == !options.scene.empty()) {
    throw Error({.where = "vicinity simulate",
                 .what = options.demo ? "it has its own scene in --demo" : "no scene is given",
                 .hint = "SCENE, or --demo"});
  }
  StudySetup setup;
  if (!options.demo) {
    setup.scene = scene_of(options);
    setup.name = options.scene.string();
  }
  setup.robot = options.robot;
  if (!options.base.empty()) setup.X_WB = pose_from("--base", options.base);
  setup.packages = options.packages;
  setup.exclude = words_from(options.exclude);
  setup.tool = options.tool;
  setup.tasks = options.tasks;
  setup.step_s = 1e-3 * options.step_ms;
  return setup;
}

void write_text(const std::string& text, const std::filesystem::path& path) {
  FreshFile file(path);
  file.write(text);
  file.commit();
}

// Joint logs of the first operator, one for each aid and task.
std::vector<std::string> record(const PreparedStudy& prepared, const StudyResult& study,
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
  std::string command = "vicinity simulate " + (options.demo ? "--demo" : options.scene.string());
  if (!options.robot.empty()) command += " --robot " + options.robot.string();
  if (!options.base.empty()) command += " --base " + options.base;
  if (!options.tasks.empty()) command += " --tasks " + options.tasks.string();
  if (!options.methods.empty()) command += " --method " + options.methods;
  const SimulateOptions usual;
  for (const auto& folder : options.packages) command += " --packages " + folder.string();
  if (!options.exclude.empty()) command += " --exclude " + options.exclude;
  if (!options.tool.empty()) command += " --tool " + options.tool;
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
  for (const std::string& name : words_from(options.methods)) {
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
  const PreparedStudy prepared = prepare_study(setup_of(options));
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
