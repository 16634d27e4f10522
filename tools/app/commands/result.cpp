// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/result.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/files/atomic_file.h"
#include "common/io/formats.h"
#include "common/message_text.h"
#include "tools/app/commands/report_file.h"
#include "tools/app/commands/unwritten.h"
#include "tools/app/printed_report.h"
#include "tools/compare/input_limited.h"
#include "tools/prepare/limiting_rules.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

// How far the count may be from what was asked, as a share of it.
constexpr double target_slack = 0.01;
constexpr double improve_slack = 0.05;

/// Relative change of a material's volume above which it is reported.
constexpr double volume_note_share = 0.02;

/// Share of tets below the bound, in percent, above which it is reported.
constexpr double bad_note_percent = 0.1;

/// Share of the edges that a size field must have within edge_length_factor.
constexpr double min_edges_within = 0.95;

/// Lost labels that are named one by one.
constexpr std::size_t max_lost_named = 5;

std::string number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.10g", value);
  return buffer;
}

/// Reports materials whose volume the simplification has changed.
void report_volumes(const TetMesh& mesh, const std::string& file, RunReport& report) {
  for (const auto& [tag, before] : report.dense->materials) {
    const auto after = report.result->materials.find(tag);
    const double volume = after == report.result->materials.end() ? 0 : after->second.volume;
    if (!(std::fabs(volume - before.volume) > volume_note_share * std::fabs(before.volume))) continue;
    const auto name = mesh.material_names.find(tag);
    report.findings.push_back(
        {file,
         {"material '" + (name != mesh.material_names.end() ? name->second : std::to_string(tag)) +
              "' whose volume changed by " +
              std::to_string(static_cast<int>(std::lround(100 * (volume / before.volume - 1)))) + " %",
          1,
          {},
          "the schedule does not bound it"}});
  }
}

void report_touching_points(const std::string& file, RunReport& report) {
  if (report.simplify->touching_points > 0)
    report.findings.push_back({file,
                               {"points where parts touch without a common face",
                                report.simplify->touching_points,
                                {},
                                "kept as they are with all their tets"}});
}

std::string rules_behind_count(const CommandLine& line, const RunReport& report, double asked,
                               double reached) {
  if (reached > asked && report.simplify->out_of_time) return "--time-limit";
  if (line.command == Command::improve)
    return "nothing: shapes were worth " + std::string(reached < asked ? "fewer" : "more") + " tets";
  if (reached > asked && report.mesher && static_cast<double>(report.mesher->filling_tets) > asked)
    return "walls so thin that fewer tets would be flat; ask for " +
           std::to_string(report.mesher->filling_tets) + " or more, or leave them out with --min-thickness";
  if (report.sizes.target_length) return "the sizes of --size-field, which decide the number of tets";
  if (reached > asked && std::isfinite(report.sizes.limits.max_edge))
    return "the lengths that --max-edge allows";
  if (reached < asked && report.sizes.limits.min_edge > 0) return "the lengths that --min-edge allows";
  if (reached > asked && report.tolerance > 0)
    return std::to_string(report.result->tets) + " tets: the tolerance holds the rest back";
  if (reached > asked) return rules_limiting_count(*report.simplify, line.max_iterations);
  return static_cast<double>(report.dense->tets) < asked
             ? "the dense mesh, which has too few tets; raise --resolution"
             : "nothing: the closing improvement took tets away";
}

void find_count_and_shape_shortfall(const CommandLine& line, RunReport& report) {
  const auto add = [&](const std::string& what, const std::string& option, double asked, double reached,
                       const std::string& limited_by) {
    report.shortfall.push_back({what, asked, reached, limited_by,
                                "short of " + option + ": " + number(asked) + " was asked, " +
                                    number(reached) + " reached; held back by: " + limited_by});
  };
  const bool improved = line.command == Command::improve;
  const double asked = static_cast<double>(improved ? report.dense->tets : line.target_tets);
  const double reached = static_cast<double>(report.result->tets);
  if ((improved || line.target_tets > 0) && !line.free_count &&
      std::fabs(reached - asked) > (improved ? improve_slack : target_slack) * asked)
    add("target_tets", improved ? "about the same count" : "--target-tets", asked, reached,
        rules_behind_count(line, report, asked, reached));
  if (line.min_solid_angle_given && report.result->min_solid_angle < line.min_solid_angle)
    add("min_solid_angle", "--min-solid-angle", line.min_solid_angle, report.result->min_solid_angle,
        rules_limiting_shapes(*report.simplify));
}

