// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/memory.h"
#include "reproduce/parts.h"

namespace vicinity::report {
namespace {

std::vector<Felt> feel_complex_cylinder(const Workshop& workshop) {
  const Part part = complex_cylinder();
  Layers layers{.m = 4, .q = 10, .coding = named_coding("linear", 10)};
  const ViscosityField field = workshop.field(part, layers);
  layers.shape = LayerShape::distance;
  return feel_all_cases(field, workshop.field(part, layers));
}

const Felt& named(const std::vector<Felt>& cases, const std::string& name) {
  return *std::ranges::find(cases, name, &Felt::name);
}

MemoryPerformance performance(const std::vector<Felt>& cases, const std::string& name) {
  return performance_of(named(cases, name));
}

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

std::filesystem::path write_cases(const Workshop& workshop, const std::string& file,
                                  const std::vector<Felt>& cases) {
  CsvTable table("case,coding,memory,x_vox,mu_Ns_m3,mu_e_Ns_m3");
  for (const Felt& felt : cases) {
    for (std::size_t n = 0; n < felt.mu.size(); ++n) {
      table.row(felt.name, felt.coding, felt.memory, n, felt.mu[n], felt.mu_e[n]);
    }
  }
  const std::filesystem::path path = workshop.file(file);
  table.write(path);
  return path;
}

cli::Series series_of(const Felt& felt) {
  const bool of_paper = felt.name.starts_with('I');
  cli::Series series{
      .name = of_paper ? felt.name + ", " + felt.memory : felt.name, .points = {}, .steps = true};
  for (std::size_t n = 0; n < felt.mu_e.size(); ++n) {
    series.points.emplace_back(static_cast<double>(n), felt.mu_e[n]);
  }
  return series;
}

cli::ChartPanel panel_of(const std::vector<Felt>& cases, const std::vector<std::string>& names) {
  cli::ChartPanel panel{"effective μ [N·s/m³]", {}};
  for (const std::string& name : names) panel.series.push_back(series_of(named(cases, name)));
  return panel;
}

cli::Chart chart_of(std::vector<cli::ChartPanel> panels) {
  return {.title = {},
          .caption = {},
          .x_label = "x [voxels]",
          .panels = std::move(panels),
          .strips = {}};
}

}  // namespace

Check memory_is_a_mean(const std::vector<Felt>& cases) {
  constexpr std::size_t longest_memory = 10;
  double lost = 0, outside = 0;
  for (const Felt& felt : cases) {
    if (felt.memory != "rising" && total(felt.mu) > 0) {
      lost = std::max(lost, std::abs(1 - total(felt.mu_e) / total(felt.mu)));
    }
    for (std::size_t n = longest_memory; n < felt.mu.size(); ++n) {
      const auto end = felt.mu.begin() + static_cast<std::ptrdiff_t>(n + 1);
      const auto [least, most] =
          std::minmax_element(end - static_cast<std::ptrdiff_t>(longest_memory), end);
      outside = std::max({outside, *least - felt.mu_e[n], felt.mu_e[n] - *most});
    }
  }
  return {"effective viscosity is a mean of what was met",
          fmt::format("over the whole pass {:.2g} of the work is lost at most, and no value leaves "
                      "the range of the last ten voxels by more than {:.2g}",
                      lost, outside),
          !cases.empty() && lost < 1e-9 && outside < 1e-9};
}

Check track_meets_first_layer(const std::vector<Felt>& cases) {
  const double first = named_coding("linear", 1).of_rank(1);  // of both codings
  std::size_t others = 0;
  for (const Felt& felt : cases) {
    // Interpolated viscosity nears the value of a layer's near side.
    const bool stepped = !felt.name.starts_with("distance");
    others += stepped && std::ranges::max(felt.mu) != first ? 1 : 0;
  }
  return {"the track comes into the first layer without touching",
          fmt::format("{:g} N·s/m³ at most, {} cases differ", first, others),
          !cases.empty() && others == 0};
}

// ------------------------------------------------------------------------------------ fig. 26, 27

std::vector<Check> check_fig26(const std::vector<Felt>& cases) {
  std::vector<Check> checks;
  for (const char* letter : {"a", "b"}) {
    const auto of = [&](const char* number) {
      return performance(cases, std::string(number) + letter);
    };
    const MemoryPerformance one = of("I"), two = of("II"), three = of("III");
    checks.push_back(
        {fmt::format("memory smooths the steps, I{0} to II{0} and III{0}", letter),
         fmt::format("largest step {:.2f}, {:.2f}, {:.2f} N·s/m³; variation of the slope "
                     "{:.0f}, {:.0f}, {:.0f}",
                     one.largest_step, two.largest_step, three.largest_step, one.slope_variation,
                     two.slope_variation, three.slope_variation),
         two.largest_step < one.largest_step && three.largest_step < one.largest_step &&
             two.slope_variation < one.slope_variation &&
             three.slope_variation < one.slope_variation});
    checks.push_back(
        {fmt::format("the long memory II{0} comes later than the fading III{0}", letter),
         fmt::format("{:.1f} and {:.1f} voxels behind", two.delay_vox, three.delay_vox),
         two.delay_vox > three.delay_vox && three.delay_vox > 0});
  }
  checks.push_back(memory_is_a_mean(cases));
  checks.push_back(track_meets_first_layer(cases));
  return checks;
}

Outcome fig26(Workshop& workshop) {
  const std::vector<Felt> cases = feel_complex_cylinder(workshop);
  Outcome outcome{.checks = check_fig26(cases), .figures = {}};
  outcome.figures = {
      chart(workshop, "fig26/linear.svg", chart_of({panel_of(cases, {"Ia", "IIa", "IIIa"})}),
            "Linear coding: Ia, IIa, IIIa (fig. 26)", "R moves to the right, at y = 20."),
      chart(workshop, "fig26/nonlinear.svg", chart_of({panel_of(cases, {"Ib", "IIb", "IIIb"})}),
            "Nonlinear coding: Ib, IIb, IIIb (fig. 27)", "")};
  outcome.data = {write_cases(workshop, "fig26/cases.csv", cases)};
  return outcome;
}

// ------------------------------------------------------------------------------------ fig. 28, 29

std::vector<Check> check_fig28(const std::vector<Felt>& cases) {
  std::vector<Check> checks;
  for (const char* letter : {"a", "b"}) {
    const Felt& fine = named(cases, std::string("IV") + letter);
    const MemoryPerformance steps = performance(cases, std::string("I") + letter);
    const MemoryPerformance row = performance_of(fine);
    double mean_off = 0;
    for (std::size_t n = 0; n < fine.mu.size(); ++n)
      mean_off += std::abs(fine.mu[n] - fine.mu_e[n]);
    mean_off /= static_cast<double>(fine.mu.size());
    checks.push_back({fmt::format("IV{0} is fine-stepped: a third of I{0}'s steps", letter),
                      fmt::format("largest step {:.2f} against {:.2f} N·s/m³", row.largest_step,
                                  steps.largest_step),
                      row.largest_step < 0.34 * steps.largest_step && row.largest_step > 0});
    checks.push_back(
        {fmt::format("IV{0} stays very close to the original", letter),
         fmt::format("off by {:.2f} N·s/m³ in the mean, of a peak of {:g}; {:.1f} voxels "
                     "behind",
                     mean_off, std::ranges::max(fine.mu), row.delay_vox),
         mean_off < 0.03 * std::ranges::max(fine.mu) && row.delay_vox < 1.05});
  }
  const std::vector<double> linear = rises_by_layer(named(cases, "IVa"));
  const std::vector<double> nonlinear = rises_by_layer(named(cases, "IVb"));
  checks.push_back({"the linear coding rises at a constant rate",
                    fmt::format("each layer adds {} N·s/m³ to that before", listed(linear)),
                    linear.size() > 1 && std::ranges::max(linear) == std::ranges::min(linear)});
  checks.push_back({"the nonlinear coding rises steeply near the object",
                    fmt::format("each layer adds {} N·s/m³, the nearest last", listed(nonlinear)),
                    nonlinear.size() > 1 && std::ranges::is_sorted(nonlinear) &&
                        nonlinear.back() > 3 * nonlinear.front()});
  checks.push_back(memory_is_a_mean(cases));
  checks.push_back(track_meets_first_layer(cases));
  return checks;
}

Outcome fig28(Workshop& workshop) {
  const std::vector<Felt> cases = feel_complex_cylinder(workshop);
  Outcome outcome{.checks = check_fig28(cases), .figures = {}};
  outcome.figures = {
      chart(workshop, "fig28/linear.svg", chart_of({panel_of(cases, {"Ia", "IVa"})}),
            "Stepped and fine-stepped, linear (fig. 28)", ""),
      chart(workshop, "fig28/nonlinear.svg", chart_of({panel_of(cases, {"Ib", "IVb"})}),
            "Stepped and fine-stepped, nonlinear (fig. 29)", "")};
  outcome.data = {write_cases(workshop, "fig28/cases.csv", cases)};
  return outcome;
}

// ---------------------------------------------------------------------------------------- fig. 30

std::vector<Check> check_fig30(const std::vector<Felt>& cases) {
  std::vector<double> saved;
  bool below = true;
  for (const char* number : {"I", "II", "III", "IV"}) {
    const Felt& linear = named(cases, std::string(number) + "a");
    const Felt& nonlinear = named(cases, std::string(number) + "b");
    saved.push_back(100 * (1 - total(nonlinear.mu_e) / total(linear.mu_e)));
    for (std::size_t n = 0; n < linear.mu_e.size(); ++n) {
      below &= nonlinear.mu_e[n] <= linear.mu_e[n] + 1e-12;
    }
  }
  const MemoryPerformance a = performance(cases, "Ia"), b = performance(cases, "Ib");
  return {{"the nonlinear coding saves energy, with every memory",
           fmt::format("{} % for I to IV", listed(saved, "{:.1f}")),
           std::ranges::all_of(saved, [](double percent) { return percent > 5; })},
          {"its curves lie below the linear ones everywhere",
           below ? "everywhere" : "not everywhere", below},
          {"it rises distinctly more near the object than far from it",
           fmt::format("{:.1f} times as fast, the linear coding {:.1f} times",
                       b.rise_near / b.rise_far, a.rise_near / a.rise_far),
           b.rise_near / b.rise_far > 2 * a.rise_near / a.rise_far},
          memory_is_a_mean(cases),
          track_meets_first_layer(cases)};
}

Outcome fig30(Workshop& workshop) {
  const std::vector<Felt> cases = feel_complex_cylinder(workshop);
  Outcome outcome{.checks = check_fig30(cases), .figures = {}};
  outcome.figures = {chart(
      workshop, "fig30/clusters.svg",
      chart_of({panel_of(cases, {"Ia", "Ib"}), panel_of(cases, {"IIa", "IIb"}),
                panel_of(cases, {"IIIa", "IIIb"}), panel_of(cases, {"IVa", "IVb"})}),
      "Linear above nonlinear, memory by memory",
      "The area between the two curves of a panel is the energy that the nonlinear coding saves.")};
  CsvTable table("memory,linear_J,nonlinear_J,saved");
  for (const char* number : {"I", "II", "III", "IV"}) {
    const MemoryPerformance a = performance(cases, std::string(number) + "a");
    const MemoryPerformance b = performance(cases, std::string(number) + "b");
    table.row(a.memory, a.work_J, b.work_J, 1 - b.work_J / a.work_J);
  }
  outcome.data = {workshop.file("fig30/energy.csv"),
                  write_cases(workshop, "fig30/cases.csv", cases)};
  table.write(outcome.data.front());
  return outcome;
}

// --------------------------------------------------------------------------------------- table 2

namespace {

std::vector<Check> check_coding(const std::vector<Felt>& cases, const std::string& letter) {
  const MemoryPerformance one = performance(cases, "I" + letter),
                          two = performance(cases, "II" + letter),
                          three = performance(cases, "III" + letter),
                          four = performance(cases, "IV" + letter);
  return {
      {fmt::format("I{}: large steps", letter),
       fmt::format("{:.2f} N·s/m³, with memory {:.2f}, {:.2f}, {:.2f}", one.largest_step,
                   two.largest_step, three.largest_step, four.largest_step),
       one.largest_step > std::max({two.largest_step, three.largest_step, four.largest_step})},
      {fmt::format("II{0} and III{0}: smooth", letter),
       fmt::format("slope varies by {:.0f} and {:.0f}, without memory by {:.0f}",
                   two.slope_variation, three.slope_variation, one.slope_variation),
       std::max(two.slope_variation, three.slope_variation) < one.slope_variation / 2},
      {fmt::format("delay large in II{0}, moderate in III{0}, none in IV{0}", letter),
       fmt::format("{:.2f}, {:.2f}, {:.2f} voxels", two.delay_vox, three.delay_vox, four.delay_vox),
       two.delay_vox > three.delay_vox && three.delay_vox > four.delay_vox &&
           four.delay_vox < 1.05},
      {fmt::format("II{} may miss narrow features", letter),
       fmt::format("misses {} of {}, III{} {}, IV{} {}, without memory {}", two.narrow.missed,
                   two.narrow.met, letter, three.narrow.missed, letter, four.narrow.missed,
                   one.narrow.missed),
       two.narrow.missed > 0 && two.narrow.missed >= three.narrow.missed &&
           two.narrow.missed >= four.narrow.missed && one.narrow.missed == 0},
      {fmt::format("IV{}: fine steps", letter),
       fmt::format("{:.2f} N·s/m³ at most", four.largest_step),
       four.largest_step < one.largest_step / 2 && four.largest_step > two.largest_step}};
}

std::vector<Check> check_ours(const std::vector<Felt>& cases) {
  std::vector<Check> checks;
  for (const char* letter : {"a", "b"}) {
    const MemoryPerformance distance = performance(cases, std::string("distance ") + letter);
    const MemoryPerformance rising = performance(cases, std::string("rising ") + letter);
    const MemoryPerformance steps = performance(cases, std::string("I") + letter);
    checks.push_back(
        {fmt::format("ours, not the paper's, {} coding: distance is smooth and not late, "
                     "rising hides nothing",
                     distance.coding),
         fmt::format("distance: largest step {:.2f} against {:.2f}, {:.2f} voxels late; "
                     "rising: hides {:.2g}, II{} up to {:.1f} N·s/m³",
                     distance.largest_step, steps.largest_step, distance.delay_vox, rising.hidden,
                     letter, performance(cases, std::string("II") + letter).hidden),
         distance.largest_step < steps.largest_step / 2 && distance.delay_vox == 0 &&
             rising.hidden == 0});
  }
  return checks;
}

}  // namespace

std::vector<Check> check_table2(const std::vector<Felt>& cases) {
  std::vector<Check> checks = check_coding(cases, "a");
  const std::vector<Check> b = check_coding(cases, "b"), ours = check_ours(cases);
  checks.insert(checks.end(), b.begin(), b.end());
  const auto ratio = [&](const char* name) {
    const MemoryPerformance row = performance(cases, name);
    return row.rise_near / row.rise_far;
  };
  checks.push_back(
      {"linear coding: the increase is gradual, near the surface as farther out",
       fmt::format("near {:.1f}, {:.1f}, {:.1f}, {:.1f} times the rate farther out, Ia to IVa",
                   ratio("Ia"), ratio("IIa"), ratio("IIIa"), ratio("IVa")),
       std::max({ratio("Ia"), ratio("IIa"), ratio("IIIa"), ratio("IVa")}) < 1.5});
  checks.push_back({"nonlinear coding: progressive towards the surface in Ib, IIIb and IVb",
                    fmt::format("near {:.1f}, {:.1f}, {:.1f} times the rate farther out",
                                ratio("Ib"), ratio("IIIb"), ratio("IVb")),
                    std::min({ratio("Ib"), ratio("IIIb"), ratio("IVb")}) > 1.5});
  checks.push_back(memory_is_a_mean(cases));
  checks.push_back(track_meets_first_layer(cases));
  checks.insert(checks.end(), ours.begin(), ours.end());
  return checks;
}

Outcome table2(Workshop& workshop) {
  const std::vector<Felt> cases = feel_complex_cylinder(workshop);
  Outcome outcome{.checks = check_table2(cases), .figures = {}};
  const double ms_per_voxel = 1000 * voxel_m / unit_speed;
  outcome.table = {{"case", "coding", "memory", "largest step", "slope variation", "delay [voxels]",
                    "delay [ms]", "hidden at most", "narrow missed", "work [J]", "rise far",
                    "rise near"}};
  CsvTable table(
      "case,coding,memory,largest_step,slope_variation,delay_vox,delay_ms,hidden,narrow_met,"
      "narrow_missed,work_J,rise_far,rise_near");
  for (const Felt& felt : cases) {
    const MemoryPerformance row = performance_of(felt);
    table.row(row.name, row.coding, row.memory, row.largest_step, row.slope_variation,
              row.delay_vox, row.delay_vox * ms_per_voxel, row.hidden, row.narrow.met,
              row.narrow.missed, row.work_J, row.rise_far, row.rise_near);
    const auto number = [](double value, int digits) {
      return fmt::format("{:.{}f}", value, digits);
    };
    outcome.table.push_back({row.name, row.coding, row.memory, number(row.largest_step, 2),
                             number(row.slope_variation, 1), number(row.delay_vox, 2),
                             number(row.delay_vox * ms_per_voxel, 1), number(row.hidden, 1),
                             fmt::format("{} of {}", row.narrow.missed, row.narrow.met),
                             number(row.work_J, 2), number(row.rise_far, 2),
                             number(row.rise_near, 2)});
  }
  outcome.figures = {
      chart(
          workshop, "table2/ours_linear.svg",
          chart_of({panel_of(cases, {"Ia", "IIa", "rising a", "distance a"})}),
          "Smooth need not mean late: linear coding",
          "Rising follows every rise at once and smooths the fall only; distance needs no memory."),
      chart(workshop, "table2/ours_nonlinear.svg",
            chart_of({panel_of(cases, {"Ib", "IIb", "rising b", "distance b"})}),
            "Smooth need not mean late: nonlinear coding", "")};
  outcome.data = {workshop.file("table2/cases.csv"),
                  write_cases(workshop, "table2/tracks.csv", cases)};
  table.write(outcome.data.front());
  return outcome;
}

}  // namespace vicinity::report
