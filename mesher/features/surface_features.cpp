// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/surface_features.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/geometry/projection_tree.h"
#include "mesher/domain/material_field.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/complex_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Size of the cells that resolve a body's patches. Bodies that are thin everywhere get smaller cells.
double patch_cell(const RepairedSurface& surface, const MesherOptions& options, double cell) {
  if (options.uniform || surface.closed < surface.triangles.size()) return cell;
  const double mean_thickness = 2 * std::abs(surface.volume) / surface.area;
  const int halvings = options.max_refinement.value_or(max_wall_refinement);
  return std::clamp(mean_thickness, std::ldexp(cell, -halvings), cell);
}

/// The patches of all bodies.
std::vector<SurfacePatches> patches_of_bodies(const MesherInput& input, const MesherOptions& options,
                                              double cell) {
  constexpr std::size_t max_patches = 0xfffe;  // one more is for faces that lie on no surface
  std::size_t count = 0;
  std::vector<SurfacePatches> patches;
  for (const MesherInput::Body& body : input.bodies) {
    const RepairedSurface& surface = body.surface;
    const double shown = patch_cell(surface, options, cell);
    PatchOptions patch_options{options.feature_angle, CellTuning::Patches::min_area * shown * shown, true};
    // Intersections of parts are creases that are not edges of the surface.
    const bool intersecting =
        surface.intersects_itself && options.feature_angle.rule != FeatureAngle::Rule::off;
    if (intersecting) patch_options.angle.rule = FeatureAngle::Rule::off;
    SurfacePatches found =
        find_patches(surface.points, surface.triangles, patch_options, surface.groups, body.file);
    if (intersecting) {
      found.verdict = SurfacePatches::Verdict::intersecting;
      patch_options.angle = options.feature_angle;
      found.chains = find_crease_chains(surface.points, surface.triangles, patch_options, surface.groups);
      found.chains.give_up();
    }
    count += found.count;
    if (count > max_patches)
      throw InputError(
          body.file, 0,
          "the surfaces have more than " + std::to_string(max_patches) +
              " patches between sharp edges; use a larger --feature-angle, or --feature-angle off");
    patches.push_back(std::move(found));
  }
  return patches;
}

/// The patches of the sheets inside bodies.
SheetPatches patches_of_sheets(const MesherInput& input, const MesherOptions& options, double cell) {
  SheetPatches result;
  if (!input.complex || input.complex->sheets.empty()) return result;
  const LabelledComplex& complex = *input.complex;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> groups;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbers;
  for (const LabelledComplex::SheetFace& f : complex.sheets) {
    triangles.push_back(f.ids);
    groups.push_back(
        numbers.try_emplace({f.component, f.region, f.sheet}, static_cast<std::uint32_t>(numbers.size()))
            .first->second);
  }
  result.found = find_patches(complex.points, triangles,
                              {options.feature_angle, CellTuning::Patches::min_area * cell * cell}, groups,
                              input.sheets[0].file);
  result.continued = ComplexTuning::Sheets::continued * cell;
  return result;
}

/// Drops the creases of a body except the borders of groups.
void give_up_creases(const MesherInput::Body& body, SurfacePatches& found) {
  if (!found.any()) return;
  PatchOptions options;
  options.angle.rule = FeatureAngle::Rule::off;
  CreaseChains chains = std::move(found.chains);
  found = find_patches(body.surface.points, body.surface.triangles, options, body.surface.groups, body.file);
  found.verdict = SurfacePatches::Verdict::meeting;
  found.chains = std::move(chains);
  found.chains.give_up();
}

/// Drops the creases of surfaces that meet others. The curves in which they meet are accurate to half a cell
/// only, and no well-shaped tets fit between these and exact creases.
void give_up_where_surfaces_meet(const MesherInput& input, const TetMesh& mesh,
                                 std::vector<SurfacePatches>& patches) {
  if (input.bodies.size() == 1) return;
  std::map<MaterialTag, std::size_t> bodies;
  for (const MaterialLayer& layer : input.layers) bodies[layer.tag] = 0;
  for (std::size_t b = 0; b < input.bodies.size(); ++b) bodies[input.bodies[b].tag] = b;
  std::vector<const InterfaceTriangle*> first_at(mesh.points.size(), nullptr);
  std::set<std::size_t> meeting;
  const auto add = [&](const InterfaceTriangle& t) {
    for (const MaterialOrOutside material : {MaterialOrOutside(t.material), t.other})
      if (const auto body = material ? bodies.find(*material) : bodies.end(); body != bodies.end())
        meeting.insert(body->second);
  };
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) {
      if (!first_at[p]) first_at[p] = &t;
      if (first_at[p]->pair() == t.pair()) continue;
      add(*first_at[p]);
      add(t);
    }
  for (const std::size_t b : meeting) give_up_creases(input.bodies[b], patches[b]);
}