/// Work that --time-limit or memory has cut short.
void find_limits(const CommandLine& line, RunReport& report) {
  if ((report.simplify && report.simplify->out_of_time) || (report.mesher && report.mesher->out_of_time)) {
    const bool counted = line.command != Command::improve && report.simplify &&
                         report.result->tets > std::max<std::size_t>(1, line.target_tets);
    const char* undone = !report.simplify ? "smaller cells where the tolerance asks for them"
                         : counted        ? "the rest of simplifying and of improving shapes"
                                          : "the rest of improving shapes";
    report.shortfall.push_back({"time_limit", line.time_limit, report.seconds_total, "--time-limit",
                                "out of time: --time-limit " + number(line.time_limit) +
                                    " s ended it; left undone: " + undone + "; give more time"});
  }
  if (report.coarser)
    report.shortfall.push_back({"memory_limit", report.coarser->asked, report.coarser->used, "memory",
                                "short of memory: cells of " + number(report.coarser->asked) +
                                    " would take about " + short_number(report.coarser->bytes / (1 << 30)) +
                                    " GB, and cells of " + number(report.coarser->used) +
                                    " were taken; free some, give a larger --memory-limit, or say "
                                    "--resolution"});
}

/// A tolerance that is not proven to be held.
void find_deviation(RunReport& report) {
  if (!report.deviation) return;
  const DeviationReport& d = *report.deviation;
  if (report.lost_area() > 0)
    report.shortfall.push_back(
        {"surface_shown", 0, report.lost_area(), "the size of the cells",
         "short of --tolerance: the mesh shows nothing of an area of " + short_number(report.lost_area()) +
             " of the surface, all of which is its outside; raise --resolution or --max-refinement"});
  if (d.upper() <= report.tolerance) return;
  const bool mesh = d.from_mesh.upper >= d.from_surface.upper;
  const SurfaceDeviation& worst = mesh ? d.from_mesh : d.from_surface;
  const bool stopped =
      (report.simplify && report.simplify->out_of_time) || (report.mesher && report.mesher->out_of_time);
  // Of a volume the dense mesh's own surface is what is meant.
  const char* limit = worst.lower <= report.tolerance && stopped
                          ? "--time-limit, which ended measuring it: it may be held"
                      : report.mesher && !report.volume
                          ? "the dense mesh is that far there; give a larger --resolution, or a larger "
                            "tolerance"
                          : "the shapes of tets there; give a larger tolerance";
  report.shortfall.push_back({"tolerance",
                              report.tolerance,
                              worst.upper,
                              limit,
                              "short of --tolerance: " + number(report.tolerance) + " was asked, " +
                                  number(worst.upper) + " reached from the " +
                                  (mesh ? "mesh to the surface" : "surface to the mesh") + ", at " +
                                  place_text(worst.place) + "; held back by: " + limit,
                              {worst.place}});
}

/// Edges that have not the lengths that are asked for.
void find_edge_lengths(const TetMesh& mesh, RunReport& report) {
  const RequestedSizes& sizes = report.sizes;
  if (!report.simplify || !sizes.any()) return;
  report.edge_lengths = compare_edge_lengths(mesh, sizes.target_length.get(), sizes.source.get(),
                                             sizes.limits.min_edge, sizes.limits.max_edge);
  const EdgeLengthReport& e = *report.edge_lengths;
  const auto offend = [&](const char* what, const char* option, double asked,
                          const EdgeLengthReport::Offender& worst, const char* way, const char* limit) {
    if (worst.count == 0) return;
    report.shortfall.push_back({what,
                                asked,
                                worst.length,
                                limit,
                                std::string("short of ") + option + ": " + std::to_string(worst.count) +
                                    " of " + std::to_string(e.edges) + " edges are " + way + ", by most " +
                                    number(worst.length) + " instead of " + number(asked) + " at " +
                                    place_text(worst.place) + "; held back by: " + limit,
                                {worst.place}});
  };
  const char* held = report.simplify->out_of_time ? "--time-limit" : "surfaces, creases and shapes there";
  offend("max_edge", "--max-edge", sizes.limits.max_edge, e.above_max, "longer", held);
  offend("min_edge", "--min-edge", sizes.limits.min_edge, e.below_min, "shorter", held);
  if (e.within_share() >= min_edges_within) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "short of --size-field: %.3g %% of the edges are within %.3g times the wanted length, not "
                "%.3g %%; held back by: ",
                100 * e.within_share(), edge_length_factor, 100 * min_edges_within);
  report.shortfall.push_back(
      {"size_field", min_edges_within, e.within_share(), held, text + std::string(held)});
}

