// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/input_changes.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <optional>

#include "common/geometry/box_tree.h"
#include "common/geometry/projection_tree.h"
#include "common/message_text.h"
#include "tetwright/sheets.h"
#include "tools/prepare/label_changes.h"

namespace tetwright {

namespace {

/// Maximum number of lost labels named in a note.
constexpr std::size_t max_lost_named = 5;

/// Reports requested labels that the mesh lacks.
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
  report.diagnostics.push_back({.code = DiagnosticCode::labels_lost,
                                .what = "lost " + std::to_string(lost.size()) + " of " + std::to_string(all) +
                                        " labels: " + names + "; all their islands have fewer voxels than " +
                                        rule + " keeps",
                                .remedy = "give a smaller number",
                                .asked = static_cast<double>(all),
                                .reached = static_cast<double>(kept),
                                .limited_by = rule + ": " + names,
                                .places = places});
}

/// Text such as "its surface is open", for any flaw except SurfaceFlaw::none.
const char* flaw_text(SurfaceFlaw flaw) {
  static constexpr const char* texts[] = {
      "", "its surface or one that carves it is open", "its surface or one that carves it touches itself",
      "its surface or one that carves it intersects itself", "its surface meets another one"};
  return texts[static_cast<std::size_t>(flaw)];
}

/// Adds notes about materials that differ from an estimate of their solid.
void find_uncertain_changes(PrepareReport& report) {
  for (const SolidComparison& f : report.solids)
    if (!f.same() && !f.certain)
      report.diagnostics.push_back({.code = DiagnosticCode::solid_uncertain,
                                    .what = "'" + f.name + "' has " + f.difference +
                                            (f.place ? ", the first at " + place_text(*f.place) : "") +
                                            ", by the distances (not certain, since " + flaw_text(f.flaw) +
                                            ")",
                                    .places = f.place ? std::vector<Vec3>{*f.place} : std::vector<Vec3>{}});
}

/// Reports materials that certainly differ from the solid of the input.
void find_changed_solids(const TetMesh& mesh, PrepareRun& run) {
  const PrepareOptions& options = run.options;
  PrepareReport& report = run.report;
  if (!report.mesher) return;
  if (const std::optional<VolumeReport>& volume = report.volume) {
    const bool outside_is_known = !options.cells.keep_outside && !report.mesher->carved;
    report.solids =
        compare_labels(volume->labels, outside_is_known ? std::optional(volume->outside_parts) : std::nullopt,
                       std::abs(volume->directions.determinant()), mesh);
    const std::vector<SolidComparison> bodies = compare_solids(report.mesher->expected, mesh);
    report.solids.insert(report.solids.end(), bodies.begin(), bodies.end());
  } else
    report.solids = compare_solids(report.mesher->expected, mesh);
  std::string text;
  std::vector<Vec3> places;
  std::size_t same = 0;
  bool dense_was_same = report.simplify.has_value();  // except for its counts, which simplification preserves
  for (const SolidComparison& f : report.solids) {
    if (f.same() || !f.certain) {
      ++same;
      continue;
    }
    const auto dense = report.dense->materials.find(f.tag);
    dense_was_same &= f.same_counts() && dense != report.dense->materials.end() &&
                      is_same_volume(dense->second.volume, f.expected.volume);
    text += (text.empty() ? "" : "; ") + std::string("'") + f.name + "' has " + f.difference +
            (f.place ? ", the first at " + place_text(*f.place) : "") +
            (f.flaw != SurfaceFlaw::none
                 ? " (" + std::string(flaw_text(f.flaw)) + ", but the distances say the same)"
                 : "");
    if (f.place) places.push_back(*f.place);
  }
  if (text.empty()) return;
  const std::size_t all = report.solids.size();
  std::string thin;
  for (const ThinPartReport& t : report.mesher->thin_parts)
    thin += (thin.empty() ? "" : ", ") + (t.name.empty() ? "a gap" : "'" + t.name + "'") + " at " +
            place_text(t.first);
  report.diagnostics.push_back({.code = DiagnosticCode::solid_changed,
                                .file = report.inputs.front(),
                                .what = "not the solid of the input: " + text,
                                .remedy = std::string("raise ") +
                                          (dense_was_same ? "--target-tets" : "--resolution") +
                                          ", or accept it with --accept-changes",
                                .asked = static_cast<double>(all),
                                .reached = static_cast<double>(same),
                                .limited_by = dense_was_same ? "the number of tets"
                                              : thin.empty() ? "the size of the cells"
                                                             : "what is thin for the cells: " + thin,
                                .places = places});
}

/// Text such as "an area of 3.2 instead of 4, 2 pieces instead of 1", or nothing.
std::string sheet_difference(const SheetStatistics& is, const SheetStatistics& should) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (!is_same_volume(is.area, should.area))
    add("an area of " + short_number(is.area) + " instead of " + short_number(should.area));
  if (is.pieces != should.pieces)
    add(std::to_string(is.pieces) + (is.pieces == 1 ? " piece" : " pieces") + " instead of " +
        std::to_string(should.pieces));
  else if (is.euler != should.euler)
    add("the Euler characteristic " + std::to_string(is.euler) + " instead of " +
        std::to_string(should.euler));
  return text;
}

