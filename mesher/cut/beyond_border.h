// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/cut/cutting.h"
#include "mesher/domain/material_field.h"
#include "mesher/lattice/lattice.h"

namespace tetwright {

/// Gives lattice points far beyond the border of a volume to the outside, if the lattice continues there:
/// nothing of their regions is part of the mesh (VoxelVolume::is_far_beyond()).
void clear_far_beyond(const MaterialField& field, const LatticePoints& points,
                      std::vector<NearestRegion>& regions);

/// Removes the tets that VoxelVolume::leaves_out(), and the points that no other tet has. No tet crosses the
/// border, so that what is left ends in its planes. The order is kept.
void drop_beyond_border(const MaterialField& field, CutMesh& mesh);

/// Interface flags of CutMesh without the points in the planes of the border: these must not leave them.
std::vector<std::uint8_t> on_interface_off_border(const MaterialField& field, const CutMesh& mesh);

}  // namespace tetwright
