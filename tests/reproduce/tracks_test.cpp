// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Verdicts on tracks: right for the method as it is, and turned by each way of breaking it.

#include <gtest/gtest.h>

#include <algorithm>

#include "bench_room.h"
#include "reproduce/master.h"
#include "reproduce/parts.h"
#include "reproduce/tracks.h"

namespace vicinity::report {
namespace {

// Every voxel feels as the rank beyond its own.
ViscosityField one_rank_off(const ViscosityField& field, const std::vector<double>& mu) {
  std::vector<double> shifted(mu.begin() + 1, mu.end());
  shifted.push_back(0);
  return field.with_codings({Coding{shifted, 100}});
}

// A force field's answer in place of drag: away from where R came from, whatever its speed.
std::vector<Pass> with_force_for_drag(std::vector<Pass> passes) {
  for (Pass& pass : passes) {
    for (TraceSample& s : pass.samples) s.force_W = s.mu_e * unit_area * Vec3(0, 0, 1);
  }
  return passes;
}

// Drag that pushes along.
std::vector<Pass> with_wrong_sign(std::vector<Pass> passes) {
  for (Pass& pass : passes) {
    for (TraceSample& s : pass.samples) s.force_W = -s.force_W;
  }
  return passes;
}

class Tracks : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const BenchRoom room;
    cone_ = room.workshop().field(cone(), {});
    cone_distances_ = room.workshop().distances(cone(), 32);
    complex_ = room.workshop().field(complex_cylinder(), {});
    complex_distances_ = room.workshop().distances(complex_cylinder(), 32);
    round_ = room.workshop().field(circular_cylinder(), {.m = 4, .q = 5});
    round_distances_ = room.workshop().distances(circular_cylinder(), 24);
  }

  static ViscosityField cone_, cone_distances_, complex_, complex_distances_, round_,
      round_distances_;
};
ViscosityField Tracks::cone_, Tracks::cone_distances_, Tracks::complex_, Tracks::complex_distances_,
    Tracks::round_, Tracks::round_distances_;

const std::vector<double> paper_mu{32, 25, 20, 17, 15, 13};

TEST_F(Tracks, Fig5TurnsForAWrongRankAForceAndForDragAtRest) {
  const std::vector<Pass> right = approach_slow_and_fast(round_, round_distances_);
  EXPECT_TRUE(agrees(check_fig5(right, 0))) << why(check_fig5(right, 0));
  EXPECT_FALSE(agrees(check_fig5(right, 0.1)));
  EXPECT_FALSE(agrees(check_fig5(with_force_for_drag(right), 0)));
  EXPECT_FALSE(agrees(check_fig5(with_wrong_sign(right), 0)));
  const ViscosityField off = one_rank_off(round_, {32, 25, 20, 17, 15});
  EXPECT_FALSE(agrees(check_fig5(approach_slow_and_fast(off, round_distances_), 0)));
}

TEST_F(Tracks, Fig22TurnsForAWrongRankAndAForce) {
  const std::vector<Pass> right = six_tracks(cone_, cone_distances_);
  EXPECT_TRUE(agrees(check_fig22(right))) << why(check_fig22(right));
  EXPECT_FALSE(agrees(check_fig22(with_force_for_drag(right))));
  EXPECT_FALSE(agrees(check_fig22(with_wrong_sign(right))));
  EXPECT_FALSE(agrees(check_fig22(six_tracks(one_rank_off(cone_, paper_mu), cone_distances_))));
}

TEST_F(Tracks, Fig23TurnsForAWrongRankAForceAndSwappedCodings) {
  const ViscosityField caption = complex_.with_codings({named_coding("nonlinear", 6)});
  const std::vector<Pass> text = three_tracks(complex_, complex_distances_);
  const std::vector<Pass> other = three_tracks(caption, complex_distances_);
  EXPECT_TRUE(agrees(check_fig23(text, other))) << why(check_fig23(text, other));
  EXPECT_FALSE(agrees(check_fig23(other, text)));
  EXPECT_FALSE(agrees(check_fig23(with_force_for_drag(text), with_force_for_drag(other))));
  const ViscosityField off = one_rank_off(complex_, paper_mu);
  EXPECT_FALSE(agrees(check_fig23(three_tracks(off, complex_distances_), other)));
}

TEST_F(Tracks, Fig24TurnsForAWrongRankAndAForceThatIgnoresSpeed) {
  const std::vector<Pass> right = same_track_at_speeds(cone_, cone_distances_);
  EXPECT_TRUE(agrees(check_fig24(right))) << why(check_fig24(right));
  EXPECT_FALSE(agrees(check_fig24(with_force_for_drag(right))));
  EXPECT_FALSE(
      agrees(check_fig24(same_track_at_speeds(one_rank_off(cone_, paper_mu), cone_distances_))));
}

TEST_F(Tracks, Fig34TurnsForAWrongRankAForceAndAWrongBalance) {
  const ViscosityField nonlinear = cone_.with_codings({named_coding("nonlinear", 6)});
  const std::vector<OperatorPass> right = operator_passes(nonlinear, cone_distances_);
  EXPECT_TRUE(agrees(check_fig34(right))) << why(check_fig34(right));

  std::vector<OperatorPass> force = right;
  for (OperatorPass& each : force) {
    for (std::size_t n = 0; n < each.absorbed.size(); ++n) {
      each.needed[n] += each.pass.samples[n].mu_e - each.absorbed[n];
      each.absorbed[n] = each.pass.samples[n].mu_e;
    }
  }
  EXPECT_FALSE(agrees(check_fig34(force)));

  std::vector<OperatorPass> unbalanced = right;
  unbalanced[1].needed[40] += 0.01;
  EXPECT_FALSE(agrees(check_fig34(unbalanced)));

  const ViscosityField off = one_rank_off(cone_, {32, 20, 13, 11, 10, 9});
  EXPECT_FALSE(agrees(check_fig34(operator_passes(off, cone_distances_))));
}

}  // namespace
}  // namespace vicinity::report
