// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/master.h"
#include "reproduce/parts.h"
#include "vicinity/teleop/master_force.h"

namespace vicinity::report {
namespace {

const Coding nonlinear = named_coding("nonlinear", 6);

// A light, balanced arm, as the paper asks for. Gain, lever and torque constant are one.
const MasterArm light_arm{.mass = 2, .damping = 1};

}  // namespace

std::vector<OperatorPass> operator_passes(const ViscosityField& field,
                                          const ViscosityField& distances) {
  constexpr double y = cone_axis - cone_base_radius - 0.5, z = 5.5;
  std::vector<OperatorPass> passes;
  for (const double speed : {0.05, 0.1, 0.2}) {
    OperatorPass each;
    each.pass = walk({.name = fmt::format("{:g} m/s", speed),
                      .from_vox = {0.5, y, z},
                      .to_vox = {119.5, y, z},
                      .speed = speed},
                     field, distances);
    for (const TraceSample& sample : each.pass.samples) {
      // The master moves as the slave does, at even speed and free of contact: tau2 is nothing.
      const double tau1 = sample.force_W.norm();
      each.absorbed.push_back(master_force(light_arm, tau1, 0));
      each.needed.push_back(operator_force(light_arm, 0, speed, tau1, 0));
    }
    passes.push_back(std::move(each));
  }
  return passes;
}

std::vector<Check> check_fig34(const std::vector<OperatorPass>& slow_to_fast) {
  std::vector<double> most, share, at;
  double unbalanced = 0;
  std::vector<Pass> passes;
  for (const OperatorPass& each : slow_to_fast) {
    const auto peak = std::ranges::max_element(each.absorbed);
    const auto n = static_cast<std::size_t>(peak - each.absorbed.begin());
    most.push_back(*peak);
    share.push_back(100 * *peak / each.needed[n]);
    // The middle of the stretch over which it is highest.
    const auto last = std::find_if(each.absorbed.rbegin(), each.absorbed.rend(),
                                   [&](double force) { return force == *peak; });
    const auto end = static_cast<std::size_t>(each.absorbed.rend() - last) - 1;
    at.push_back(
        (each.pass.way_vox(each.pass.samples[n]) + each.pass.way_vox(each.pass.samples[end])) / 2 +
        0.5);
    for (std::size_t i = 0; i < each.absorbed.size(); ++i) {
      unbalanced = std::max(unbalanced, std::abs(each.needed[i] - each.absorbed[i] -
                                                 light_arm.damping * each.pass.speed));
    }
    passes.push_back(each.pass);
  }
  return {{"the faster the approach, the more force is absorbed",
           fmt::format("{} N at most", listed(most)),
           std::ranges::adjacent_find(most, std::greater_equal<>()) == most.end()},
          {"absorption is highest where R is nearest to the cone",
           fmt::format("about x = {}, the axis is at {:g}", listed(at, "{:.1f}"), cone_axis),
           std::ranges::all_of(at, [](double x) { return std::abs(x - cone_axis) < 1; })},
          {"there drag is the dominant part of the hand's effort",
           fmt::format("{} % of it", listed(share, "{:.0f}")),
           std::ranges::all_of(share, [](double percent) { return percent > 50; })},
          {"the rest is what eq. 10 leaves for the master's own motion",
           fmt::format("off by {:.1g} N at most", unbalanced), unbalanced < 1e-9},
          viscosity_tells_distance(passes, nonlinear, 4),
          force_is_drag(passes)};
}

Outcome fig34(Workshop& workshop) {
  const Part part = cone();
  const ViscosityField field = workshop.field(part, {.coding = nonlinear});
  const std::vector<OperatorPass> passes = operator_passes(field, workshop.distances(part, 32));
  Outcome outcome{.checks = check_fig34(passes), .figures = {}};
  cli::Chart chart_of_force{
      .title = {}, .caption = {}, .x_label = "x [voxels]", .panels = {}, .strips = {}};
  CsvTable table("speed_m_s,x_vox,operator_force_N,absorbed_N,left_for_the_master_N");
  for (const OperatorPass& each : passes) {
    cli::Series needed{.name = "the operator's force", .points = {}, .steps = true},
        left{.name = "left for the master's motion", .points = {}, .steps = true};
    for (std::size_t n = 0; n < each.needed.size(); ++n) {
      const double x = each.pass.way_vox(each.pass.samples[n]);
      needed.points.emplace_back(x, each.needed[n]);
      left.points.emplace_back(x, each.needed[n] - each.absorbed[n]);
      table.row(each.pass.speed, x, each.needed[n], each.absorbed[n],
                each.needed[n] - each.absorbed[n]);
    }
    chart_of_force.panels.push_back({each.pass.name + ": force [N]", {needed, left}});
  }
  outcome.figures = {
      chart(workshop, "fig34/operator_force.svg", chart_of_force,
            "What the operator brings up, and what is left for the master",
            "What lies between the two lines is absorbed by the layers. Three speeds, slowest "
            "above; the vertical scales differ.")};
  outcome.data = {workshop.file("fig34/operator_force.csv")};
  table.write(outcome.data.front());
  return outcome;
}

}  // namespace vicinity::report
