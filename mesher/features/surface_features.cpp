// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/surface_features.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "common/features/crease_pieces.h"
#include "common/features/edge_uses.h"
#include "common/geometry/projection_tree.h"
#include "mesher/domain/material_field.h"
#include "mesher/sizing/thin_bodies.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/complex_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Size of the cells that resolve a body's patches. Bodies that are thin everywhere get smaller cells.
double patch_cell(const RepairedSurface& surface, const MesherOptions& options, double cell) {
  if (options.uniform || surface.closed < surface.triangles.size()) return cell;
  const int halvings = options.max_refinement.value_or(max_wall_refinement);
  return std::clamp(mean_thickness(surface), std::ldexp(cell, -halvings), cell);
}

/// How the patches of each body are found.
/// \param cells at each body, or empty
PatchOptions patch_options(const MesherInput& input, std::size_t body, const MesherOptions& options,
                           double cell, const std::vector<double>& cells) {
  const double shown = cells.empty() ? patch_cell(input.bodies[body].surface, options, cell) : cells[body];
  return {options.feature_angle, CellTuning::Patches::min_area * shown * shown, true};
}

/// The patches of all bodies.
std::vector<SurfacePatches> patches_of_bodies(const MesherInput& input,
                                              const std::vector<PatchOptions>& options) {
  constexpr std::size_t max_patches = 0xfffe;  // one more is for faces that lie on no surface
  std::size_t count = 0;
  std::vector<SurfacePatches> patches;
  for (std::size_t b = 0; b < input.bodies.size(); ++b) {
    const MesherInput::Body& body = input.bodies[b];
    const RepairedSurface& surface = body.surface;
    patches.push_back(find_patches(surface.points, surface.triangles, options[b], surface.groups, body.file));
    count += patches.back().count;
    if (count > max_patches)
      throw InputError(
          body.file, 0,
          "the surfaces have more than " + std::to_string(max_patches) +
              " patches between sharp edges; use a larger --feature-angle, or --feature-angle off");
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

using Causes = std::vector<GivenUpZone::Causes>;

/// Adds the points where surfaces meet that are not joined. The curves in which they meet are accurate to
/// half a cell only, and no well-shaped tets fit between these and exact creases.
void add_meetings(const MesherInput& input, const TetMesh& mesh, Causes& causes) {
  if (input.bodies.size() == 1) return;
  std::map<MaterialTag, std::size_t> bodies;
  for (const MaterialLayer& layer : input.layers) bodies[layer.tag] = 0;
  for (std::size_t b = 0; b < input.bodies.size(); ++b) bodies[input.bodies[b].tag] = b;
  // Labels around the bodies are like the outside.
  using Pair = std::pair<MaterialOrOutside, MaterialOrOutside>;
  const auto pair_of = [&](const InterfaceTriangle& t) {
    Pair pair = t.pair();
    for (MaterialOrOutside* material : {&pair.first, &pair.second})
      if (*material && !bodies.contains(**material)) material->reset();
    return pair.first < pair.second ? pair : Pair(pair.second, pair.first);
  };
  std::vector<std::optional<Pair>> first_at(mesh.points.size());
  std::vector<std::uint8_t> is_junction(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const Pair pair = pair_of(t);
    if (!pair.second) continue;
    for (const Index p : t.ids) {
      if (!first_at[p]) first_at[p] = pair;
      is_junction[p] |= *first_at[p] != pair;
    }
  }
  std::set<std::pair<std::size_t, Index>> meeting;
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) {
      if (!is_junction[p]) continue;
      for (const MaterialOrOutside material : {MaterialOrOutside(t.material), t.other})
        if (const auto body = material ? bodies.find(*material) : bodies.end(); body != bodies.end())
          meeting.insert({body->second, p});
    }
  for (const auto& [body, p] : meeting) causes[body].add(mesh.points[p]);
}

/// Where creases of bodies are given up.
GivenUpZone find_given_up(const MesherInput& input, const std::vector<std::vector<Vec3>>& closed_gaps,
                          const std::vector<SurfacePatches>& patches, const DenseMesh& dense, double cell) {
  Causes causes(patches.size());
  if (!input.complex) add_meetings(input, dense.mesh, causes);
  for (std::size_t b = 0; b < patches.size(); ++b) {
    for (const Vec3& p : closed_gaps[b]) causes[b].add(p);
    if (input.bodies[b].surface.intersects_itself && patches[b].any())
      add_self_crossings(input.bodies[b].surface, causes[b]);
    if (!patches[b].any()) causes[b] = {};
  }
  return {std::move(causes), cell};
}

/// Where creases of bodies are lost: where they are given up, and where a body that crosses itself has them
/// inside the solid or outside of it, away from the mesh's boundary.
class LostCreases {
 public:
  LostCreases(const MesherInput& input, const GivenUpZone& zone, const DenseMesh& dense, double cell)
      : input_(input), zone_(zone), near_(CellTuning::Patches::junction_reach * cell) {
    const auto crosses_itself = [](const MesherInput::Body& body) { return body.surface.intersects_itself; };
    if (!zone.any() || std::none_of(input.bodies.begin(), input.bodies.end(), crosses_itself)) return;
    std::vector<ProjectionTree::Item> faces;
    faces.reserve(dense.mesh.interfaces.size());
    for (const InterfaceTriangle& t : dense.mesh.interfaces) faces.push_back({t.ids, {}});
    boundary_ = ProjectionTree(dense.mesh.points, std::move(faces));
  }

  const GivenUpZone& zone() const { return zone_; }
  bool contains(const Vec3& p, std::size_t body) const {
    return zone_.affects(p, body) || (input_.bodies[body].surface.intersects_itself && !boundary_.empty() &&
                                      !boundary_.any_within(p, near_));
  }

 private:
  const MesherInput& input_;
  const GivenUpZone& zone_;
  double near_;
  ProjectionTree boundary_;
};

/// Sets the fate of the sharp edges of a body that are lost. If no crease is left, the patches become those
/// of groups.
void give_up_creases(const MesherInput& input, std::size_t number, const LostCreases& lost,
                     SurfaceFeatures& features) {
  using Fate = CreaseChain::Fate;
  using Verdict = SurfacePatches::Verdict;
  const GivenUpZone& zone = features.given_up;
  SurfacePatches& found = features.bodies[number];
  if (!zone.has(number) || found.verdict != Verdict::part) return;
  const MesherInput::Body& body = input.bodies[number];
  const RepairedSurface& surface = body.surface;
  CreaseChains chains = find_crease_chains(
      surface.points, surface.triangles, features.options[number], surface.groups,
      [&](const Vec3& p) { return lost.contains(p, number); }, zone.piece());
  if (chains.total(Fate::kept).count == 0 && chains.total(Fate::given_up).count > 0) {
    PatchOptions off;
    off.angle.rule = FeatureAngle::Rule::off;
    found = find_patches(surface.points, surface.triangles, off, surface.groups, body.file);
    found.verdict = zone.has_only_crossings(number) ? Verdict::intersecting : Verdict::meeting;
  }
  found.chains = std::move(chains);
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

/// Leaves out what is in a region, and of long segments only the part there.
/// \param piece max length of the parts that are left out as a whole
template <class IsLost>
CreaseCurves without(const CreaseCurves& creases, double piece, const IsLost& is_lost) {
  CreaseCurves kept;
  kept.points = creases.points;
  for (const auto& [a, b] : creases.segments) {
    Index from = a;
    for_each_run(
        creases.points[a], creases.points[b], piece,
        [&](const Vec3& p, const Vec3& q) { return is_lost(p) || is_lost(q); },
        [&, end = b](const Vec3&, const Vec3& q, bool lost) {
          const bool is_last = q == creases.points[end];
          const Index to = is_last ? end : static_cast<Index>(kept.points.size());
          if (!is_last) kept.points.push_back(q);
          if (!lost) kept.segments.push_back({from, to});
          from = to;
        });
  }
  std::copy_if(creases.corners.begin(), creases.corners.end(), std::back_inserter(kept.corners),
               [&](const Vec3& p) { return !is_lost(p); });
  return kept;
}

/// Leaves out what is nearer to some curves than `reach`.
CreaseCurves away_from(const CreaseCurves& creases, const ProjectionTree& curves, double reach) {
  return without(creases, reach, [&](const Vec3& p) { return curves.any_within(p, reach); });
}

/// The size of the cells at a body.
double cell_of(const SurfaceFeatures& features, std::size_t body) {
  return features.cells.empty() ? features.cell : features.cells[body];
}

/// Reports patches and creases. Omits creases that are given up, and those at open rims, where the mesh
/// rounds into the cap of a hole.
void report_features(const MesherInput& input, const SurfaceFeatures& features, const LostCreases& lost,
                     MesherReport& report) {
  const std::vector<SurfacePatches>& patches = features.bodies;
  for (std::size_t b = 0; b < patches.size(); ++b) {
    const RepairedSurface& surface = input.bodies[b].surface;
    if (patches[b].any() && !input.complex) {
      CreaseCurves creases;
      creases.add(find_creases(surface.points, surface.triangles, patches[b].patches,
                               CellTuning::Patches::corner_reach * cell_of(features, b), patches[b].rough),
                  surface.points);
      if (surface.closed < surface.triangles.size())
        creases =
            away_from(creases, open_rims(surface), CellTuning::Patches::rim_reach * cell_of(features, b));
      if (lost.zone().has(b))
        creases = without(creases, lost.zone().piece(), [&](const Vec3& p) { return lost.contains(p, b); });
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

/// Reports the creases of a complex: for each sheet, those between its patches that are not given up. Omits
/// those at lines in which bodies touch, where the mesh joins them over a few cells.
void report_complex_creases(const MesherInput& input, const ComplexPatches& found, const LostCreases& lost,
                            double cell, MesherReport& report) {
  std::vector<std::vector<Triangle>> triangles(found.sheets.size());
  std::vector<std::vector<std::uint16_t>> of_triangles(found.sheets.size());
  for (std::size_t t = 0; t < input.complex->faces.size(); ++t) {
    const std::size_t sheet = found.sheet_of_patch[found.patches[t]];
    triangles[sheet].push_back(found.triangles[t]);
    of_triangles[sheet].push_back(found.patches[t]);
  }
  std::vector<std::pair<RegionIndex, RegionIndex>> regions(triangles.size());
  for (const auto& [pair, sheet] : found.sheets) regions[sheet] = pair;
  const ProjectionTree lines = touching_lines(found);
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    CreaseCurves creases;
    creases.add(find_creases(input.complex->points, triangles[s], of_triangles[s],
                             CellTuning::Patches::corner_reach * cell, found.rough),
                input.complex->points);
    if (lost.zone().any())
      creases = without(creases, lost.zone().piece(), [&](const Vec3& p) {
        const auto is_given_up = [&](RegionIndex r) {
          return r != outside_region && lost.contains(p, std::size_t{r} - 1);
        };
        return is_given_up(regions[s].first) || is_given_up(regions[s].second);
      });
    if (!lines.empty()) creases = away_from(creases, lines, CellTuning::Patches::rim_reach * cell);
    report.creases.add(creases);
  }
}

/// The faces of bodies.
ProjectionTree body_faces(const MesherInput& input, const TetMesh& mesh) {
  const auto is_body = [&](MaterialOrOutside m) {
    return m && std::any_of(input.bodies.begin(), input.bodies.end(),
                            [&](const MesherInput::Body& b) { return b.tag == *m; });
  };
  std::vector<ProjectionTree::Item> faces;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (is_body(t.material) || is_body(t.other)) faces.push_back({t.ids, {}});
  return {mesh.points, std::move(faces)};
}

/// Drops creases that later bodies or protected labels cover, and creases near `junctions`, curves where
/// three regions meet, which are accurate to half a cell only.
/// \param faces of all bodies, or null: distances tell where these are, except beside protected labels
void keep_visible(CreaseCurves& creases, const MesherInput& input, const DenseMesh& dense, double cell,
                  CreaseCurves junctions, const ProjectionTree* faces = nullptr) {
  const double near = CellTuning::Patches::junction_reach * cell;
  std::vector<ProjectionTree::Item> segments;
  segments.reserve(junctions.segments.size());
  for (const auto& [a, b] : junctions.segments) segments.push_back({{a, b, b}, {}});
  const ProjectionTree tree(std::move(junctions.points), std::move(segments));
  const auto is_hidden = [&](const Vec3& p) {
    if (tree.nearest(p, {}, near)) return true;
    if (faces) return !faces->nearest(p, {}, near);
    const auto shows = [&](const auto& material) {
      return std::abs(dense.field->signed_distance(p, material.tag)) <= near;
    };
    return std::none_of(input.bodies.begin(), input.bodies.end(), shows) &&
           std::none_of(input.layers.begin(), input.layers.end(), shows);
  };
  std::erase_if(creases.segments, [&](const std::array<Index, 2>& s) {
    return is_hidden(creases.points[s[0]]) || is_hidden(creases.points[s[1]]) ||
           is_hidden((creases.points[s[0]] + creases.points[s[1]]) / 2);
  });
  std::erase_if(creases.corners, is_hidden);
}

/// Sets the slack of volumes derived from distances, which chamfer creases that the mesh keeps sharp.
void allow_for_chamfers(double cell, MesherReport& report) {
  double length = 0;
  for (const auto& [a, b] : report.creases.segments)
    length += (report.creases.points[b] - report.creases.points[a]).norm();
  for (ExpectedSolid& e : report.expected)
    if (e.flaw != SurfaceFlaw::none) e.volume_slack = 0.5 * length * cell * cell;
}

}  // namespace

SurfaceFeatures find_features(const MesherInput& input, const MesherOptions& options, double cell,
                              std::vector<double> cells) {
  SurfaceFeatures found;
  for (std::size_t b = 0; b < input.bodies.size(); ++b)
    found.options.push_back(patch_options(input, b, options, cell, cells));
  found.bodies = patches_of_bodies(input, found.options);
  found.sheets = patches_of_sheets(input, options, cell);
  found.cell = cell;
  found.cells = std::move(cells);
  return found;
}

bool has_features(const MesherInput& input, const SurfaceFeatures& features) {
  return input.complex ||
         std::any_of(features.bodies.begin(), features.bodies.end(), [](const auto& p) { return p.any(); }) ||
         std::any_of(input.bodies.begin(), input.bodies.end(),
                     [](const MesherInput::Body& body) { return !body.surface.groups.empty(); });
}

void settle_features(const MesherInput& input, const std::vector<std::vector<Vec3>>& closed_gaps,
                     SurfaceFeatures& features, DenseMesh& dense, Surroundings around) {
  features.given_up = find_given_up(input, closed_gaps, features.bodies, dense, features.cell);
  const LostCreases lost(input, features.given_up, dense, features.cell);
  for (std::size_t b = 0; b < features.bodies.size(); ++b) give_up_creases(input, b, lost, features);
  report_features(input, features, lost, dense.report);
  if (input.complex) {
    features.complex = complex_patches(input, features.bodies, features.sheets, features.cell);
    report_complex_creases(input, *features.complex, lost, features.cell, dense.report);
  } else if (input.bodies.size() > 1 && around == Surroundings::outside && has_features(input, features)) {
    keep_visible(dense.report.creases, input, dense, features.cell, mesh_junctions(dense.mesh));
  }
  // Labels end at the surfaces of bodies, whose creases stay exact there.
  // Beside protected labels only those away from the curves in which bodies end are certain.
  if (around == Surroundings::protected_labels) {
    const ProjectionTree faces = body_faces(input, dense.mesh);
    keep_visible(dense.report.creases, input, dense, features.cell, mesh_junctions(dense.mesh), &faces);
  } else if (around == Surroundings::labels && input.bodies.size() > 1) {
    keep_visible(dense.report.creases, input, dense, features.cell, {});
  }
  allow_for_chamfers(features.cell, dense.report);
}

}  // namespace tetwright
