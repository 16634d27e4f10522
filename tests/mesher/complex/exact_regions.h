// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "tetwright/surface_mesh.h"

namespace tetwright {

/// A set of points, edges and faces.
struct SetShape {
  int euler = 0;       ///< points - edges + faces
  int components = 0;  ///< connected by common points
};

struct RegionShape {
  SetShape boundary;
  double volume = 0;
};

/// The regions of bodies, later ones carving earlier ones.
struct AssemblyShape {
  std::vector<RegionShape> regions;  ///< by body
  /// Faces, edges and points that two regions, ascending, have in common. No entry for regions that are
  /// apart.
  std::map<std::pair<std::size_t, std::size_t>, SetShape> contacts;
};

/// Computes the regions with CGAL's exact kernel (Nef polyhedra: Hachenberger, Kettner, Mehlhorn 2007).
/// \pre each surface is closed, oriented outwards, does not cross itself, and has no two equal points
AssemblyShape exact_regions(const std::vector<TriangleMesh>& bodies);

}  // namespace tetwright
