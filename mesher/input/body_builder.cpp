// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/body_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "common/geometry/surface_tree.h"
#include "common/message_text.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/input/body_contacts.h"
#include "mesher/input/connected_patches.h"
#include "mesher/input/surface_cleaning.h"
#include "mesher/input/surface_components.h"
#include "mesher/input/surface_holes.h"
#include "mesher/input/surface_measures.h"
#include "mesher/tuning/input_tuning.h"
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

/// A point inside a cell, next to the middle of its largest triangle.
Vec3 place_inside(const RepairedSurface& s) {
  double largest = -1;
  Vec3 place = s.points[0];
  for (const auto& [a, b, c] : s.triangles) {
    const Vec3 normal = (s.points[b] - s.points[a]).cross(s.points[c] - s.points[a]);
    const double size = normal.norm();
    if (!(size > largest)) continue;
    largest = size;
    place = (s.points[a] + s.points[b] + s.points[c]) / 3 -
            InputTuning::Cells::step_inside / std::sqrt(size) * normal;
  }
  return place;
}

/// Sorts cells by the height of their middle, highest first; at equal heights by y, then x.
void order_from_top(std::vector<SurfaceCell>& cells) {
  std::vector<std::pair<std::array<double, 3>, std::size_t>> order;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const RepairedSurface& s = cells[k].surface;
    const double step = InputTuning::Cells::equal * (s.high - s.low).norm();
    Vec3 middle = Vec3::Zero();
    double volume = 0;
    for (const auto& [a, b, c] : s.triangles) {
      const Vec3 p = s.points[a] - s.low, q = s.points[b] - s.low, r = s.points[c] - s.low;
      const double part = p.dot(q.cross(r));
      volume += part;
      middle += part * (p + q + r) / 4;
    }
    middle = s.low + middle / volume;
    order.push_back(
        {{-std::round(middle.z() / step), -std::round(middle.y() / step), -std::round(middle.x() / step)},
         k});
  }
  std::sort(order.begin(), order.end());
  std::vector<SurfaceCell> sorted;
  sorted.reserve(order.size());
  for (const auto& [key, k] : order) sorted.push_back(std::move(cells[k]));
  cells = std::move(sorted);
}

bool has_code(const std::vector<Diagnostic>& findings, DiagnosticCode code) {
  return std::any_of(findings.begin(), findings.end(), [&](const Diagnostic& d) { return d.code == code; });
}

/// Names in quotes, of many the first ones.
std::string listed(const std::set<std::string>& names) {
  std::string text;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (count == InputTuning::Messages::max_named_walls) return text + " and more";
    text += (count++ == 0 ? " '" : ", '") + name + "'";
  }
  return text;
}

}  // namespace

MaterialTag BodyBuilder::free_tag() {
  while (!tags_.insert(next_tag_).second) ++next_tag_;
  return next_tag_;
}

/// Cleans the surfaces, takes walls out, closes flat holes, and names the holes of all surfaces together.
/// Frees points and triangles of `surfaces`; their groups receive those of caps.
std::vector<BodyBuilder::ClosedSurface> BodyBuilder::close_holes(std::vector<MaterialSurface>& surfaces,
                                                                 NestedRule nested, RegionRule rule,
                                                                 bool partitioned) {
  std::vector<ClosedSurface> closed;
  std::vector<SurfaceHole>& holes = input_.holes;
  CapOptions options = caps_;
  // Meshing says what is missing of surfaces that nearly close together.
  options.open.accept_sheets |= has_code(input_.findings, DiagnosticCode::surfaces_not_joined);
  Vec3 low = Vec3::Constant(INFINITY), high = Vec3::Constant(-INFINITY);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    MaterialSurface& s = surfaces[i];
    ClosedSurface& own = closed.emplace_back();
    own.cleaned = clean_surface(s.surface, s.file, own.findings);
    s.surface.points = {};
    s.surface.triangles = {};
    s.surface.triangle_groups = {};
    for (const Vec3& p : own.cleaned.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    for (const SurfaceRegion& group : s.surface.groups) names_.insert(group.name);
    const auto joined = joined_.find(i);
    if (joined != joined_.end() && rule == RegionRule::cells && !partitioned) {
      own.walled = std::move(joined->second);
    } else if (joined != joined_.end()) {
      const DividedSurface& divided = joined->second.divided;
      own.cleaned = outline_of(divided);
      if (divided.cells.size() > 1)
        add_finding(own.findings, DiagnosticCode::inner_walls_dropped,
                    "cells between the inner walls of surfaces that close together", divided.cells.size(),
                    divided.cells[0].surface.points[0],
                    "joined, as partitions or the outer body were asked for");
    } else {
      own.walled = separate_walls(own.cleaned, s.file, nested, rule, contact_, progress_);
    }
    if (own.has_cells() && partitioned) own.walled.reset();
    if (own.has_cells()) continue;
    for (SurfaceHole& hole : close_flat_holes(own.cleaned, s.surface.groups, s.file, options, own.findings)) {
      hole.surface = i;
      holes.push_back(std::move(hole));
    }
    if (progress_) progress_->throw_if_stopped();
  }
  order_holes(holes);
  name_holes(holes, caps_.names, names_, (high - low).norm());
  for (const SurfaceHole& hole : holes)
    if (hole.sharp) surfaces[hole.surface].surface.groups[hole.group] = {0, hole.name};
  return closed;
}

