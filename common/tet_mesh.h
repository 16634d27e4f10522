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

/// The two regions at a face: the smaller tag first; std::nullopt for outside second.
using MaterialPair = std::pair<MaterialTag, std::optional<MaterialTag>>;

/// A face between two materials or between a material and outside.
struct InterfaceTriangle {
  Triangle ids;                      ///< indices into points; the normal points out of `material`
  MaterialTag material;              ///< on the side of the normal's tail
  std::optional<MaterialTag> other;  ///< on the side of its tip: a larger tag, or nothing for outside
  /// Patch of the interface; points where patches meet stay on the curve between them.
  std::uint16_t patch = 0;

  MaterialPair pair() const { return {material, other}; }
  bool operator==(const InterfaceTriangle&) const = default;
};

/// A patch of the interface between two regions.
using InterfacePatch = std::pair<MaterialPair, std::uint16_t>;

/// Values that a file gives to each point or tet: `components` consecutive numbers each.
struct MeshField {
  std::string name;
  int components = 1;
  bool integer = false;        ///< whole numbers, written as integers
  std::vector<double> values;  ///< size: components * number of points or tets
  bool operator==(const MeshField&) const = default;
};

/// A tetrahedral mesh of one or more materials: the plain value that all parts of the library exchange.
///
/// A tet (a, b, c, d) is positive when (b-a) x (c-a) . (d-a) > 0. Readers return what the file contains;
/// meshes made by mesher/ and simplify/ satisfy the invariants of mesh_check.h.
struct TetMesh {
  std::vector<Vec3> points;                           ///< input units
  std::vector<Tet> tets;                              ///< indices into points
  std::vector<MaterialTag> materials;                 ///< one tag for each tet
  std::map<MaterialTag, std::string> material_names;  ///< only materials that have a name
  /// Result of find_interfaces() (interfaces.h) for this mesh, or empty. Readers leave it empty unless a file
  /// has groups of faces; mesher/ and simplify/ fill it. Code that changes the numbers of points, tets or
  /// materials clears or recomputes it.
  std::vector<InterfaceTriangle> interfaces = {};
  /// Regions of the patches of the interfaces; only patches that belong to one.
  std::map<InterfacePatch, SurfaceRegion> patch_groups = {};
  /// Further data of the file for points and tets; materials are not among them.
  std::vector<MeshField> point_fields = {};
  std::vector<MeshField> cell_fields = {};
};

}  // namespace tetwright
