#include "tools/prepare/input_changes.h"

#include <algorithm>
#include <cstdio>

#include "common/message_text.h"

namespace tetwright {

namespace {

/// Lost labels that are named one by one.
constexpr std::size_t max_lost_named = 5;

/// Labels that were to be meshed and are not in the mesh.
void find_lost_labels(PrepareRun& run) {
  const PrepareOptions& options = run.options;
  PrepareReport& report = run.report;
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
  const std::string rule =
      "--min-voxels " + std::to_string(options.labels.min_voxels.value_or(default_min_voxels));
  report.shortfall.push_back(
      {"labels", static_cast<double>(all), static_cast<double>(kept), rule + ": " + names,
       "lost " + std::to_string(lost.size()) + " of " + std::to_string(all) + " labels: " + names +
           "; all their islands have fewer voxels than " + rule + " keeps; give a smaller number",
       places});
}

/// Whether --min-gap or --min-thickness have changed something.
bool changed_on_purpose(const PrepareReport& report) {
  return report.mesher && std::any_of(report.mesher->closed_gaps.begin(), report.mesher->closed_gaps.end(),
                                      [](const ClosedGapReport& g) { return g.on_purpose; });
}

/// Materials that are not the solid they are meant to be: a shortfall, or with --accept-changes a finding.
void find_changed_solids(const TetMesh& mesh, PrepareRun& run) {
  const PrepareOptions& options = run.options;
  PrepareReport& report = run.report;
  if (!report.mesher) return;
  if (const std::optional<VolumeReport>& volume = report.volume)
    report.solids = compare_labels(
        volume->labels, options.cells.keep_outside ? std::nullopt : std::optional(volume->outside_parts),
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
  if (options.acceptance.accept_changes || on_purpose) {
    report.findings.push_back(
        {report.inputs.front(),
         {"of " + std::to_string(all) + " materials not the solid of the input: " + text, all - same,
          places.empty() ? std::nullopt : std::optional(places.front()),
          options.acceptance.accept_changes ? "accepted" : "as --min-gap and --min-thickness ask"}});
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
void find_thin_walls(PrepareRun& run) {
  const PrepareOptions& options = run.options;
  PrepareReport& report = run.report;
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
  if (options.acceptance.accept_changes) {
    report.findings.push_back(
        {report.inputs.front(), {"thin place, too thin for cells: " + text, 1, places.front(), "accepted"}});
    return;
  }
  const bool finer = !options.cells.uniform && options.cells.max_refinement.value_or(0) < max_wall_refinement;
  report.shortfall.push_back(
      {"thin_walls", 0, static_cast<double>(report.mesher->closed_gaps.size() + t.points),
       "the size of the cells",
       "too thin for cells: " + text + "; raise --resolution" + (finer ? " or --max-refinement" : "") +
           ", or take it as it is with --accept-changes",
       places});
}

/// Creases and corners that are not where they are in the input: a shortfall, or with --accept-changes a
/// finding.
void find_changed_creases(const TetMesh& mesh, PrepareRun& run) {
  const PrepareOptions& options = run.options;
  PrepareReport& report = run.report;
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
  if (options.acceptance.accept_changes || changed_on_purpose(report)) {
    report.findings.push_back(
        {report.inputs.front(),
         {"place where " + text, 1, c.place,
          options.acceptance.accept_changes ? "accepted" : "as --min-gap and --min-thickness ask"}});
    return;
  }
  const bool of_tets = !report.mesher;
  std::vector<Vec3> places{c.place};
  if (c.lost_corners > 0) places.push_back(c.lost_corner);
  report.shortfall.push_back({"creases", 0, c.max_distance,
                              report.simplify ? "the number of tets" : "the size of the cells",
                              text + "; " +
                                  (run.task == Task::improve ? ""
                                   : report.simplify         ? "raise --target-tets, or "
                                                             : "raise --resolution, or ") +
                                  (of_tets ? "leave sharp edges alone with --feature-angle off"
                                           : "take it as it is with --accept-changes"),
                              places});
}

/// Patches of the user of which the mesh has nothing: a shortfall, or with --accept-changes a finding.
void find_lost_patches(const TetMesh& mesh, PrepareRun& run) {
  const PrepareOptions& options = run.options;
  PrepareReport& report = run.report;
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
  if (options.acceptance.accept_changes || changed_on_purpose(report)) {
    report.findings.push_back(
        {report.inputs.front(),
         {"named patches that are lost: " + text, lost, places.front(),
          options.acceptance.accept_changes ? "accepted" : "as --min-gap and --min-thickness ask"}});
    return;
  }
  report.shortfall.push_back(
      {"patches", static_cast<double>(all), static_cast<double>(all - lost), "the size of the cells",
       "lost " + std::to_string(lost) + " of " + std::to_string(all) + " named patches: " + text +
           "; they are smaller than cells, within the solid, or on triangles that are there twice: raise "
           "--resolution, or leave them out",
       places});
}

}  // namespace

void find_input_changes(const TetMesh& mesh, PrepareRun& run) {
  find_lost_labels(run);
  find_changed_solids(mesh, run);
  find_thin_walls(run);
  find_changed_creases(mesh, run);
  find_lost_patches(mesh, run);
}

}  // namespace tetwright
