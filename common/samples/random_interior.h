// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/tet_mesh.h"

namespace tetwright {

/// A flat body with a coarse, uneven skin and points thrown into it at random, with the Delaunay
/// tetrahedralisation (up to rounding) that keeps the skin: two in five of its tets are slivers, or flat
/// between a large triangle of the skin and a point near it, which is what other programs hand over when they
/// fill a decimated surface, and about the worst that can still be mended.
///
/// `thickness`: of its width. The body is star-shaped. Its skin is a cube's surface of `skin_cells` squares
/// along each edge, blown up to a blob. All tets are positive by exact sign; the same bits on every machine.
TetMesh random_interior(Index skin_cells, std::size_t interior_points, double thickness);

}  // namespace tetwright
