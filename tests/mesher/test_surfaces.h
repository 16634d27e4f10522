// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "mesher/cut/cutting.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Sphere by three or more subdivisions of an octahedron: 8 * 4^subdivisions triangles, oriented outwards.
TriangleMesh make_sphere(double radius, const Vec3& centre = Vec3::Zero(), int subdivisions = 4);
/// Torus around the z axis, oriented outwards.
TriangleMesh make_torus(double ring_radius, double tube_radius, int around = 48, int across = 24);
/// Axis-aligned box of twelve triangles, oriented outwards.
TriangleMesh make_box(const Vec3& low, const Vec3& high);
/// One-sided strip around the z axis.
TriangleMesh make_moebius_strip(int around = 24);
/// The figure-eight immersion of the Klein bottle: no boundary, one-sided.
TriangleMesh make_klein_bottle(int around = 24, int across = 12);
/// Drops every `step`-th triangle.
TriangleMesh punctured(TriangleMesh mesh, int step);
/// Reverses every `step`-th triangle.
TriangleMesh partly_turned_over(TriangleMesh mesh, std::size_t step);
/// Reverses all triangles.
TriangleMesh turned_over(TriangleMesh mesh);
/// Concatenates both meshes without merging points.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);

/// Volume enclosed by a closed surface.
double enclosed_volume(const TriangleMesh& mesh);
double volume(const std::vector<Vec3>& points, const std::vector<Tet>& tets);

/// The interfaces with all patches set to 0.
std::vector<InterfaceTriangle> without_patches(std::vector<InterfaceTriangle> interfaces);

/// Describes the first violated guarantee of mesher/README.md; empty if all hold. Checks exact signs, faces
/// in one or two tets, the boundary closed and manifold at edges and points, one connected star at each
/// point, no unused point.
std::string broken_promise(const std::vector<Vec3>& points, const std::vector<Tet>& tets);

struct SolidTopology {
  int components = 0;  ///< of the solid
  int boundary_components = 0;
  int euler = 0;  ///< of the solid
  int boundary_euler = 0;
};
SolidTopology solid_topology(const std::vector<Vec3>& points, const std::vector<Tet>& tets);

}  // namespace tetwright
