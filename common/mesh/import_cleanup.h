// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

/// What make_coherent() changed in a mesh, and what is still wrong with it.
struct ImportCleanupReport {
  std::size_t merged_points = 0;      ///< taken out for an earlier one at the same place
  std::size_t removed_tets = 0;       ///< that had a vertex twice
  std::size_t turned_tets = 0;        ///< whose last two vertices were swapped
  std::size_t inverted_tets = 0;      ///< flat or negative (exact sign) in the mesh as returned
  std::vector<Index> first_inverted;  ///< the first of them, at most three
  std::size_t lost_faces = 0;         ///< faces of patches that are no longer of boundary or interfaces
};

/// Brings a mesh as other programs write it to what the rest of this one expects, as far as its combinatorics
/// can tell; no point moves.
///
/// - A soup (more than one tet, and each point used by at most one tet) gets its points of equal coordinates
///   merged, where -0 equals 0: the first stays, with its values of the point fields. In any other mesh
///   points at one place are taken for meant. Points without a tet stay.
/// - Tets with a repeated vertex are taken out; materials and cell fields follow.
/// - Tets are turned so that any two that share a face lie on opposite sides of it, and then each part that
///   is connected by faces so that its total signed volume is positive; where that is exactly zero, so that
///   its first tet that is not flat is positive. Faces of more than two tets connect nothing. A tet that
///   cannot agree with all its neighbours agrees with the one it is first reached from. A tet that is
///   inverted in space but fits its neighbours thus stays inverted, and is counted.
///
/// If anything changed, `interfaces` are found anew where they have patches, which their faces keep, and else
/// cleared. When all tets are positive nothing is turned, and unless
/// the mesh has the four points a tet of a soup nothing is allocated.
///
/// Vertices must be in range, coordinates finite, materials as many as tets, tets fewer than 2^30. At the
/// peak 40 bytes a tet; the result does not depend on the number of threads.
ImportCleanupReport make_coherent(TetMesh& mesh);

}  // namespace tetwright
