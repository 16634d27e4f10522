// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/body_builder.h"

#include <map>
#include <optional>
#include <utility>

#include "common/geometry/surface_tree.h"
#include "common/message_text.h"
#include "mesher/input/body_contacts.h"
#include "mesher/input/surface_cleaning.h"
#include "mesher/input/surface_components.h"
#include "mesher/input/surface_measures.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

double diagonal_of(const std::vector<Vec3>& points) {
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).norm();
}

/// The smallest cell before cell `k` that contains it, or `k`.
std::size_t encloser_of(std::size_t k, const std::vector<SurfaceCell>& cells) {
  const Vec3& place = cells[k].surface.points[0];
  for (std::size_t j = k; j-- > 0;)
    if (winding_number(cells[j].surface.points, cells[j].surface.triangles, place) >= 0.5) return j;
  return k;
}

/// Makes a shell within a cell a cavity of it.
void add_cavity(const RepairedSurface& shell, RepairedSurface& s) {
  const auto first = static_cast<Index>(s.points.size());
  s.points.insert(s.points.end(), shell.points.begin(), shell.points.end());
  for (const auto& [a, b, c] : shell.triangles) s.triangles.push_back({first + a, first + c, first + b});
  s.groups.insert(s.groups.end(), shell.groups.begin(), shell.groups.end());
  s.intersects_itself |= shell.intersects_itself;
  s.closed = s.triangles.size();
  measure_surface(s);
}

/// Treats closed shells within cells as cavities or solids, if that is asked for; otherwise they are cells
/// like others, since the orientation of a surface with inner walls means nothing.
void arrange_shells(std::vector<SurfaceCell>& cells, NestedRule nested, std::vector<Diagnostic>& findings) {
  if (nested != NestedRule::cavity && nested != NestedRule::solid) return;
  std::vector<char> removed(cells.size(), 0);
  std::size_t count = 0;
  std::optional<Vec3> place;
  for (std::size_t k = 1; k < cells.size(); ++k) {
    const std::size_t around = cells[k].walled ? k : encloser_of(k, cells);
    if (around == k || (nested == NestedRule::cavity && removed[around])) continue;
    removed[k] = 1;
    if (count++ == 0) place = cells[k].surface.points[0];
    if (nested == NestedRule::cavity) add_cavity(cells[k].surface, cells[around].surface);
  }
  for (std::size_t k = cells.size(); k-- > 0;)
    if (removed[k]) cells.erase(cells.begin() + static_cast<std::ptrdiff_t>(k));
  const bool cavity = nested == NestedRule::cavity;
  add_finding(findings, cavity ? DiagnosticCode::components_alternate : DiagnosticCode::cavities_filled,
              "shells within cells", count, place,
              cavity ? "solid and cavity alternate, as requested" : "filled, as requested");
}

}  // namespace

MaterialTag BodyBuilder::free_tag() {
  while (!tags_.insert(next_tag_).second) ++next_tag_;
  return next_tag_;
}

void BodyBuilder::add(std::vector<MaterialSurface> surfaces, NestedRule nested, RegionRule rule) {
  for (MaterialSurface& s : surfaces) {
    std::vector<Diagnostic> findings;
    CleanedSurface cleaned = clean_surface(s.surface, s.file, findings);
    const std::vector<SurfaceRegion> groups = s.surface.groups;
    if (rule == RegionRule::outer || !may_have_inner_walls(cleaned) ||
        !add_cells(cleaned, s, nested, findings)) {
      s.surface = {};
      SurfaceRepair repaired = repair_cleaned(std::move(cleaned), s.file, nested, std::move(findings));
      findings = std::move(repaired.findings);
      input_.bodies.push_back({s.name, s.tag, s.file, std::move(repaired.surface), groups});
      for (std::size_t k = 0; k < repaired.nested.size(); ++k)
        input_.bodies.push_back({s.name + "_" + std::to_string(k + 1), free_tag(), s.file,
                                 std::move(repaired.nested[k]), groups});
    }
    for (Diagnostic& f : findings) {
      f.file = s.file;
      input_.findings.push_back(std::move(f));
    }
  }
}

/// Adds the cells of a surface as bodies.
/// \return false if inner walls do not divide it
bool BodyBuilder::add_cells(const CleanedSurface& cleaned, const MaterialSurface& from, NestedRule nested,
                            std::vector<Diagnostic>& findings) {
  const double tolerance = contact_tolerance(contact_, diagonal_of(cleaned.points));
  DividedSurface divided = divide_surface(cleaned, tolerance, progress_);
  if (!divided.has_inner_walls()) return false;
  arrange_shells(divided.cells, nested, findings);
  report_cells(divided, findings);
  std::set<std::string> used;
  for (std::size_t k = 0; k < divided.cells.size(); ++k) {
    SurfaceCell& cell = divided.cells[k];
    cells_.insert(input_.bodies.size());
    input_.bodies.push_back({cell_name(cell, k + 1, from, used), k == 0 ? from.tag : free_tag(), from.file,
                             std::move(cell.surface), from.surface.groups});
  }
  return true;
}

std::string BodyBuilder::cell_name(const SurfaceCell& cell, std::size_t number, const MaterialSurface& from,
                                   std::set<std::string>& used) const {
  if (cell.group) {
    const std::string& group = from.surface.groups[*cell.group].name;
    if (!group.empty() && used.insert(group).second) return group;
  }
  return from.name + "_" + std::to_string(number);
}

void BodyBuilder::report_cells(const DividedSurface& divided, std::vector<Diagnostic>& findings) const {
  add_finding(findings, DiagnosticCode::cells_separated, "cells between the inner walls of a surface",
              divided.cells.size(), divided.cells[0].surface.points[0], "each a material of its own");
  add_finding(findings, DiagnosticCode::inner_walls_dropped,
              "triangles of sheets that bound no cell, with an area of " + short_number(divided.sheet_area),
              divided.sheet_triangles, divided.sheet, "left out");
  add_finding(findings, DiagnosticCode::inner_walls_dropped,
              "cells that are tiny or thinner than the tolerance", divided.dissolved_cells, divided.dissolved,
              "joined with a neighbour");
  add_finding(findings, DiagnosticCode::surface_self_intersects, "pairs of triangles that intersect",
              divided.crossing_pairs, divided.crossing, "kept; points inside any part count as inside");
}

void BodyBuilder::name(const std::vector<RegionSeed>& seeds) {
  std::map<std::size_t, const RegionSeed*> named;
  for (const RegionSeed& seed : seeds) {
    std::size_t body = input_.bodies.size();
    while (body-- > 0) {
      const RepairedSurface& s = input_.bodies[body].surface;
      if (winding_number(s.points, s.triangles, seed.point) >= 0.5) break;
    }
    const std::string place = "'" + seed.name + "' at " + place_text(seed.point);
    if (body > input_.bodies.size() || !cells_.contains(body))
      throw UsageError("the region " + place +
                       " is in no cell of a surface that inner walls divide; choose another point");
    const auto [known, is_new] = named.insert({body, &seed});
    if (!is_new && known->second->name != seed.name)
      throw UsageError("the region " + place + " is the same cell as '" + known->second->name + "' at " +
                       place_text(known->second->point) + "; leave one of them out");
    input_.bodies[body].name = seed.name;
  }
}

}  // namespace tetwright
