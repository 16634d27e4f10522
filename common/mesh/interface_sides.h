// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "common/material_names.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

inline Triangle ascending_ids(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Region of a face's patch; none without one.
inline const SurfaceRegion& region_of(const TetMesh& mesh, const InterfaceTriangle& face) {
  static const SurfaceRegion none;
  const auto known = mesh.patch_groups.find({face.pair(), face.patch});
  return known == mesh.patch_groups.end() ? none : known->second;
}

/// Name of an interface between two materials: "bone|implant".
inline std::string interface_name(const TetMesh& mesh, MaterialTag first, MaterialTag second) {
  return unique_material_name(mesh.material_names, first) + "|" +
         unique_material_name(mesh.material_names, second);
}

/// Sides of a sheet: the one that its normals point away from, and the other one.
inline constexpr std::array<const char*, 2> sheet_sides{"back", "front"};

/// Coordinates of a face's corners in ascending order.
using FaceCoordinates = std::array<std::array<double, 3>, 3>;

/// Corners of a face in the order of their coordinates.
Triangle by_coordinates(const TetMesh& mesh, Triangle ids);
FaceCoordinates coordinates_of(const TetMesh& mesh, const Triangle& ids);

/// Two groups of boundary faces that are the sides of a parted interface.
struct InterfaceSides {
  std::string name;  ///< of the interface, without that of a side
  /// Whether it is named after its two materials, and not a sheet or a group of the user.
  bool by_materials;
  /// Faces of the first and the second side that coincide, as indices into TetMesh::interfaces.
  std::vector<std::pair<std::size_t, std::size_t>> faces;
};

/// Groups whose names are those of sides, but whose faces do not coincide one by one.
struct SidesApart {
  std::string name;
  std::size_t faces = 0;  ///< of both sides, without a counterpart
};

struct FoundSides {
  std::vector<InterfaceSides> sides;  ///< by name
  std::vector<SidesApart> apart;
};

/// Finds the sides of parted interfaces by the names of groups: NAME:back and NAME:front for a sheet;
/// otherwise A|B:A and A|B:B, or NAME:A and NAME:B with the names of the groups' materials. O(n log n).
///
/// \pre indices in range
FoundSides find_interface_sides(const TetMesh& mesh);

}  // namespace tetwright
