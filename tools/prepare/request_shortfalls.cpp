// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/request_shortfalls.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/message_text.h"
#include "tools/prepare/limiting_rules.h"
#include "tools/prepare/small_target.h"

namespace tetwright {

namespace {

// Maximum relative deviation of the number of tets from its target.
constexpr double target_slack = 0.01;
constexpr double improve_slack = 0.05;

/// Relative change of a material's volume above which it is reported.
constexpr double volume_note_share = 0.02;

/// Percentage of tets below the bound above which they are reported.
constexpr double bad_note_percent = 0.1;

/// Minimum fraction of the edges that must be within edge_length_factor of a size field.
constexpr double min_edges_within = 0.95;

std::string number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.10g", value);
  return buffer;
}

/// Reports materials whose volume was changed by simplification.
void report_volumes(const TetMesh& mesh, const std::string& file, PrepareReport& report) {
  for (const auto& [tag, before] : report.dense->materials) {
    const auto after = report.result->materials.find(tag);
    const double volume = after == report.result->materials.end() ? 0 : after->second.volume;
    if (!(std::fabs(volume - before.volume) > volume_note_share * std::fabs(before.volume))) continue;
    const auto name = mesh.material_names.find(tag);
    report.diagnostics.push_back(
        {.code = DiagnosticCode::volume_changed,
         .file = file,
         .what = "material '" + (name != mesh.material_names.end() ? name->second : std::to_string(tag)) +
                 "' whose volume changed by " +
                 std::to_string(static_cast<int>(std::lround(100 * (volume / before.volume - 1)))) + " %",
         .count = 1,
         .done = "the schedule does not bound it",
         .asked = before.volume,
         .reached = volume});
  }
}

void report_touching_points(const std::string& file, PrepareReport& report) {
  if (report.simplify->touching_points > 0)
    report.diagnostics.push_back({.code = DiagnosticCode::parts_touch,
                                  .file = file,
                                  .what = "points where parts touch without a common face",
                                  .count = report.simplify->touching_points,
                                  .done = "kept unchanged with all their tets"});
}

std::string rules_behind_count(const PrepareRun& run, double asked, double reached) {
  const PrepareOptions& options = run.options;
  const PrepareReport& report = run.report;
  if (reached > asked && report.simplify->out_of_time) return "--time-limit";
  if (run.task == Task::improve)
    return "nothing: good shapes require " + std::string(reached < asked ? "fewer" : "more") + " tets";
  if (reached > asked && report.mesher && static_cast<double>(report.mesher->filling_tets) > asked)
    return "walls so thin that fewer tets would be flat; request " +
           std::to_string(report.mesher->filling_tets) + " or more, or leave them out with --min-thickness";
  if (report.sizes.target_length) return "the sizes of --size-field, which decide the number of tets";
  if (reached > asked && std::isfinite(report.sizes.limits.max_edge))
    return "the lengths that --max-edge allows";
  if (reached < asked && report.sizes.limits.min_edge > 0) return "the lengths that --min-edge allows";
  if (reached > asked && report.tolerance > 0)
    return std::to_string(report.result->tets) + " tets: the tolerance prevents fewer";
  if (reached > asked) return rules_limiting_count(*report.simplify, options.shapes.max_iterations);
  return static_cast<double>(report.dense->tets) < asked
             ? "the dense mesh, which has too few tets; raise --resolution"
             : "nothing: the final improvement removed tets";
}

void find_count_and_shapes(PrepareRun& run) {
  const PrepareOptions& options = run.options;
  PrepareReport& report = run.report;
  const auto add = [&](DiagnosticCode code, const std::string& option, double asked, double reached,
                       const std::string& limited_by) {
    report.diagnostics.push_back({.code = code,
                                  .what = "short of " + option + ": " + number(asked) + " requested, " +
                                          number(reached) + " reached; limited by: " + limited_by,
                                  .asked = asked,
                                  .reached = reached,
                                  .limited_by = limited_by});
  };
  const bool improved = run.task == Task::improve;
  const double asked = static_cast<double>(improved ? report.dense->tets : options.target.tets.value_or(0));
  const double reached = static_cast<double>(report.result->tets);
  const bool missed = std::fabs(reached - asked) > (improved ? improve_slack : target_slack) * asked;
  if (!improved) settle_small_target(run, target_slack, bad_note_percent);
  if ((improved || options.target.tets.value_or(0) > 0) && !options.shapes.free_count && missed)
    add(DiagnosticCode::target_missed, improved ? "about the same count" : "--target-tets", asked, reached,
        rules_behind_count(run, asked, reached));
  if (options.shapes.min_solid_angle && report.result->min_solid_angle < options.shapes.bound())
    add(DiagnosticCode::angle_missed, "--min-solid-angle", options.shapes.bound(),
        report.result->min_solid_angle, rules_limiting_shapes(*report.simplify));
}

/// Reports work that was ended early by --time-limit or the memory limit.
void find_limits(PrepareRun& run) {
  const PrepareOptions& options = run.options;
  PrepareReport& report = run.report;
  if ((report.simplify && report.simplify->out_of_time) || (report.mesher && report.mesher->out_of_time)) {
    const bool counted = run.task != Task::improve && report.simplify &&
                         report.result->tets > std::max<std::size_t>(1, options.target.tets.value_or(0));
    const char* undone = !report.simplify ? "smaller cells where the tolerance requires them"
                         : counted        ? "the rest of simplifying and of improving shapes"
                                          : "the rest of improving shapes";
    const double limit = options.limits.seconds.value_or(0);
    report.diagnostics.push_back(
        {.code = DiagnosticCode::time_limit_reached,
         .what = "out of time: --time-limit " + number(limit) + " s ended it; left undone: " + undone,
         .remedy = "give more time",
         .asked = limit,
         .reached = report.seconds_total,
         .limited_by = "--time-limit"});
  }
  if (report.coarser)
    report.diagnostics.push_back({.code = DiagnosticCode::cells_enlarged,
                                  .what = "short of memory: cells of " + number(report.coarser->asked) +
                                          " would take about " +
                                          short_number(report.coarser->bytes / gigabyte) +
                                          " GB, so cells of " + number(report.coarser->used) + " were used",
                                  .remedy = "free some, give a larger --memory-limit, or set --resolution",
                                  .asked = report.coarser->asked,
                                  .reached = report.coarser->used,
                                  .limited_by = "memory"});
}

/// Reports a tolerance that is not proven to be met.
void find_deviation(PrepareRun& run) {
  PrepareReport& report = run.report;
  if (!report.deviation) return;
  const DeviationReport& d = *report.deviation;
  if (report.lost_area() > 0)
    report.diagnostics.push_back({.code = DiagnosticCode::surface_not_shown,
                                  .what = "short of --tolerance: the mesh lacks an area of " +
                                          short_number(report.lost_area()) + " of the outer surface",
                                  .remedy = "raise --resolution or --max-refinement",
                                  .asked = 0,
                                  .reached = report.lost_area(),
                                  .limited_by = "the size of the cells"});
  if (d.upper() <= report.tolerance) return;
  const bool mesh = d.from_mesh.upper >= d.from_surface.upper;
  const SurfaceDeviation& worst = mesh ? d.from_mesh : d.from_surface;
  const bool stopped =
      (report.simplify && report.simplify->out_of_time) || (report.mesher && report.mesher->out_of_time);
  // The result for a volume is compared with the dense mesh's own surface.
  const char* limit = worst.lower <= report.tolerance && stopped
                          ? "--time-limit, which ended the measurement: the tolerance may be met"
                      : report.mesher && !report.volume
                          ? "the dense mesh is that far there; give a larger --resolution, or a larger "
                            "tolerance"
                          : "the shapes of tets there; give a larger tolerance";
  report.diagnostics.push_back({.code = DiagnosticCode::tolerance_missed,
                                .what = "short of --tolerance: " + number(report.tolerance) + " requested, " +
                                        number(worst.upper) + " reached from the " +
                                        (mesh ? "mesh to the surface" : "surface to the mesh") + ", at " +
                                        place_text(worst.place) + "; limited by: " + limit,
                                .asked = report.tolerance,
                                .reached = worst.upper,
                                .limited_by = limit,
                                .places = {worst.place}});
}

/// Reports edges without the requested lengths.
void find_edge_lengths(const TetMesh& mesh, PrepareRun& run) {
  PrepareReport& report = run.report;
  const RequestedSizes& sizes = report.sizes;
  if (!report.simplify || !sizes.any()) return;
  report.edge_lengths = compare_edge_lengths(mesh, sizes.target_length.get(), sizes.source.get(),
                                             sizes.limits.min_edge, sizes.limits.max_edge);
  const EdgeLengthReport& e = *report.edge_lengths;
  const auto offend = [&](DiagnosticCode code, const char* option, double asked,
                          const EdgeLengthReport::Offender& worst, const char* way, const char* limit) {
    if (worst.count == 0) return;
    report.diagnostics.push_back(
        {.code = code,
         .what = std::string("short of ") + option + ": " + std::to_string(worst.count) + " of " +
                 std::to_string(e.edges) + " edges are " + way + ", at worst " + number(worst.length) +
                 " instead of " + number(asked) + " at " + place_text(worst.place) + "; limited by: " + limit,
         .asked = asked,
         .reached = worst.length,
         .limited_by = limit,
         .places = {worst.place}});
  };
  const char* held = report.simplify->out_of_time ? "--time-limit" : "surfaces, creases and shapes there";
  offend(DiagnosticCode::edges_too_long, "--max-edge", sizes.limits.max_edge, e.above_max, "longer", held);
  offend(DiagnosticCode::edges_too_short, "--min-edge", sizes.limits.min_edge, e.below_min, "shorter", held);
  if (e.within_share() >= min_edges_within) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "short of --size-field: %.3g %% of the edges are within %.3g times the target length, not "
                "%.3g %%; limited by: ",
                100 * e.within_share(), edge_length_factor, 100 * min_edges_within);
  report.diagnostics.push_back({.code = DiagnosticCode::sizes_missed,
                                .what = text + std::string(held),
                                .asked = min_edges_within,
                                .reached = e.within_share(),
                                .limited_by = held});
}

