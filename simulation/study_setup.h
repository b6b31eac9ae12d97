// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What a study is about: scene, arm and tasks, from files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulation/task.h"
#include "simulation/workplace.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/viscosity/scene.h"

namespace vicinity {

/// Empty or absent: not said. What is said wins over the scene's `robot` block.
struct StudySetup {
  std::optional<Scene> scene;    ///< absent: the demo's hot cell, its arm and six tasks
  std::string name = "a scene";  ///< of the scene, in words
  std::filesystem::path robot;   ///< URDF of the arm, with inertia
  std::optional<Pose> X_WB;      ///< where it stands
  std::vector<std::filesystem::path>
      packages;                      ///< folders for the package:// addresses of its meshes
  std::vector<std::string> exclude;  ///< links that feel nothing
  std::string tool;                  ///< link that the hand leads; empty: the last one
  std::filesystem::path tasks;  ///< YAML file; empty: approaches and retreats made for the scene
  double step_s = 0.002;        ///< of the physics and the slave's servo, whole ms, 1 to 5 [s]
};

/// A study that can be run.
struct PreparedStudy {
  Workplace place;
  std::vector<Task> tasks;
  std::string words;           ///< arm and scene
  std::filesystem::path urdf;  ///< of the arm; empty: the demo's own, urdf_text
  std::string urdf_text;
};

/// Reads what the setup names, builds both fields, and finds a start for each task.
/// Errors: throws Error for files that cannot be used, an arm that cannot be simulated, a step that
/// is none, and tasks that the arm cannot do.
PreparedStudy prepare_study(const StudySetup& setup);

}  // namespace vicinity
