// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The robots that the tests are made with: real ones, and random trees.
#pragma once

#include <filesystem>
#include <random>
#include <string>

#include "vicinity/robot/robot_model.h"

namespace vicinity {

/// Path of a file below the folder of real data; empty where the tests run without it.
std::filesystem::path robot_file(const std::string& below_robots);

inline constexpr const char* kinova =
    "kinova_gen3_7dof/kortex_description/arms/gen3/7dof/urdf/"
    "GEN3-7DOF-NOVISION_FOR_URDF_ARM_V12.urdf";
inline constexpr const char* fanuc =
    "fanuc_m10ia/moveit_resources_fanuc_description/urdf/fanuc.urdf";
inline constexpr const char* omni = "phantom_omni/omni_description/urdf/omni.urdf";

/// A random tree of 1 to 30 links with joints of every type, some of them mimics.
RobotModel random_robot(std::mt19937_64& random);

Pose random_pose(std::mt19937_64& random);
Vec3 random_vector(std::mt19937_64& random);

}  // namespace vicinity