/// Tets below the bound where it is the default: a finding and no shortfall.
void report_bad_shapes(const CommandLine& line, RunReport& report) {
  const MeshStatistics& result = *report.result;
  // --only-below has its own report.
  if (line.min_solid_angle_given || line.only_below > 0 || result.below_percent <= bad_note_percent) return;
  char what[100];
  std::snprintf(what, sizeof what, "tets below %.6g sr, %.3g %% of all, the smallest at %.3g sr",
                line.min_solid_angle, result.below_percent, result.min_solid_angle);
  const std::string held =
      report.input_limited == 0
          ? ""
          : std::to_string(report.input_limited) + " of them in angles of the input too narrow for more; ";
  report.findings.push_back(
      {report.inputs.front(),
       {what, result.below_count, {}, held + "held back by: " + rules_limiting_shapes(*report.simplify)}});
}

/// Labels that were to be meshed and are not in the mesh.
void find_lost_labels(const CommandLine& line, RunReport& report) {
  if (!report.volume || report.volume->lost.empty()) return;
  const std::vector<LostLabel>& lost = report.volume->lost;
  const std::size_t kept = report.volume->labels.size(), all = kept + lost.size();
  std::string names;
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < std::min(lost.size(), max_lost_named); ++i) {
    names += (i ? ", " : "") + std::to_string(lost[i].tag) + " '" + lost[i].name + "' (" +
             std::to_string(lost[i].voxels) +
             (lost[i].voxels == 1 ? " voxel at " : " voxels, the first at ") + place_text(lost[i].place) +
             ")";
    places.push_back(lost[i].place);
  }
  if (lost.size() > max_lost_named) names += ", ...";
  const std::string rule = "--min-voxels " + std::to_string(line.min_voxels);
  report.shortfall.push_back(
      {"labels", static_cast<double>(all), static_cast<double>(kept), rule + ": " + names,
       "lost " + std::to_string(lost.size()) + " of " + std::to_string(all) + " labels: " + names +
           "; all their islands have fewer voxels than " + rule + " keeps; give a smaller number",
       places});
}

/// Whether --min-gap or --min-thickness have changed something.
bool changed_on_purpose(const RunReport& report) {
  return report.mesher && std::any_of(report.mesher->closed_gaps.begin(), report.mesher->closed_gaps.end(),
                                      [](const ClosedGapReport& g) { return g.on_purpose; });
}

/// Materials that are not the solid they are meant to be: a shortfall, or with --accept-changes a finding.
void find_changed_solids(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  if (!report.mesher) return;
  if (const std::optional<VolumeReport>& volume = report.volume)
    report.solids = compare_labels(volume->labels,
                                   line.keep_outside ? std::nullopt : std::optional(volume->outside_parts),
                                   std::abs(volume->directions.determinant()), mesh);
  else
    report.solids = compare_solids(report.mesher->expected, mesh);
  std::string text;
  std::vector<Vec3> places;
  std::size_t same = 0;
  bool dense_was_same = report.simplify.has_value();  // but for its counts, which simplifying keeps
  for (const SolidComparison& f : report.solids) {
    if (f.same()) {
      ++same;
      continue;
    }
    const auto dense = report.dense->materials.find(f.tag);
    dense_was_same &= f.same_counts() && dense != report.dense->materials.end() &&
                      is_same_volume(dense->second.volume, f.expected.volume);
    text += (text.empty() ? "" : "; ") + std::string("'") + f.name + "' has " + f.difference +
            (f.place ? ", the first at " + place_text(*f.place) : "") +
            (f.against == SolidComparison::Against::distances
                 ? " (by the distances: the surface is open, intersects itself or meets another)"
                 : "");
    if (f.place) places.push_back(*f.place);
  }
  if (text.empty()) return;
  const std::size_t all = report.solids.size();
  const bool on_purpose = changed_on_purpose(report);
  if (line.accept_changes || on_purpose) {
    report.findings.push_back(
        {report.inputs.front(),
         {"of " + std::to_string(all) + " materials not the solid of the input: " + text, all - same,
          places.empty() ? std::nullopt : std::optional(places.front()),
          line.accept_changes ? "accepted" : "as --min-gap and --min-thickness ask"}});
    return;
  }
  std::string thin;
  for (const ThinPartReport& t : report.mesher->thin_parts)
    thin += (thin.empty() ? "" : ", ") + (t.name.empty() ? "a gap" : "'" + t.name + "'") + " at " +
            place_text(t.first);
  report.shortfall.push_back({"fidelity", static_cast<double>(all), static_cast<double>(same),
                              dense_was_same ? "the number of tets"
                              : thin.empty() ? "the size of the cells"
                                             : "what is thin for the cells: " + thin,
                              "not the solid of the input: " + text + "; raise " +
                                  (dense_was_same ? "--target-tets" : "--resolution") +
                                  ", or take it as it is with --accept-changes",
                              places});
}

