// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/utf8.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tetwright/value_bins.h"

namespace tetwright {

/// The face of a tet opposite its vertex `face`.
struct TetFace {
  Index tet;
  std::uint8_t face;
};

/// Named parts of a mesh in the formats of solvers.
struct MeshParts {
  struct Material {
    MaterialTag tag;
    std::int64_t number;      ///< number of the tag in the format
    std::string name;         ///< unique
    std::vector<Index> tets;  ///< ascending, at least one
  };
  struct Surface {
    SurfaceRegion group;  ///< region of the input, or none
    /// Number in BoundaryGroups if the format can hold it; 0 if the format has no surface numbers.
    std::int64_t number;
    std::string name;                ///< unique
    std::vector<std::size_t> faces;  ///< indices into TetMesh::interfaces, ascending, at least one
  };
  std::vector<Material> materials;  ///< ascending by tag
  std::vector<Surface> surfaces;    ///< in the order of BoundaryGroups::all()
};

/// Constraints of a format on names and numbers.
struct NameRules {
  std::function<std::string(const std::string&)> form;  ///< converts a name to one that the format can hold
  bool ignore_case = false;                             ///< true: names that differ only in case are equal
  /// Maximum number of a material or a surface; numbers start at 1, see positive_numbers(). 0: tags and the
  /// numbers of BoundaryGroups are written unchanged.
  std::int64_t max_number = 0;
  bool surface_numbers = true;  ///< surfaces have numbers in the file, in addition to names
};

/// Rules of formats that can hold any tag and any name without control characters.
NameRules printable_names();

/// Materials of the mesh and groups of its interfaces, with names that the format can hold. Default names:
/// "material_TAG"; for a group "surface_NUMBER" if it is a region of the input, otherwise the names of the
/// two materials, "bone|skin" or "bone|outside".
MeshParts mesh_parts(const TetMesh& mesh, const NameRules& rules);

/// A bin of tets in the formats of solvers.
struct BinPart {
  const ValueBin* bin;
  std::int64_t number;      ///< of the bin in the format, none of a material
  std::string name;         ///< unique, also among the materials
  std::vector<Index> tets;  ///< ascending
};

/// A division of the tets into bins.
struct BinDivision {
  const TetBins* bins;
  std::vector<BinPart> parts;
};

/// Bins with names and numbers that the format can hold, unique among all divisions. The leading division
/// (see leading_division()) is the first one.
///
/// \param materials of the same mesh in the same format
std::vector<BinDivision> parts_of_bins(std::span<const TetBins> divisions,
                                       const std::vector<MeshParts::Material>& materials,
                                       const NameRules& rules);

/// The cohesive elements of a parted interface, which are written like a material.
struct CohesivePart {
  std::int64_t number;              ///< in the format, none of a material or bin
  std::string name;                 ///< unique, also among materials and bins
  std::vector<std::size_t> wedges;  ///< indices into TetMesh::wedges, ascending
};

/// \param names, numbers taken by others in the same format
std::vector<CohesivePart> cohesive_parts(const TetMesh& mesh, const std::set<std::string>& names,
                                         const std::set<std::int64_t>& numbers, const NameRules& rules);
/// Likewise, where only the materials have taken names and numbers.
std::vector<CohesivePart> cohesive_parts(const TetMesh& mesh,
                                         const std::vector<MeshParts::Material>& materials,
                                         const NameRules& rules);

/// VTK's and XDMF's order of a wedge's corners: the normal of the first three points away from the others.
inline constexpr std::array<std::size_t, 6> vtk_wedge_order{0, 2, 1, 3, 5, 4};

/// Mean, bounds and number of tets of a bin, for a comment.
std::string comment_on_bin(const ValueBin& bin, const std::string& field);

/// mesh_parts() without tets and faces; takes one pass over them.
MeshParts names_of_parts(const TetMesh& mesh, const NameRules& rules);

/// Converts to a name of at most `longest` ASCII letters, digits and underscores that begins with a letter,
/// leaving room for a suffix; other characters become underscores.
std::string plain_name(const std::string& name, std::size_t longest = 76);

/// Assigns unique numbers from 1 to `max` to material tags or surface numbers. Numbers in that range are
/// kept, others get the smallest free ones, in ascending order.
std::map<std::int64_t, std::int64_t> positive_numbers(const std::set<std::int64_t>& numbers,
                                                      std::int64_t max);

/// Tags of the materials that have tets.
std::set<std::int64_t> tags_of(const std::vector<MaterialTag>& materials);

/// For each interface triangle of the mesh, the tet on the side of its `material`, and its face there. O(n
/// log n).
std::vector<TetFace> faces_of_tets(const TetMesh& mesh);

/// Boundary and interfaces of the mesh as a surface: triangles grouped as in mesh_parts(), points on
/// interfaces only, in the order of the mesh.
TriangleMesh interface_surface(const TetMesh& mesh, const NameRules& rules);

/// Nodes of the faces of a surface, ascending, each once.
/// \param midside MidsideNodes::of_faces; their nodes are included and numbered after the points; null:
///   corners only
std::vector<Index> nodes_of_faces(const TetMesh& mesh, const std::vector<std::size_t>& faces,
                                  const std::vector<std::array<Index, 3>>* midside);

}  // namespace tetwright