/// Reports sheets that differ from those of the input.
void find_changed_sheets(const TetMesh& mesh, PrepareRun& run) {
  PrepareReport& report = run.report;
  if (!report.mesher || report.mesher->sheets.empty()) return;
  const std::vector<SheetStatistics> found = sheet_statistics(mesh);
  std::string text;
  std::vector<Vec3> places;
  for (const ExpectedSheet& e : report.mesher->sheets) {
    const auto is = std::find_if(found.begin(), found.end(),
                                 [&](const SheetStatistics& s) { return s.name == e.shape.name; });
    const std::string difference = sheet_difference(is == found.end() ? SheetStatistics{} : *is, e.shape);
    if (difference.empty()) continue;
    text += (text.empty() ? "" : "; ") + ("'" + e.shape.name + "' has ") + difference + ", it is at " +
            place_text(e.place);
    places.push_back(e.place);
  }
  if (text.empty()) return;
  const std::size_t all = report.mesher->sheets.size();
  report.diagnostics.push_back({.code = DiagnosticCode::sheets_changed,
                                .file = report.inputs.front(),
                                .what = "not the sheets of the input: " + text,
                                .remedy = "raise --resolution, or accept it with --accept-changes",
                                .asked = static_cast<double>(all),
                                .reached = static_cast<double>(all - places.size()),
                                .limited_by = "the size of the cells",
                                .places = places});
}

/// Reports walls thickened and gaps closed by large cells, and those changed on request.
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
      report.diagnostics.push_back(
          {.code = g.gap ? DiagnosticCode::gap_closed : DiagnosticCode::wall_left_out,
           .file = report.inputs.front(),
           .what = (g.gap ? "gap of " : "wall of ") + what,
           .count = 1,
           .done = g.gap ? "closed by --min-gap" : "left out by --min-thickness",
           .places = {g.place}});
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
            " points of the boundary, worst at " + place_text(t.place);
    places.push_back(t.place);
  }
  if (text.empty()) return;
  const bool finer = !options.cells.uniform && options.cells.max_refinement.value_or(0) < max_wall_refinement;
  const GapOpening& opening = report.gap_opening;
  const std::string opens =
      opening.target_tets      ? " (" + std::to_string(*opening.target_tets) + " opens the gaps)"
      : opening.max_refinement ? " (" + std::to_string(*opening.max_refinement) + " opens the gaps)"
                               : "";
  report.diagnostics.push_back(
      {.code = DiagnosticCode::thin_walls_changed,
       .file = report.inputs.front(),
       .what = "too thin for cells: " + text,
       .remedy = std::string("raise ") + (options.target.tets ? "--target-tets" : "") +
                 (opening.target_tets ? opens : "") + (options.target.tets ? ", " : "") + "--resolution" +
                 (finer ? " or --max-refinement" : "") + (opening.max_refinement ? opens : "") +
                 ", or accept it with --accept-changes",
       .asked = 0,
       .reached = static_cast<double>(report.mesher->closed_gaps.size() + t.points),
       .limited_by = "the size of the cells",
       .places = places});
}

/// Reports faces between what only meets in a curve.
void find_strips(PrepareReport& report) {
  if (!report.mesher || report.mesher->strips.faces == 0) return;
  const StripReport& strips = report.mesher->strips;
  report.diagnostics.push_back({.code = DiagnosticCode::contacts_changed,
                                .file = report.inputs.front(),
                                .what = "not the contacts of the input: " + std::to_string(strips.faces) +
                                        (strips.faces == 1 ? " face joins" : " faces join") +
                                        " what only meets in a curve, one at " + place_text(strips.place),
                                .remedy = "raise --resolution, or accept it with --accept-changes",
                                .asked = 0,
                                .reached = static_cast<double>(strips.faces),
                                .limited_by = "the size of the cells",
                                .places = {strips.place}});
}

