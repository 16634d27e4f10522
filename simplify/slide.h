#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/reference_surface.h"
#include "simplify/editable_mesh.h"

namespace tetwright {

/// Triangles, segments and points (triangles with equal corners) for nearest-point queries: a tree of boxes
/// over them in Morton order, four to a leaf.
class NearestTree {
 public:
  struct Item {
    Triangle corners;      ///< indices into the points given
    Region first, second;  ///< what it separates, first < second; equal for all to count as one kind
  };
  NearestTree() = default;
  NearestTree(std::vector<Vec3> points, std::vector<Item> items);

  bool empty() const { return items_.empty(); }
  /// The nearest point on the items of a kind, if it is nearer than `most`. Safe to call concurrently.
  std::optional<Vec3> nearest(const Vec3& p, Region first, Region second, double most) const;

 private:
  struct Box {
    std::array<float, 3> low, high;
  };
  double squared_distance_to(const Box& box, const Vec3& p) const;
  std::vector<Vec3> points_;
  std::vector<Item> items_;
  std::vector<Box> boxes_;  ///< a heap: children of k are 2k + 1 and 2k + 2
  std::size_t leaves_ = 0;  ///< a power of two
};

/// What boundary, interface and junction points slide along while shapes are improved: the interfaces and
/// junction curves of the mesh as it came, or for interfaces a reference surface given by the caller. Working
/// coordinates.
class Slide {
 public:
  Slide() = default;
  /// Copies what it needs: the mesh may change afterwards. `given` may be null and must outlive this.
  Slide(const EditableMesh& mesh, const ReferenceSurface* given);

  /// The nearest point, or one near it, of the interface between two regions within `most`; safe
  /// concurrently.
  std::optional<Vec3> onto_surface(const Vec3& p, Region first, Region second, double most) const;
  /// True if there is a surface to slide on.
  bool has_surface() const { return given_ || !surfaces_.empty(); }
  /// The nearest point of a junction curve within `most`; safe concurrently.
  std::optional<Vec3> onto_curve(const Vec3& p, double most) const { return curves_.nearest(p, 0, 0, most); }
  /// The same of a point where junction curves end or branch.
  std::optional<Vec3> onto_corner(const Vec3& p, double most) const {
    return corners_.nearest(p, 0, 0, most);
  }

 private:
  NearestTree surfaces_, curves_, corners_;
  const ReferenceSurface* given_ = nullptr;
  const EditableMesh* mesh_ = nullptr;
};

}  // namespace tetwright
