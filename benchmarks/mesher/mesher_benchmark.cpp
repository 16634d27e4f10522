// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher.h"

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "benchmarks/inputs.h"
#include "tetwright/resources.h"

namespace tetwright {
namespace {

/// Times repeated meshing; counters report the seconds of each stage.
void run(benchmark::State& state, const MesherInput& input, bool uniform) {
  MesherOptions options;
  options.resolution = static_cast<int>(state.range(0));
  options.uniform = uniform;
  const ThreadLimit limit(static_cast<unsigned>(state.range(1)));
  DenseMesh meshed;
  for (auto _ : state) meshed = mesh_surfaces(input, options, nullptr);
  const MesherReport& r = meshed.report;
  const double tets = static_cast<double>(meshed.mesh.tets.size());
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["tets"] = tets;
  state.counters["sdf_s"] = r.seconds_sdf;
  state.counters["octree_s"] = r.seconds_octree;
  state.counters["lattice_s"] = r.seconds_lattice;
  state.counters["move_s"] = r.seconds_move;
  state.counters["cut_s"] = r.seconds_cut;
  state.counters["tets/s_without_sdf"] =
      tets / (r.seconds_octree + r.seconds_lattice + r.seconds_move + r.seconds_cut);
  // Peak of the whole process so far: meaningful only if a filter selects a single case.
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1e3;
}

/// Doubling the resolution should take about four times the time and memory.
void adaptive(benchmark::State& state) { run(state, benchmark_input(), false); }
BENCHMARK(adaptive)
    ->Name("mesh_surfaces/adaptive")
    ->ArgNames({"cells", "threads"})
    ->ArgsProduct({{64, 128, 256, 512}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void uniform(benchmark::State& state) { run(state, benchmark_input(), true); }
BENCHMARK(uniform)
    ->Name("mesh_surfaces/uniform")
    ->ArgNames({"cells", "threads"})
    ->ArgsProduct({{64, 128, 160}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// The body with two layers: three materials.
void layered(benchmark::State& state) {
  MesherInput input = benchmark_input();
  const double size = (input.high - input.low).maxCoeff();
  input.layers = {{"skin", 2, 0.02 * size}, {"fat", 3, 0.04 * size}};
  run(state, input, false);
}
BENCHMARK(layered)
    ->Name("mesh_surfaces/layered")
    ->ArgNames({"cells", "threads"})
    ->ArgsProduct({{64, 128}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace tetwright