/// Drops the creases of surfaces whose own gaps are closed over more than a small part of their area, since
/// such creases would lie inside the solid.
void give_up_where_gaps_are_closed(const MesherInput& input, const MesherReport& report,
                                   std::vector<SurfacePatches>& patches) {
  for (std::size_t b = 0; b < patches.size(); ++b) {
    double closed = 0;
    for (const ClosedGapReport& g : report.closed_gaps)
      if (g.gap && g.name == input.bodies[b].name) closed += g.area;
    if (closed > CellTuning::WallBudget::max_closed_share * input.bodies[b].surface.area)
      give_up_creases(input.bodies[b], patches[b]);
  }
}

/// The edges with one triangle, around holes that are not flat: the mesh rounds into their caps.
ProjectionTree open_rims(const RepairedSurface& surface) {
  std::vector<ProjectionTree::Item> segments;
  const std::vector<EdgeUse> uses = edge_uses(surface.triangles, {});
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    const auto [a, b] = ends_of(uses[i].key);
    if (j - i == 1) segments.push_back({{a, b, b}, {}});
  }
  return {surface.points, std::move(segments)};
}

/// Leaves out what is nearer to some curves than `reach`.
CreaseCurves away_from(const CreaseCurves& creases, const ProjectionTree& curves, double reach) {
  CreaseCurves kept;
  const auto is_near = [&](const Vec3& p) { return curves.any_within(p, reach); };
  for (const auto& [a, b] : creases.segments) {
    const Vec3 &from = creases.points[a], &to = creases.points[b];
    // Long segments lose only their ends.
    const int pieces = std::max(1, static_cast<int>(std::ceil((to - from).norm() / reach)));
    for (int k = 0; k < pieces; ++k) {
      const Vec3 p = from + (to - from) * k / pieces, q = from + (to - from) * (k + 1) / pieces;
      if (is_near(p) || is_near(q)) continue;
      const auto first = static_cast<Index>(kept.points.size());
      kept.points.insert(kept.points.end(), {p, q});
      kept.segments.push_back({first, first + 1});
    }
  }
  std::copy_if(creases.corners.begin(), creases.corners.end(), std::back_inserter(kept.corners),
               [&](const Vec3& p) { return !is_near(p); });
  return kept;
}

/// Reports patches and creases. Omits the creases of surfaces that meet others or themselves, as they may lie
/// inside the solid, and those at open rims.
void report_features(const MesherInput& input, const std::vector<SurfacePatches>& patches,
                     MesherReport& report) {
  for (std::size_t b = 0; b < patches.size(); ++b) {
    const RepairedSurface& surface = input.bodies[b].surface;
    const bool exact = patches[b].verdict != SurfacePatches::Verdict::meeting &&
                       patches[b].verdict != SurfacePatches::Verdict::intersecting;
    if (patches[b].any() && exact && !input.complex) {
      CreaseCurves creases;
      creases.add(find_creases(surface.points, surface.triangles, patches[b].patches,
                               CellTuning::Patches::corner_reach * report.cell_size, patches[b].rough),
                  surface.points);
      if (surface.closed < surface.triangles.size())
        creases = away_from(creases, open_rims(surface), CellTuning::Patches::rim_reach * report.cell_size);
      report.creases.add(creases);
    }
    report.features.push_back({input.bodies[b].name, patches[b]});
    report.features.back().found.patches = {};
    report.features.back().found.rough = {};
  }
}

/// The lines in which bodies touch without a common face.
ProjectionTree touching_lines(const ComplexPatches& complex) {
  std::vector<ProjectionTree::Item> segments;
  for (const auto& [a, b] : complex.touching) segments.push_back({{a, b, b}, {}});
  return {complex.points, std::move(segments)};
}

