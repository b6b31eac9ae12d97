// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Drag as passive forces, held against MuJoCo's own Jacobians at the same points.

#include "vicinity/mujoco/drag.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "no_allocation.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity {
namespace {

using std::numbers::pi;
using testing::AllOf;
using testing::HasSubstr;

struct Free {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
};
using ModelPointer = std::unique_ptr<mjModel, Free>;
using DataPointer = std::unique_ptr<mjData, Free>;

ModelPointer model_of(const std::string& inside) {
  const std::string text = "<mujoco model=\"test\">" + inside + "</mujoco>";
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "test.xml", static_cast<int>(text.size()) + 1);
  std::memcpy(files->filedata[0], text.c_str(), text.size() + 1);
  char why[500] = "";
  ModelPointer model(mj_loadXML("test.xml", files.get(), why, sizeof why));
  mj_deleteVFS(files.get());
  if (!model) throw Error({.what = why});
  return model;
}

// Continuous viscosity, up to and into the surface: a point that rounding puts into the next voxel
// feels the same. So large that whatever the models do, some of it is felt.
ViscosityField smooth_field() {
  Scene scene;
  scene.voxel_size = 0.02;
  SceneObject ball{.name = "ball", .shape = primitive::sphere(0.25)};
  ball.layers = LayerShape::distance;
  ball.m = 4;
  ball.q = 6;
  ball.coding = {{32, 25, 20, 17, 15, 13}, 32};
  scene.objects.push_back(ball);
  return build_field(scene).field;
}

const ViscosityField& field() {
  static const ViscosityField only = smooth_field();
  return only;
}

// Joints of every kind, two in one body, off its origin; geoms of every kind; a body that is welded
// to a moving one; bodies that stand still; one that is only seen.
constexpr const char* zoo = R"(
  <option timestep="0.001"/>
  <asset>
    <mesh name="wedge" vertex="0 0 0  .2 0 0  0 .2 0  0 0 .1  .2 0 .1  0 .2 .1"/>
  </asset>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 .1" pos="0 0 -2"/>
    <body name="post" pos="0 0 .3"><geom type="box" size=".1 .1 .1"/></body>
    <body name="upper" pos=".1 .1 .2" euler="20 30 40">
      <joint name="slide" type="slide" axis="1 .2 0"/>
      <joint name="turn" type="hinge" axis="0 1 .3" pos=".05 0 .1"/>
      <geom type="capsule" fromto="0 0 0 .2 0 .1" size=".03"/>
      <geom type="sphere" size=".3" contype="0" conaffinity="0"/>
      <body name="plate" pos=".2 0 .1" euler="0 45 0">
        <geom type="box" size=".05 .1 .02" pos="0 .05 0"/>
        <body name="fore">
          <joint name="elbow" type="hinge" axis="1 0 0" pos="0 .1 0" ref="30"/>
          <geom type="cylinder" size=".03 .1"/>
          <geom type="mesh" mesh="wedge" pos="0 0 .2" euler="10 20 30"/>
        </body>
      </body>
    </body>
    <body name="swing" pos="-.2 -.1 0">
      <joint type="ball" pos="0 0 .2"/>
      <geom type="ellipsoid" size=".05 .1 .15"/>
    </body>
    <body name="thrown" pos="0 -.3 .1">
      <freejoint/>
      <geom type="sphere" size=".08"/>
      <body pos="0 0 .2"><joint type="hinge" axis="0 1 0"/><geom type="sphere" size=".05" contype="0" conaffinity="0"/></body>
    </body>
  </worldbody>)";

// Positions within the layers' reach, and velocities, drawn by a seed.
void draw_state(const mjModel& model, mjData& data, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> turn(-3, 3), place(-0.3, 0.3);
  for (int joint = 0; joint < model.njnt; ++joint) {
    double* q = data.qpos + model.jnt_qposadr[joint];
    const int type = model.jnt_type[joint];
    if (type == mjJNT_HINGE) *q = turn(random);
    if (type == mjJNT_SLIDE) *q = place(random);
    if (type == mjJNT_FREE) {
      for (int axis = 0; axis < 3; ++axis) *q++ = place(random);
    }
    if (type == mjJNT_FREE || type == mjJNT_BALL) {
      for (int n = 0; n < 4; ++n) q[n] = normal(random);
      mju_normalize4(q);
    }
  }
  for (int dof = 0; dof < model.nv; ++dof) data.qvel[dof] = normal(random);
}

