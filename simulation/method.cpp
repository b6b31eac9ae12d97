// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "simulation/method.h"

#include <algorithm>

#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"
#include "vicinity/viscosity/coding.h"

namespace vicinity {
namespace {

// From the device's reading of one step: slower than that is rest [rad].
constexpr double noise_band = 3e-5;
// A tick that comes after so many periods came too late.
constexpr double late_periods = 1.5;

std::vector<Method> all_methods() {
  std::vector<Method> all;
  all.push_back({.name = "none", .says = "no aid: contact force alone comes back"});
  all.push_back({.name = "potential_field",
                 .says = "repelled by every surface within the layers' reach (Khatib)",
                 .kind = MethodKind::potential,
                 .cue = Cue::force,
                 .setting_name = "gain [N]",
                 .tried = {0.003, 0.01, 0.03, 0.1, 0.3}});
  all.push_back({.name = "virtual_fixture",
                 .says = "a spring from a barrier 25 mm off every surface",
                 .kind = MethodKind::fixture,
                 .cue = Cue::force,
                 .setting_name = "stiffness [N/m]",
                 .tried = {100, 200, 400, 800, 1600}});
  all.push_back({.name = "speed_scaling",
                 .says = "slowed by distance, in every direction (MoveIt Servo)",
                 .kind = MethodKind::scaling,
                 .setting_name = "threshold [m]",
                 .tried = {0.005, 0.01, 0.02, 0.04, 0.08}});
  const std::vector<double> gains = {30, 100, 300, 1000, 3000};
  const auto drag = [&](std::string name, std::string says, std::string coding, std::string memory,
                        DragDirection direction, bool keeps_distance) {
    all.push_back({.name = std::move(name),
                   .says = std::move(says),
                   .kind = MethodKind::drag,
                   .cue = Cue::viscosity,
                   .coding = std::move(coding),
                   .memory = std::move(memory),
                   .direction = direction,
                   .keeps_distance = keeps_distance,
                   .setting_name = "gain G",
                   .tried = gains});
  };
  for (const char* coding : {"linear", "nonlinear"}) {
    const std::string type = coding == std::string("linear") ? "I" : "II";
    for (const char* memory : {"none", "sustained", "fading", "short"}) {
      drag("all_" + type + "_" + memory,
           "the paper's: opposes all motion; coding " + type + ", memory " + memory, coding, memory,
           DragDirection::all, false);
    }
  }
  drag("closing", "ours: opposes only what comes nearer; the paper's coding", "paper", "none",
       DragDirection::closing, false);
  drag("distance", "ours: closing, with viscosity continuous in distance; coding jnd", "jnd",
       "none", DragDirection::closing, true);
  drag("jnd", "ours: closing, in steps that can just be told apart", "jnd", "none",
       DragDirection::closing, false);
  drag("rising", "ours: closing, coding jnd, a rise at once and a fall smoothed", "jnd", "rising",
       DragDirection::closing, false);
  return all;
}

ViscosityField coded(const ViscosityField& field, const std::string& coding) {
  std::vector<Coding> codings;
  for (const FieldObject& object : field.objects()) {
    Coding each =
        coding == "paper" && object.q > 6 ? object.coding : named_coding(coding, object.q);
    each.skin = object.coding.skin;
    codings.push_back(std::move(each));
  }
  return field.with_codings(codings);
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> all = all_methods();
  return all;
}

const Method& method_named(std::string_view name) {
  std::vector<std::string> names;
  std::string list;
  for (const Method& method : methods()) {
    if (method.name == name) return method;
    names.push_back(method.name);
    list += (list.empty() ? "" : ", ") + method.name;
  }
  throw Error({.where = "method",
               .what = "no aid has that name",
               .found = "'" + std::string(name) + "'",
               .expected = "one of " + list,
               .hint = nearest_word(name, names)});
}

FittedAid fit_aid(const Workplace& place, const Method& method, const Device& device,
                  double period_s) {
  FittedAid fitted;
  const auto distance = [&] {
    return ArmDistance(place.robot, place.points, place.distance, place.distance_clearance);
  };
  const HandleLimits limits{place.tool_link,
                            device.force_limit.value_or(HandleLimits{}.force_limit)};
  switch (method.kind) {
    case MethodKind::none:
      fitted.aid = std::make_unique<NoAid>(3);
      break;
    case MethodKind::potential:
      // As far as the layers of the smaller things reach: 48 mm.
      fitted.aid = std::make_unique<PotentialField>(distance(), method.setting, 0.048, limits);
      break;
    case MethodKind::fixture:
      fitted.aid = std::make_unique<VirtualFixture>(distance(), method.setting, 0.025, limits);
      break;
    case MethodKind::scaling:
      fitted.aid = std::make_unique<SpeedScaling>(distance(), method.setting, 3);
      break;
    case MethodKind::drag: {
      TeleoperationOptions options;
      options.memory = named_memory(method.memory);
      options.direction = method.direction;
      options.limiter = limiter_options(device, method.mode);
      options.limiter->period_s = period_s;
      options.noise_band = noise_band;
      options.tool_link = place.tool_link;
      options.longest_period_s = late_periods * period_s;
      BodyPoints points = place.points;
      for (float& area : points.area) area *= static_cast<float>(method.setting);
      fitted.teleoperation = std::make_unique<Teleoperation>(
          place.robot, std::move(points),
          coded(method.keeps_distance ? place.distance : place.ranked, method.coding), options);
      fitted.aid = std::make_unique<DragAid>(*fitted.teleoperation);
      break;
    }
  }
  return fitted;
}

}  // namespace vicinity