/// Reports creases and corners that moved away from those of the input.
void find_changed_creases(const TetMesh& mesh, PrepareRun& run) {
  PrepareReport& report = run.report;
  if (report.creases.segments.empty()) return;
  report.crease_comparison = compare_creases(report.creases, mesh);
  measure_chains(report.features, mesh);
  const CreaseComparison& c = *report.crease_comparison;
  if (c.same()) return;
  char distance[80];
  std::snprintf(distance, sizeof distance, "%.3g (%.3g %% of the diagonal)", c.max_distance,
                100 * c.max_distance / c.diagonal);
  std::string text = std::string("creases are off by up to ") + distance + " at " + place_text(c.place);
  if (c.lost_corners > 0)
    text += ", and " + std::to_string(c.lost_corners) + " of " + std::to_string(c.corners) +
            " corners are lost, the first at " + place_text(c.lost_corner);
  const bool of_tets = !report.mesher;
  std::vector<Vec3> places{c.place};
  if (c.lost_corners > 0) places.push_back(c.lost_corner);
  report.diagnostics.push_back(
      {.code = DiagnosticCode::creases_changed,
       .file = report.inputs.front(),
       .what = text,
       .remedy =
           std::string(run.task == Task::improve ? ""
                       : report.simplify         ? "raise --target-tets, or "
                                                 : "raise --resolution, or ") +
           (of_tets ? "ignore sharp edges with --feature-angle off" : "accept it with --accept-changes"),
       .asked = 0,
       .reached = c.max_distance,
       .limited_by = report.simplify ? "the number of tets" : "the size of the cells",
       .places = places});
}

/// Reports named or numbered patches that are missing in the mesh.
void find_lost_patches(const TetMesh& mesh, PrepareRun& run) {
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
  report.diagnostics.push_back(
      {.code = DiagnosticCode::patches_lost,
       .file = report.inputs.front(),
       .what = "lost " + std::to_string(lost) + " of " + std::to_string(all) + " named patches: " + text,
       .remedy = "they are smaller than cells, within the solid, or on duplicate triangles: raise "
                 "--resolution, or leave them out",
       .asked = static_cast<double>(all),
       .reached = static_cast<double>(all - lost),
       .limited_by = "the size of the cells",
       .places = places});
}

/// Whether a material has changed, according to its comparison with the input; the worst value is last.
enum class Change : std::uint8_t {
  none,
  none_by_estimate,  ///< equal to an estimate
  by_estimate,       ///< different from an estimate
  possible           ///< changed, or unknown
};

Change change_of(const PrepareReport& report, MaterialTag tag) {
  const auto f = std::find_if(report.solids.begin(), report.solids.end(),
                              [&](const SolidComparison& m) { return m.tag == tag; });
  if (f == report.solids.end() || !f->counted || f->against == SolidComparison::Against::voxels)
    return Change::possible;
  if (f->certain) return f->same() ? Change::none : Change::possible;
  return f->same() ? Change::none_by_estimate : Change::by_estimate;
}

/// Worst change of the materials at a thin part: of the part's material, or of all materials for a gap.
Change change_beside(const PrepareReport& report, const ThinPartReport& thin) {
  std::optional<Change> worst;
  for (const auto& [tag, material] : report.dense->materials) {
    const auto name = report.material_names.find(tag);
    if (tag == outside_tag ||
        (!thin.name.empty() && (name == report.material_names.end() || name->second != thin.name)))
      continue;
    worst = std::max(worst.value_or(Change::none), change_of(report, tag));
  }
  return worst.value_or(Change::possible);
}

/// Adds a note about a thin part unless the comparison shows that its material is unchanged.
void find_thin_part(const ThinPartReport& thin, PrepareReport& report) {
  const Change change = change_beside(report, thin);
  if (change == Change::none) return;
  report.diagnostics.push_back(
      {.code = change == Change::possible ? DiagnosticCode::thin_parts : DiagnosticCode::thin_parts_uncertain,
       .what = (thin.name.empty() ? "a gap" : "'" + thin.name + "'") + " is thinner than " +
               (thin.refined ? "the smallest cells can represent" : "two cells") + " at " +
               std::to_string(thin.places) +
               (thin.places == 1 ? " location, at " : " locations, the first at ") + place_text(thin.first) +
               (change == Change::none_by_estimate
                    ? ": nothing is known to be torn or joined there"
                    : ": parts may be torn or joined there; a higher resolution keeps them"),
       .places = {thin.first}});
}

/// \param count locations where bodies run beside something
void find_narrow_labels(std::size_t count, const Vec3& first, const std::string& beside,
                        const std::string& done, PrepareReport& report) {
  if (count == 0) return;
  report.diagnostics.push_back(
      {.code = DiagnosticCode::narrow_labels,
       .what = "bodies run less than a cell beside " + beside + " at " + std::to_string(count) +
               (count == 1 ? " location, at " : " locations, the first at ") + place_text(first),
       .done = done,
       .places = {first}});
}

