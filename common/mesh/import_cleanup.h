// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

/// Changes that make_coherent() made to a mesh, and defects that remain.
struct ImportCleanupReport {
  std::size_t merged_points = 0;      ///< merged into an earlier point with equal coordinates
  std::size_t removed_tets = 0;       ///< with a repeated vertex
  std::size_t turned_tets = 0;        ///< reoriented: the last two vertices swapped
  std::size_t inverted_tets = 0;      ///< flat or negative (exact sign) in the returned mesh
  std::vector<Index> first_inverted;  ///< the first, at most three
  std::size_t lost_faces = 0;         ///< faces of patches that are on no boundary or interface any more
};

/// Makes the mesh of another program satisfy what this library expects, as far as connectivity allows; no
/// point moves.
///
/// - In a soup (more than one tet, and each point used by at most one tet) points of equal coordinates are
///   merged, where -0 equals 0: the first stays, with its values of the point fields. In any other mesh
///   duplicate points are considered intended. Points without a tet stay.
/// - Tets with a repeated vertex are removed; materials and cell fields follow.
/// - Tets are oriented so that any two with a common face lie on opposite sides of it, and then each
///   component connected by faces so that its total signed volume is positive; if that is exactly zero, so
///   that its first tet that is not flat is positive. Faces of more than two tets connect nothing. A tet that
///   cannot agree with all its neighbours agrees with the one it is first reached from. A tet that is
///   inverted in space but consistent with its neighbours thus stays inverted, and is counted.
///
/// If anything changed, `interfaces` with patches are recomputed, and their faces keep the patches;
/// `interfaces` without patches are cleared. If all tets are positive none is reoriented, and nothing is
/// allocated unless the mesh has the four points a tet of a soup. Peak memory 40 bytes a tet; the result does
/// not depend on the number of threads.
/// \pre vertices in range, coordinates finite, one material for each tet, fewer than 2^30 tets
ImportCleanupReport make_coherent(TetMesh& mesh);

}  // namespace tetwright