/// Walls that are too thick and gaps that are closed because cells are too large: a shortfall, or with
/// --accept-changes a finding. What was asked for is a finding.
void find_thin_walls(const CommandLine& line, RunReport& report) {
  if (!report.mesher) return;
  std::string text;
  std::vector<Vec3> places;
  for (const ClosedGapReport& g : report.mesher->closed_gaps) {
    char numbers[120];
    std::snprintf(numbers, sizeof numbers, "%.3g wide, over an area of %.3g, narrowest at ", g.width, g.area);
    const std::string what = "'" + g.name + "' " + numbers + place_text(g.place);
    if (g.on_purpose) {
      report.findings.push_back({report.inputs.front(),
                                 {(g.gap ? "gap of " : "wall of ") + what, 1, g.place,
                                  g.gap ? "closed by --min-gap" : "left out by --min-thickness"}});
      continue;
    }
    text += (text.empty() ? "" : "; ") + std::string("a gap of ") + what + " is closed";
    places.push_back(g.place);
  }
  const ThickenedWallsReport& t = report.mesher->thickened;
  if (t.points > 0) {
    char factor[120];
    std::snprintf(factor, sizeof factor, "walls are up to %.3g times too thick (%.3g, not %.3g) at ",
                  (t.thickness + 2 * t.offset) / t.thickness, t.thickness + 2 * t.offset, t.thickness);
    text += (text.empty() ? "" : "; ") + std::string(factor) + std::to_string(t.points) +
            " points of the boundary, most at " + place_text(t.place);
    places.push_back(t.place);
  }
  if (text.empty()) return;
  if (line.accept_changes) {
    report.findings.push_back(
        {report.inputs.front(), {"thin place, too thin for cells: " + text, 1, places.front(), "accepted"}});
    return;
  }
  const bool finer = !line.uniform && line.max_refinement.value_or(0) < max_wall_refinement;
  report.shortfall.push_back(
      {"thin_walls", 0, static_cast<double>(report.mesher->closed_gaps.size() + t.points),
       "the size of the cells",
       "too thin for cells: " + text + "; raise --resolution" + (finer ? " or --max-refinement" : "") +
           ", or take it as it is with --accept-changes",
       places});
}

/// Creases and corners that are not where they are in the input: a shortfall, or with --accept-changes a
/// finding.
void find_changed_creases(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  if (report.creases.segments.empty()) return;
  report.crease_comparison = compare_creases(report.creases, mesh);
  const CreaseComparison& c = *report.crease_comparison;
  if (c.same()) return;
  char distance[80];
  std::snprintf(distance, sizeof distance, "%.3g (%.3g %% of the diagonal)", c.max_distance,
                100 * c.max_distance / c.diagonal);
  std::string text = std::string("creases are off by up to ") + distance + " at " + place_text(c.place);
  if (c.lost_corners > 0)
    text += ", and " + std::to_string(c.lost_corners) + " of " + std::to_string(c.corners) +
            " corners are lost, the first at " + place_text(c.lost_corner);
  if (line.accept_changes || changed_on_purpose(report)) {
    report.findings.push_back({report.inputs.front(),
                               {"place where " + text, 1, c.place,
                                line.accept_changes ? "accepted" : "as --min-gap and --min-thickness ask"}});
    return;
  }
  const bool of_tets = !report.mesher;
  std::vector<Vec3> places{c.place};
  if (c.lost_corners > 0) places.push_back(c.lost_corner);
  report.shortfall.push_back({"creases", 0, c.max_distance,
                              report.simplify ? "the number of tets" : "the size of the cells",
                              text + "; " +
                                  (line.command == Command::improve ? ""
                                   : report.simplify                ? "raise --target-tets, or "
                                                                    : "raise --resolution, or ") +
                                  (of_tets ? "leave sharp edges alone with --feature-angle off"
                                           : "take it as it is with --accept-changes"),
                              places});
}