// Eq. 5 at every point, and its way to the joints, by mj_jac.
Eigen::VectorXd plainly(const mjModel& model, mjData& data, const BodyPoints& points,
                        const Pose& X_WM, double* power) {
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(model.nv);
  const Eigen::Map<const Eigen::VectorXd> qd(data.qvel, model.nv);
  Rows J(3, model.nv);
  *power = 0;
  for (const BodyPoints::LinkRange& range : points.links) {
    for (std::uint32_t n = range.begin; n < range.end; ++n) {
      const Vec3 p_B(points.x[n], points.y[n], points.z[n]);
      Vec3 p_M;
      mju_mulMatVec(p_M.data(), data.xmat + 9 * range.link, p_B.data(), 3, 3);
      mju_addTo3(p_M.data(), data.xpos + 3 * range.link);
      mj_jac(&model, &data, J.data(), nullptr, p_M.data(), range.link);
      const Vec3 v = J * qd;
      const Vec3 F = -field().at(X_WM * p_M).viscosity * points.area[n] * v;
      forces += J.transpose() * F;
      *power += F.dot(v);
    }
  }
  return forces;
}

TEST(MuJoCoDrag, IsTheSumOverAllPointsByMuJoCosOwnJacobians) {
  const ModelPointer model = model_of(zoo);
  const DataPointer data(mj_makeData(model.get())), free(mj_makeData(model.get()));
  MuJoCoDragOptions options;
  options.X_WM = pose_from_rpy({0.05, -0.02, 0.1}, {0.3, -0.2, 0.9});
  const AttachedDrag drag(model.get(), data.get(), field(), options);
  std::mt19937_64 random(21);
  int felt = 0;
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    draw_state(*model, *data, random);
    mju_copy(free->qpos, data->qpos, model->nq);
    mju_copy(free->qvel, data->qvel, model->nv);
    // Twice: in the first a layer counts that was crossed on the way from the last state.
    for (int n = 0; n < 2; ++n) mj_forward(model.get(), data.get());
    mj_forward(model.get(), free.get());
    const Eigen::Map<const Eigen::VectorXd> with(data->qfrc_passive, model->nv),
        without(free->qfrc_passive, model->nv), qd(data->qvel, model->nv);
    double power = 0;
    const Eigen::VectorXd expected = plainly(*model, *data, drag.points(), options.X_WM, &power);
    ASSERT_EQ(drag.output().scale, 1);
    EXPECT_LT((with - without - expected).norm(), 1e-5 * expected.norm() + 1e-9);
    EXPECT_NEAR((with - without).dot(qd), power, 1e-5 * std::abs(power) + 1e-9);
    EXPECT_NEAR(drag.output().power, -power, 1e-5 * std::abs(power) + 1e-9);
    EXPECT_LE((with - without).dot(qd), 0);
    felt += power < -0.01;
  }
  EXPECT_GT(felt, 40) << "most states must be felt for this to mean anything";
}

TEST(MuJoCoDrag, ThePointsOfABodyStandForTheSurfaceOfItsGeoms) {
  const ModelPointer model = model_of(zoo);
  const MuJoCoDrag drag(model.get(), field());
  std::map<std::string, double> areas;
  for (const BodyPoints::LinkRange& range : drag.points().links) {
    const char* name = mj_id2name(model.get(), mjOBJ_BODY, range.link);
    areas[name != nullptr ? name : ""] = range.area;
  }
  EXPECT_EQ(areas.size(), 6u) << "what stands still has none";
  EXPECT_NEAR(areas["upper"] / (2 * pi * 0.03 * std::hypot(0.2, 0.1) + 4 * pi * 0.03 * 0.03), 1,
              0.01);
  EXPECT_NEAR(areas["plate"], 8 * (0.05 * 0.1 + 0.05 * 0.02 + 0.1 * 0.02), 1e-9);
  const double wedge = 0.2 * 0.2 + 0.1 * (0.4 + 0.2 * std::numbers::sqrt2);
  EXPECT_NEAR(areas["fore"] / (2 * pi * 0.03 * 0.23 + wedge), 1, 0.01);
  // Knud Thomsen's formula, good to 1.1 %.
  const auto ellipsoid = [](double a, double b, double c) {
    const auto p = [](double x, double y) { return std::pow(x * y, 1.6075); };
    return 4 * pi * std::pow((p(a, b) + p(a, c) + p(b, c)) / 3, 1 / 1.6075);
  };
  EXPECT_NEAR(areas["swing"] / ellipsoid(0.05, 0.1, 0.15), 1, 0.02);
  EXPECT_NEAR(areas["thrown"] / (4 * pi * 0.08 * 0.08), 1, 0.01);
  EXPECT_NEAR(areas[""] / (4 * pi * 0.05 * 0.05), 1, 0.01) << "it has nothing but what is seen";
}

