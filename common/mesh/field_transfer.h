// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/tet_mesh.h"

namespace tetwright {

/// Replaces the fields of `after`, a mesh of the same thing with other points and tets, by those of `before`
/// carried over. Without fields in `before`, `after` has none at once.
///
/// Point fields: a point that is at the place of one of `before` (equal coordinates; of several the first)
/// has its values to the bit. Others are interpolated linearly in the tet of `before` that holds them, of any
/// material; where none does, at the nearest place of the nearest tet. Integer fields take the value of the
/// vertex with the largest weight there, on ties of the smallest number. NaN at a vertex reaches only points
/// that depend on that vertex.
///
/// Cell fields: a tet has the values of the tet of `before` of its material that holds its centroid, or else
/// is nearest to it (on ties the first). A material that `before` does not have takes from any.
///
/// Inverted tets of `before` count as their mirror images; flat ones hold nothing, but may be nearest. If
/// `before` has no tets at all the values are NaN, or 0 in integer fields.
///
/// Both meshes must be in range, with finite coordinates and fields of the right size. Parallel; the result
/// does not depend on the number of threads. At the peak 40 bytes for each tet of `before`
/// and 16 for each of its points beside the fields.
void transfer_fields(const TetMesh& before, TetMesh& after);

}  // namespace tetwright
