// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"
#include "common/utf8.h"

namespace tetwright {

/// A face of a tet: the one opposite this vertex of it.
struct TetFace {
  Index tet;
  std::uint8_t face;
};

/// The parts of a mesh that formats of solvers list by name.
struct MeshParts {
  struct Material {
    MaterialTag tag;
    std::int64_t number;      ///< that the format has for the tag
    std::string name;         ///< unlike that of every other material
    std::vector<Index> tets;  ///< ascending, at least one
  };
  struct Surface {
    SurfaceRegion group;  ///< of the user, or none
    /// As BoundaryGroups has it, where the format can hold it; 0 where it has no numbers of surfaces.
    std::int64_t number;
    std::string name;                ///< unlike that of every other surface
    std::vector<std::size_t> faces;  ///< indices into TetMesh::interfaces, ascending, at least one
  };
  std::vector<Material> materials;  ///< ascending by tag
  std::vector<Surface> surfaces;    ///< in the order of BoundaryGroups::all()
};

/// What names and numbers must be in a format.
struct NameRules {
  std::function<std::string(const std::string&)> form;  ///< makes a name one that the format can hold
  bool ignore_case = false;                             ///< names that differ in case alone are the same
  /// Numbers of materials and of surfaces are from 1 to this, see positive_numbers(); 0: tags and the numbers
  /// of BoundaryGroups stand as they are.
  std::int64_t max_number = 0;
  bool surface_numbers = true;  ///< surfaces have numbers in the file, and not only names
};

/// Those of formats that can hold any name on a line, and any tag.
NameRules printable_names();

/// The materials of the mesh and the groups of its interfaces with names that the format can hold. Where a
/// material has no name it is "material_TAG"; where a group has none, "surface_NUMBER" if it is the user's,
/// else the names of the two materials, "bone|skin", or "bone|outside".
MeshParts mesh_parts(const TetMesh& mesh, const NameRules& rules);

/// The same without their tets and faces, at the cost of a look at each.
MeshParts names_of_parts(const TetMesh& mesh, const NameRules& rules);

/// A name of ASCII letters, digits and underscores that begins with a letter and has at most `longest`
/// characters and room for a suffix; other characters become underscores.
std::string plain_name(const std::string& name, std::size_t longest = 76);

/// Numbers from 1 to `max` for tags of materials or numbers of surfaces, no two alike: one in that range
/// stays as it is, others get the smallest that are left, in ascending order.
std::map<std::int64_t, std::int64_t> positive_numbers(const std::set<std::int64_t>& numbers,
                                                      std::int64_t max);

/// The tags of the materials that have tets.
std::set<std::int64_t> tags_of(const std::vector<MaterialTag>& materials);

/// For each of the mesh's interfaces the tet on the side of its `material`, whose face it is. O(n log n).
std::vector<TetFace> faces_of_tets(const TetMesh& mesh);

/// The boundary and the interfaces of the mesh as a surface by themselves: triangles by group, those of
/// mesh_parts(); points in the order of the mesh, those of no interface left out.
TriangleMesh interface_surface(const TetMesh& mesh, const NameRules& rules);

/// The nodes of the faces of a surface, ascending, each once. With `midside` (MidsideNodes::of_faces) those,
/// too, numbered after `points` points.
std::vector<Index> nodes_of_faces(const TetMesh& mesh, const std::vector<std::size_t>& faces,
                                  const std::vector<std::array<Index, 3>>* midside);

}  // namespace tetwright