TEST(MuJoCoDrag, FarFromEverythingTheForcesAreThoseWithoutIt) {
  const ModelPointer model = model_of(zoo);
  const DataPointer data(mj_makeData(model.get())), free(mj_makeData(model.get()));
  MuJoCoDragOptions options;
  options.X_WM.translation() = Vec3(50, 0, 0);
  const AttachedDrag drag(model.get(), data.get(), field(), options);
  std::mt19937_64 random(22);
  draw_state(*model, *data, random);
  mju_copy(free->qpos, data->qpos, model->nq);
  mju_copy(free->qvel, data->qvel, model->nv);
  for (int step = 0; step < 50; ++step) {
    mj_step(model.get(), data.get());
    mj_step(model.get(), free.get());
  }
  EXPECT_EQ(std::memcmp(data->qpos, free->qpos, sizeof(mjtNum) * model->nq), 0);
  EXPECT_EQ(drag.output().power, 0);
  EXPECT_EQ(drag.output().reason.point, -1);
}

// A pendulum of 0.5 m above the ball: hanging down, its bob is in the layers.
std::string pendulum(const std::string& options, double kg) {
  return "<option " + options + "><flag energy=\"enable\"/></option>" + R"(
  <worldbody><body name="bob" pos="0 0 0.9">
    <joint name="pivot" type="hinge" axis="0 1 0"/>
    <geom type="sphere" size=".04" pos="0 0 -.5" mass=")" +
         std::to_string(kg) + R"("/>
  </body></worldbody>)";
}

double energy(const mjModel& model, mjData& data) {
  mj_forward(&model, &data);
  return data.energy[0] + data.energy[1];
}

TEST(MuJoCoDrag, APendulumLosesItsEnergyInTheLayersAndRestsWithoutForce) {
  for (const char* integrator : {"Euler", "RK4"}) {
    SCOPED_TRACE(integrator);
    const std::string options = std::string("timestep=\"0.002\" integrator=\"") + integrator + "\"";
    const ModelPointer model = model_of(pendulum(options, 0.2));
    const DataPointer with(mj_makeData(model.get())), without(mj_makeData(model.get()));
    with->qpos[0] = without->qpos[0] = 1.5;
    MuJoCoDragOptions heavy;
    heavy.points.weight = {{"bob", 30}};
    const AttachedDrag drag(model.get(), with.get(), field(), heavy);
    const double start = energy(*model, *without);
    with->time = without->time = 0;
    double last = energy(*model, *with), most_rise = 0, taken = 0;
    for (int step = 0; step < 3'000; ++step) {
      mj_step(model.get(), with.get());
      taken += model->opt.timestep * drag.output().power;
      const double now = energy(*model, *with);
      if (drag.output().power > 0.01) most_rise = std::max(most_rise, now - last);
      last = now;
      if (step == 1'000) {
        for (int n = 0; n <= step; ++n) mj_step(model.get(), without.get());
        EXPECT_NEAR(energy(*model, *without), start, 0.01) << "by itself it swings on";
        EXPECT_LT(last, start - 0.2);
      }
    }
    EXPECT_LE(most_rise, 1e-9);
    EXPECT_NEAR(with->qpos[0], 0, 0.2) << "it has come down";
    EXPECT_NEAR(taken, start - last, 0.03 * (start - last)) << "all that is lost, drag has taken";
    with->qvel[0] = 0;
    mj_forward(model.get(), with.get());
    EXPECT_EQ(with->qfrc_passive[0], 0) << "standing still is free";
    EXPECT_EQ(drag.output().power, 0);
  }
}

