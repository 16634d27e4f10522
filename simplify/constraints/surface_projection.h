// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "simplify/mesh/editable_mesh.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// The surfaces that boundary, interface and junction points are projected onto while shapes are improved:
/// the interfaces, sheets and junction curves of the input mesh, or for interfaces a reference surface given
/// by the caller. Working coordinates. Queries are safe concurrently.
class SurfaceProjection {
 public:
  SurfaceProjection() = default;
  /// Copies its data: the mesh may change afterwards.
  ///
  /// \param given reference surface, may be null; must outlive this object. If it has no patches, the patch
  ///   borders of the mesh are accurate to a cell only.
  SurfaceProjection(const EditableMesh& mesh, const ReferenceSurface* given)
      : SurfaceProjection(mesh, mesh.positions(), mesh.interface_faces(), given, [](Index) { return true; }) {
  }
  /// As above, with these faces instead of the mesh's.
  ///
  /// \param points of the faces, by index.
  /// \param complete whether all interface faces at a point are among `faces`; junction curves are found only
  ///   between such points.
  SurfaceProjection(const EditableMesh& mesh, std::span<const Vec3> points,
                    const std::vector<InterfaceFace>& faces, const ReferenceSurface* given,
                    const std::function<bool(Index)>& complete);

  /// Whether some face has a patch other than 0; false if the given surface has no patches. If true, planes
  /// and feature edges are kept exactly.
  bool has_patches() const { return has_patches_; }
  /// Whether the mesh has sheets, which are kept like patches.
  bool has_sheets() const { return has_sheets_; }
  /// Whether the given surface gives up the creases at a point.
  bool lacks_creases(const Vec3& p) const {
    return given_patches_ && given_->lacks_creases(mesh_->space().to_input(p));
  }
  /// ReferenceSurface::first_body_patch() of the given surface.
  PatchId first_body_patch() const { return given_patches_ ? given_->first_body_patch() : PatchId{0}; }
  /// ReferenceSurface::is_flat() of the given surface.
  bool is_flat(PatchId patch) const { return given_patches_ && given_->is_flat(patch); }
  /// ReferenceSurface::creased_size() of the given surface, working coordinates.
  std::optional<double> creased_size() const {
    const auto size = given_patches_ ? given_->creased_size() : std::nullopt;
    return size ? std::optional(*size * mesh_->space().scale()) : std::nullopt;
  }
  /// The nearest or nearly nearest point to p on a patch of the interface between two regions, within
  /// `max_distance`.
  std::optional<Vec3> onto_surface(const Vec3& p, RegionId first, RegionId second, PatchId patch,
                                   double max_distance) const;
  /// The nearest point of a junction curve within `max_distance`.
  std::optional<Vec3> onto_curve(const Vec3& p, double max_distance) const;
  /// The nearest point of a crease of the given surface within `max_distance`.
  std::optional<Vec3> onto_crease(const Vec3& p, double max_distance) const;
  /// The nearest corner, where junction curves end or branch, within `max_distance`.
  /// \param of_bodies only those of the given surface
  std::optional<Vec3> onto_corner(const Vec3& p, double max_distance, bool of_bodies = false) const;

 private:
  /// Whether the given surface itself has the curve that a junction edge or patch border follows.
  bool given_has_curve(const Vec3& p, const Vec3& q, bool junction) const;
  /// The nearer of `own` and the given surface's answer, if that has patches.
  std::optional<Vec3> nearer(const Vec3& p, const std::optional<Vec3>& own, double max_distance,
                             std::optional<Vec3> (ReferenceSurface::*onto)(const Vec3&, double) const) const;

  ProjectionTree surfaces_, curves_, corners_;
  bool has_patches_ = false, has_sheets_ = false;
  bool given_patches_ = false;  ///< `given_` provides feature edges and corners
  bool has_labels_ = false;     ///< the bodies of `given_` are among labels
  const ReferenceSurface* given_ = nullptr;
  const EditableMesh* mesh_ = nullptr;
};

}  // namespace tetwright
