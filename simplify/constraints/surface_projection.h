#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/reference_surface.h"
#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

/// Triangles, segments and points (triangles with equal corners) for nearest-point queries: a tree of boxes
/// over them in Morton order, four to a leaf.
class ProjectionTree {
 public:
  struct Item {
    Triangle corners;        ///< indices into the points given
    RegionId first, second;  ///< what it separates, first < second; equal for all to count as one kind
    PatchId patch;           ///< likewise
  };
  ProjectionTree() = default;
  ProjectionTree(std::vector<Vec3> points, std::vector<Item> items);

  bool empty() const { return items_.empty(); }
  /// The nearest point on the items of a kind, if it is nearer than `max_distance`. Safe to call
  /// concurrently.
  std::optional<Vec3> nearest(const Vec3& p, RegionId first, RegionId second, PatchId patch,
                              double max_distance) const;

 private:
  std::vector<Vec3> points_;
  std::vector<Item> items_;
  BoxTree tree_;
};

/// What boundary, interface and junction points are projected onto while shapes are improved: the interfaces
/// and junction curves of the mesh as it came, or for interfaces a reference surface given by the caller.
/// Working coordinates.
class SurfaceProjection {
 public:
  SurfaceProjection() = default;
  /// Copies what it needs: the mesh may change afterwards. `given` may be null and must outlive this.
  SurfaceProjection(const EditableMesh& mesh, const ReferenceSurface* given)
      : SurfaceProjection(mesh, mesh.interface_faces(), given, [](Index) { return true; }) {}
  /// Of these faces alone. `complete`: whether all interface faces at a point are among them; junction curves
  /// are looked for between such points.
  SurfaceProjection(const EditableMesh& mesh, const std::vector<InterfaceFace>& faces,
                    const ReferenceSurface* given, const std::function<bool(Index)>& complete);

  /// The nearest point, or one near it, of a patch of the interface between two regions within
  /// `max_distance`; safe concurrently. A given reference surface knows no patches.
  std::optional<Vec3> onto_surface(const Vec3& p, RegionId first, RegionId second, PatchId patch,
                                   double max_distance) const;
  /// The nearest point of a junction curve within `max_distance`; safe concurrently.
  std::optional<Vec3> onto_curve(const Vec3& p, double max_distance) const {
    return curves_.nearest(p, 0, 0, 0, max_distance);
  }
  /// The same of a point where junction curves end or branch.
  std::optional<Vec3> onto_corner(const Vec3& p, double max_distance) const {
    return corners_.nearest(p, 0, 0, 0, max_distance);
  }

 private:
  ProjectionTree surfaces_, curves_, corners_;
  const ReferenceSurface* given_ = nullptr;
  const EditableMesh* mesh_ = nullptr;
};

}  // namespace tetwright
