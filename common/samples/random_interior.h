// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A flat body with a coarse, uneven skin and random interior points: the Delaunay tetrahedralisation (up to
/// rounding) that contains the skin. Two in five of its tets are slivers, or flat between a large triangle of
/// the skin and a point near it. This is typical of programs that fill a decimated surface, and about the
/// worst that can still be repaired.
///
/// The body is star-shaped. All tets are positive by exact sign; the same bits on every machine.
/// \param skin_cells squares along each edge of the cube whose surface is mapped to the skin
/// \param thickness ratio of the body's thickness to its width
TetMesh random_interior(Index skin_cells, std::size_t interior_points, double thickness);

}  // namespace tetwright
