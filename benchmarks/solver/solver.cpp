// SPDX-License-Identifier: Apache-2.0

// Suitability of meshes for a solver: iterations, time steps, eigenvalues and errors of linear finite
// elements.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <optional>

#include "benchmarks/processes.h"
#include "benchmarks/solver/problems.h"
#include "benchmarks/solver/spectrum.h"
#include "benchmarks/table1/surface_distance.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {
namespace {

/// Reads the mesh of any program and orients its tets.
///
/// \throws InputError if some tet cannot be made positive, since a solver could not use it.
TetMesh read_for_solver(const std::string& path) {
  TetMesh mesh = read_tet_mesh(path).mesh;
  const ImportCleanupReport report = make_coherent(mesh);
  if (mesh.tets.empty()) throw InputError(path, 0, "has no tets");
  if (report.inverted_tets > 0)
    throw InputError(path, 0, "has " + std::to_string(report.inverted_tets) + " flat or negative tets");
  remove_unused_points(mesh);
  return mesh;
}

/// Speed of the fastest waves in the material, with unit density.
double wave_speed(const Elasticity& e) {
  return std::sqrt(e.young * (1 - e.poisson) / ((1 + e.poisson) * (1 - 2 * e.poisson)));
}

TriangleMesh boundary(const TetMesh& mesh) {
  TriangleMesh surface;
  surface.points = mesh.points;
  for (const MeshFace& face : mesh_faces(mesh.tets, mesh.points.size()))
    if (face.second == no_index) surface.triangles.push_back(face.ids);
  return surface;
}

/// Distances between the mesh's boundary and the given surface of the body.
nlohmann::json distances(const TetMesh& mesh, const TriangleMesh& reference) {
  const TriangleMesh surface = boundary(mesh);
  const SurfaceDistance distance = surface_distance(surface, reference);
  const double percent = 100 / diagonal(reference);
  return {{"boundary_triangles", surface.triangles.size()},
          {"to_surface_percent", percent * distance.to_reference.rms},
          {"from_surface_percent", percent * distance.from_reference.rms}};
}

nlohmann::json measure(const TetMesh& mesh) {
  const MeshStatistics statistics = mesh_statistics(mesh);
  const Elasticity material;
  const double edge = mean_regular_edge(mesh);
  const SparseMatrix heat = heat_matrix(mesh), elastic = elastic_matrix(mesh, material);
  const Iterations iterations = count_iterations(mesh, heat, elastic);
  Eigen::VectorXd masses(elastic.rows());
  const Eigen::VectorXd volumes = point_volumes(mesh);
  for (Eigen::Index i = 0; i < masses.size(); ++i) masses[i] = volumes[i / 3];
  const double step = 2 / largest_frequency(elastic, masses);
  const ElementEigenvalues eigenvalues = largest_element_eigenvalues(mesh, material, edge);
  const PoissonErrors errors = poisson_errors(mesh, heat);
  return {{"tets", mesh.tets.size()},
          {"nodes", mesh.points.size()},
          {"volume", statistics.volume},
          {"min_solid_angle", statistics.min_solid_angle},
          {"mean_solid_angle", statistics.mean_solid_angle},
          {"below_percent", statistics.below_percent},
          {"min_dihedral", statistics.min_dihedral},
          {"max_dihedral", statistics.max_dihedral},
          {"heat_iterations", iterations.heat},
          {"elastic_iterations", iterations.elastic},
          {"time_step", step},
          {"relative_time_step", step * wave_speed(material) / edge},
          {"heat_eigenvalue", eigenvalues.heat},
          {"elastic_eigenvalue", eigenvalues.elastic},
          {"l2_error", errors.l2},
          {"energy_error", errors.energy},
          {"interpolation_error", errors.interpolation}};
}

void print_heads() {
  std::printf("%8s %7s %13s %11s %11s %14s %9s %11s %12s  %s\n", "tets", "nodes", "sr min/mean", "dihedrals",
              "CG heat/el.", "time step", "el. heat", "el. elastic", "L2/energy %", "file");
}

void print_row(const nlohmann::json& r) {
  const auto number = [&](const char* name) { return r[name].get<double>(); };
  std::printf("%8zu %7zu  %.4f/%.4f %5.1f-%5.1f %5d/%5d %.2e %5.3f %9.3f %11.3f  %5.3f/%6.3f  %s\n",
              r["tets"].get<std::size_t>(), r["nodes"].get<std::size_t>(), number("min_solid_angle"),
              number("mean_solid_angle"), number("min_dihedral"), number("max_dihedral"),
              r["heat_iterations"].get<int>(), r["elastic_iterations"].get<int>(), number("time_step"),
              number("relative_time_step"), number("heat_eigenvalue"), number("elastic_eigenvalue"),
              100 * number("l2_error"), 100 * number("energy_error"), r["file"].get<std::string>().c_str());
  std::fflush(stdout);
}

int run(const std::vector<std::string>& files, const std::string& surface, const std::string& json) {
  std::optional<TriangleMesh> reference;
  if (!surface.empty()) reference = read_surface(surface);
  nlohmann::json all = nlohmann::json::array();
  bool failed = false;
  print_heads();
  for (const std::string& file : files) {
    nlohmann::json row;
    try {
      const TetMesh mesh = read_for_solver(file);
      row = measure(mesh);
      row["file"] = file;
      if (reference) row.update(distances(mesh, *reference));
      print_row(row);
    } catch (const std::exception& e) {
      failed = true;
      row = {{"file", file}, {"error", e.what()}};
      std::printf("failed: %s\n", e.what());
    }
    all.push_back(row);
  }
  write_json(all, json);
  return failed ? 1 : 0;
}

}  // namespace
}  // namespace tetwright

int main(int argc, char** argv) {
  CLI::App app(
      "What tet meshes are worth to a solver, with linear finite elements: iterations of conjugate "
      "gradients,\n"
      "largest stable explicit time step (absolute, and times the speed of waves over the edge of the "
      "regular\n"
      "tet of the mean volume), largest eigenvalues of element matrices, errors of a Poisson problem.",
      "solver");
  std::vector<std::string> files;
  std::string surface, json;
  app.add_option("meshes", files, "Tet meshes, of any program and format that tetwright reads")->required();
  app.add_option("--surface", surface,
                 "A surface: its rms distance from the boundaries of the meshes is written, too");
  app.add_option("--json", json, "Write all that was measured to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return tetwright::run(files, surface, json);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "solver: %s\n", e.what());
    return 1;
  }
}