/// Adds notes about parts that are small or thin relative to the cells.
void find_small_parts(PrepareReport& report) {
  for (const FeatureReport& f : report.features)
    if (f.found.dropped > 0)
      report.diagnostics.push_back({.code = DiagnosticCode::crease_patches_dropped,
                                    .what = "'" + f.name + "' has " + std::to_string(f.found.dropped) +
                                            " patches between sharp edges smaller than eight faces of a cell",
                                    .done = "their edges are not kept; a higher resolution keeps them"});
  if (!report.mesher) return;
  if (report.mesher->isolated_vertices > 0)
    report.diagnostics.push_back({.code = DiagnosticCode::specks_dropped,
                                  .what = "parts or cavities of a single lattice point",
                                  .count = report.mesher->isolated_vertices,
                                  .done = "left out; a higher resolution keeps them"});
  for (const std::string& name : report.mesher->unknown)
    report.diagnostics.push_back(
        {.code = DiagnosticCode::not_compared,
         .what =
             "'" + name +
             "' was not compared with its input: its surface is open, intersects itself or meets another, "
             "and cells of this size do not show it"});
  for (const std::string& name : report.mesher->at_protected)
    report.diagnostics.push_back(
        {.code = DiagnosticCode::not_compared,
         .what =
             "'" + name +
             "' was not compared with its surface: it meets labels of --protect-labels, to which it gives "
             "way"});
  for (const std::string& name : report.mesher->off_labels)
    report.diagnostics.push_back({.code = DiagnosticCode::body_off_labels,
                                  .what = "'" + name + "' is in no label of the volume, only outside",
                                  .done = "meshed beside them; check its position and --surface-space if it "
                                          "should carve labels"});
  const NarrowLabelsReport& narrow = report.mesher->narrow_labels;
  find_narrow_labels(narrow.places, narrow.first, "an interface of labels, or the border of the volume,",
                     "cells there are larger than the gap, so that tets may be poor; smaller cells or a "
                     "higher --max-refinement resolve it",
                     report);
  find_narrow_labels(narrow.at_border, narrow.first_at_border, "the border of the volume",
                     "no cells resolve a gap that thin, so that tets may be poor; let the body end in the "
                     "border, cross it, or keep away from it",
                     report);
  for (const ThinPartReport& t : report.mesher->thin_parts) find_thin_part(t, report);
}

/// Max distance of points on the boundary beside sheets, as a share of the diagonal: that of creases
/// (crease_comparison.cpp).
constexpr double max_boundary_share = 0.005;

}  // namespace

void find_moved_boundary(const TetMesh& mesh, const TriangleMesh& surface, PrepareRun& run) {
  if (!run.report.mesher || run.report.mesher->sheets.empty()) return;
  std::vector<ProjectionTree::Item> items;
  Box3 box;
  for (const Triangle& t : surface.triangles) {
    items.push_back({t, {}});
    for (const Index p : t) box.add(surface.points[p]);
  }
  const ProjectionTree tree(surface.points, std::move(items));
  const double diagonal = (box.high - box.low).norm();
  double worst = 0;
  Vec3 place = Vec3::Zero();
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (t.is_sheet() || (t.material == outside_tag && !t.other)) continue;
    for (const Index p : t.ids)
      if (const auto foot = tree.nearest(mesh.points[p], {}, diagonal))
        if (const double distance = (*foot - mesh.points[p]).norm(); distance > worst)
          worst = distance, place = mesh.points[p];
  }
  if (worst <= max_boundary_share * diagonal) return;
  run.report.diagnostics.push_back(
      {.code = DiagnosticCode::sheets_changed,
       .file = run.report.inputs.front(),
       .what = "not the surface of the input: beside sheets it is off by up to " + short_number(worst) +
               " (" + short_number(100 * worst / diagonal) + " % of the diagonal) at " + place_text(place),
       .remedy = "change --resolution or --target-tets a little, or accept it with --accept-changes",
       .asked = 0,
       .reached = worst,
       .limited_by = "the shapes of tets where sheets meet the boundary",
       .places = {place}});
}

void find_input_changes(const TetMesh& mesh, PrepareRun& run) {
  find_lost_labels(run);
  find_changed_labels(run);
  find_changed_contacts(mesh, run);
  find_changed_solids(mesh, run);
  find_uncertain_changes(run.report);
  find_changed_sheets(mesh, run);
  find_thin_walls(run);
  find_strips(run.report);
  find_changed_creases(mesh, run);
  find_lost_patches(mesh, run);
  find_small_parts(run.report);
}

}  // namespace tetwright
