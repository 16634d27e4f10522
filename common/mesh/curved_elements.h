// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "common/mesh/midside_nodes.h"
#include "common/reference_surface.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// What the faces of second-order tets follow. Both functions return the nearest point within a distance
/// (input units), or nothing; they may be called concurrently.
struct SurfaceToFollow {
  /// Of a patch of the interface between two regions.
  std::function<std::optional<Vec3>(const Vec3&, const InterfacePatch&, double max_distance)> onto_patch;
  /// Of the lines where patches or more than two regions meet; null: these stay straight.
  std::function<std::optional<Vec3>(const Vec3&, double max_distance)> onto_crease;
};

/// `reference` must outlive what is returned.
SurfaceToFollow follow(const ReferenceSurface& reference);

/// The interfaces of a mesh with their patches, and the edges where these meet. Copies what it needs.
SurfaceToFollow follow_interfaces(const TetMesh& mesh);

struct CurvingReport {
  std::size_t edges = 0;       ///< of interfaces
  std::size_t on_surface = 0;  ///< midside nodes that lie on the surface
  std::size_t part_way = 0;  ///< those that were moved back half or three quarters of the way, for valid tets
  std::size_t straight =
      0;  ///< those that stay halfway between the ends: no valid tets else, or no surface near
};

/// Moves the midside nodes of the edges of the interfaces onto the surface, where all tets around stay valid;
/// else part of the way or not at all. A tet is valid if the determinant of its Jacobian is everywhere at
/// least a tenth of that of the straight tet, which is certain where its Bezier coefficients are (Johnen,
/// Remacle, Geuzaine 2013). An edge moves by at most a quarter of its length. O(n log n).
CurvingReport curve_midside_nodes(const TetMesh& mesh, const SurfaceToFollow& surface, MidsideNodes& nodes);

/// The smallest Bezier coefficient of the determinant of a second-order tet's Jacobian, over that of the
/// straight tet; the determinant is nowhere smaller. `midside` in the order of tet_midside_edges.
double min_scaled_jacobian(const std::array<Vec3, 4>& corners, const std::array<Vec3, 6>& midside);

}  // namespace tetwright
