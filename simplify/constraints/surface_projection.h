// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "common/reference_surface.h"
#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

/// What boundary, interface and junction points are projected onto while shapes are improved: the interfaces
/// and junction curves of the mesh as it came, or for interfaces a reference surface given by the caller.
/// Working coordinates.
class SurfaceProjection {
 public:
  SurfaceProjection() = default;
  /// Copies what it needs: the mesh may change afterwards. `given` may be null and must outlive this; one
  /// without patches says that the borders of the faces' patches are known to a cell only.
  SurfaceProjection(const EditableMesh& mesh, const ReferenceSurface* given)
      : SurfaceProjection(mesh, mesh.interface_faces(), given, [](Index) { return true; }) {}
  /// Of these faces alone. `complete`: whether all interface faces at a point are among them; junction curves
  /// are looked for between such points.
  SurfaceProjection(const EditableMesh& mesh, const std::vector<InterfaceFace>& faces,
                    const ReferenceSurface* given, const std::function<bool(Index)>& complete);

  /// Whether some face has another patch than 0 and no given surface says that it knows none: planes and
  /// creases are kept exactly.
  bool has_patches() const { return has_patches_; }
  /// The nearest point, or one near it, of a patch of the interface between two regions within
  /// `max_distance`; safe concurrently.
  std::optional<Vec3> onto_surface(const Vec3& p, RegionId first, RegionId second, PatchId patch,
                                   double max_distance) const;
  /// The nearest point of a junction curve within `max_distance`; safe concurrently.
  std::optional<Vec3> onto_curve(const Vec3& p, double max_distance) const;
  /// The same of a point where junction curves end or branch.
  std::optional<Vec3> onto_corner(const Vec3& p, double max_distance) const;

 private:
  /// The nearer one of `own` and what a given surface with patches answers.
  std::optional<Vec3> nearer(const Vec3& p, const std::optional<Vec3>& own, double max_distance,
                             std::optional<Vec3> (ReferenceSurface::*onto)(const Vec3&, double) const) const;

  ProjectionTree surfaces_, curves_, corners_;
  bool has_patches_ = false;
  bool given_patches_ = false;  ///< `given_` knows creases and corners
  const ReferenceSurface* given_ = nullptr;
  const EditableMesh* mesh_ = nullptr;
};

}  // namespace tetwright
