// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/master.h"
#include "reproduce/parts.h"
#include "vicinity/teleop/passivity.h"

namespace vicinity::report {
namespace {

// Both methods act from here to the surface.
constexpr double zone = 0.03;  // [m]
// The force field's push at the surface. It balances a hand that leans on it with 5 N.
constexpr double push_at_surface = 5;  // [N]
constexpr int delay_periods = 10;
// Of the device's own damping: what stability rule 2 allows, with a margin.
constexpr double drag_share = 0.95;
// Above it, drag that is late feeds a free mass (rule 6); the hand's own damping bears a little
// more.
constexpr double beyond_mass_limit = 1.5;
constexpr double highest_mu = 32;

// A spring that repels from a surface at distance d, and no more behind it than at it.
double repulsion(double d) { return push_at_surface * std::clamp(1 - d / zone, 0.0, 1.0); }

// Along the line of the slot: its faces are at +- half_gap of the middle.
constexpr double half_gap = slot_half_gap * voxel_m;
double field_in_slot(double x) { return repulsion(half_gap + x) - repulsion(half_gap - x); }

// Along a line beside the post; only the part along the line moves the joint.
constexpr double post_radius_m = post_radius * voxel_m, line_offset = post_line_offset * voxel_m;
double field_by_post(double x) {
  const double r = std::hypot(x, line_offset);
  return repulsion(r - post_radius_m) * x / r;
}

// Viscosity on the line, as a damping: the highest is given share of the device's own.
using Line = std::function<Vec3(double x)>;
Feedback drag_along(const ViscosityField& field, const Line& line, double highest_damping,
                    const std::function<double(double, double)>& drag_law) {
  return [=](double x, double v) {
    return drag_law(field.at(line(x)).viscosity / highest_mu * highest_damping, v);
  };
}

Vec3 slot_line(double x) {
  return voxel_m * Vec3(slot_middle, slot_middle, slot_middle) + Vec3(x, 0, 0);
}
Vec3 post_line(double x) {
  return voxel_m * Vec3(post_axis, post_axis + post_line_offset, post_axis) + Vec3(x, 0, 0);
}

std::filesystem::path write_runs(const Workshop& workshop, const std::string& file,
                                 const Duel& duel) {
  CsvTable table("method,t_s,x_m,v_m_s,force_N");
  const auto write = [&](const char* method, const JointRun& run) {
    for (std::size_t n = 0; n < run.instants.size(); n += 2) {
      const JointInstant& instant = run.instants[n];
      table.row(method, instant.t, instant.x, instant.v, instant.force);
    }
  };
  write("force field", duel.field);
  write("drag", duel.drag);
  write("neither", duel.alone);
  const std::filesystem::path path = workshop.file(file);
  table.write(path);
  return path;
}

cli::Chart chart_of(const Duel& duel) {
  const auto series = [](const JointRun& run, const char* name, auto&& value) {
    cli::Series s{.name = name, .points = {}};
    for (const JointInstant& instant : run.instants)
      s.points.emplace_back(instant.t, value(instant));
    return s;
  };
  const auto position = [](const JointInstant& i) { return 1000 * i.x; };
  const auto force = [](const JointInstant& i) { return i.force; };
  return {
      .title = {},
      .caption = {},
      .x_label = "time [s]",
      .panels = {{"position [mm]",
                  {series(duel.field, "force field", position),
                   series(duel.drag, "drag", position)}},
                 {"force on the hand [N]",
                  {series(duel.field, "force field", force), series(duel.drag, "drag", force)}}},
      .strips = {}};
}

}  // namespace

double drag_in_one_dimension(double mu_S, double v) { return -mu_S * v; }

DynamicsRuns run_dynamics(const ViscosityField& slot, const ViscosityField& post,
                          const std::function<double(double, double)>& drag_law) {
  const JointSetting prompt{};
  JointSetting delayed = prompt;
  delayed.delay = delay_periods;
  JointSetting between_walls = prompt;
  between_walls.wall = delayed.wall = half_gap;
  const Feedback slot_field = [](double x, double) { return field_in_slot(x); };
  const Feedback post_field = [](double x, double) { return field_by_post(x); };
  const double strength = drag_share * prompt.damping;
  const Feedback slot_drag = drag_along(slot, slot_line, strength, drag_law);
  const Feedback post_drag = drag_along(post, post_line, strength, drag_law);

  DynamicsRuns runs;
  const auto duel = [](const JointSetting& setting, const Feedback& field, const Feedback& drag,
                       const Target& target, double x, double v, double duration) {
    const Feedback nothing = [](double, double) { return 0.0; };
    return Duel{simulate(setting, field, target, x, v, duration),
                simulate(setting, drag, target, x, v, duration),
                simulate(setting, nothing, target, x, v, duration)};
  };
  // Held in the middle of the slot and knocked sideways.
  const Target middle = [](double) { return 0.0; };
  runs.slot = duel(between_walls, slot_field, slot_drag, middle, 0, 0.1, 4);
  runs.slot_delayed = duel(delayed, slot_field, slot_drag, middle, 0, 0.1, 4);
  // In the middle of the slot, where viscosity is lowest.
  const double too_much = beyond_mass_limit * mass_limit(delay_periods) * prompt.mass /
                          prompt.period * highest_mu / slot.at(slot_line(0)).viscosity;
  runs.too_much_drag =
      simulate(delayed, drag_along(slot, slot_line, too_much, drag_law), middle, 0, 0.1, 4);
  // Past the post, from well before its zone to well behind it.
  runs.edge = duel(
      prompt, post_field, post_drag, [](double t) { return -0.12 + 0.1 * t; }, -0.12, 0.1, 2.4);
  // To 10 mm before the nearest point, then standing.
  runs.stop = duel(
      prompt, post_field, post_drag, [](double t) { return std::min(-0.12 + 0.1 * t, -0.01); },
      -0.12, 0.1, 4);
  // The target lies behind the face of the slot.
  runs.lean = duel(
      between_walls, slot_field, slot_drag, [](double) { return 2 * half_gap; }, 0, 0, 4);
  return runs;
}

namespace {

bool settles(const JointRun& run) {
  constexpr double still = 1e-4;  // [m]
  return !run.contact && run.ripple < still;
}

double strongest(const JointRun& run) {
  double most = 0;
  for (const JointInstant& instant : run.instants) most = std::max(most, std::abs(instant.force));
  return most;
}

std::string ending(const JointRun& run) {
  return run.contact ? fmt::format("strikes the object after {:.2f} s", run.instants.back().t)
                     : fmt::format("{:.2g} mm peak to peak after 3 s", 1000 * run.ripple);
}

}  // namespace

std::vector<Check> check_dynamics(const DynamicsRuns& runs) {
  double push_back = 0, pull = 0;
  for (const JointInstant& instant : runs.edge.field.instants) {
    push_back = std::min(push_back, instant.force);
    pull = std::max(pull, instant.force);
  }
  double drag_pull = 0;
  for (const JointInstant& instant : runs.edge.drag.instants) {
    if (instant.v > 0) drag_pull = std::max(drag_pull, instant.force);
  }
  double drag_gain = 0;
  for (const Duel* duel : {&runs.slot, &runs.slot_delayed, &runs.edge, &runs.stop, &runs.lean}) {
    drag_gain = std::max(drag_gain, duel->drag.gain);
  }
  const auto mJ = [](double joule) { return 1000 * joule; };
  const auto speed_at_end = [](const JointRun& run) { return std::abs(run.instants.back().v); };
  return {
      {"in a narrow slot the force field makes the hand oscillate, drag does not",
       fmt::format("{} reversals with the force field, {} with drag, {} of the hand alone",
                   runs.slot.field.reversals, runs.slot.drag.reversals, runs.slot.alone.reversals),
       runs.slot.field.reversals > 2 * runs.slot.alone.reversals &&
           runs.slot.drag.reversals <= runs.slot.alone.reversals},
      {fmt::format("with {} ms of delay the counteracting forces of the slot grow, drag settles",
                   delay_periods),
       fmt::format("force field: {}; drag: {}", ending(runs.slot_delayed.field),
                   ending(runs.slot_delayed.drag)),
       !settles(runs.slot_delayed.field) && settles(runs.slot_delayed.drag)},
      {"the force field drives the hand, and with delay feeds it without end",
       fmt::format("drives it with {:.2f} mJ in the slot and {:.1f} mJ past the edge; with delay "
                   "it has given {:.1f} mJ more than it took by then",
                   mJ(runs.slot.field.put_in), mJ(runs.edge.field.put_in),
                   mJ(runs.slot_delayed.field.gain)),
       runs.slot.field.put_in > 1e-4 && runs.edge.field.put_in > 1e-4 &&
           runs.slot_delayed.field.gain > 1e-3},
      {"drag never has given more than it took",
       fmt::format("{:.2g} mJ at most at any time of any run, the delayed one included",
                   mJ(drag_gain)),
       drag_gain < 1e-6},
      {"past an edge the force field pushes back at p1 and pulls on at p3, drag never pulls",
       fmt::format("{:.1f} N, then {:+.1f} N; drag {:+.1g} N along the motion at most", push_back,
                   pull, drag_pull),
       push_back < -0.5 && pull > 0.5 && drag_pull < 1e-9},
      {"a hand that stops in the zone is still pushed by the force field, by drag no more",
       fmt::format("{:.2f} N against {:.1g} N", runs.stop.field.final_force,
                   runs.stop.drag.final_force),
       runs.stop.field.final_force > 0.1 && runs.stop.drag.final_force < 1e-3},
      {"where drag loses, 1: a hand that leans on the object reaches it, if more slowly; the force "
       "field holds it off",
       fmt::format(
           "contact at {:.2f} m/s with drag, at {:.2f} m/s without; {} with the force field",
           speed_at_end(runs.lean.drag), speed_at_end(runs.lean.alone),
           runs.lean.field.contact ? "contact" : "none"),
       runs.lean.drag.contact && runs.lean.alone.contact && !runs.lean.field.contact &&
           speed_at_end(runs.lean.drag) < speed_at_end(runs.lean.alone)},
      {fmt::format("where drag loses, 2: {} ms late and {:g} times what the mass bears, it buzzes",
                   delay_periods, beyond_mass_limit),
       ending(runs.too_much_drag), !settles(runs.too_much_drag)},
      {"where drag loses, 3: as strong as a passive device bears it, it is the weaker cue",
       fmt::format("{:.2f} N at most past the edge at 0.1 m/s, the force field {:.2f} N",
                   strongest(runs.edge.drag), strongest(runs.edge.field)),
       strongest(runs.edge.drag) > 0 && strongest(runs.edge.drag) < strongest(runs.edge.field)}};
}

Outcome dynamics(Workshop& workshop) {
  const Layers six_thin{.m = 1, .q = 6, .shape = LayerShape::cube};
  const ViscosityField slot_field = workshop.field(slot(), six_thin);
  const ViscosityField post_field = workshop.field(post(), six_thin);
  const DynamicsRuns runs = run_dynamics(slot_field, post_field, drag_in_one_dimension);
  Outcome outcome{.checks = check_dynamics(runs), .figures = {}};
  outcome.figures = {
      section(workshop, "dynamics/slot_layers.png", slot_field, 2, static_cast<int>(slot_middle),
              "The slot", "Two objects, 40 mm apart; layers of both meet in the middle."),
      chart(workshop, "dynamics/slot.svg", chart_of(runs.slot), "In the slot, no delay",
            "The hand is held in the middle and knocked sideways at 0.1 m/s."),
      chart(workshop, "dynamics/slot_delayed.svg", chart_of(runs.slot_delayed),
            fmt::format("In the slot, {} ms of delay", delay_periods),
            "The same knock. A line ends where the hand strikes an object."),
      chart(workshop, "dynamics/edge.svg", chart_of(runs.edge), "Past an edge",
            "The operator wants to pass at 0.1 m/s. The force field first pushes back, then drives "
            "the hand on."),
      chart(workshop, "dynamics/stop.svg", chart_of(runs.stop), "Stopping in the zone", ""),
      chart(workshop, "dynamics/lean.svg", chart_of(runs.lean), "Leaning on the object",
            "Here drag loses, or keeps its promise: an object can be reached slowly. Its surface "
            "is at 20 mm."),
      chart(workshop, "dynamics/too_much_drag.svg",
            chart_of({runs.slot_delayed.field, runs.too_much_drag, {}}), "Too much drag, and late",
            "Drag of one and a half times what the mass bears at this delay, beside the force "
            "field of "
            "the delayed slot. Lines end where the hand strikes an object.")};
  outcome.data = {write_runs(workshop, "dynamics/slot.csv", runs.slot),
                  write_runs(workshop, "dynamics/slot_delayed.csv", runs.slot_delayed),
                  write_runs(workshop, "dynamics/edge.csv", runs.edge),
                  write_runs(workshop, "dynamics/stop.csv", runs.stop),
                  write_runs(workshop, "dynamics/lean.csv", runs.lean)};
  outcome.table = {{"run", "method", "reversals", "put in [mJ]", "taken out [mJ]",
                    "peak to peak at the end [mm]", "force at the end [N]"}};
  const auto add = [&](const char* name, const char* method, const JointRun& run) {
    outcome.table.push_back({name, method, fmt::format("{}", run.reversals),
                             fmt::format("{:.3f}", 1000 * run.put_in),
                             fmt::format("{:.3f}", 1000 * run.taken_out),
                             run.contact ? "struck" : fmt::format("{:.3f}", 1000 * run.ripple),
                             fmt::format("{:.3f}", run.final_force)});
  };
  const std::pair<const char*, const Duel*> duels[] = {{"slot", &runs.slot},
                                                       {"slot, delayed", &runs.slot_delayed},
                                                       {"edge", &runs.edge},
                                                       {"stop", &runs.stop},
                                                       {"lean", &runs.lean}};
  for (const auto& [name, duel] : duels) {
    add(name, "force field", duel->field);
    add(name, "drag", duel->drag);
    add(name, "neither", duel->alone);
  }
  add("slot, delayed", "too much drag", runs.too_much_drag);
  return outcome;
}

}  // namespace vicinity::report
