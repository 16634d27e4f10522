// SPDX-License-Identifier: Apache-2.0
#include "tetwright/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/features/inner_edges.h"
#include "common/geometry/predicates.h"
#include "common/geometry/projection_tree.h"
#include "common/message_text.h"
#include "common/tolerances.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher_input.h"
#include "tools/compare/surface_caps.h"

namespace tetwright {

namespace {

/// Angle of the creases of a mesh. Creases of its surface are found by find_patches(), automatic, which uses
/// the same angle.
constexpr double crease_degrees = 35;
/// Minimum turn of an edge that counts as the counterpart of a crease: an edge must not be missed because it
/// turns slightly less than a crease.
constexpr double counterpart_degrees = crease_degrees / 2;

/// Maximum fraction of the mesh's area that caps over holes may cover; beyond it the surface is not a scan of
/// this body.
constexpr double max_cap_share = 0.5;

/// Tets without the outside; reoriented if all of them are inverted.
TetMesh compared_tets(const TetMesh& mesh, SurfaceComparison& c) {
  TetMesh part;
  part.points = mesh.points;
  const auto is_outside = [&](MaterialTag tag) {
    const auto name = mesh.material_names.find(tag);
    return name != mesh.material_names.end() && name->second == outside_name;
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (is_outside(mesh.materials[t])) continue;
    part.tets.push_back(mesh.tets[t]);
    part.materials.push_back(mesh.materials[t]);
  }
  c.outside_tets = mesh.tets.size() - part.tets.size();
  if (part.tets.empty())
    throw UsageError(
        "all tets of the mesh have the material 'outside', so it has no part to compare with surfaces; "
        "rename that material, or leave out --surface");
  c.inverted = std::all_of(part.tets.begin(), part.tets.end(), [&](const Tet& t) {
    return orient3d(part.points[t[0]], part.points[t[1]], part.points[t[2]], part.points[t[3]]) < 0;
  });
  if (c.inverted)
    for (Tet& t : part.tets) std::swap(t[2], t[3]);
  return part;
}

/// Part of the mesh to be compared. For a single surface, its boundary as that of one material.
TetMesh compared_part(const TetMesh& mesh, bool with_interfaces, SurfaceComparison& c) {
  TetMesh part = compared_tets(mesh, c);
  std::vector<InterfaceTriangle> all =
      c.outside_tets > 0 || c.inverted ? find_interfaces(part) : mesh.interfaces;
  std::erase_if(all, [](const InterfaceTriangle& t) { return t.is_sheet(); });
  for (InterfaceTriangle& t : all) {
    t.patch = 0;
    if (!with_interfaces && !t.other) t.material = 0;
  }
  if (!with_interfaces) std::erase_if(all, [](const InterfaceTriangle& t) { return t.other.has_value(); });
  part.interfaces = std::move(all);
  part.tets.clear();
  part.materials.clear();
  return part;
}

ProjectionTree tree_of(const TetMesh& mesh) {
  std::vector<ProjectionTree::Item> items;
  for (const InterfaceTriangle& t : mesh.interfaces) items.push_back({t.ids, {}});
  return {mesh.points, std::move(items)};
}

ProjectionTree tree_of(const std::vector<TriangleMesh>& surfaces) {
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> items;
  for (const TriangleMesh& s : surfaces) {
    const auto first = static_cast<Index>(points.size());
    points.insert(points.end(), s.points.begin(), s.points.end());
    for (const Triangle& t : s.triangles) items.push_back({{first + t[0], first + t[1], first + t[2]}, {}});
  }
  return {std::move(points), std::move(items)};
}

/// Surfaces as `prepare` uses them: equal points merged, triangles oriented consistently.
MesherInput repaired(const std::vector<TriangleMesh>& surfaces, const std::vector<std::string>& names) {
  std::vector<MaterialSurface> materials;
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    materials.push_back({"",
                         static_cast<MaterialTag>(i + 1),
                         {.points = surfaces[i].points, .triangles = surfaces[i].triangles},
                         names[i]});
  // Caps are no part of the surfaces to compare with.
  CapOptions caps;
  caps.close_flat = false;
  caps.open.accept_sheets = true;
  return make_mesher_input(std::move(materials), {}, NestedRule::automatic, {}, {}, nullptr, {}, caps);
}

/// Returns std::nullopt unless the surface is closed. `mesh` has its boundary as that of one material.
std::optional<SolidComparison> compare_solid(const TetMesh& mesh, const MesherInput::Body& body) {
  const RepairedSurface& surface = body.surface;
  if (surface.closed < surface.triangles.size()) return {};
  ExpectedSolid expected;
  expected.name = body.file;
  expected.shape = solid_shape(surface.points, surface.triangles);
  if (!expected.shape.manifold) return {};
  return compare_solids({expected}, mesh).front();
}

/// Measures the distance of the mesh from open surfaces, and of its caps.
void compare_open(const CapFinder::Parts& parts, const ProjectionTree& surfaces, double accuracy,
                  SurfaceComparison& c) {
  c.from_mesh = surface_deviation(parts.kept, surfaces, accuracy);
  if (parts.caps.empty()) return;
  c.caps = {surface_deviation(parts.caps, surfaces, accuracy), parts.cap_area, parts.cap_area / parts.area};
}

/// Edges that turn by more than `counterpart_degrees`, whether or not they are creases.
CreaseCurves counterparts(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  SurfaceCreases sharp;
  for (const InnerEdge& e : inner_edges(points, triangles, edge_uses(triangles, {})))
    if (e.turn > counterpart_degrees * std::numbers::pi / 180) sharp.segments.push_back({e.ends, {}});
  CreaseCurves curves;
  curves.add(sharp, points);
  return curves;
}

/// Compares the creases of both; those of the mesh only if the surfaces have any.
void compare_creases_of(TetMesh& mesh, const MesherInput& surfaces, const OpenEdges& open,
                        const CapFinder& caps, SurfaceComparison& c) {
  CreaseCurves expected;
  std::vector<CreaseCurves> of_surfaces;
  std::vector<Vec3> surface_points;
  for (const MesherInput::Body& body : surfaces.bodies) {
    const RepairedSurface& s = body.surface;
    of_surfaces.push_back(counterparts(s.points, s.triangles));
    surface_points.insert(surface_points.end(), s.points.begin(), s.points.end());
    c.intersecting |= s.intersects_itself;
    const SurfacePatches patches = find_patches(s.points, s.triangles, {}, {}, body.file);
    // Where parts intersect there are creases that are not edges, and some creases are inside the solid.
    if (s.intersects_itself)
      c.creases_left_out |= patches.any();
    else if (patches.any())
      expected.add(find_creases(s.points, s.triangles, patches.patches, 0, patches.rough), s.points);
  }
  if (expected.segments.empty()) return;
  of_surfaces.push_back(expected);
  find_mesh_patches(mesh, {FeatureAngle::Rule::degrees, crease_degrees}, "the mesh");
  CreaseCurves of_mesh = mesh_creases(mesh);
  std::vector<CreaseCurves> counterparts_of_mesh{of_mesh, mesh_junctions(mesh)};
  std::map<MaterialPair, std::vector<Triangle>> by_pair;
  std::vector<char> used(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces) {
    by_pair[t.pair()].push_back(t.ids);
    for (const Index p : t.ids) used[p] = 1;
  }
  for (const auto& [pair, triangles] : by_pair)
    counterparts_of_mesh.push_back(counterparts(mesh.points, triangles));
  std::vector<Vec3> mesh_points;
  for (std::size_t p = 0; p < used.size(); ++p)
    if (used[p]) mesh_points.push_back(mesh.points[p]);
  c.creases = compare_creases(expected, counterparts_of_mesh, mesh_points, c.diagonal);
  if (!open.rims.empty()) {
    std::erase_if(of_mesh.segments, [&](const std::array<Index, 2>& s) {
      return caps.is_beyond_rim((of_mesh.points[s[0]] + of_mesh.points[s[1]]) / 2);
    });
    std::erase_if(of_mesh.corners, [&](const Vec3& p) { return caps.is_beyond_rim(p); });
  }
  c.mesh_creases = compare_creases(of_mesh, of_surfaces, surface_points, c.diagonal);
}

std::string length_text(double length, double diagonal) {
  char text[80];
  std::snprintf(text, sizeof text, "%.6g (%.3g %% of the diagonal)", length, 100 * length / diagonal);
  return text;
}

std::string deviation_line(const char* what, const SurfaceDeviation& d, double diagonal) {
  char lower[40];
  std::snprintf(lower, sizeof lower, "%.6g to ", d.lower);
  return std::string(what) + ": at most " + lower + length_text(d.upper, diagonal) + ", at " +
         place_text(d.place) + "; rms " + length_text(d.rms, diagonal);
}

std::string creases_text(const CreaseComparison& c, const std::string& of, const std::string& from) {
  const std::string start = "creases of the " + of + ": ";
  if (!std::isfinite(c.max_distance)) return start + "the " + from + " has none";
  return start + "at most " + length_text(c.max_distance, c.diagonal) + " from those of the " + from +
         ", at " + place_text(c.place) + ", 99 % of them " + length_text(c.p99_distance, c.diagonal);
}

std::string corners_text(const CreaseComparison& c) {
  if (c.corners == 0) return "";
  return "; " + std::to_string(c.lost_corners) + " of its " + std::to_string(c.corners) +
         " corners lost, at most " + length_text(c.max_corner_distance, c.diagonal) +
         " from points of the mesh, at " + place_text(c.corner_place);
}

/// Text such as "75 %".
std::string share_text(double share) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

std::string open_line(const SurfaceComparison& c) {
  const std::string edges = "the surface is open: " + std::to_string(c.open_edges) +
                            (c.open_edges == 1 ? " edge" : " edges") + " with one triangle; ";
  if (!c.caps) return edges + "no part of the mesh is a cap there";
  return edges + "caps of the mesh are left out, area " + short_number(c.caps->area) + " (" +
         share_text(c.caps->share) + "), at most " + length_text(c.caps->from_mesh.upper, c.diagonal) +
         " from the surface, at " + place_text(c.caps->from_mesh.place);
}

}  // namespace

std::vector<SurfaceComparison::Bound> SurfaceComparison::bounds() const {
  const auto bound = [](double upper, const char* what, const char* from, const Vec3& place) {
    const std::string text =
        std::string(what) + " up to " + short_number(upper) + " from " + from + ", at " + place_text(place);
    return Bound{upper, text};
  };
  std::vector<Bound> all{bound(from_mesh.upper, "the mesh is", "the surface", from_mesh.place),
                         bound(from_surfaces.upper, "the surface is", "the mesh", from_surfaces.place)};
  if (caps && caps->share > max_cap_share)
    all.push_back({std::numeric_limits<double>::infinity(),
                   "most of the mesh has no counterpart on the surface: " + share_text(caps->share) +
                       " of its area are caps, up to " + short_number(caps->from_mesh.upper) + " from it"});
  if (creases) {
    if (std::isfinite(creases->max_distance))
      all.push_back(
          bound(creases->max_distance, "creases of the surface are", "those of the mesh", creases->place));
    else
      all.push_back({creases->max_distance, "the mesh has none of the creases of the surface"});
    all.push_back(bound(creases->max_corner_distance, "corners of the surface are", "points of the mesh",
                        creases->corner_place));
  }
  return all;
}

double SurfaceComparison::upper() const {
  double upper = 0;
  for (const Bound& b : bounds()) upper = std::max(upper, b.upper);
  return upper;
}

namespace {

/// Adds the sheets of a mesh that are walls of zero thickness in the files of its surfaces.
TetMesh with_walls(const TetMesh& part, const TetMesh& mesh, const MesherInput& input) {
  TetMesh shown;
  shown.points = part.points;
  shown.interfaces = part.interfaces;
  if (input.sheets.empty()) return shown;
  std::set<std::string> walls, known;
  for (const MesherInput::Sheet& s : input.sheets) walls.insert(s.group.name);
  std::vector<std::pair<InterfaceTriangle, std::string>> sheets;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (!t.is_sheet()) continue;
    const auto group = mesh.patch_groups.find({t.pair(), t.patch});
    sheets.emplace_back(t, group == mesh.patch_groups.end() ? "" : group->second.name);
    if (walls.contains(sheets.back().second)) known.insert(sheets.back().second);
  }
  // Walls without names are called after their body, which the files do not say.
  for (const auto& [triangle, name] : sheets)
    if (known != walls || walls.contains(name)) shown.interfaces.push_back(triangle);
  return shown;
}

}  // namespace

