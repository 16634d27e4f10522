// SPDX-License-Identifier: Apache-2.0
#include "tetwright/simplify.h"

#include <benchmark/benchmark.h>

#include "benchmarks/inputs.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright {
namespace {

/// Simplifies a dense mesh to a fortieth of its tets. Counters report the quality of the result together with
/// the time.
void simplify_fortieth(benchmark::State& state) {
  const TetMesh& mesh = benchmark_mesh(static_cast<int>(state.range(0)));
  const ThreadLimit limit(static_cast<unsigned>(state.range(1)));
  SimplifyOptions options;
  options.target_tets = mesh.tets.size() / 40;
  SimplifyReport report;
  TetMesh result;
  for (auto _ : state) {
    state.PauseTiming();
    TetMesh copy = mesh;
    report = {};
    state.ResumeTiming();
    result = simplify(std::move(copy), options, &report);
  }
  const MeshStatistics m = mesh_statistics(result);
  state.counters["tets_in"] = static_cast<double>(mesh.tets.size());
  state.counters["tets_out"] = static_cast<double>(m.tets);
  state.counters["below_0.1sr_%"] = m.below_percent;
  state.counters["min_sr"] = m.min_solid_angle;
  double conflicts = 0;
  for (const auto& it : report.iterations) conflicts += static_cast<double>(it.conflicts);
  state.counters["lock_conflicts"] = conflicts;
}
BENCHMARK(simplify_fortieth)
    ->Name("simplify")
    ->ArgNames({"cells", "threads"})
    ->ArgsProduct({{64, 96}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace tetwright
