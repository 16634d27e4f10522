// SPDX-License-Identifier: Apache-2.0

// Section 7 of Cutler, Dorsey & McMillan 2004: block iteration compared with a progressive mesh, on the same
// code.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "benchmarks/inputs.h"
#include "benchmarks/processes.h"
#include "benchmarks/strategy/orderings.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright {
namespace {

struct Ordering {
  const char* name;
  std::function<void(Workpiece&, std::uint64_t)> run;
};

const std::vector<Ordering>& orderings() {
  static const std::vector<Ordering> all{
      {"progressive mesh, legality when weighed", [](Workpiece& w, auto) { progressive_mesh(w, true); }},
      {"progressive mesh, legality when taken", [](Workpiece& w, auto) { progressive_mesh(w, false); }},
      {"blocks of tets (the paper's)", [](Workpiece& w, std::uint64_t seed) { block_of_tets(w, seed); }},
      {"blocks of points (tuned)", [](Workpiece& w, std::uint64_t seed) { block_of_points(w, seed); }},
  };
  return all;
}

nlohmann::json measure(const TetMesh& mesh, std::size_t target, const Ordering& ordering,
                       std::uint64_t seed) {
  Workpiece piece(mesh, target);
  const Stopwatch watch;
  ordering.run(piece, seed);
  const double seconds = watch.seconds();
  const StrategyCounts c = piece.counts;
  const MeshStatistics after = mesh_statistics(std::move(piece).result());
  return {{"ordering", ordering.name}, {"weights", c.weights},     {"tests", c.tests},
          {"stars", c.stars},          {"collapses", c.collapses}, {"seconds", seconds},
          {"tets_after", after.tets},  {"volume", after.volume},   {"below_percent", after.below_percent}};
}

int run(int resolution, double reduction, std::uint64_t seed, const std::string& json) {
  const ThreadLimit one(1);
  MesherOptions options;
  options.resolution = resolution;
  options.uniform = true;
  const TetMesh mesh = mesh_surfaces(benchmark_input(), options, nullptr).mesh;
  const auto target = static_cast<std::size_t>(static_cast<double>(mesh.tets.size()) / reduction);
  const double volume = mesh_statistics(mesh).volume;
  std::printf(
      "%zu tets -> %zu, one thread, collapses only. Weighed: weights of half-edges computed; share: of "
      "the first line's.\n\n%-42s %11s %7s %11s %11s %9s %8s %7s %7s %9s %8s\n",
      mesh.tets.size(), target, "", "weighed", "share", "weighed/", "legality", "collapses", "s", "share",
      "tets", "% <0.1 sr", "volume");
  std::printf("%-42s %11s %7s %11s %11s\n", "", "", "", "collapse", "tests");
  nlohmann::json all = {
      {"tets", mesh.tets.size()}, {"target", target}, {"orderings", nlohmann::json::array()}};
  for (const Ordering& o : orderings()) {
    nlohmann::json r = measure(mesh, target, o, seed);
    const nlohmann::json& first = all["orderings"].empty() ? r : all["orderings"][0];
    const double weights = r["weights"], seconds = r["seconds"], collapses = r["collapses"];
    const double share = 100 * weights / first["weights"].get<double>();
    const double time_share = 100 * seconds / first["seconds"].get<double>();
    std::printf("%-42s %11.0f %6.1f%% %11.1f %11zu %9.0f %8.2f %6.1f%% %7zu %9.2f %8.4f\n", o.name, weights,
                share, weights / std::max(1.0, collapses), r["tests"].get<std::size_t>(), collapses, seconds,
                time_share, r["tets_after"].get<std::size_t>(), r["below_percent"].get<double>(),
                r["volume"].get<double>() / volume);
    std::fflush(stdout);
    r["weights_share_percent"] = share;
    r["seconds_share_percent"] = time_share;
    all["orderings"].push_back(r);
  }
  std::printf(
      "\nThe paper: 5-15 %% as many edge collapses as a progressive mesh, over 100 weights for each "
      "collapse there.\n");
  write_json(all, json);
  return 0;
}

}  // namespace
}  // namespace tetwright

int main(int argc, char** argv) {
  int resolution = 64;
  double reduction = 40;
  std::uint64_t seed = 1;
  std::string json;
  CLI::App app("Collapses evaluated, and time, of a progressive mesh and of block iteration.", "strategy");
  app.add_option("--resolution", resolution, "Cells of the uniform dense mesh along the longest side")
      ->check(CLI::Range(8, 512))
      ->capture_default_str();
  app.add_option("--reduction", reduction, "Dense tets for each tet wanted")
      ->check(CLI::Range(1.1, 10000.0))
      ->capture_default_str();
  app.add_option("--seed", seed)->capture_default_str();
  app.add_option("--json", json, "Write all that was measured to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return tetwright::run(resolution, reduction, seed, json);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "strategy: %s\n", e.what());
    return 1;
  }
}
