// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/mesh_check.h"

#include <benchmark/benchmark.h>

#include "benchmarks/inputs.h"
#include "common/mesh/mesh_statistics.h"
#include "common/mesh/topology.h"

namespace tetwright {
namespace {

void per_tet(benchmark::State& state, const TetMesh& mesh) {
  state.counters["tets"] = static_cast<double>(mesh.tets.size());
  state.counters["tets/s"] = benchmark::Counter(static_cast<double>(mesh.tets.size()),
                                                benchmark::Counter::kIsIterationInvariantRate);
}

void check(benchmark::State& state) {
  const TetMesh& mesh = benchmark_mesh(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(check_mesh(mesh));
  per_tet(state, mesh);
}
BENCHMARK(check)->Name("check_mesh")->ArgName("cells")->Arg(64)->Unit(benchmark::kMillisecond)->UseRealTime();

void signature(benchmark::State& state) {
  const TetMesh& mesh = benchmark_mesh(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(topology(mesh));
  per_tet(state, mesh);
}
BENCHMARK(signature)
    ->Name("topology")
    ->ArgName("cells")
    ->Arg(64)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void statistics(benchmark::State& state) {
  const TetMesh& mesh = benchmark_mesh(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(mesh_statistics(mesh));
  per_tet(state, mesh);
}
BENCHMARK(statistics)
    ->Name("mesh_statistics")
    ->ArgName("cells")
    ->Arg(64)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace tetwright
