// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity-bridge, which `vicinity bridge` becomes: words in, an exit code out.

#include <CLI/CLI.hpp>
#include <iostream>

#include "bridge.h"
#include "command_line.h"
#include "commands/bridge.h"
#include "exit_code.h"

namespace vicinity::bridge {
namespace {

int run(int argc, char** argv) {
  CLI::App app(cli::bridge_does, "vicinity bridge");
  app.footer(
      "Example:\n"
      "  vicinity bridge cell.vicinity --robot arm.urdf --base 0,0,0.8,0,0,0\n"
      "  vicinity bridge scene.yaml --share-field /cell --dds here.xml\n"
      "  vicinity bridge copy.vicinity --follow-field /cell --dds there.xml --robot arm.urdf");
  BridgeOptions options;
  app.add_option("INPUT", options.input, "made by vicinity build, or a scene (.yaml, .yml)")
      ->required();
  cli::add_arm(app, options.arm);
  cli::add_density(app, options.arm);
  cli::add_feel(app, options.arm);
  app.add_option("--world", options.world,
                 "the frame that the workspace is called; a transform from it to the robot's base "
                 "link moves the base")
      ->capture_default_str();
  app.add_option("--domain", options.domain, "ROS_DOMAIN_ID")->capture_default_str();
  app.add_option("--namespace", options.name_space,
                 "in front of every topic but of transforms: /left");
  app.add_option("--dds", options.dds,
                 "Cyclone DDS configuration (XML); default: this machine alone");
  CLI::Option* const share = app.add_option(
      "--share-field", options.share_field,
      "give the field, and what becomes of it, to other machines under this name: /cell");
  app.add_option("--follow-field", options.follow_field,
                 "take the field that is shared under this name; INPUT is our copy of it, which "
                 "need not be there yet")
      ->excludes(share);
  app.add_option("--half-speed-drag", options.half_speed_drag,
                 "drag of the tool that halves the speed scale [N·s/m]")
      ->capture_default_str();
  app.add_option("--record", options.recording,
                 "what was felt, while it is: .mcap; one that is there becomes felt.1.mcap");
  app.add_option("--seconds", options.seconds, "end after so long; default: Ctrl-C");
  app.add_flag("--json", options.json, "the summary, for programs");
  return cli::run_words(app, argc, argv, [&] { return bridge(options, std::cout, std::cerr); });
}

}  // namespace
}  // namespace vicinity::bridge

int main(int argc, char** argv) {
  return vicinity::cli::exit_code_of([&] { return vicinity::bridge::run(argc, argv); });
}
