// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity simulate: master, slave and operator in simulation, with and without aids.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace vicinity::cli {

struct SimulateOptions {
  bool demo = false;                            ///< the embedded hot cell with its arm and tasks
  std::filesystem::path scene;                  ///< with a `robot` block, or with `robot` here
  std::filesystem::path robot;                  ///< URDF
  std::vector<std::filesystem::path> packages;  ///< folders for package:// addresses
  std::string base;                             ///< "x,y,z,r,p,y" [m, rad]
  std::string exclude;                          ///< "link,link": they feel nothing
  std::string tool;                             ///< link
  std::filesystem::path tasks;                  ///< YAML; empty: the demo's, or made for the scene
  std::filesystem::path meshes;  ///< folder that relative mesh paths start at; empty: the scene's
  std::filesystem::path folder;  ///< to leave everything in
  int trials = 200;
  int seed = 1;
  int threads = 0;      ///< 0: as many as the machine has
  std::string methods;  ///< "none,rising"; empty: all
  std::string delays_ms = "20,50,100,200";
  double step_ms = 2;  ///< of the physics
  bool json = false;
};

/// Writes index.html, study.json, trials.csv, tables.md, the field, the robot, and in recordings/ a
/// joint log of the first trial of every aid at every task, which `vicinity replay` plays.
/// @return 0; 130 where a signal ended it early: there is nothing then
/// Errors: throws Error for what cannot be simulated, and where the folder cannot be written.
int simulate(const SimulateOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
