// SPDX-License-Identifier: Apache-2.0

// Benchmarks of every expensive stage on generated inputs, measured by tools/bench --ci and compared by
// --compare. benchmarks/bench.py reads the counters: peak_MB, poor_% (tets below 0.1 sr) and those that end
// in _s, the seconds of a stage.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include "benchmarks/processes.h"
#include "common/geometry/distance_tree.h"
#include "common/geometry/surface_tree.h"
#include "common/random.h"
#include "common/samples/samples.h"
#include "simplify/mesh/editable_mesh.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/remesher.h"
#include "tetwright/resources.h"
#include "tetwright/simplify.h"

namespace tetwright {
namespace {

TriangleMesh surface_of(const char* sample) { return std::get<TriangleMesh>(make_sample(sample)); }

MesherInput input_of(const char* sample) {
  return make_mesher_input({{sample, 1, surface_of(sample), sample}});
}

MesherInput layered_input() {
  MesherInput input = input_of("torus");
  input.layers = {{"skin", 2, 0.12}, {"fat", 3, 0.14}};
  return input;
}

TetMesh dense_mesh(const MesherInput& input, int resolution, bool uniform) {
  MesherOptions options;
  options.resolution = resolution;
  options.uniform = uniform;
  return mesh_surfaces(input, options, nullptr).mesh;
}

/// Input meshes of about 300,000 and 100,000 tets, created once in each process.
const TetMesh& knot_mesh() {
  static const TetMesh mesh = dense_mesh(input_of("knot"), 90, false);
  return mesh;
}

const TetMesh& layered_mesh() {
  static const TetMesh mesh = dense_mesh(layered_input(), 40, false);
  return mesh;
}

void count_peak(benchmark::State& state) {
  state.counters["peak_MB"] = static_cast<double>(peak_bytes_now()) / 1e6;
}

void count_mesh(benchmark::State& state, const TetMesh& mesh) {
  const MeshStatistics m = mesh_statistics(mesh);
  state.counters["tets"] = static_cast<double>(m.tets);
  state.counters["poor_%"] = m.below_percent;
  state.counters["min_sr"] = m.min_solid_angle;
}

/// Times `work(copy of the mesh)`.
template <class Work>
void on_copies(benchmark::State& state, const TetMesh& mesh, const Work& work) {
  reset_peak();
  for (auto _ : state) {
    state.PauseTiming();
    TetMesh copy = mesh;
    state.ResumeTiming();
    work(std::move(copy));
  }
  count_peak(state);
}

/// Times `work()`.
template <class Work>
void repeatedly(benchmark::State& state, const Work& work) {
  reset_peak();
  for (auto _ : state) work();
  count_peak(state);
}

#define TETWRIGHT_CI(function, name) \
  BENCHMARK(function)->Name(name)->Unit(benchmark::kMillisecond)->UseRealTime()

/// Times `mesh()`, which returns a DenseMesh.
template <class Mesh>
void run_mesher(benchmark::State& state, const Mesh& mesh) {
  DenseMesh meshed;
  double sdf = 0, octree = 0, lattice = 0, move = 0, cut = 0;
  repeatedly(state, [&] {
    meshed = mesh();
    sdf += meshed.report.seconds_sdf;
    octree += meshed.report.seconds_octree;
    lattice += meshed.report.seconds_lattice;
    move += meshed.report.seconds_move;
    cut += meshed.report.seconds_cut;
  });
  const auto mean = [](double sum) { return benchmark::Counter(sum, benchmark::Counter::kAvgIterations); };
  state.counters["sdf_s"] = mean(sdf);
  state.counters["octree_s"] = mean(octree);
  state.counters["lattice_s"] = mean(lattice);
  state.counters["move_s"] = mean(move);
  state.counters["cut_s"] = mean(cut);
  count_mesh(state, meshed.mesh);
}

void run_mesher(benchmark::State& state, const MesherInput& input, int resolution, bool uniform) {
  MesherOptions options;
  options.resolution = resolution;
  options.uniform = uniform;
  run_mesher(state, [&] { return mesh_surfaces(input, options, nullptr); });
}

void mesh_adaptive(benchmark::State& state) { run_mesher(state, input_of("knot"), 90, false); }
TETWRIGHT_CI(mesh_adaptive, "mesh/adaptive");

void mesh_uniform(benchmark::State& state) { run_mesher(state, input_of("knot"), 80, true); }
TETWRIGHT_CI(mesh_uniform, "mesh/uniform");

void mesh_layered(benchmark::State& state) { run_mesher(state, layered_input(), 40, false); }
TETWRIGHT_CI(mesh_layered, "mesh/layered");

const LabelVolume& organs() {
  static const LabelVolume volume = std::get<LabelVolume>(make_sample("organs"));
  return volume;
}

void choose_labels(benchmark::State& state) {
  repeatedly(state, [&] {
    benchmark::DoNotOptimize(
        make_label_input(std::make_unique<MemoryLabelSource>(organs()), "organs", {}, nullptr));
  });
}
TETWRIGHT_CI(choose_labels, "prepare_labels");

void mesh_organs(benchmark::State& state) {
  const LabelInput labels =
      make_label_input(std::make_unique<MemoryLabelSource>(organs()), "organs", {}, nullptr);
  MesherOptions options;
  options.voxel_size = default_cell_size(labels);
  run_mesher(state, [&] { return mesh_labels(labels, options, nullptr); });
}
TETWRIGHT_CI(mesh_organs, "mesh/labels");

void prepare_surfaces(benchmark::State& state) {
  const TriangleMesh surface = surface_of("open_sphere");
  repeatedly(state, [&] { benchmark::DoNotOptimize(make_mesher_input({{"s", 1, surface, "s"}})); });
}
TETWRIGHT_CI(prepare_surfaces, "prepare_input");

void tree_build(benchmark::State& state) {
  const TriangleMesh surface = surface_of("sphere");
  repeatedly(state, [&] { benchmark::DoNotOptimize(SurfaceTree(surface.points, surface.triangles)); });
}
TETWRIGHT_CI(tree_build, "surface_tree/build");

std::vector<Vec3> places_near(const TriangleMesh& surface, double reach) {
  Random random(1);
  std::vector<Vec3> places(1 << 14);
  for (Vec3& p : places) {
    p = surface.points[random.below(static_cast<std::uint32_t>(surface.points.size()))];
    for (int a = 0; a < 3; ++a) p[a] += reach * (2 * random.uniform() - 1);
  }
  return places;
}

void tree_winding(benchmark::State& state) {
  const TriangleMesh surface = surface_of("sphere");
  const SurfaceTree tree(surface.points, surface.triangles);
  const std::vector<Vec3> places = places_near(surface, 0.2);
  repeatedly(state, [&] {
    for (const Vec3& p : places) benchmark::DoNotOptimize(tree.winding_number(p));
  });
}
TETWRIGHT_CI(tree_winding, "surface_tree/winding_number");

void tree_distance(benchmark::State& state) {
  const TriangleMesh surface = surface_of("sphere");
  const DistanceTree tree(surface.points, surface.triangles);
  const std::vector<Vec3> places = places_near(surface, 0.05);
  repeatedly(state, [&] {
    for (const Vec3& p : places) benchmark::DoNotOptimize(tree.distance(p, 0.1));
  });
}
TETWRIGHT_CI(tree_distance, "distance_tree/distance");

void check(benchmark::State& state) {
  const TetMesh& mesh = knot_mesh();
  repeatedly(state, [&] { benchmark::DoNotOptimize(check_mesh(mesh)); });
}
TETWRIGHT_CI(check, "check_mesh");

void signature(benchmark::State& state) {
  const TetMesh& mesh = layered_mesh();
  repeatedly(state, [&] { benchmark::DoNotOptimize(topology(mesh)); });
}
TETWRIGHT_CI(signature, "topology");

void interfaces(benchmark::State& state) {
  const TetMesh& mesh = knot_mesh();
  repeatedly(state, [&] { benchmark::DoNotOptimize(find_interfaces(mesh)); });
}
TETWRIGHT_CI(interfaces, "find_interfaces");

void editable_build(benchmark::State& state) {
  on_copies(state, knot_mesh(), [](TetMesh&& mesh) {
    EditableMesh editable(std::move(mesh), "mesh");
    benchmark::DoNotOptimize(editable.live_tets());
  });
}
TETWRIGHT_CI(editable_build, "editable_mesh/build");

void editable_compact(benchmark::State& state) {
  EditableMesh editable(TetMesh(knot_mesh()), "mesh");
  repeatedly(state, [&] { editable.compact(1024, 1024); });
}
TETWRIGHT_CI(editable_compact, "editable_mesh/compact");

void run_simplify(benchmark::State& state, const TetMesh& mesh, Schedule schedule, unsigned threads,
                  double reduction) {
  const ThreadLimit limit(threads);
  SimplifyOptions options;
  options.target_tets = static_cast<std::size_t>(static_cast<double>(mesh.tets.size()) / reduction);
  options.schedule = schedule;
  TetMesh result;
  SimplifyReport report;
  double loop = 0, close = 0;
  on_copies(state, mesh, [&](TetMesh&& copy) {
    report = {};
    result = simplify(std::move(copy), options, &report);
    loop += report.seconds_simplify;
    close += report.seconds_close;
  });
  state.counters["loop_s"] = benchmark::Counter(loop, benchmark::Counter::kAvgIterations);
  state.counters["close_s"] = benchmark::Counter(close, benchmark::Counter::kAvgIterations);
  count_mesh(state, result);
}

void simplify_tuned(benchmark::State& state) { run_simplify(state, knot_mesh(), Schedule::tuned, 1, 30); }
TETWRIGHT_CI(simplify_tuned, "simplify/tuned");

void simplify_threads(benchmark::State& state) { run_simplify(state, knot_mesh(), Schedule::tuned, 2, 30); }
TETWRIGHT_CI(simplify_threads, "simplify/tuned_two_threads");

void simplify_paper(benchmark::State& state) { run_simplify(state, knot_mesh(), Schedule::paper, 1, 30); }
TETWRIGHT_CI(simplify_paper, "simplify/paper");

void simplify_layers(benchmark::State& state) { run_simplify(state, layered_mesh(), Schedule::tuned, 1, 20); }
TETWRIGHT_CI(simplify_layers, "simplify/layered");

void improve_again(benchmark::State& state) {
  static const TetMesh bad = [] {
    const ThreadLimit one(1);
    SimplifyOptions options;
    options.target_tets = knot_mesh().tets.size() / 15;
    options.schedule = Schedule::paper;  // this schedule leaves bad tets
    return simplify(knot_mesh(), options);
  }();
  const ThreadLimit one(1);
  TetMesh result;
  on_copies(state, bad, [&](TetMesh&& copy) { result = improve(std::move(copy), {}); });
  count_mesh(state, result);
}
TETWRIGHT_CI(improve_again, "improve");

/// Times Remesher calls on boxes around points of the mesh.
void remesh(benchmark::State& state) {
  constexpr int calls = 60;
  const TetMesh& mesh = knot_mesh();
  const Vec3 edge = mesh.points[mesh.tets[0][1]] - mesh.points[mesh.tets[0][0]];
  const double size = edge.norm();
  const ThreadLimit one(1);
  TetMesh result;
  reset_peak();
  for (auto _ : state) {
    state.PauseTiming();
    Remesher remesher{TetMesh(mesh)};
    remesher.add_tet_field(1, std::vector<double>(remesher.tet_slots(), 1));
    Random random(1);
    state.ResumeTiming();
    for (int call = 0; call < calls; ++call) {
      const Vec3 centre = mesh.points[random.below(static_cast<std::uint32_t>(mesh.points.size()))];
      const Vec3 half = Vec3::Constant(2.5 * size);
      const RemeshRegion box = RemeshRegion::box(centre - half, centre + half);
      if (call % 2 == 0) {
        remesher.coarsen(box, 2 * size);
      } else {
        remesher.refine(box, size);
      }
    }
    state.PauseTiming();
    result = remesher.mesh();
    state.ResumeTiming();
  }
  count_peak(state);
  count_mesh(state, result);
}
TETWRIGHT_CI(remesh, "remesh");

void write_mesh(benchmark::State& state, const char* extension) {
  const ScratchFolder folder;
  const std::string path = folder / (std::string("mesh") + extension);
  const TetMesh& mesh = knot_mesh();
  repeatedly(state, [&] { write_tet_mesh(mesh, path); });
  state.counters["file_MB"] = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
}

void read_mesh(benchmark::State& state, const char* extension) {
  const ScratchFolder folder;
  const std::string path = folder / (std::string("mesh") + extension);
  write_tet_mesh(knot_mesh(), path);
  repeatedly(state, [&] { benchmark::DoNotOptimize(read_tet_mesh(path)); });
}

void read_scan(benchmark::State& state, const char* extension) {
  const ScratchFolder folder;
  const std::string path = folder / (std::string("surface") + extension);
  write_surface(surface_of("sphere"), path);
  repeatedly(state, [&] { benchmark::DoNotOptimize(read_surface(path)); });
}

#define TETWRIGHT_CI_FILE(function, name, extension) \
  BENCHMARK_CAPTURE(function, extension, extension)  \
      ->Name(name extension)                         \
      ->Unit(benchmark::kMillisecond)                \
      ->UseRealTime()

TETWRIGHT_CI_FILE(write_mesh, "write", ".vtu");
TETWRIGHT_CI_FILE(write_mesh, "write", ".msh");
TETWRIGHT_CI_FILE(write_mesh, "write", ".mesh");
TETWRIGHT_CI_FILE(read_mesh, "read", ".vtu");
TETWRIGHT_CI_FILE(read_mesh, "read", ".msh");
TETWRIGHT_CI_FILE(read_mesh, "read", ".mesh");
TETWRIGHT_CI_FILE(read_scan, "read", ".ply");
TETWRIGHT_CI_FILE(read_scan, "read", ".stl");

}  // namespace
}  // namespace tetwright
