// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What our programs have in common on their command lines: options of an arm, and words that are
/// refused. For the units with a main() alone, and therefore all in here: CLI11 takes long to
/// compile.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "interruption.h"
#include "replay/arm.h"
#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"
#include "vicinity/teleop/device.h"

namespace vicinity::cli {

/// Which arm, where it stands, and what of it feels.
inline void add_arm(CLI::App& app, ArmOptions& options) {
  app.add_option("--robot", options.robot, "URDF file of the arm");
  app.add_option("--base", options.base, "where it stands: x,y,z,roll,pitch,yaw [m, rad]");
  app.add_option("--scene", options.scene,
                 "take robot, base, points, excluded links and tool from this scene's 'robot' "
                 "block; what is said here wins");
  app.add_option("--packages", options.packages,
                 "folders for the package:// addresses of its meshes");
  app.add_option("--exclude", options.exclude, "links that feel nothing: base_link,...");
  app.add_option("--tool", options.tool, "link that forces are about; default: the last one");
}

/// How many points it feels with.
inline CLI::Option* add_density(CLI::App& app, ArmOptions& options) {
  return app.add_option("--points-per-m2", options.points_per_m2,
                        "density of body points; default: 2000");
}

/// How it feels, and for which device.
inline void add_feel(CLI::App& app, ArmOptions& options) {
  std::string devices;
  for (const Device& device : known_devices()) {
    devices += (devices.empty() ? "" : ", ") + device.name;
  }
  app.add_option("--memory", options.memory, "none, sustained, fading, short or rising")
      ->capture_default_str();
  app.add_option("--direction", options.direction,
                 "all: oppose the whole velocity; closing: only what comes nearer")
      ->capture_default_str();
  app.add_option("--traversal", options.traversal,
                 "swept: record every voxel passed; sampled: end points only")
      ->capture_default_str();
  app.add_option(
      "--device", options.device,
      "in the operator's hand: " + devices + ", or a .yaml file; default: none, no limiter");
  app.add_option("--mode", options.mode,
                 "strict: within the device's own damping, provably passive; device: within a "
                 "ceiling known from practice")
      ->capture_default_str();
  app.add_option("--master", options.master, "G,A,L,lambda of the master arm; default: 1,1,1,1");
  app.add_option("--rate", options.rate, "ticks per second; default: the device's, or 1000");
}

/// CLI11 only says that a word was not expected; people want to know which one was meant.
/// @return the command that was named, in full: "vicinity bench tick"
/// Errors: throws Error for a command or a long option that is none.
inline std::string named_command(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  std::string name = app.get_name();
  int n = 1;
  for (; n < argc; ++n) {
    std::vector<std::string> commands;
    const CLI::App* next = nullptr;
    for (const CLI::App* each : command->get_subcommands({})) {
      commands.push_back(each->get_name());
      if (each->get_name() == argv[n]) next = each;
    }
    if (commands.empty() || *argv[n] == '-') break;
    if (next == nullptr) {
      const std::string nearest = nearest_word(argv[n], commands);
      throw Error({.where = argv[n],
                   .what = "there is no such command",
                   .hint = name + (nearest.empty() ? " --help" : " " + nearest)});
    }
    command = next;
    name += std::string(" ") + argv[n];
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& long_name : option->get_lnames()) known.push_back("--" + long_name);
  }
  for (; n < argc && std::string_view(argv[n]) != "--"; ++n) {
    const std::string word = argv[n];
    const std::string option = word.substr(0, word.find('='));
    if (!option.starts_with("--") || command->get_option_no_throw(option) != nullptr) continue;
    const std::string nearest = nearest_word(option, known);
    throw Error({.where = option,
                 .what = name + " has no such option",
                 .hint = nearest.empty() ? name + " --help" : nearest});
  }
  return name;
}

/// "nan", "inf" and "1e999" are numbers to CLI11, and of use to no option: from now on every option
/// of the command and of those below it that takes a number refuses them.
inline void refuse_what_is_not_finite(CLI::App& command) {
  const auto finite = [](const std::string& word) {
    double number = 0;
    const bool refused = CLI::detail::lexical_cast(word, number) && !std::isfinite(number);
    return refused ? "'" + word + "' is not a finite number" : std::string();
  };
  for (CLI::Option* option : command.get_options()) {
    if (option->get_type_name().starts_with("FLOAT")) option->check(finite);
  }
  for (CLI::App* next : command.get_subcommands({})) refuse_what_is_not_finite(*next);
}

/// Reads the words into the options that `app` knows, then runs what they ask for; --help and
/// --version need no more than being read.
/// @return exit code
/// Errors: throws Error for words that cannot be used, and what `run` throws.
inline int run_words(CLI::App& app, int argc, char** argv, const std::function<int()>& run) {
  const std::string command = named_command(app, argc, argv);
  refuse_what_is_not_finite(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    throw Error({.what = error.what(), .hint = command + " --help"});
  }
  catch_interruptions();
  return run();
}

}  // namespace vicinity::cli
