// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/table1/rows.h"

#include <cmath>

#include "benchmarks/processes.h"
#include "benchmarks/table1/surface_distance.h"
#include "common/io/formats.h"
#include "common/mesh/interfaces.h"
#include "common/mesh/mesh_check.h"
#include "common/mesh/mesh_statistics.h"
#include "common/mesh/topology.h"
#include "common/parallel/parallel.h"
#include "mesher/mesher.h"

namespace tetwright {

namespace {

constexpr double count_tolerance = 0.03;
constexpr int max_steps = 8;

TriangleMesh boundary(const TetMesh& mesh) {
  TriangleMesh surface;
  surface.points = mesh.points;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (!t.other) surface.triangles.push_back(t.ids);
  return surface;
}

nlohmann::json distance_json(const OneWayDistance& d, double diagonal) {
  return {{"rms_percent", 100 * d.rms / diagonal}, {"max_percent", 100 * d.max / diagonal}};
}

nlohmann::json operations_json(const SimplifyReport& report) {
  OperationCounts counts;
  std::uint64_t tried = 0, done = 0, conflicts = 0;
  for (const IterationReport& it : report.iterations) {
    counts.add(it.counts);
    conflicts += it.conflicts;
  }
  nlohmann::json each = nlohmann::json::object();
  for (std::size_t o = 0; o < operation_count; ++o) {
    const auto operation = static_cast<Operation>(o);
    tried += counts.tried(operation);
    done += counts.of(operation, Outcome::done);
    each[std::string(operation_names[o])] = {{"tried", counts.tried(operation)},
                                             {"done", counts.of(operation, Outcome::done)}};
  }
  return {{"tried", tried}, {"done", done}, {"lock_conflicts", conflicts}, {"each", each}};
}

}  // namespace

nlohmann::json make_dense(const std::string& scan, std::size_t tets, const std::string& path) {
  const MesherInput input = make_mesher_input({{"body", 1, read_surface(scan), scan}});
  const double wanted = static_cast<double>(tets);
  MesherOptions options;
  options.uniform = true;
  options.voxel_size = (input.high - input.low).maxCoeff() / 64;
  // The number of tets grows with the cube of the resolution.
  options.voxel_size *= std::cbrt(static_cast<double>(estimate_mesh(input, options).tets) / wanted);
  double last_size = 0, last_count = 0;
  for (int step = 1; step <= max_steps; ++step) {
    const Stopwatch watch;
    DenseMesh dense = mesh_surfaces(input, options, nullptr);
    const double seconds = watch.seconds(), count = static_cast<double>(dense.mesh.tets.size());
    if (std::abs(count - wanted) <= count_tolerance * wanted) {
      write_tet_mesh(dense.mesh, path);
      return {{"voxel_size", options.voxel_size},
              {"tets", dense.mesh.tets.size()},
              {"steps", step},
              {"seconds_mesh", seconds}};
    }
    double slope = -3;
    if (last_count > 0 && last_size != options.voxel_size)
      slope = std::clamp(std::log(count / last_count) / std::log(options.voxel_size / last_size), -4.0, -2.0);
    last_size = options.voxel_size;
    last_count = count;
    options.voxel_size *= std::pow(wanted / count, 1 / slope);
  }
  throw InputError(scan, 0,
                   "no voxel size gave " + std::to_string(tets) + " tets within 3 %; the last gave " +
                       std::to_string(static_cast<std::size_t>(last_count)));
}

nlohmann::json run_row(const std::string& dense, const std::string& scan, const RowOptions& options) {
  const ThreadLimit limit(options.threads);
  TetMesh mesh = read_tet_mesh(dense).mesh;
  const TriangleMesh reference = read_surface(scan);
  nlohmann::json row = {{"threads", thread_count()}, {"tets_before", mesh.tets.size()}};
  Topology topology_before;
  double volume_before = 0;
  if (options.measure_more) {
    const MeshStatistics before = mesh_statistics(mesh);
    volume_before = before.volume;
    row["below_before_percent"] = before.below_percent;
    topology_before = topology(mesh);
  }
  reset_peak();
  row["memory_before"] = peak_bytes_now();
  SimplifyReport report;
  const Stopwatch watch;
  SimplifyOptions simplification = options.simplify;
  simplification.surface = &reference;
  mesh = simplify(std::move(mesh), simplification, &report);
  row["seconds"] = watch.seconds();
  row["peak_bytes"] = peak_bytes_now();
  row["seconds_build"] = report.seconds_build;
  row["seconds_loop"] = report.seconds_simplify;
  row["seconds_close"] = report.seconds_close;
  int iterations = 0;
  for (const IterationReport& it : report.iterations) iterations += it.kind == "simplify";
  row["iterations"] = iterations;
  row["closing_rounds"] = report.iterations.size() - static_cast<std::size_t>(iterations);
  row["operations"] = operations_json(report);

  const MeshStatistics after = mesh_statistics(mesh);
  row["tets_after"] = after.tets;
  row["below_after_percent"] = after.below_percent;
  row["min_solid_angle"] = after.min_solid_angle;
  row["min_dihedral"] = after.min_dihedral;
  row["max_dihedral"] = after.max_dihedral;
  if (!options.write_to.empty()) write_tet_mesh(mesh, options.write_to);
  if (!options.measure_more) return row;
  row["volume_ratio"] = after.volume / volume_before;
  row["findings"] = nlohmann::json::array();
  for (const MeshFinding& f : check_mesh(mesh)) row["findings"].push_back(mesh_finding_line(f));
  row["topology_differences"] = topology_differences(topology_before, topology(mesh));
  const TriangleMesh surface = boundary(mesh);
  const SurfaceDistance d = surface_distance(surface, reference);
  const double size = diagonal(reference);
  row["boundary_triangles"] = surface.triangles.size();
  row["to_scan"] = distance_json(d.to_reference, size);
  row["from_scan"] = distance_json(d.from_reference, size);
  return row;
}

}  // namespace tetwright
