// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Master, slave and operator in simulation, for Python.

#include "simulation/study.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "beside_interpreter.h"
#include "casters.h"
#include "docstrings.h"
#include "parts.h"
#include "simulation/not_built.h"
#include "simulation/study_report.h"
#include "simulation/study_setup.h"
#include "vicinity/viscosity/scene_file.h"

namespace py = pybind11;
using namespace py::literals;

namespace vicinity::python {
namespace {

// A study that has ended, with all that its report is made from.
struct Study {
  StudyOptions options;
  std::vector<Task> tasks;
  StudyResult result;

  StudyReport report() const { return {.study = result, .tasks = tasks, .options = options}; }
};

// One cell, with the names of what it is about.
struct StudyCell {
  std::string task;
  CellResult result;
};

#ifdef VICINITY_SIMULATION
Study run(const StudySetup& setup, StudyOptions options, const Report& report) {
  options.progress = report;
  check(options);
  report("building the workplace", 0);
  const PreparedStudy prepared = prepare_study(setup);
  StudyResult result = run_study(prepared.place, prepared.tasks, options);
  options.progress = nullptr;
  return {std::move(options), prepared.tasks, std::move(result)};
}
std::string trials_csv_of(const Study& study) { return trials_csv(study.report()); }
std::string json_of(const Study& study) { return as_json(study.report()).dump(2) + '\n'; }
std::string tables_of(const Study& study) { return as_markdown(study.report()); }
const char* name_of(Part part) { return to_string(part); }
#else
Study run(const StudySetup&, const StudyOptions&, const Report&) { refuse_to_simulate(); }
std::string trials_csv_of(const Study&) { return {}; }
std::string json_of(const Study&) { return {}; }
std::string tables_of(const Study&) { return {}; }
const char* name_of(Part) { return ""; }
#endif

// None: the demo; a Scene; or the path of one.
void set_scene(StudySetup& setup, const py::object& scene) {
  if (scene.is_none()) return;
  if (const auto given = scene_from(scene)) {
    setup.scene = given;
    return;
  }
  const auto path = scene.cast<std::filesystem::path>();
  setup.scene = read_scene(path);
  setup.name = path.string();
}

void add_results(py::module_& module) {
  py::class_<Estimate>(module, "Estimate", doc::Estimate)
      .def_readonly(VICINITY_PLAIN_MEMBER(Estimate, value))
      .def_readonly(VICINITY_PLAIN_MEMBER(Estimate, low))
      .def_readonly(VICINITY_PLAIN_MEMBER(Estimate, high));
  py::class_<TrialResult>(module, "TrialResult", doc::TrialResult)
      .def_readonly(VICINITY_MEMBER(TrialResult, finished))
      .def_readonly(VICINITY_PLAIN_MEMBER(TrialResult, touched))
      .def_readonly(VICINITY_MEMBER(TrialResult, blew_up))
      .def_readonly(VICINITY_MEMBER(TrialResult, impact_speed))
      .def_readonly(VICINITY_MEMBER(TrialResult, peak_force))
      .def_readonly(VICINITY_MEMBER(TrialResult, overshoot_m))
      .def_readonly(VICINITY_MEMBER(TrialResult, miss_m))
      .def_readonly(VICINITY_MEMBER(TrialResult, time_s))
      .def_readonly(VICINITY_MEMBER(TrialResult, effort))
      .def_readonly(VICINITY_MEMBER(TrialResult, clearance_m))
      .def_readonly(VICINITY_MEMBER(TrialResult, pushed_j))
      .def_readonly(VICINITY_MEMBER(TrialResult, given_j))
      .def_readonly(VICINITY_MEMBER(TrialResult, given_beyond_device_j));
  py::class_<Summary>(module, "Summary", "What all trials of a cell say.")
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, trials))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, touched))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, finished))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, impact_speed))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, peak_force))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, overshoot_m))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, miss_m))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, time_s))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, effort))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, clearance_m))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, pushed_j))
      .def_readonly(VICINITY_MEMBER(Summary, given_j))
      .def_readonly(VICINITY_MEMBER(Summary, most_given_j))
      .def_readonly(VICINITY_MEMBER(Summary, most_beyond_device_j))
      .def_readonly(VICINITY_MEMBER(Summary, gave))
      .def_readonly(VICINITY_PLAIN_MEMBER(Summary, blew_up));
}

template <class Get>
auto of_cell(Get&& get) {
  return [get](const StudyCell& cell) { return get(cell.result); };
}