TEST(MuJoCoDrag, NeverTurnsAMotionRoundHoweverCoarseTheStep) {
  const ModelPointer model = model_of(pendulum("timestep=\"0.01\" gravity=\"0 0 0\"", 0.001));
  const DataPointer data(mj_makeData(model.get()));
  MuJoCoDragOptions absurd;
  absurd.points.weight = {{"bob", 1e5}};
  const AttachedDrag drag(model.get(), data.get(), field(), absurd);
  data->qpos[0] = 0.3;
  data->qvel[0] = -2;
  bool held_back = false;
  for (int step = 0; step < 200; ++step) {
    const double before = data->qvel[0];
    mj_step(model.get(), data.get());
    held_back |= drag.output().scale < 0.01;
    ASSERT_LE(data->qvel[0], 1e-12) << "at step " << step;
    ASSERT_GE(data->qvel[0], before - 1e-12) << "at step " << step;
  }
  EXPECT_TRUE(held_back);
}

TEST(MuJoCoDrag, AStateIsFeltTheSameHoweverOftenAndWheneverItIsAskedFor) {
  const ModelPointer model = model_of(zoo);
  const DataPointer data(mj_makeData(model.get()));
  const AttachedDrag drag(model.get(), data.get(), field());
  std::mt19937_64 random(23);
  draw_state(*model, *data, random);
  for (int n = 0; n < 2; ++n) mj_forward(model.get(), data.get());
  const Eigen::VectorXd first = Eigen::Map<Eigen::VectorXd>(data->qfrc_passive, model->nv);
  const std::vector<double> q(data->qpos, data->qpos + model->nq),
      qd(data->qvel, data->qvel + model->nv);
  const auto expect_the_same = [&] {
    for (int n = 0; n < 2; ++n) mj_forward(model.get(), data.get());
    const Eigen::Map<const Eigen::VectorXd> now(data->qfrc_passive, model->nv);
    EXPECT_LT((now - first).norm(), 1e-6 * first.norm());
  };
  expect_the_same();
  for (int n = 0; n < 20; ++n) mj_step(model.get(), data.get());
  mj_resetData(model.get(), data.get());
  mju_copy(data->qpos, q.data(), model->nq);
  mju_copy(data->qvel, qd.data(), model->nv);
  expect_the_same();
  data->qvel[0] = std::nan("");
  mj_forward(model.get(), data.get());
  data->qvel[0] = qd[0];
  expect_the_same();
}

TEST(MuJoCoDrag, TakesNoMemoryWhileTheSimulationRuns) {
  const ModelPointer model = model_of(zoo);
  const DataPointer data(mj_makeData(model.get()));
  MuJoCoDrag drag(model.get(), field());
  std::mt19937_64 random(24);
  draw_state(*model, *data, random);
  mj_forward(model.get(), data.get());
  {
    const NoAllocation guard;
    EXPECT_TRUE(drag.apply(model.get(), data.get()));
    EXPECT_TRUE(drag.apply(model.get(), data.get()));
  }
  EXPECT_GT(drag.output().power, 0);
}

int own_calls = 0;
void own_callback(const mjModel*, mjData*) { ++own_calls; }

