// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The circular memory on the y = 20 track: figures 26 to 30 and table 2.
#pragma once

#include <string>
#include <vector>

#include "reproduce/item.h"
#include "reproduce/pass.h"

namespace vicinity::report {

/// Narrow features on tracks parallel to y = 20: plateaus of viscosity, less than ten voxels long,
/// that are higher than what lies before and behind them. Missed: less than half of that is felt.
struct NarrowFeatures {
  int met = 0, missed = 0;
};

/// What R feels voxel by voxel, for one coding and one memory. Voxels are numbered along x.
struct Felt {
  std::string name;              ///< "Ia", ...
  std::string coding, memory;    ///< "linear", "sustained", ...
  std::vector<double> mu, mu_e;  ///< one for each voxel on the way [N·s/m³]
  NarrowFeatures narrow = {};
};

/// All eight cases Ia to IVa and Ib to IVb in the order of table 2, then ours: rising on both
/// codings, and the continuous distance field with both.
/// @param field       ranks around the complex cylinder, ten layers
/// @param continuous  the same in distance mode
std::vector<Felt> feel_all_cases(const ViscosityField& field, const ViscosityField& continuous);

/// A row of table 2, in numbers.
struct MemoryPerformance {
  std::string name, coding, memory;
  double largest_step = 0;     ///< between neighbouring voxels [N·s/m³]
  double slope_variation = 0;  ///< total variation of the slope: the smaller, the smoother
  double delay_vox = 0;        ///< how much later mu_e rises than mu does
  double hidden = 0;           ///< the most that mu_e is below mu [N·s/m³]
  NarrowFeatures narrow = {};
  double work_J = 0;                   ///< energy absorbed at unit speed
  double rise_near = 0, rise_far = 0;  ///< mean rise over the last and the first half of the
                                       ///< approach to the first peak [N·s/m³ per voxel]
};

MemoryPerformance performance_of(const Felt& felt);

/// How much viscosity each layer adds to that before it, on the approach to the highest; without
/// the step into the first.
std::vector<double> rises_by_layer(const Felt& felt);

/// mu_e is a weighted mean of exactly the remembered values: where these are all alike it is their
/// value, and a whole pass from empty space to empty space keeps the work.
Check memory_is_a_mean(const std::vector<Felt>& cases);

/// The track comes into the first layer and no farther: every coding has its first value there.
Check track_meets_first_layer(const std::vector<Felt>& cases);

std::vector<Check> check_fig26(const std::vector<Felt>& cases);
Outcome fig26(Workshop& workshop);

std::vector<Check> check_fig28(const std::vector<Felt>& cases);
Outcome fig28(Workshop& workshop);

std::vector<Check> check_fig30(const std::vector<Felt>& cases);
Outcome fig30(Workshop& workshop);

std::vector<Check> check_table2(const std::vector<Felt>& cases);
Outcome table2(Workshop& workshop);

}  // namespace vicinity::report