/// Patches of the user of which the mesh has nothing: a shortfall, or with --accept-changes a finding.
void find_lost_patches(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  compare_patches(mesh, report.patches);
  std::string text;
  std::size_t lost = 0;
  std::vector<Vec3> places;
  for (const PatchComparison& p : report.patches) {
    if (!p.lost() || lost++ >= max_lost_named) continue;
    text += (text.empty() ? "" : ", ") + ("'" + patch_name(p.group)) + "' at " + place_text(p.place);
    places.push_back(p.place);
  }
  if (lost == 0) return;
  if (lost > max_lost_named) text += ", ...";
  const std::size_t all = report.patches.size();
  if (line.accept_changes || changed_on_purpose(report)) {
    report.findings.push_back({report.inputs.front(),
                               {"named patches that are lost: " + text, lost, places.front(),
                                line.accept_changes ? "accepted" : "as --min-gap and --min-thickness ask"}});
    return;
  }
  report.shortfall.push_back(
      {"patches", static_cast<double>(all), static_cast<double>(all - lost), "the size of the cells",
       "lost " + std::to_string(lost) + " of " + std::to_string(all) + " named patches: " + text +
           "; they are smaller than cells, within the solid, or on triangles that are there twice: raise "
           "--resolution, or leave them out",
       places});
}

/// With --strict whatever is noted.
void find_notes(const CommandLine& line, const std::vector<std::string>& notes, RunReport& report) {
  if (!line.strict || notes.empty()) return;
  report.shortfall.push_back({"notes", 0, static_cast<double>(notes.size()), "--strict",
                              "--strict: " + std::to_string(notes.size()) +
                                  (notes.size() == 1 ? " note: " : " notes, the first: ") + notes.front()});
}

/// The mesh without the triangles of its interfaces.
TetMesh without_triangles(TetMesh mesh) {
  mesh.interfaces.clear();
  mesh.patch_groups.clear();
  return mesh;
}

void write_mesh(const TetMesh& mesh, const CommandRun& run, OutputFiles& files) {
  write_tet_mesh({mesh, run.midside ? &*run.midside : nullptr}, run.line.output, &files,
                 run.line.output_format);
}

}  // namespace

void assess(const TetMesh& mesh, CommandRun& run) {
  RunReport& report = run.report;
  report.material_names = mesh.material_names;
  report.seconds_total = run.since_start.seconds();
  if (report.simplify) {
    report.result = mesh_statistics(mesh, run.line.min_solid_angle);
    report.input_limited = input_limited_tets(mesh, report.creases, run.line.min_solid_angle);
    report_touching_points(report.inputs.front(), report);
    report_volumes(mesh, report.inputs.front(), report);
    find_count_and_shape_shortfall(run.line, report);
    find_edge_lengths(mesh, report);
    report_bad_shapes(run.line, report);
  } else {
    report.result = report.dense;  // the dense mesh is the result
  }
  find_limits(run.line, report);
  find_deviation(report);
  find_lost_labels(run.line, report);
  find_changed_solids(run.line, mesh, report);
  find_thin_walls(run.line, report);
  find_changed_creases(run.line, mesh, report);
  find_lost_patches(run.line, mesh, report);
  if (!run.line.output.empty()) find_unwritten(run.line, mesh, report);
  find_notes(run.line, notes_of(report), report);
  report.status = report.shortfall.empty() ? ExitStatus::done : ExitStatus::short_of_request;
  report.seconds_total = run.since_start.seconds();
}

void write_result(CommandResult& result, CommandRun& run) {
  const CommandLine& line = run.line;
  const Stopwatch watch;
  run.progress.begin_stage("write");
  OutputFiles files(&run.progress);
  if (!line.write_sdf.empty()) write_fields(*result.field, line.write_sdf, &files);
  result.field.reset();  // memory that writing the mesh needs
  if (line.no_boundary)
    write_mesh(without_triangles(result.mesh), run, files);
  else
    write_mesh(result.mesh, run, files);
  if (!line.boundary.empty()) write_interfaces(result.mesh, line.boundary, &files, line.boundary_format);
  write_report(result.mesh, run, files);
  run.report.seconds_write = watch.seconds();
  run.report.seconds_total = run.since_start.seconds();
  write_stats(run, files);
  files.commit();
  run.progress.finish();
}

void print_result(const CommandRun& run) {
  if (!run.line.quiet) print_notes(notes_of(run.report));
  if (run.line.stats == "-")
    std::printf("%s\n", stats_json(run.line, run.report).c_str());
  else if (!run.line.quiet && run.line.output != "-" && run.line.boundary != "-")
    print_report(run.line, run.report);
  for (const Shortfall& s : run.report.shortfall) print_line(s.message);
}

}  // namespace tetwright
