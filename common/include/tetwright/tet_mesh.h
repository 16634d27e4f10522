// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tetwright {

/// A position or a direction, in input units unless a name says otherwise.
using Vec3 = Eigen::Vector3d;

/// Number of a point, triangle or tet in its array.
using Index = std::uint32_t;
inline constexpr Index no_index = std::numeric_limits<Index>::max();

using Triangle = std::array<Index, 3>;
using Tet = std::array<Index, 4>;
using Wedge = std::array<Index, 6>;

/// Integer that identifies a material: any value, returned unchanged. Outside has no tag.
using MaterialTag = std::int32_t;

/// Face i of a positive tet lies opposite its vertex i; its vertices are ordered so that the normal points
/// out.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> tet_faces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// The six edges of a tet.
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> tet_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// A region of a surface, or of the boundary and the interfaces of a mesh, that a file distinguishes. Its
/// faces stay together and are written under the same name.
struct SurfaceRegion {
  std::int64_t number = 0;  ///< group number, in formats that have one; 0: none
  std::string name;         ///< empty: the region has only a number

  /// False: no region.
  explicit operator bool() const { return number != 0 || !name.empty(); }
  auto operator<=>(const SurfaceRegion&) const = default;
};

/// The two regions at a face: the smaller tag first; outside is std::nullopt and second. Equal at a sheet.
using MaterialPair = std::pair<MaterialTag, std::optional<MaterialTag>>;

/// A face between two materials or between a material and outside, or a face of a sheet: an inner face of a
/// mesh with the same material on both sides, such as a baffle, a membrane or a fracture without thickness.
struct InterfaceTriangle {
  Triangle ids;          ///< indices into points; the normal points out of `material`
  MaterialTag material;  ///< on the side that the normal points away from
  /// On the other side: a larger tag, std::nullopt for outside, or `material` for a sheet.
  std::optional<MaterialTag> other;
  /// Patch of the interface; points where patches meet stay on the curve between them.
  std::uint16_t patch = 0;

  MaterialPair pair() const { return {material, other}; }
  bool is_sheet() const { return other == material; }
  bool operator==(const InterfaceTriangle&) const = default;
};

/// A patch of the interface between two regions.
using InterfacePatch = std::pair<MaterialPair, std::uint16_t>;

/// Values of a file for each point or tet: `components` consecutive numbers for each.
struct MeshField {
  std::string name;
  int components = 1;
  bool integer = false;        ///< whole numbers, written as integers
  std::vector<double> values;  ///< size: components * number of points or tets
  bool operator==(const MeshField&) const = default;
};

/// A tetrahedral mesh of one or more materials: a plain value, exchanged by all parts of the library.
///
/// A tet (a, b, c, d) is positive when (b-a) x (c-a) . (d-a) > 0. Readers return what the file contains;
/// meshes made by mesher/ and simplify/ satisfy the invariants of mesh_quality.h.
struct TetMesh {
  std::vector<Vec3> points;                           ///< input units
  std::vector<Tet> tets;                              ///< indices into points
  std::vector<MaterialTag> materials;                 ///< one tag for each tet
  std::map<MaterialTag, std::string> material_names;  ///< only materials that have a name
  /// Result of find_interfaces() (mesh_quality.h) for this mesh, followed by the faces of its sheets; or
  /// empty. Readers leave it empty unless a file has groups of faces; mesher/ and simplify/ fill it. Code
  /// that renumbers points or tets, or changes materials, must clear or recompute it. The tets alone do not
  /// contain the sheets: interfaces_with_sheets() (sheets.h) recomputes the rest and keeps them. A sheet's
  /// faces are oriented consistently in each connected piece; the direction of the normal is arbitrary. Its
  /// patches belong to the pair (material, material).
  std::vector<InterfaceTriangle> interfaces = {};
  /// Region of each interface patch that belongs to one.
  std::map<InterfacePatch, SurfaceRegion> patch_groups = {};
  /// Further data of the file for points and tets, without the materials.
  std::vector<MeshField> point_fields = {};
  std::vector<MeshField> cell_fields = {};
  /// Cohesive elements: wedges without volume between the two sides of parted interfaces (see
  /// parted_interfaces.h). Corners 0, 1, 2 are those of a face of the first side, whose normal points to the
  /// second side; corner k + 3 has the coordinates of corner k. Only meshes to be written, or just read, have
  /// any.
  std::vector<Wedge> wedges = {};
  /// Coordinate system of the points: "left-posterior-superior", "right-anterior-superior" or another one
  /// that the volume or surface names from which the mesh was made; empty: unknown. Files of VTK's formats
  /// record the first two. It is never converted: surfaces, images and sizes are, see change_space().
  std::string space = {};
};

/// Edges of a tet in the order of its midside nodes in VTK, Abaqus, Nastran and FEBio. Gmsh swaps the last
/// two.
inline constexpr std::array<std::array<std::size_t, 2>, 6> tet_midside_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// Endpoints of an edge, the smaller one first.
inline std::array<Index, 2> ascending_edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// Midside nodes that turn the tets of a mesh into second-order elements.
struct MidsideNodes {
  std::vector<std::array<Index, 2>> edges;     ///< in ascending order; smaller endpoint first
  std::vector<Vec3> points;                    ///< one for each edge, input units
  std::vector<std::array<Index, 6>> of_tets;   ///< indices into `points`, in the order of tet_midside_edges
  std::vector<std::array<Index, 3>> of_faces;  ///< likewise, for edges 01, 12, 20 of the interfaces
};

/// Extends point fields to the midside nodes, which are appended after the points: the mean of both
/// endpoints, rounded in integer fields.
std::vector<MeshField> fields_of_nodes(std::vector<MeshField> point_fields, const MidsideNodes& nodes);

/// Places nodes halfway between the endpoints of each edge: straight elements. O(n log n).
MidsideNodes straight_midside_nodes(const TetMesh& mesh);

}  // namespace tetwright