/// Adds a note about tets below the default bound, which is not a shortfall.
void report_bad_shapes(PrepareRun& run) {
  const PrepareOptions& options = run.options;
  PrepareReport& report = run.report;
  const MeshStatistics& result = *report.result;
  // --only-below has its own report.
  if (options.shapes.min_solid_angle || options.shapes.only_below.value_or(0) > 0 ||
      result.below_percent <= bad_note_percent)
    return;
  char what[100];
  std::snprintf(what, sizeof what, "tets below %.6g sr, %.3g %% of all, the smallest at %.3g sr",
                options.shapes.bound(), result.below_percent, result.min_solid_angle);
  const std::string narrow = report.input_limited == 0
                                 ? ""
                                 : std::to_string(report.input_limited) +
                                       " of them in angles of the input too narrow for better ones; ";
  const std::string held = rules_limiting_shapes(*report.simplify);
  report.diagnostics.push_back({.code = DiagnosticCode::angles_below_bound,
                                .file = report.inputs.front(),
                                .what = what,
                                .count = result.below_count,
                                .done = narrow + "limited by: " + held,
                                .asked = options.shapes.bound(),
                                .reached = result.min_solid_angle,
                                .limited_by = held});
}

}  // namespace

void find_request_shortfalls(const TetMesh& mesh, PrepareRun& run) {
  if (run.report.simplify) {
    report_touching_points(run.report.inputs.front(), run.report);
    report_volumes(mesh, run.report.inputs.front(), run.report);
    find_count_and_shapes(run);
    find_edge_lengths(mesh, run);
    report_bad_shapes(run);
  }
  find_limits(run);
  find_deviation(run);
}

}  // namespace tetwright
