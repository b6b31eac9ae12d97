// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0
//
// One tick of an arm with many points, beside the plain way of doing the same:
//
//   build/release/benchmarks/vicinity_benchmark --benchmark_filter=tick
//
// `hot_cell` is the demo's arm at work beside the vessel; `immersed` the same arm in a field whose
// layers fill the whole cell, so that every point feels something in every tick: the worst case.
// Plain: each point's position by Eigen, its viscosity from a dense array of floats, its force, and
// the sum of J'F by carrying wrenches down the tree. What this does not show: the tail of a tick in
// a real-time loop, which `vicinity bench tick` measures.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>

#include "named_scenes.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/teleop/tick.h"
#include "vicinity/viscosity/build_field.h"

namespace vicinity::benchmarks {
namespace {

constexpr double period = 0.001;

struct Cell {
  ViscosityField field;
  std::vector<float> dense;  // viscosity, x fastest

  explicit Cell(const Scene& scene) : field(build_field(scene).field) {
    const VoxelIndex dims = field.workspace().dims;
    dense.reserve(static_cast<std::size_t>(dims.i) * static_cast<std::size_t>(dims.j) *
                  static_cast<std::size_t>(dims.k));
    for (VoxelIndex v; v.k < dims.k; ++v.k) {
      for (v.j = 0; v.j < dims.j; ++v.j) {
        for (v.i = 0; v.i < dims.i; ++v.i)
          dense.push_back(static_cast<float>(field.viscosities()[field.code_at(v)]));
      }
    }
  }
  float viscosity_at(const Vec3& p_W) const noexcept {
    const Workspace& workspace = field.workspace();
    const Vec3 grid = workspace.to_grid(p_W);
    const auto i = static_cast<int>(std::floor(grid.x())),
               j = static_cast<int>(std::floor(grid.y())),
               k = static_cast<int>(std::floor(grid.z()));
    const VoxelIndex d = workspace.dims;
    if (i < 0 || j < 0 || k < 0 || i >= d.i || j >= d.j || k >= d.k) return 0;
    return dense[(static_cast<std::size_t>(k) * static_cast<std::size_t>(d.j) +
                  static_cast<std::size_t>(j)) *
                     static_cast<std::size_t>(d.i) +
                 static_cast<std::size_t>(i)];
  }
};

const Cell& typical() {
  static const Cell cell(hot_cell());
  return cell;
}

const Cell& immersed() {
  static const Cell cell([] {
    Scene scene = hot_cell();
    for (SceneObject& object : scene.objects) {
      object.m = 8;
      object.q = 32;
      object.coding.mu.clear();
      for (int n = 0; n < 32; ++n) object.coding.mu.push_back(33 - n);
    }
    return scene;
  }());
  return cell;
}

const RobotModel& arm() {
  static const RobotModel robot = read_urdf(VICINITY_SCENES "/hot_cell_arm.urdf").robot;
  return robot;
}

// Swinging about a pose between bench, risers and vessel; the tool at 0.25 m/s or so.
struct State {
  std::array<double, 7> q, qd;
  explicit State(double t) {
    constexpr std::array<double, 7> centre{0.1, 0.9, 0.3, 0.9, 0.2, 0.4, 0.0};
    for (std::size_t c = 0; c < 7; ++c) {
      const double rate = 1.0 + 0.13 * static_cast<double>(c), size = 0.15;
      q[c] = centre[c] + size * std::sin(rate * t + static_cast<double>(c));
      qd[c] = size * rate * std::cos(rate * t + static_cast<double>(c));
    }
  }
};

Pose base() { return hot_cell().robot->X_WB; }

BodyPoints points(std::int64_t count) {
  return sample_body_points(arm(), {.total = static_cast<std::size_t>(count)});
}

void ours(benchmark::State& state, const Cell& cell, const char* memory) {
  TeleoperationOptions options;
  options.memory = named_memory(memory);
  Teleoperation teleoperation(arm(), points(state.range(0)), cell.field, options);
  Output output;
  const Pose X_WB = base();
  double t = 0, looked = 0, felt = 0, ticks = 0;
  for (auto _ : state) {
    t += period;
    const State at(t);
    benchmark::DoNotOptimize(teleoperation.tick(
        {.time_s = t, .q = at.q.data(), .qd = at.qd.data(), .joint_count = 7, .X_WB = X_WB},
        output));
    looked += output.counts.points_looked;
    felt += output.counts.points_felt;
    ++ticks;
  }
  const double all = static_cast<double>(state.range(0));
  state.counters["looked"] = looked / ticks / all;
  state.counters["felt"] = felt / ticks / all;
}

void plain(benchmark::State& state, const Cell& cell) {
  const BodyPoints body = points(state.range(0));
  ForwardKinematics kinematics(arm());
  std::vector<Wrench> wrenches(arm().links.size());
  std::array<double, 7> tau{};
  const Pose X_WB = base();
  double t = 0;
  for (auto _ : state) {
    t += period;
    const State at(t);
    kinematics.update(at.q.data(), at.qd.data(), X_WB);
    for (const BodyPoints::LinkRange& range : body.links) {
      const auto link = static_cast<std::size_t>(range.link);
      const Pose X_WL = kinematics.X_WL(link);
      Wrench& wrench = wrenches[link];
      wrench = {};
      for (std::uint32_t p = range.begin; p < range.end; ++p) {
        const Vec3 p_W = X_WL * Vec3(body.x[p], body.y[p], body.z[p]);
        const double mu = static_cast<double>(cell.viscosity_at(p_W));
        const Vec3 r = p_W - kinematics.p_WL(link);
        const Vec3 v = kinematics.v_WLo(link) + kinematics.w_WL(link).cross(r);
        const Vec3 F = -mu * static_cast<double>(body.area[p]) * v;
        wrench.force += F;
        wrench.moment += r.cross(F);
      }
    }
    kinematics.joint_torques(wrenches.data(), tau.data());
    benchmark::DoNotOptimize(tau);
  }
}

void tick_hot_cell(benchmark::State& state) { ours(state, typical(), "none"); }
void tick_hot_cell_fading(benchmark::State& state) { ours(state, typical(), "fading"); }
void plain_hot_cell(benchmark::State& state) { plain(state, typical()); }
void tick_immersed(benchmark::State& state) { ours(state, immersed(), "none"); }
void tick_immersed_fading(benchmark::State& state) { ours(state, immersed(), "fading"); }
void plain_immersed(benchmark::State& state) { plain(state, immersed()); }

void sizes(benchmark::internal::Benchmark* each) {
  each->Arg(5000)->Arg(20000)->Arg(100000)->Unit(benchmark::kMicrosecond);
}
BENCHMARK(tick_hot_cell)->Name("tick/hot_cell/ours")->Apply(sizes);
BENCHMARK(tick_hot_cell_fading)->Name("tick/hot_cell/ours_fading")->Apply(sizes);
BENCHMARK(plain_hot_cell)->Name("tick/hot_cell/plain")->Apply(sizes);
BENCHMARK(tick_immersed)->Name("tick/immersed/ours")->Apply(sizes);
BENCHMARK(tick_immersed_fading)->Name("tick/immersed/ours_fading")->Apply(sizes);
BENCHMARK(plain_immersed)->Name("tick/immersed/plain")->Apply(sizes);

}  // namespace
}  // namespace vicinity::benchmarks
