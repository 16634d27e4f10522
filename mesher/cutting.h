#pragma once

#include <vector>

#include "common/types.h"
#include "mesher/labelled_lattice.h"

namespace tetwright {

/// A tet mesh in lattice units, with the region of each tet.
struct CutMesh {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  std::vector<RegionIndex> regions;
  std::vector<std::uint8_t> on_interface;  ///< 1 for points between regions: cuts and points moved there
};

/// The smallest solid angle among the pieces of a tet that go into the mesh, as the tangent of its half;
/// larger than any tet's if there are none. The tet has a point near an interface.
double worst_piece_tangent(const LabelledLattice& lattice, const Tet& tet);

/// The lattice cut along its interfaces, without what is outside unless the lattice keeps that. Cuts are made
/// once per edge, face and tet, by linear interpolation of the distances, and kept off the ends. Tets stay in
/// the order of the lattice, points are numbered in the order of their first use. The lattice's tets go as
/// the mesh's come: 20 bytes for each of these are needed beside the lattice's points.
CutMesh cut_lattice(LabelledLattice lattice);

}  // namespace tetwright
