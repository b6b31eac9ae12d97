// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0
//
// The build half by stage, each beside the plain way where there is one:
//
//   scripts/install_packages.sh --benchmarks
//   cmake --preset release -DVICINITY_BENCHMARKS=ON && cmake --build --preset release
//   VICINITY_DATA=../shared/data build/release/benchmarks/vicinity_benchmark
//
// Times are wall time. The argument after the name is the number of threads.

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <filesystem>
#include <memory>
#include <string>

#include "layers/triple_loop.h"
#include "named_scenes.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/layers/ranked_neighbours.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/voxel/boundary.h"
#include "vicinity/voxel/inner.h"

namespace vicinity::benchmarks {
namespace {

constexpr int lengths[] = {256, 512};
constexpr int thread_counts[] = {1, 2};

/// Runs `stage` once per iteration inside an arena of the benchmark's number of threads.
template <class Stage>
void run(benchmark::State& state, int threads, Stage&& stage) {
  tbb::task_arena arena(threads);
  arena.execute([&] {
    for (auto _ : state) benchmark::DoNotOptimize(stage());
  });
}

template <class Stage>
void add(const std::string& name, int threads, Stage stage) {
  benchmark::RegisterBenchmark((name + "/threads:" + std::to_string(threads)).c_str(),
                               [=](benchmark::State& state) { run(state, threads, stage); })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

/// Every stage of one object, for each number of threads.
void add_object(const NamedObject& object) {
  const auto boundary = std::make_shared<VoxelSet>(boundary_voxels(object.mesh, object.workspace));
  const auto inner =
      std::make_shared<VoxelSet>(inner_voxels(object.mesh, *boundary, object.workspace));
  const ShapingElement sphere(LayerShape::sphere, layers_m);
  const ShapingElement cube(LayerShape::cube, layers_m);
  for (const int threads : thread_counts) {
    add("voxelise/" + object.name, threads,
        [&object] { return boundary_voxels(object.mesh, object.workspace); });
    add("fill/" + object.name, threads,
        [&object, boundary] { return inner_voxels(object.mesh, *boundary, object.workspace); });
    add("rank_sphere/" + object.name, threads,
        [=] { return ranked_neighbours(*boundary, *inner, sphere, layers_q); });
    add("rank_cube/" + object.name, threads,
        [=] { return ranked_neighbours(*boundary, *inner, cube, layers_q); });
    add("rank_distance/" + object.name, threads, [&object, boundary, inner] {
      return distance_layers(object.mesh, *boundary, *inner, object.workspace, layers_m, layers_q);
    });
  }
  benchmark::RegisterBenchmark(("rank_sphere_triple_loop/" + object.name + "/threads:1").c_str(),
                               [=](benchmark::State& state) {
                                 run(state, 1, [&] {
                                   return triple_loop::ranked_neighbours(
                                       *boundary, *inner, LayerShape::sphere, layers_m, layers_q);
                                 });
                               })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Iterations(1);  // seconds each
}

/// Merging and writing of a whole scene; both come out of one build.
void merge_scene(benchmark::State& state) {
  const Scene scene = hot_cell();
  for (auto _ : state) {
    const BuildResult result =
        build_field(scene, {.threads = static_cast<int>(state.range(0)), .progress = {}});
    state.SetIterationTime(result.report.seconds.merge);
  }
}
BENCHMARK(merge_scene)
    ->Name("merge/hot_cell/threads")
    ->Arg(1)
    ->Arg(2)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void write_scene(benchmark::State& state) {
  const ViscosityField field = build_field(hot_cell()).field;
  const auto path = std::filesystem::temp_directory_path() / "vicinity_write_benchmark.vicinity";
  for (auto _ : state) save_field(field, path);
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * field.image().size()));
  std::filesystem::remove(path);
}
BENCHMARK(write_scene)->Name("write/hot_cell")->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vicinity::benchmarks

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  for (const int voxels : vicinity::benchmarks::lengths) {
    for (const auto& object : vicinity::benchmarks::named_objects(voxels)) {
      vicinity::benchmarks::add_object(object);
    }
  }
  benchmark::RunSpecifiedBenchmarks();
}
