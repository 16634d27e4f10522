// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/surface_region.h"
#include "common/types.h"

namespace tetwright {

/// Two regions that meet in a face: of two materials the smaller tag comes first; the second is nothing for
/// outside.
using MaterialPair = std::pair<MaterialTag, std::optional<MaterialTag>>;

/// A face between two materials or between a material and outside.
struct InterfaceTriangle {
  Triangle ids;                      ///< indices into points; the normal points out of `material`
  MaterialTag material;              ///< on the side of the normal's tail
  std::optional<MaterialTag> other;  ///< on the side of its tip: a larger tag, or nothing for outside
  /// The part of the interface that it belongs to: where patches meet, points stay on the line between them.
  std::uint16_t patch = 0;

  MaterialPair pair() const { return {material, other}; }
  bool operator==(const InterfaceTriangle&) const = default;
};

/// A patch of the interface between two regions.
using InterfacePatch = std::pair<MaterialPair, std::uint16_t>;

/// Numbers that a file gives to each point or tet: `components` for each, one after the other.
struct MeshField {
  std::string name;
  int components = 1;
  bool integer = false;        ///< whole numbers, to be written as such
  std::vector<double> values;  ///< size: components * number of points or tets
  bool operator==(const MeshField&) const = default;
};

/// A tetrahedral mesh of one or more materials: a plain value, the currency between all parts.
///
/// A tet (a, b, c, d) is positive when (b-a) x (c-a) . (d-a) > 0. Readers hand over what the file says;
/// meshes made by mesher/ and simplify/ hold the invariants of mesh_check.h.
struct TetMesh {
  std::vector<Vec3> points;                           ///< input units
  std::vector<Tet> tets;                              ///< indices into points
  std::vector<MaterialTag> materials;                 ///< one tag for each tet
  std::map<MaterialTag, std::string> material_names;  ///< only materials that have a name
  /// What find_interfaces() of interfaces.h finds in this mesh, or empty: readers leave it so unless a file
  /// has groups of faces, mesher/ and simplify/ fill it. Who changes points' numbers, tets or materials
  /// clears it or fills it anew.
  std::vector<InterfaceTriangle> interfaces = {};
  /// The groups that patches of the interfaces belong to, of those that do.
  std::map<InterfacePatch, SurfaceRegion> patch_groups = {};
  /// What else a file says of points and tets; materials are not among them.
  std::vector<MeshField> point_fields = {};
  std::vector<MeshField> cell_fields = {};
};

}  // namespace tetwright