TEST(AttachedDrag, ManyModelsFeelEachTheirOwnAndOnesOwnCallbackGoesOn) {
  const ModelPointer one = model_of(pendulum("", 0.2)), two = model_of(zoo);
  mjcb_passive = own_callback;
  own_calls = 0;
  const DataPointer a(mj_makeData(one.get())), b(mj_makeData(one.get())), c(mj_makeData(two.get())),
      none(mj_makeData(one.get()));
  std::mt19937_64 random(25);
  draw_state(*two, *c, random);
  for (mjData* data : {a.get(), b.get(), none.get()}) data->qvel[0] = 1;
  {
    const AttachedDrag on_a(one.get(), a.get(), field());
    const AttachedDrag on_c(two.get(), c.get(), field());
    {
      MuJoCoDragOptions heavy;
      heavy.points.weight = {{"bob", 10}};
      const AttachedDrag on_b(one.get(), b.get(), field(), heavy);
      std::thread beside([&] { mj_forward(two.get(), c.get()); });
      for (mjData* data : {a.get(), b.get(), none.get()}) mj_forward(one.get(), data);
      beside.join();
      EXPECT_LT(a->qfrc_passive[0], 0);
      EXPECT_NEAR(b->qfrc_passive[0], 10 * a->qfrc_passive[0], 1e-5 * -b->qfrc_passive[0]);
      EXPECT_EQ(none->qfrc_passive[0], 0);
      EXPECT_GT(on_c.output().power, 0);
      const AttachedDrag again(one.get(), a.get(), field());  // two fields on one arm add up
      const double once = a->qfrc_passive[0];
      mj_forward(one.get(), a.get());
      EXPECT_NEAR(a->qfrc_passive[0], 2 * once, 1e-12);
    }
    mj_forward(one.get(), b.get());
    EXPECT_EQ(b->qfrc_passive[0], 0) << "nothing is left of what has gone";
  }
  EXPECT_EQ(mjcb_passive, own_callback);
  EXPECT_EQ(own_calls, 6);
  mjcb_passive = nullptr;
}

TEST(AttachedDrag, SaysWhichBodyIsNearWhichObject) {
  const ModelPointer model = model_of(zoo);
  const DataPointer data(mj_makeData(model.get()));
  MuJoCoDragOptions options;
  options.bodies = {"plate"};
  const AttachedDrag drag(model.get(), data.get(), field(), options);
  EXPECT_EQ(drag.points().links.size(), 2u) << "the plate, and what hangs on it";
  std::fill_n(data->qvel, model->nv, 1.0);
  mj_forward(model.get(), data.get());
  const Reason& reason = drag.output().reason;
  ASSERT_GE(reason.point, 0);
  EXPECT_THAT(mj_id2name(model.get(), mjOBJ_BODY, reason.link),
              testing::AnyOf(testing::StrEq("plate"), testing::StrEq("fore")));
  EXPECT_EQ(reason.object, 0);
  EXPECT_GT(reason.share, 0);
  EXPECT_LE(reason.share, 1);
}

void expect_refused(const std::function<void()>& act, const testing::Matcher<std::string>& says) {
  try {
    act();
    ADD_FAILURE() << "it was taken";
  } catch (const Error& error) {
    EXPECT_THAT(std::string(error.what()), says);
  }
}

TEST(AttachedDrag, WrongInputIsRefusedWithASentence) {
  const ModelPointer model = model_of(zoo);
  const DataPointer data(mj_makeData(model.get()));
  const auto attach = [&](const MuJoCoDragOptions& options) {
    return [&, options] { const AttachedDrag drag(model.get(), data.get(), field(), options); };
  };
  MuJoCoDragOptions wrong;
  wrong.bodies = {"plaet"};
  expect_refused(attach(wrong), AllOf(HasSubstr("no such body"), HasSubstr("try plate")));
  wrong = {};
  wrong.bodies = {"post"};
  expect_refused(attach(wrong), HasSubstr("no body of 'test' that moves"));
  wrong = {};
  wrong.points.exclude = {"uper"};
  expect_refused(attach(wrong), HasSubstr("uper"));
  wrong = {};
  wrong.X_WM.translation().x() = std::nan("");
  expect_refused(attach(wrong), HasSubstr("not finite"));
  expect_refused([&] { const AttachedDrag drag(model.get(), nullptr, field()); },
                 HasSubstr("no data"));
  expect_refused([&] { const AttachedDrag drag(nullptr, data.get(), field()); },
                 HasSubstr("no model"));
  EXPECT_EQ(mjcb_passive, nullptr);

  MuJoCoDrag drag(model.get(), field());
  const ModelPointer other = model_of(pendulum("", 1));
  const DataPointer others(mj_makeData(other.get()));
  EXPECT_FALSE(drag.apply(other.get(), others.get()));
  EXPECT_FALSE(drag.apply(nullptr, nullptr));
}

}  // namespace
}  // namespace vicinity
