// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "common/mesh/midside_nodes.h"
#include "common/reference_surface.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// Surface that the faces of second-order tets follow. Both functions return the nearest point within a
/// distance (input units), or nothing; they may be called concurrently.
struct SurfaceToFollow {
  /// Projects onto a patch of the interface between two regions.
  std::function<std::optional<Vec3>(const Vec3&, const InterfacePatch&, double max_distance)> onto_patch;
  /// Projects onto the curves where patches or more than two regions meet; null: these stay straight.
  std::function<std::optional<Vec3>(const Vec3&, double max_distance)> onto_crease;
};

/// Follows a reference surface.
/// \pre `reference` outlives the result
SurfaceToFollow follow(const ReferenceSurface& reference);

/// Follows the interfaces of a mesh with their patches, and the edges where these meet. Copies its input.
SurfaceToFollow follow_interfaces(const TetMesh& mesh);

struct CurvingReport {
  std::size_t edges = 0;       ///< of interfaces
  std::size_t on_surface = 0;  ///< midside nodes on the surface
  std::size_t part_way = 0;    ///< moved half or a quarter of the way, for valid tets
  std::size_t straight = 0;    ///< kept halfway between the ends: no valid tets otherwise, or no surface near
};

/// Moves the midside nodes of the interfaces' edges onto the surface if all tets around stay valid; otherwise
/// part of the way or not at all. A tet is valid if the determinant of its Jacobian is everywhere at least a
/// tenth of the straight tet's, which its Bezier coefficients certify (Johnen, Remacle, Geuzaine 2013). A
/// node moves by at most a quarter of its edge's length. O(n log n).
CurvingReport curve_midside_nodes(const TetMesh& mesh, const SurfaceToFollow& surface, MidsideNodes& nodes);

/// Smallest Bezier coefficient of the determinant of a second-order tet's Jacobian, over the straight tet's
/// determinant: a lower bound of the scaled Jacobian.
/// \param midside in the order of tet_midside_edges
double min_scaled_jacobian(const std::array<Vec3, 4>& corners, const std::array<Vec3, 6>& midside);

}  // namespace tetwright
