// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Removes points of a surface where it is nearly flat: collapses edges to one of their points, so that all
/// points that are left are those of the given surface. Points on curves where faces of different materials
/// or patches meet, on the rim and at points where the surface touches itself are kept, and so are the
/// number of its parts and their topology. Faces may come to intersect others within `max_distance`.
///
/// Deterministic, by one thread. May be called concurrently.
/// \param surface its interfaces and their points; no tets. Points without a face are removed
/// \param kept by point: nonzero if it must not be removed. Renumbered with the points
/// \param max_distance of a removed point from the faces that took over from its own; the surface's units
/// \param faces_left faces with points that the caller has beside the surface, renumbered as well; their
///   points must be among those kept
void thin_surface(TetMesh& surface, std::vector<std::uint8_t>& kept, double max_distance,
                  std::vector<InterfaceTriangle>& faces_left);

}  // namespace tetwright
