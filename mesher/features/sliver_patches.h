// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Merges slivers with neighbours: parts of patches, connected across edges, that are smaller than
/// `min_area`. Imprinting leaves them where curves of several surfaces coincide within the tolerance; a mesh
/// has neither faces nor corners for them. Each joins the patch of its own sheet with which it shares most
/// border, smallest first; one that borders none of its sheet stays. O(n log n); the result depends on the
/// order of the triangles only.
/// \param sheet_of_patch triangles of one sheet meet in creases, those of two sheets in junctions
/// \param patches of each triangle; changed
/// \param min_area square of the points' unit
void merge_slivers(std::span<const Vec3> points, std::span<const Triangle> triangles,
                   std::span<const std::size_t> sheet_of_patch, double min_area,
                   std::span<std::uint16_t> patches);

}  // namespace tetwright
