// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A simulated operator: plans smoothly, executes noisily, sees badly, feels with limits, reacts
/// late.
///
///   seen goal --> minimum jerk --> + execution noise --> arm impedance --> force on the handle
///      ^              ^                                                         |
///      | corrections  | slower, or stop                                         v
///   eye (late, and wrong in depth)        sense of resistance (Weber) <-- what pushes back
#pragma once

#include <cstdint>
#include <vector>

#include "vicinity/geometry/vec3.h"
#include "vicinity/teleop/seeded_noise.h"

namespace vicinity {

/// Numbers of a grown, healthy person. Each says where it is from; `chosen` is ours, and the
/// study's results hold for it alone.
struct OperatorParameters {
  // How the arm yields. Hogan 1985, Mussa-Ivaldi, Hogan & Bizzi 1985 and Tsuji et al. 1995 measured
  // hands in posture: 100 to 500 N/m, 5 to 30 N·s/m, 0.7 to 2 kg, by direction and tension.
  double stiffness = 300;  ///< [N/m]
  double damping = 20;     ///< [N·s/m]
  double mass = 1.2;       ///< of hand and forearm at the handle [kg]

  // Reaction to a touch 0.155 s, to a light 0.19 s: simple reactions, Woodworth & Schlosberg 1954.
  double touch_reaction_s = 0.155;
  double sight_reaction_s = 0.19;

  // Signal-dependent noise (Harris & Wolpert 1998). This much spreads a reach by some 4 % of its
  // length, as van Beers, Haggard & Wolpert 2004 saw.
  double noise = 0.1;                 ///< s.d. of the velocity, relative to the intended one
  double noise_correlation_s = 0.15;  ///< chosen: a few corrections a second

  // Just noticeable differences: viscosity 34 % by adjustment (Jones & Hunter 1993), 19 % by choice
  // (Jones, Hunter & Lafontaine 1997), force 7 to 10 % (Jones 1989; Pang, Tan & Durlach 1991). One
  // person has one number of each, drawn for each trial.
  double viscosity_weber[2] = {0.19, 0.34};
  double force_weber[2] = {0.07, 0.10};
  /// s.d. of a level as judged against one that was learned, relative. Viscosity: 84 % right at 34
  /// % and 71 % right at 19 % (the same two) are both 0.34. Force: as much in relation.
  double viscosity_spread = 0.34;
  double force_spread = 0.12;
  /// Least force that is noticed while the hand moves. Chosen; 0.1 to 0.5 N are reported.
  double least_force = 0.2;  ///< [N]
  /// What moving the hand and the handle costs anyhow: resistances are told apart from there on.
  /// Chosen, near the own damping of good devices.
  double own_resistance = 3;  ///< [N·s/m]

  // The eye. A camera that is poor or absent is the paper's reason to exist; nothing is measured
  // for it. Chosen.
  double depth_error_m = 0.02;    ///< s.d., along the line of sight, one for each trial
  double across_error_m = 0.005;  ///< s.d., across it
  double tolerance_m = 0.006;     ///< what is seen as there

  // What he does with what he feels. Chosen.
  double caution = 0.6;         ///< each noticed rise of resistance slows the motion by this
  double least_pace = 0.2;      ///< and never below this share of the intended one
  double creep_speed = 0.04;    ///< on, where sight says "there" and the hand does not yet [m/s]
  double creep_most = 2;        ///< for so many s.d. of the depth error
  int most_corrections = 8;     ///< by sight, before he takes it for there
  double felt_over_s = 0.03;    ///< resistance is felt as its mean over so long
  double slowest_felt = 0.005;  ///< slower than that, force by speed says nothing [m/s]
  double bump = 1;  ///< reflected contact that is not taken for inertia, and stops him [N]
};

/// What the operator wants.
struct Intent {
  std::vector<Vec3> path_W;  ///< of the tool, from where it is on, shape (n >= 2) [m]
  double speed = 0.25;  ///< mean along the path; a minimum-jerk motion peaks at 1.875 of it [m/s]
  Vec3 sight_W = Vec3::UnitY();  ///< along the line of sight
  bool stops_by_feel = false;    ///< at a part: stops where it feels as it did in training
  bool careful = true;           ///< slows down where resistance rises; not who leaves in haste
};

/// How resistance tells of nearness, which training teaches.
enum class Cue : std::uint8_t {
  none,
  viscosity,  ///< force by speed: drag
  force,      ///< force itself: springs
};

struct Training {
  Cue cue = Cue::none;
  double level = 0;  ///< what is felt at the wanted distance [N·s/m or N]; zero: nothing to go by
};

/// What he knows in one tick.
struct Senses {
  Vec3 handle = Vec3::Zero(), velocity = Vec3::Zero();  ///< his own hand, in W [m], [m/s]
  Vec3 felt = Vec3::Zero();       ///< what the aid does to the hand, in W          [N]
  double bump = 0;                ///< reflected contact, beyond the usual          [N]
  Vec3 seen_tool = Vec3::Zero();  ///< the slave's tool as the picture has it, late [m]
};

class Operator {
 public:
  /// @param trained  with this aid, at this part
  Operator(const OperatorParameters& parameters, const Intent& intent, const Training& trained,
           std::uint64_t seed);

  /// Force of his hand on the handle until the next tick [N].
  /// Real-time: no allocation.
  Vec3 act(double time_s, double period_s, const Senses& senses) noexcept;

  /// Whether he believes to be there, or has stopped for what he felt.
  bool done() const noexcept { return done_; }
  /// What resistance he feels now, by his cue [N·s/m or N].
  double felt_level() const noexcept { return level_; }

 private:
  void feel(double time_s, double period_s, const Senses& senses) noexcept;
  void heed(double time_s) noexcept;
  void plan(double time_s, const Vec3& from, const Vec3& to, double speed) noexcept;
  void move_on(double time_s, double period_s, const Senses& senses) noexcept;
  void stop(const Vec3& at) noexcept;

  OperatorParameters parameters_;
  Intent intent_;
  Training trained_;
  SeededNoise noise_;
  Vec3 aim_error_ = Vec3::Zero();
  double weber_ = 0.3;
  double stop_level_ = 0;   // where he takes what he feels for what he was trained to stop at
  double clear_level_ = 0;  // below, he is sure that it is less

  // The motion under way: from, to, share of it done, rate of that share.
  std::size_t leg_ = 0;
  Vec3 from_ = Vec3::Zero(), to_ = Vec3::Zero();
  double phase_ = 1, duration_s_ = 1, wait_until_s_ = 0, pace_ = 1;
  Vec3 wanted_ = Vec3::Zero(), wanted_rate_ = Vec3::Zero();
  Vec3 tremble_ = Vec3::Zero(), strayed_ = Vec3::Zero();
  bool creeping_ = false, done_ = false, stopped_ = false, started_ = false;
  int corrections_ = 0;

  double level_ = 0, reference_ = 0;
  double notices_at_s_ = -1, stops_at_s_ = -1;
  int rises_ = 0, pending_ = 0;
};

}  // namespace vicinity