void BodyBuilder::add(std::vector<MaterialSurface> surfaces, NestedRule nested, RegionRule rule,
                      const std::vector<Partition>& partitions, std::set<std::string> names) {
  names_ = std::move(names);
  std::vector<ClosedSurface> closed = close_holes(surfaces, nested, rule, !partitions.empty());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    MaterialSurface& s = surfaces[i];
    std::vector<Diagnostic>& findings = closed[i].findings;
    const std::vector<SurfaceRegion> groups = s.surface.groups;
    if (const std::optional<WalledSurface>& walled = closed[i].walled; walled && walled->walls) {
      take_walls(*walled->walls, *walled->given, walled->divided, s, rule, findings);
      add_finding(findings, DiagnosticCode::inner_walls_dropped,
                  "triangles of walls that are tiny or lie on others, with an area of " +
                      short_number(walled->walls->dropped_area),
                  walled->walls->dropped, walled->walls->dropped_place, "left out");
    }
    if (!add_layers(closed[i].cleaned, s, nested, partitions, findings) &&
        (rule == RegionRule::outer || !add_cells(closed[i], s, nested))) {
      SurfaceRepair repaired =
          repair_cleaned(std::move(closed[i].cleaned), s.file, nested, std::move(findings));
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
  for (std::uint32_t k = 0; k < partitions.size(); ++k) {
    if (dividing_.contains(k)) continue;
    const auto end = ends_.find(k);
    if (const auto twice = repeated_.find(k); end == ends_.end() && twice != repeated_.end())
      throw InputError(partitions[k].file, 0,
                       "the partition '" + partitions[k].name + "' divides no body: " + twice->second);
    throw InputError(
        partitions[k].file, 0,
        "the partition '" + partitions[k].name + "' divides no body: " +
            (end == ends_.end()
                 ? "it reaches the boundary of none; check its units and position, or continue it "
                   "with a larger --extend"
                 : end->second + "; use a larger --extend, or --sheet to keep it "
                                 "as a sheet inside the body"));
  }
}

/// The contact tolerance of one surface, input units.
double BodyBuilder::tolerance_for(const CleanedSurface& cleaned, const MaterialSurface& from) const {
  const double diagonal = diagonal_of(cleaned.points), tolerance = contact_tolerance(contact_, diagonal);
  require_larger_than_tolerance(diagonal, tolerance, from.name, from.file);
  return tolerance;
}

/// Adds the cells into which partitions divide a body.
/// \return false if they do not
bool BodyBuilder::add_layers(const CleanedSurface& cleaned, const MaterialSurface& from, NestedRule nested,
                             const std::vector<Partition>& partitions, std::vector<Diagnostic>& findings) {
  const PartitionedSurface all = with_partitions(cleaned, from.surface.groups, partitions);
  if (!all.any()) return false;
  DividedSurface divided = divide_surface(all.surface, tolerance_for(cleaned, from), progress_);
  if (divided.unresolved)
    throw InputError(from.file, 0,
                     "a partition cannot be joined with this surface at " + place_text(*divided.unresolved) +
                         ": facets there are about as small as the contact tolerance; use a smaller "
                         "--contact-tolerance");
  if (nested != NestedRule::material && !may_have_inner_walls(cleaned)) {
    // Cavities stay cavities.
    std::vector<Diagnostic> unused;
    const RepairedSurface body = repair_cleaned(cleaned, from.file, nested, unused).surface;
    std::erase_if(divided.cells, [&](const SurfaceCell& cell) {
      return winding_number(body.points, body.triangles, place_inside(cell.surface)) < 0.5;
    });
  }
  report_partitions(divided, all, partitions, from);
  if (divided.cells.size() < 2) return false;
  add_finding(findings, DiagnosticCode::cells_separated, "cells between partitions", divided.cells.size(),
              divided.cells[0].surface.points[0], "each a material of its own");
  order_from_top(divided.cells);
  add_bodies(std::move(divided.cells), from, all.groups);
  return true;
}

/// Notes which partitions divide the body, and reports those that end inside.
void BodyBuilder::report_partitions(const DividedSurface& divided, const PartitionedSurface& all,
                                    const std::vector<Partition>& partitions, const MaterialSurface& from) {
  const auto partition_of = [&](Index source) { return all.partition[source - all.body_triangles]; };
  const std::size_t walled = std::count_if(divided.cells.begin(), divided.cells.end(),
                                           [](const SurfaceCell& c) { return c.walled; });
  std::map<std::uint32_t, double> loose;  // area inside
  std::map<std::uint32_t, const WallTriangle*> border;
  std::map<std::uint32_t, SheetLoss> outside;
  for (const WallTriangle& w : divided.sheets) {
    if (w.source < all.body_triangles) continue;
    const std::uint32_t k = partition_of(w.source);
    if (w.outside) {
      if (!all.continued[w.source - all.body_triangles]) outside[k].add(w.area(), w.centre());
      continue;
    }
    loose[k] += w.area();
    if (w.at_border && (!border[k] || w.area() > border[k]->area())) border[k] = &w;
  }
  // A partition whose triangles are not all loose or outside is a wall somewhere.
  std::map<std::uint32_t, double> given;
  for (std::size_t t = 0; t < all.partition.size(); ++t) {
    const Triangle& ids = all.surface.triangles[all.body_triangles + t];
    const std::vector<Vec3>& p = all.surface.points;
    given[all.partition[t]] += (p[ids[1]] - p[ids[0]]).cross(p[ids[2]] - p[ids[0]]).norm() / 2;
  }
  std::map<std::uint32_t, double> bound_none = loose;
  std::map<std::uint32_t, SheetLoss> repeated;
  for (const WallTriangle& w : divided.repeated) {
    if (w.source < all.body_triangles || all.continued[w.source - all.body_triangles]) continue;
    repeated[partition_of(w.source)].add(w.area(), w.centre());
    bound_none[partition_of(w.source)] += w.area();
  }
  for (const WallTriangle& w : divided.sheets)
    if (w.outside && w.source >= all.body_triangles) bound_none[partition_of(w.source)] += w.area();
  for (const auto& [k, area] : given) {
    const bool divides = walled > 1 && bound_none[k] < (1 - InputTuning::Cells::equal) * area;
    if (divides) dividing_.insert(k);
    if (const auto twice = repeated.find(k); twice != repeated.end() && divides)
      input_.findings.push_back({.code = DiagnosticCode::sheet_on_faces,
                                 .file = partitions[k].file,
                                 .what = "a part of the partition '" + partitions[k].name +
                                         "' on an earlier one or on the boundary of '" + from.name +
                                         "', with an area of " + short_number(twice->second.area),
                                 .done = "left out",
                                 .places = {twice->second.place}});
    else if (twice != repeated.end())
      repeated_.try_emplace(k, "it lies on an earlier one or on the boundary of '" + from.name + "', at " +
                                   place_text(twice->second.place) + "; leave it out");
    if (loose[k] > 0 && border[k]) {
      const Vec3 place = border[k]->centre();
      const std::string where = "it ends inside '" + from.name + "' at " + place_text(place);
      ends_.try_emplace(k, where);
      if (divides)
        input_.findings.push_back({.code = DiagnosticCode::partition_ends,
                                   .file = partitions[k].file,
                                   .what = "a part of the partition '" + partitions[k].name +
                                           "' that ends inside '" + from.name + "', with an area of " +
                                           short_number(loose[k]),
                                   .done = "left out, as it separates nothing",
                                   .places = {place}});
    }
    if (const auto lost = outside.find(k); lost != outside.end() && lost->second.area > 0 && divides)
      input_.findings.push_back({.code = DiagnosticCode::sheet_cut_off,
                                 .file = partitions[k].file,
                                 .what = "a part of the partition '" + partitions[k].name + "' outside '" +
                                         from.name + "', with an area of " + short_number(lost->second.area),
                                 .done = "left out",
                                 .places = {lost->second.place}});
  }
}

/// Adds the cells of a surface as bodies.
/// \return false if inner walls do not divide it
bool BodyBuilder::add_cells(ClosedSurface& surface, const MaterialSurface& from, NestedRule nested) {
  std::vector<Diagnostic>& findings = surface.findings;
  if (!surface.has_cells()) {
    if (!may_have_inner_walls(surface.cleaned)) return false;
    const double tolerance = tolerance_for(surface.cleaned, from);
    WalledSurface walled;
    walled.divided = divide_surface(surface.cleaned, tolerance, progress_);
    if (walled.divided.unresolved)
      findings.push_back({.code = DiagnosticCode::bodies_not_joined,
                          .what = "parts of a surface that meet are not joined",
                          .done = "their facets there are about as small as the contact tolerance of " +
                                  short_number(tolerance) + "; inner walls are left out",
                          .places = {*walled.divided.unresolved}});
    if (!walled.divided.has_inner_walls()) return false;
    walled.patches = find_connected_patches(surface.cleaned.points, surface.cleaned.triangles);
    surface.walled = std::move(walled);
  }
  DividedSurface& divided = surface.walled->divided;
  const CleanedSurface& given = surface.walled->given ? *surface.walled->given : surface.cleaned;
  arrange_shells(divided.cells, nested, findings);
  std::vector<const RepairedSurface*> solids;
  for (const SurfaceCell& cell : divided.cells) solids.push_back(&cell.surface);
  const InnerWalls walls = walls_inside(solids, given, surface.walled->patches, divided);
  report_cells(divided, walls, findings);
  take_walls(walls, given, divided, from, RegionRule::cells, findings);
  add_bodies(std::move(divided.cells), from, from.surface.groups);
  return true;
}

/// Keeps walls as sheets, or leaves them out as asked or where there are layers.
void BodyBuilder::take_walls(const InnerWalls& walls, const CleanedSurface& surface,
                             const DividedSurface& divided, const MaterialSurface& from, RegionRule rule,
                             std::vector<Diagnostic>& findings) {
  if (walls.kept.triangles.empty()) return;
  const std::string with_area = "inside '" + from.name + "', with an area of " + short_number(walls.area);
  WallSheet sheet = sheet_of_walls(walls, surface, divided, from, names_);
  std::erase_if(input_.groups, [&](const MesherInput::Group& g) {
    return std::find(sheet.groups.begin(), sheet.groups.end(), g.group) != sheet.groups.end();
  });
  if (rule == RegionRule::outer || !input_.layers.empty()) {
    add_finding(findings, DiagnosticCode::inner_walls_dropped, "triangles of walls " + with_area,
                walls.kept.triangles.size(), walls.place, "left out");
    return;
  }
  std::set<std::string> names;
  for (const SurfaceRegion& group : sheet.sheet.surface.groups) names.insert(group.name);
  if (names.empty()) names.insert(sheet.sheet.name);
  const bool single = walls.pieces == 1;
  findings.push_back(
      {.code = DiagnosticCode::walls_kept_as_sheets,
       .what = (single ? "a wall of zero thickness " : "walls of zero thickness ") + with_area,
       .count = single ? 0 : walls.pieces,
       .done = (names.size() == 1 ? "kept as the sheet" : "kept as the sheets") + listed(names),
       .places = {walls.place}});
  walls_.push_back(std::move(sheet.sheet));
}

void BodyBuilder::add_bodies(std::vector<SurfaceCell> cells, const MaterialSurface& from,
                             const std::vector<SurfaceRegion>& groups) {
  std::set<std::string> used;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    SurfaceCell& cell = cells[k];
    cells_.insert(input_.bodies.size());
    std::string name = cells.size() == 1 ? from.name : cell_name(cell, k + 1, from, used);
    input_.bodies.push_back(
        {std::move(name), k == 0 ? from.tag : free_tag(), from.file, std::move(cell.surface), groups});
  }
}

std::string BodyBuilder::cell_name(const SurfaceCell& cell, std::size_t number, const MaterialSurface& from,
                                   std::set<std::string>& used) const {
  if (cell.group && *cell.group < from.surface.groups.size()) {
    const std::string& group = from.surface.groups[*cell.group].name;
    if (!group.empty() && used.insert(group).second) return group;
  }
  return from.name + "_" + std::to_string(number);
}

void BodyBuilder::report_cells(const DividedSurface& divided, const InnerWalls& walls,
                               std::vector<Diagnostic>& findings) const {
  if (divided.cells.size() > 1)
    add_finding(findings, DiagnosticCode::cells_separated, "cells between the inner walls of a surface",
                divided.cells.size(), divided.cells[0].surface.points[0], "each a material of its own");
  add_finding(findings, DiagnosticCode::inner_walls_dropped,
              "triangles of sheets that bound no cell, with an area of " + short_number(walls.dropped_area),
              walls.dropped, walls.dropped_place, "left out");
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
