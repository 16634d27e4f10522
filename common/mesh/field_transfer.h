// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/tet_mesh.h"

namespace tetwright {

/// Replaces the fields of `after`, a mesh of the same body with other points and tets, by those of `before`.
/// Returns at once with no fields if `before` has none.
///
/// Point fields: a point with the coordinates of a point of `before` (the first of several) gets its values
/// bit by bit. Others are interpolated linearly in the containing tet of `before`, of any material, or at the
/// nearest point of the nearest tet. Integer fields get the value of the vertex with the largest weight, of
/// the smallest index among equals. NaN at a vertex affects only points that depend on that vertex.
///
/// Cell fields: a tet gets the values of the tet of `before` with the same material that contains its
/// centroid, or is nearest to it (the first among equals). A material that `before` lacks takes values from
/// any.
///
/// Inverted tets of `before` count as their mirror images; flat ones contain no point but may be nearest. If
/// `before` has no tets, values are NaN, or 0 in integer fields.
///
/// Parallel; the result does not depend on the number of threads. Peak memory beside the fields: 40 bytes for
/// each tet of `before` and 16 for each of its points.
/// \pre both meshes in range, with finite coordinates and fields of the right size
void transfer_fields(const TetMesh& before, TetMesh& after);

}  // namespace tetwright
