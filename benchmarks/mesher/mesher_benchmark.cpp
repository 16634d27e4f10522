#include "mesher/mesher.h"

#include <benchmark/benchmark.h>

#include "benchmarks/inputs.h"
#include "common/parallel.h"

namespace tetwright {
namespace {

/// Surface to dense mesh; seconds of each stage as counters.
void dense(benchmark::State& state) {
  const auto surface = benchmark_surface();
  MesherOptions options;
  options.resolution = static_cast<int>(state.range(0));
  const ThreadLimit limit(static_cast<unsigned>(state.range(1)));
  MeshedSurface meshed;
  for (auto _ : state) meshed = mesh_surfaces(surface, options, nullptr);
  const MesherReport& r = meshed.report;
  const double tets = static_cast<double>(meshed.mesh.tets.size());
  state.counters["tets"] = tets;
  state.counters["sdf_s"] = r.seconds_sdf;
  state.counters["octree_s"] = r.seconds_octree;
  state.counters["lattice_s"] = r.seconds_lattice;
  state.counters["move_s"] = r.seconds_move;
  state.counters["cut_s"] = r.seconds_cut;
  state.counters["tets/s_without_sdf"] =
      tets / (r.seconds_octree + r.seconds_lattice + r.seconds_move + r.seconds_cut);
}
BENCHMARK(dense)
    ->Name("mesh_surfaces")
    ->ArgNames({"cells", "threads"})
    ->ArgsProduct({{64, 128}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace tetwright