SurfaceComparison compare_with_surfaces(const TetMesh& mesh, const std::vector<TriangleMesh>& surfaces,
                                        const std::vector<std::string>& names) {
  SurfaceComparison c;
  const MesherInput input = repaired(surfaces, names);
  Box3 box;
  for (const TriangleMesh& s : surfaces)
    for (const Triangle& t : s.triangles)
      for (const Index p : t) box.add(s.points[p]);
  c.diagonal = (box.high - box.low).norm();
  TetMesh part = compared_part(mesh, surfaces.size() > 1, c);
  const ProjectionTree of_mesh = tree_of(with_walls(part, mesh, input)), of_surfaces = tree_of(surfaces);
  const double accuracy = tolerance::deviation_share * c.diagonal;
  const OpenEdges open = find_open_edges(input);
  c.open_edges = open.count;
  const CapFinder cap_finder(of_surfaces, open.rims, c.diagonal);
  if (open.rims.empty())
    c.from_mesh = surface_deviation(of_mesh, of_surfaces, accuracy);
  else
    compare_open(cap_finder.split(part), of_surfaces, accuracy, c);
  c.from_surfaces = surface_deviation(of_surfaces, of_mesh, accuracy);
  if (input.bodies.size() == 1) c.solid = compare_solid(part, input.bodies.front());
  compare_creases_of(part, input, open, cap_finder, c);
  return c;
}

