// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/types.h"
#include "mesher/lattice/labelled_lattice.h"

namespace tetwright {

/// A tet mesh in lattice units, with the region of each tet.
struct CutMesh {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  std::vector<RegionIndex> regions;
  std::vector<std::uint8_t> on_interface;  ///< 1 for points between regions: cuts and points moved there
};

/// The smallest solid angle of the pieces of a tet that become part of the mesh, as the tangent of half the
/// angle; 1, more than any tet has, if there are no such pieces. The tet must have a point near an interface.
double worst_piece_tangent(const LabelledLattice& lattice, const Tet& tet);

/// Cuts the lattice along its interfaces; tets outside are dropped unless the lattice keeps the outside.
///
/// Each cut edge, face or tet gets one new point, by linear interpolation of the distances and a minimum
/// distance from the corners. Tets keep the order of the lattice, points are numbered in the order of their
/// first use. The lattice's tets are freed while the mesh is built, which takes 20 bytes for each of its tets
/// beside the points of the lattice.
CutMesh cut_lattice(LabelledLattice lattice);

}  // namespace tetwright
