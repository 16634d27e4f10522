#include "simplify/simplify.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "simplify/engine.h"

namespace tetwright {

namespace {

/// Rounds that close simplify().
constexpr int most_closing_rounds = 40;
/// Tets whose quality is below this many times the bound are worked on, for a margin.
constexpr double improve_margin = 1.27;
/// Share of the tets that improve() may add or take away; 5 % are promised.
constexpr double improve_slack = 0.045;
/// E of improve(), in edges of a regular mesh of that count: the paper's first E.
constexpr double improve_error_edges = 1;

void check(const TetMesh& mesh, std::size_t chunk_size, const std::string& name) {
  if (chunk_size == 0) throw UsageError("a chunk must hold at least one item");
  if (mesh.tets.empty()) throw InputError(name, 0, "no tets in it");
}

float working_limit(ShapeObjective objective, double solid_angle) {
  return static_cast<float>(std::min(0.99, shape_quality_bound(objective, solid_angle)));
}

}  // namespace

TetMesh simplify(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report, Progress* progress) {
  if (options.target_tets == 0) throw UsageError("a target of 0 tets leaves nothing; give 1 or more");
  if (!(options.beta > 0) || !(options.gamma >= 0))
    throw UsageError("beta must be above 0 and gamma at least 0");
  check(mesh, options.chunk_size, options.name);
  const auto start = std::chrono::steady_clock::now();
  const std::size_t first_count = mesh.tets.size();
  Engine engine(std::move(mesh),
                {options.name, static_cast<double>(options.target_tets), options.beta, options.gamma,
                 options.seed, options.chunk_size, options.objective, options.reference},
                report, progress);
  engine.begin_stage("simplify");
  engine.squeeze();
  const double build = seconds_since(start);
  if (options.schedule == Schedule::paper) {
    run_paper_schedule(engine, options);
  } else {
    run_tuned_schedule(engine, options);
  }
  const double loop_end = seconds_since(start);
  if (options.schedule == Schedule::tuned) {
    engine.begin_stage("improve");
    const auto count = static_cast<double>(std::min(options.target_tets, first_count));
    run_improvement(
        engine,
        {"close", working_limit(options.objective, improve_margin * options.min_solid_angle),
         static_cast<std::size_t>(count), static_cast<std::size_t>(std::ceil(count * (1 - closing_slack))),
         static_cast<std::size_t>(count * (1 + closing_slack)), most_closing_rounds, 2});
  }
  if (report) {
    report->seconds_build = build;
    report->seconds_simplify = loop_end - build;
    report->seconds_close = seconds_since(start) - loop_end;
  }
  return std::move(engine).take();
}

TetMesh improve(TetMesh mesh, const ImproveOptions& options, SimplifyReport* report, Progress* progress) {
  check(mesh, options.chunk_size, options.name);
  const auto start = std::chrono::steady_clock::now();
  const auto count = static_cast<double>(mesh.tets.size());
  const SimplifyOptions defaults;
  Engine engine(std::move(mesh),
                {options.name, count, defaults.beta, defaults.gamma, options.seed, options.chunk_size,
                 options.objective, options.reference},
                report, progress);
  engine.begin_stage("improve");
  engine.squeeze();
  const double build = seconds_since(start);
  engine.rules.largest_error = improve_error_edges * engine.rules.objective.quality.ideal_edge;
  run_improvement(
      engine,
      {"improve", working_limit(options.objective, options.only_below > 0 ? options.only_below : 0.2),
       static_cast<std::size_t>(count), static_cast<std::size_t>(std::ceil(count * (1 - improve_slack))),
       static_cast<std::size_t>(count * (1 + improve_slack)), options.max_iterations, 0});
  if (report) {
    report->seconds_build = build;
    report->seconds_close = seconds_since(start) - build;
  }
  return std::move(engine).take();
}

}  // namespace tetwright
