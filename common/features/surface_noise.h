// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/features/inner_edges.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Flags the points at which creases may end: those on open borders, on edges of three and more triangles and
/// on edges between two groups.
std::vector<std::uint8_t> points_on_borders(const std::vector<EdgeUse>& uses, std::size_t point_count);

/// Ratio of loose ends to edges that turn by more than an angle (radians), at most 2. A loose end is a point
/// not on a border at which exactly one such edge ends.
double loose_ends(const std::vector<InnerEdge>& edges, const std::vector<std::uint8_t>& on_border,
                  double angle);

/// Flags the parts of a noisy surface in which sharp edges end anywhere, and the parts beside these, unless
/// they are large or flat and have hardly a loose end: the flat cut through a scan, the sides of a block of
/// terrain.
/// \param edges of the triangles
/// \param on_border points_on_borders()
/// \param part of each triangle, from 0
/// \param part_count number of parts
/// \param angle radians; edges that turn by more are sharp
std::vector<std::uint8_t> find_noisy_parts(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                           const std::vector<InnerEdge>& edges,
                                           const std::vector<std::uint8_t>& on_border,
                                           std::span<const Index> part, std::size_t part_count, double angle);

}  // namespace tetwright