/// Reports the creases of a complex: for each sheet, those between its patches. Omits those at lines in which
/// bodies touch, where the mesh joins them over a few cells.
void report_complex_creases(const MesherInput& input, const ComplexPatches& found, MesherReport& report) {
  std::vector<std::vector<Triangle>> triangles(found.sheets.size());
  std::vector<std::vector<std::uint16_t>> of_triangles(found.sheets.size());
  for (std::size_t t = 0; t < input.complex->faces.size(); ++t) {
    const std::size_t sheet = found.sheet_of_patch[found.patches[t]];
    triangles[sheet].push_back(found.triangles[t]);
    of_triangles[sheet].push_back(found.patches[t]);
  }
  CreaseCurves creases;
  for (std::size_t s = 0; s < triangles.size(); ++s)
    creases.add(find_creases(input.complex->points, triangles[s], of_triangles[s],
                             CellTuning::Patches::corner_reach * report.cell_size, found.rough),
                input.complex->points);
  if (const ProjectionTree lines = touching_lines(found); !lines.empty())
    creases = away_from(creases, lines, CellTuning::Patches::rim_reach * report.cell_size);
  report.creases.add(creases);
}

/// Drops creases that later bodies carve away, and creases near curves where three regions meet, which are
/// accurate to half a cell only.
void keep_visible(CreaseCurves& creases, const MesherInput& input, const DenseMesh& dense) {
  if (input.bodies.size() == 1) return;
  const double near = CellTuning::Patches::junction_reach * dense.report.cell_size;
  CreaseCurves junctions = mesh_junctions(dense.mesh);
  std::vector<ProjectionTree::Item> segments;
  segments.reserve(junctions.segments.size());
  for (const auto& [a, b] : junctions.segments) segments.push_back({{a, b, b}, {}});
  const ProjectionTree tree(std::move(junctions.points), std::move(segments));
  const auto is_hidden = [&](const Vec3& p) {
    if (tree.nearest(p, {}, near)) return true;
    const auto shows = [&](MaterialTag tag) {
      return std::abs(dense.field->signed_distance(p, tag)) <= near;
    };
    return std::none_of(input.bodies.begin(), input.bodies.end(),
                        [&](const auto& b) { return shows(b.tag); }) &&
           std::none_of(input.layers.begin(), input.layers.end(),
                        [&](const auto& l) { return shows(l.tag); });
  };
  std::erase_if(creases.segments, [&](const std::array<Index, 2>& s) {
    return is_hidden(creases.points[s[0]]) || is_hidden(creases.points[s[1]]) ||
           is_hidden((creases.points[s[0]] + creases.points[s[1]]) / 2);
  });
  std::erase_if(creases.corners, is_hidden);
}

/// Sets the slack of volumes derived from distances, which chamfer creases that the mesh keeps sharp.
void allow_for_chamfers(MesherReport& report) {
  double length = 0;
  for (const auto& [a, b] : report.creases.segments)
    length += (report.creases.points[b] - report.creases.points[a]).norm();
  for (ExpectedSolid& e : report.expected)
    if (e.flaw != SurfaceFlaw::none) e.volume_slack = 0.5 * length * report.cell_size * report.cell_size;
}

}  // namespace

SurfaceFeatures find_features(const MesherInput& input, const MesherOptions& options, double cell) {
  return {patches_of_bodies(input, options, cell), patches_of_sheets(input, options, cell), {}};
}

bool has_features(const MesherInput& input, const SurfaceFeatures& features) {
  return input.complex ||
         std::any_of(features.bodies.begin(), features.bodies.end(), [](const auto& p) { return p.any(); }) ||
         std::any_of(input.bodies.begin(), input.bodies.end(),
                     [](const MesherInput::Body& body) { return !body.surface.groups.empty(); });
}

bool are_exact(const SurfaceFeatures& features) {
  return std::none_of(features.bodies.begin(), features.bodies.end(), [](const SurfacePatches& p) {
    return p.verdict == SurfacePatches::Verdict::meeting && p.any();
  });
}

void settle_features(const MesherInput& input, SurfaceFeatures& features, DenseMesh& dense) {
  if (!input.complex) give_up_where_surfaces_meet(input, dense.mesh, features.bodies);
  give_up_where_gaps_are_closed(input, dense.report, features.bodies);
  report_features(input, features.bodies, dense.report);
  if (input.complex) {
    features.complex = complex_patches(input, features.bodies, features.sheets, dense.report.cell_size);
    report_complex_creases(input, *features.complex, dense.report);
  } else if (has_features(input, features)) {
    keep_visible(dense.report.creases, input, dense);
  }
  allow_for_chamfers(dense.report);
}

}  // namespace tetwright
