// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/lattice/labelled_lattice.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A tet mesh in lattice units, with the region of each tet.
struct CutMesh {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  std::vector<RegionIndex> regions;
  std::vector<std::uint8_t> on_interface;  ///< 1 for cuts and for points moved onto an interface
  std::vector<std::uint8_t> owned;         ///< by tet: LabelledLattice::owns(); empty: all
};

/// The smallest solid angle among the pieces of a tet that become part of the mesh, as the tangent of half
/// the angle. Returns 1, which no tet reaches, if there is no such piece.
/// \param enough pieces that are at least this bad end the search: the result may then be that of any of them
/// \pre the tet has a point near an interface
double worst_piece_tangent(const LabelledLattice& lattice, const Tet& tet, double enough = 0);

/// Cuts the lattice along its interfaces; tets outside are dropped unless the lattice keeps the outside.
///
/// Each cut edge, face or tet gets one new vertex, by linear interpolation of the distances, at a minimum
/// distance from the corners. Tets keep the lattice's order; vertices are numbered by first use. The
/// lattice's tets are freed while the mesh is built, which takes 20 bytes per lattice tet in addition to the
/// lattice points.
CutMesh cut_lattice(LabelledLattice lattice);

}  // namespace tetwright
