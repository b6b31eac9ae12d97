// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reproduce/workshop.h"

namespace vicinity::report {
namespace {

Vec3 velocity_of(const Pass& pass) {
  const Vec3 way = pass.to_vox - pass.from_vox;
  return way.norm() > 0 ? Vec3(pass.speed * way.normalized()) : Vec3::Zero();
}

}  // namespace

double Pass::way_vox(const TraceSample& sample) const {
  return (sample.p_WR / voxel_m - from_vox).norm();
}

double Pass::peak() const {
  double most = 0;
  for (const TraceSample& sample : samples) most = std::max(most, sample.force_W.norm());
  return most;
}

Pass walk(Pass pass, const ViscosityField& field, const ViscosityField& distances,
          const MemoryWeights& memory) {
  constexpr double samples_per_voxel = 5;
  pass.samples = trace(field,
                       {.from_W = voxel_m * pass.from_vox,
                        .to_W = voxel_m * pass.to_vox,
                        .speed = pass.speed,
                        .rate = samples_per_voxel * pass.speed / voxel_m},
                       {.area = unit_area, .memory = memory});
  for (const TraceSample& sample : pass.samples) {
    pass.distance_vox.push_back(
        distances.distance_vox_at(distances.workspace().index_of(sample.p_WR)));
  }
  return pass;
}

cli::Series drag_series(const Pass& pass) {
  cli::Series series{.name = pass.name, .points = {}, .steps = true};
  for (const TraceSample& sample : pass.samples) {
    series.points.emplace_back(pass.way_vox(sample), sample.force_W.norm());
  }
  return series;
}

Check viscosity_tells_distance(const std::vector<Pass>& passes, const Coding& coding, int m) {
  // A layer of a sphere of radius m is at most m voxels thick, and less where a diagonal is cut
  // short: on the average the middle of layer n is no farther than (n - 1/2) m, and no nearer than
  // the middle of the layer before. The boundary voxel itself adds half its diagonal.
  double sum = 0, worst = 0;
  std::size_t ranked = 0, strange = 0;
  for (const Pass& pass : passes) {
    for (std::size_t n = 0; n < pass.samples.size(); ++n) {
      const double mu = pass.samples[n].mu, distance = pass.distance_vox[n];
      if (mu == 0 || mu == coding.skin) continue;
      const auto found = std::ranges::find(coding.mu, mu);
      if (found == coding.mu.end() || distance < 0) {
        ++strange;
        continue;
      }
      const auto layer = static_cast<double>(found - coding.mu.begin());
      const double off = distance - (layer + 0.5) * m;
      sum += off;
      worst = std::max(worst, std::abs(off));
      ++ranked;
    }
  }
  const double mean = ranked == 0 ? 0 : sum / static_cast<double>(ranked);
  return {"each viscosity stands for its layer of true distance",
          fmt::format("voxels lie {:+.2f} voxels off the middle of their layer in the mean, {:.2f} "
                      "at worst, layers {} thick{}",
                      mean, worst, m,
                      strange == 0 ? "" : fmt::format("; {} samples belong to no layer", strange)),
          ranked > 0 && strange == 0 && std::abs(mean) < 0.5 * m && worst < 1.5 * m};
}

Check force_is_drag(const std::vector<Pass>& passes) {
  double worst = 0;
  std::size_t felt = 0;
  for (const Pass& pass : passes) {
    const Vec3 v_WR = velocity_of(pass);
    for (const TraceSample& sample : pass.samples) {
      worst = std::max(worst, (sample.force_W + sample.mu_e * unit_area * v_WR).norm());
      felt += sample.mu_e > 0 ? 1 : 0;
    }
  }
  return {"the force is -mu S v everywhere",
          fmt::format("off by {:.1g} N at most over {} samples in the layers", worst, felt),
          worst < 1e-9};
}

std::string listed(const std::vector<double>& values, const char* format) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += ", ";
    text += fmt::format(fmt::runtime(format), value);
  }
  return text;
}

}  // namespace vicinity::report