void add_study_itself(py::module_& module) {
  py::class_<StudyCell>(module, "StudyCell", "One aid at one task under one condition.")
      .def_property_readonly(
          "part", of_cell([](const CellResult& cell) { return name_of(cell.cell.part); }),
          "Which question it belongs to: tasks, delay, beside, strict or devices.")
      .def_readonly("task", &StudyCell::task)
      .def_property_readonly("method",
                             of_cell([](const CellResult& cell) { return cell.cell.method.name; }))
      .def_property_readonly("mode",
                             of_cell([](const CellResult& cell) { return cell.cell.method.mode; }))
      .def_property_readonly(
          "delay_s", of_cell([](const CellResult& cell) { return cell.cell.condition.delay_s; }),
          doc::Condition_delay_s)
      .def_property_readonly("placement", of_cell([](const CellResult& cell) {
                               return to_string(cell.cell.condition.placement);
                             }),
                             "Beside which side the aid is computed: local or remote.")
      .def_property_readonly(
          "device", of_cell([](const CellResult& cell) { return cell.cell.condition.device.name; }))
      .def_property_readonly("summary",
                             of_cell([](const CellResult& cell) { return cell.summary; }))
      .def_property_readonly("trials", of_cell([](const CellResult& cell) { return cell.trials; }));
  py::class_<Study>(module, "Study", "What simulated operators did with each aid.")
      .def_property_readonly("cells",
                             [](const Study& study) {
                               std::vector<StudyCell> cells;
                               for (const CellResult& result : study.result.cells) {
                                 cells.push_back({study.tasks[result.cell.task].name, result});
                               }
                               return cells;
                             })
      .def_property_readonly(
          "settings",
          [](const Study& study) {
            std::map<std::string, double> settings;
            for (const Tuning& tuning : study.result.tunings) {
              settings[tuning.method] = tuning.tried[tuning.best].setting;
            }
            return settings;
          },
          "What each aid was tuned to.")
      .def("trials_csv", &trials_csv_of, "The trials.csv of `vicinity simulate`, byte for byte.")
      .def("as_json", &json_of, "The study.json of `vicinity simulate`, byte for byte.")
      .def("tables", &tables_of, "Claims and tables as Markdown: the tables.md.");
}

}  // namespace

void add_study(py::module_& module) {
  add_results(module);
  add_study_itself(module);
  const StudySetup setup;
  const StudyOptions options;
  const std::string says =
      std::string("Lets simulated operators work with and without aids: `vicinity simulate`.\n\n") +
      doc::run_study +
      "\n\nscene: a Scene or the path of one; None: the demo's hot cell, its arm and six tasks."
      "\nrobot: " +
      doc::StudySetup_robot + "; None: that of the scene" + "\nX_WB: " + doc::StudySetup_X_WB +
      "\npackages: " + doc::StudySetup_packages + "\nexclude: " + doc::StudySetup_exclude +
      "\ntool: " + doc::StudySetup_tool + "\ntasks: " + doc::StudySetup_tasks +
      "\nstep_s: " + doc::StudySetup_step_s + "\ntrials: " + doc::StudyOptions_trials +
      "\nthreads: " + doc::StudyOptions_threads + "\nmethods: " + doc::StudyOptions_methods +
      "\ndelays_s: " + doc::StudyOptions_delays_s +
      "\nprogress: called now and then from this thread as progress(what, done), done 0..1. What\n"
      "it raises stops the study, as Ctrl-C does; other Python threads go on meanwhile.";
  module.def(
      "simulate",
      [](const py::object& scene, const std::optional<std::filesystem::path>& robot,
         const std::optional<Pose>& X_WB, std::vector<std::filesystem::path> packages,
         std::vector<std::string> exclude, std::string tool,
         const std::optional<std::filesystem::path>& tasks, double step_s, int trials,
         std::uint64_t seed, int threads, std::vector<std::string> methods,
         std::vector<double> delays_s, const py::object& progress) {
        StudySetup asked;
        set_scene(asked, scene);
        asked.robot = robot.value_or(std::filesystem::path());
        asked.X_WB = X_WB;
        asked.packages = std::move(packages);
        asked.exclude = std::move(exclude);
        asked.tool = std::move(tool);
        asked.tasks = tasks.value_or(std::filesystem::path());
        asked.step_s = step_s;
        StudyOptions study;
        study.trials = trials;
        study.seed = seed;
        study.threads = threads;
        study.methods = std::move(methods);
        study.delays_s = std::move(delays_s);
        return beside_interpreter(progress,
                                  [&](const Report& report) { return run(asked, study, report); });
      },
      "scene"_a = py::none(), py::kw_only(), "robot"_a = py::none(), "X_WB"_a = py::none(),
      "packages"_a = setup.packages, "exclude"_a = setup.exclude, "tool"_a = setup.tool,
      "tasks"_a = py::none(), "step_s"_a = setup.step_s, "trials"_a = options.trials,
      "seed"_a = options.seed, "threads"_a = options.threads, "methods"_a = options.methods,
      "delays_s"_a = options.delays_s, "progress"_a = py::none(), says.c_str());
}

}  // namespace vicinity::python
