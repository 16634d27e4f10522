// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/geometry/point_triangle.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Triangles, segments and points (triangles with coinciding corners) of several kinds, for nearest-point
/// queries: a tree of boxes in Morton order, four items to a leaf.
class ProjectionTree {
 public:
  /// Key that a query and the items it considers have in common; its numbers are defined by the caller.
  using Kind = std::array<std::uint32_t, 3>;
  struct Item {
    Triangle corners;  ///< indices into points()
    Kind kind;
  };
  struct Hit {
    Vec3 point;        ///< on the item
    std::size_t item;  ///< index into items()
  };
  ProjectionTree() = default;
  ProjectionTree(std::vector<Vec3> points, std::vector<Item> items);

  bool empty() const { return items_.empty(); }
  /// Items in the order of the tree.
  const std::vector<Item>& items() const { return items_; }
  const std::vector<Vec3>& points() const { return points_; }
  const Vec3& corner(const Item& item, int k) const { return points_[item.corners[k]]; }
  /// Nearest point of an item of items().
  Vec3 closest_on(std::size_t item, const Vec3& p) const {
    return closest_point(p, corner(items_[item], 0), corner(items_[item], 1), corner(items_[item], 2));
  }

  /// Nearest point of the items for which `accepts(item)` holds, or std::nullopt if none is nearer than
  /// `max_distance`. May be called concurrently.
  template <class Accepts>
  std::optional<Hit> nearest_of(const Vec3& p, double max_distance, const Accepts& accepts) const {
    std::optional<Hit> found;
    tree_.nearest(p, max_distance * max_distance, tree_.all(), [&](std::size_t i, double best) {
      const Item& item = items_[i];
      if (!accepts(item)) return best;
      const Vec3 q = closest_on(i, p);
      const double d = (q - p).squaredNorm();
      if (d > best || (d == best && found)) return best;
      found = Hit{q, i};
      return d;
    });
    return found;
  }
  /// Whether an item is within `max_distance`; faster than finding the nearest one. May be called
  /// concurrently.
  bool any_within(const Vec3& p, double max_distance) const {
    return tree_.nearest(p, max_distance * max_distance, tree_.all(), [&](std::size_t i, double best) {
      const Item& item = items_[i];
      if (best < 0 || squared_distance(p, corner(item, 0), corner(item, 1), corner(item, 2)) > best)
        return best;
      return -1.0;  // nothing can be nearer: ends the search
    }) < 0;
  }
  /// Nearest point of the items of a kind, or std::nullopt if none is nearer than `max_distance`.
  std::optional<Vec3> nearest(const Vec3& p, const Kind& kind, double max_distance) const {
    const auto hit = nearest_of(p, max_distance, [&](const Item& item) { return item.kind == kind; });
    if (!hit) return {};
    return hit->point;
  }

 private:
  std::vector<Vec3> points_;
  std::vector<Item> items_;
  BoxTree tree_;
};

}  // namespace tetwright
