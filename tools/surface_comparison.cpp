#include "tools/surface_comparison.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "common/geometry/projection_tree.h"
#include "common/mesh/solid_shape.h"

#include "common/message_text.h"
#include "common/tolerances.h"

namespace tetwright {

namespace {

/// Creases of a mesh are looked for where those of its surface were found: find_patches(), automatic.
constexpr double crease_degrees = 35;

ProjectionTree tree_of(const TetMesh& mesh, bool with_interfaces) {
  std::vector<ProjectionTree::Item> items;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (with_interfaces || !t.other) items.push_back({t.ids, {}});
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

/// Nothing where the surface is not closed.
std::optional<MaterialFidelity> compare_solid(const TetMesh& mesh, const TriangleMesh& surface,
                                              const std::string& name) {
  ExpectedSolid expected;
  expected.name = name;
  expected.shape = solid_shape(surface.points, surface.triangles);
  if (expected.shape.volume() < 0) {
    std::vector<Triangle> turned = surface.triangles;
    for (Triangle& t : turned) std::swap(t[1], t[2]);
    expected.shape = solid_shape(surface.points, turned);
  }
  if (!expected.shape.manifold) return {};
  // All materials as one.
  TetMesh whole;
  whole.points = mesh.points;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (!t.other) whole.interfaces.push_back({t.ids, expected.tag, {}});
  return compare_solids({expected}, whole).front();
}

std::optional<CreaseFidelity> compare_creases_of(TetMesh& mesh, const std::vector<TriangleMesh>& surfaces,
                                                 const std::vector<std::string>& names) {
  CreaseCurves expected;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const TriangleMesh& s = surfaces[i];
    const SurfacePatches patches = find_patches(s.points, s.triangles, {}, {}, names[i]);
    if (patches.any()) expected.add(find_creases(s.points, s.triangles, patches.patches), s.points);
  }
  if (expected.segments.empty()) return {};
  find_mesh_patches(mesh, {FeatureAngle::Rule::degrees, crease_degrees}, "the mesh");
  return compare_creases(expected, mesh);
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

}  // namespace

double SurfaceComparison::upper() const {
  double upper = std::max(from_mesh.upper, from_surfaces.upper);
  if (creases) upper = std::max({upper, creases->max_distance, creases->max_corner_distance});
  return upper;
}

SurfaceComparison compare_with_surfaces(TetMesh& mesh, const std::vector<TriangleMesh>& surfaces,
                                        const std::vector<std::string>& names) {
  SurfaceComparison c;
  Box3 box;
  for (const TriangleMesh& s : surfaces)
    for (const Triangle& t : s.triangles)
      for (const Index p : t) box.add(s.points[p]);
  c.diagonal = (box.high - box.low).norm();
  const ProjectionTree of_mesh = tree_of(mesh, surfaces.size() > 1), of_surfaces = tree_of(surfaces);
  const double accuracy = tolerance::deviation_share * c.diagonal;
  c.from_mesh = surface_deviation(of_mesh, of_surfaces, accuracy);
  c.from_surfaces = surface_deviation(of_surfaces, of_mesh, accuracy);
  if (surfaces.size() == 1) c.solid = compare_solid(mesh, surfaces.front(), names.front());
  c.creases = compare_creases_of(mesh, surfaces, names);
  return c;
}

std::vector<std::string> comparison_lines(const SurfaceComparison& c) {
  std::vector<std::string> lines{
      deviation_line("distance of the mesh from the surface", c.from_mesh, c.diagonal),
      deviation_line("distance of the surface from the mesh", c.from_surfaces, c.diagonal)};
  if (c.solid) {
    char volumes[120];
    std::snprintf(volumes, sizeof volumes, "volume %.6g, of the surface %.6g; ", c.solid->result.volume,
                  c.solid->expected.volume);
    lines.push_back(volumes +
                    (c.solid->same() ? "same components, handles and cavities" : c.solid->difference) +
                    (c.solid->place ? ", at " + place_text(*c.solid->place) : ""));
  } else {
    lines.emplace_back("volume and topology: not compared; that takes one closed surface");
  }
  if (c.creases)
    lines.push_back("creases of the surface: at most " + length_text(c.creases->max_distance, c.diagonal) +
                    " from those of the mesh, at " + place_text(c.creases->place) + "; its corners at most " +
                    length_text(c.creases->max_corner_distance, c.diagonal) + " from the mesh");
  return lines;
}

}  // namespace tetwright
