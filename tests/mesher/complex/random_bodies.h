// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "mesher/complex/surface_imprint.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// All surfaces as one soup; points of different ones stay apart.
SurfaceSoup soup_of(const std::vector<TriangleMesh>& surfaces);

TriangleMesh turned(TriangleMesh mesh, double angle, const Vec3& axis);

/// Prism over a regular polygon, its axis along z, oriented outwards.
TriangleMesh make_prism(double radius, double height, const Vec3& centre_below, int sides);

/// Two to four boxes, prisms and balls near the origin, the same for a seed on every system. Corners of half
/// of them are on a coarse grid, so that bodies touch in faces, edges and points, coincide or lie within each
/// other; others are turned, so that they cross.
/// \param exact bodies that touch do so exactly, or are apart; otherwise some would touch but for rounding:
///   turned ones at the origin, and balls in planes of symmetry
std::vector<TriangleMesh> random_bodies(std::uint32_t seed, bool exact = true);

}  // namespace tetwright
