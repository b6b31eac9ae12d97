// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/memory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "reproduce/parts.h"
#include "reproduce/workshop.h"
#include "vicinity/drag/trace.h"

namespace vicinity::report {
namespace {

constexpr int layers = 10;  // as many as the linear coding has values

constexpr std::size_t longest_memory = 10;

double most_within(const std::vector<double>& values, std::size_t first, std::size_t last) {
  const auto begin = values.begin();
  return *std::max_element(begin + static_cast<std::ptrdiff_t>(first),
                           begin + static_cast<std::ptrdiff_t>(std::min(last + 1, values.size())));
}

void count_narrow(const std::vector<double>& mu, const std::vector<double>& mu_e,
                  NarrowFeatures& narrow) {
  for (std::size_t first = 1, last = 0; first < mu.size(); first = last + 1) {
    last = first;
    while (last + 1 < mu.size() && mu[last + 1] == mu[first]) ++last;
    if (last + 1 == mu.size()) return;
    const double around = std::max(mu[first - 1], mu[last + 1]);
    if (mu[first] <= around || last - first + 1 >= longest_memory) continue;
    ++narrow.met;
    // The memory may answer late, but not later than its length.
    const double felt = most_within(mu_e, first, last + longest_memory) - around;
    narrow.missed += felt < (mu[first] - around) / 2 ? 1 : 0;
  }
}

struct Voxels {
  std::vector<double> mu, mu_e;
};

// The middle of every voxel on the way, from trace's five samples a voxel.
Voxels along_x(const ViscosityField& field, const std::string& memory, int y) {
  constexpr int samples_per_voxel = 5;
  const Vec3 from(0.5, y + 0.5, 40.5), to(199.5, y + 0.5, 40.5);
  const std::vector<TraceSample> samples =
      trace(field,
            {.from_W = voxel_m * from,
             .to_W = voxel_m * to,
             .speed = unit_speed,
             .rate = samples_per_voxel * unit_speed / voxel_m},
            {.area = unit_area, .memory = named_memory(memory)});
  Voxels voxels;
  for (std::size_t n = 0; n < samples.size(); n += samples_per_voxel) {
    voxels.mu.push_back(samples[n].mu);
    voxels.mu_e.push_back(samples[n].mu_e);
  }
  return voxels;
}

Felt feel(const ViscosityField& field, const std::string& coding, const std::string& memory,
          std::string name) {
  const ViscosityField coded = field.with_codings({named_coding(coding, layers)});
  Voxels voxels = along_x(coded, memory, 20);
  Felt felt{.name = std::move(name),
            .coding = coding,
            .memory = memory,
            .mu = std::move(voxels.mu),
            .mu_e = std::move(voxels.mu_e)};
  for (int y = 0; y <= 20; ++y) {
    const Voxels beside = along_x(coded, memory, y);
    count_narrow(beside.mu, beside.mu_e, felt.narrow);
  }
  return felt;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Where it rises, in the mean over all rises, weighted by how much.
double rise_position(const std::vector<double>& values) {
  double weighted = 0, all = 0;
  for (std::size_t n = 1; n < values.size(); ++n) {
    const double rise = std::max(0.0, values[n] - values[n - 1]);
    weighted += static_cast<double>(n) * rise;
    all += rise;
  }
  return all == 0 ? 0 : weighted / all;
}

void measure_rise(const Felt& felt, MemoryPerformance& row) {
  const auto start = std::ranges::find_if(felt.mu_e, [](double mu) { return mu > 0; });
  const auto peak = std::ranges::max_element(felt.mu_e);
  const auto length = peak - start;
  if (length < 2) return;
  const auto middle = start + length / 2;
  const double outside = start == felt.mu_e.begin() ? 0 : *std::prev(start);
  row.rise_far = (*middle - outside) / static_cast<double>(middle - start + 1);
  row.rise_near = (*peak - *middle) / static_cast<double>(peak - middle);
}

}  // namespace

std::vector<Felt> feel_all_cases(const ViscosityField& field, const ViscosityField& continuous) {
  std::vector<Felt> cases;
  const std::array<std::pair<const char*, const char*>, 4> memories{
      {{"I", "none"}, {"II", "sustained"}, {"III", "fading"}, {"IV", "short"}}};
  const std::array<std::pair<const char*, const char*>, 2> codings{
      {{"a", "linear"}, {"b", "nonlinear"}}};
  for (const auto& [letter, coding] : codings) {
    for (const auto& [number, memory] : memories) {
      cases.push_back(feel(field, coding, memory, std::string(number) + letter));
    }
  }
  for (const auto& [letter, coding] : codings) {
    cases.push_back(feel(field, coding, "rising", std::string("rising ") + letter));
  }
  for (const auto& [letter, coding] : codings) {
    cases.push_back(feel(continuous, coding, "none", std::string("distance ") + letter));
  }
  return cases;
}

MemoryPerformance performance_of(const Felt& felt) {
  MemoryPerformance row{.name = felt.name, .coding = felt.coding, .memory = felt.memory};
  const std::vector<double>& mu_e = felt.mu_e;
  for (std::size_t n = 1; n < mu_e.size(); ++n) {
    row.largest_step = std::max(row.largest_step, std::abs(mu_e[n] - mu_e[n - 1]));
  }
  for (std::size_t n = 2; n < mu_e.size(); ++n) {
    row.slope_variation += std::abs(mu_e[n] - 2 * mu_e[n - 1] + mu_e[n - 2]);
  }
  for (std::size_t n = 0; n < mu_e.size(); ++n) {
    row.hidden = std::max(row.hidden, felt.mu[n] - mu_e[n]);
  }
  row.delay_vox = rise_position(mu_e) - rise_position(felt.mu);
  row.work_J = sum(mu_e) * unit_area * unit_speed * voxel_m;
  row.narrow = felt.narrow;
  measure_rise(felt, row);
  return row;
}

std::vector<double> rises_by_layer(const Felt& felt) {
  const auto peak = std::ranges::max_element(felt.mu);
  std::vector<double> rises;
  double before = 0;
  for (auto mu = felt.mu.begin(); mu <= peak && mu != felt.mu.end(); ++mu) {
    if (*mu != before && before > 0) rises.push_back(*mu - before);
    before = *mu;
  }
  return rises;
}

}  // namespace vicinity::report