std::vector<std::string> comparison_lines(const SurfaceComparison& c) {
  std::vector<std::string> lines;
  if (c.outside_tets > 0)
    lines.push_back("not compared with the surface: the " + std::to_string(c.outside_tets) +
                    " tets of the material 'outside'");
  if (c.inverted)
    lines.emplace_back(
        "all tets are inverted; compared with the surface as if their orientation were reversed");
  if (c.open_edges > 0) lines.push_back(open_line(c));
  lines.push_back(deviation_line("distance of the mesh from the surface", c.from_mesh, c.diagonal));
  lines.push_back(deviation_line("distance of the surface from the mesh", c.from_surfaces, c.diagonal));
  if (c.solid) {
    char volumes[120];
    std::snprintf(volumes, sizeof volumes, "volume %.6g, of the surface %.6g; ", c.solid->result.volume,
                  c.solid->expected.volume);
    lines.push_back(volumes +
                    (c.solid->same() ? "same components, handles and cavities" : c.solid->difference) +
                    (c.solid->place ? ", at " + place_text(*c.solid->place) : "") +
                    (c.intersecting && !c.solid->same()
                         ? "; the surface intersects itself, and its parts count as if they were separate"
                         : ""));
  } else {
    lines.emplace_back("volume and topology: not compared; that requires one closed surface");
  }
  if (c.creases_left_out)
    lines.emplace_back("creases of the surface: not compared; the surface intersects itself");
  if (c.creases) lines.push_back(creases_text(*c.creases, "surface", "mesh") + corners_text(*c.creases));
  if (c.mesh_creases && c.mesh_creases->length > 0)
    lines.push_back(creases_text(*c.mesh_creases, "mesh", "surface"));
  return lines;
}

std::string tolerance_line(const SurfaceComparison& c, double tolerance) {
  std::string far;
  for (const SurfaceComparison::Bound& b : c.bounds())
    if (!(b.upper <= tolerance)) far += (far.empty() ? ": " : "; ") + b.what;
  std::string line = (far.empty() ? "within the tolerance of " : "not within the tolerance of ") +
                     short_number(tolerance) + far;
  // Caps have no counterpart in the surface, however far from it they are.
  if (c.caps) line += "; caps, " + share_text(c.caps->share) + " of the mesh's area, are left out";
  return line;
}

}  // namespace tetwright
