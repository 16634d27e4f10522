// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// An axis-aligned box, initially empty.
struct Box3 {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const Box3& b) {
    low = low.cwiseMin(b.low);
    high = high.cwiseMax(b.high);
  }
  bool contains(const Vec3& p) const {
    return low.x() <= p.x() && p.x() <= high.x() && low.y() <= p.y() && p.y() <= high.y() &&
           low.z() <= p.z() && p.z() <= high.z();
  }
  bool intersects(const Box3& b) const {
    return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all();
  }
  /// Infinite for an empty box.
  double squared_distance(const Vec3& p) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = std::max({low[axis] - p[axis], p[axis] - high[axis], 0.0});
      sum += d * d;
    }
    return sum;
  }
};

/// A bounding volume hierarchy over items in an order chosen by the caller. Neighbours in the order should be
/// neighbours in space (morton_order(), median_order()). The tree stores boxes and positions in that order,
/// never the items.
///
/// A node of L > 1 leaves is split into L / 2 and the remaining leaves, so that its shape depends only on the
/// number of items. Nodes are in depth-first order: the first child of node k is k + 1, and `next` is the
/// first node after the subtree of k. Built in O(n); 64 bytes for each node. Immutable after construction;
/// all functions may be called concurrently.
class BoxTree {
 public:
  /// A range of positions.
  struct Range {
    std::size_t begin, end;
  };
  struct Node {
    Box3 box;
    std::uint32_t next;
    std::uint32_t begin, end;  ///< positions
  };

  BoxTree() = default;
  /// \param box_at returns the box of the item at a position
  /// \pre fewer than 2^31 items
  BoxTree(std::size_t count, std::size_t leaf_size, const std::function<Box3(std::size_t)>& box_at);

  bool empty() const { return nodes_.empty(); }
  std::span<const Node> nodes() const { return nodes_; }
  bool is_leaf(const Node& node) const { return node.end - node.begin <= leaf_size_; }
  Range all() const { return {0, nodes_.empty() ? 0 : nodes_[0].end}; }

  /// Visits the items of `range`, nearest boxes first. Skips leaves farther away than the best distance so
  /// far, but not those at an equal distance.
  /// \param visit `visit(position, best)` returns the minimum of `best` and the squared distance of the item
  ///   from `p`
  /// \return the smallest squared distance, or `squared_limit` if no item is nearer
  template <class Visit>
  double nearest(const Vec3& p, double squared_limit, const Range& range, const Visit& visit) const {
    double best = squared_limit;
    if (nodes_.empty()) return best;
    struct Entry {
      std::uint32_t node;
      double squared_distance;
    };
    std::array<Entry, stack_size> stack;
    std::size_t size = 0;
    stack[size++] = {0, nodes_[0].box.squared_distance(p)};
    while (size > 0) {
      const Entry entry = stack[--size];
      if (entry.squared_distance > best) continue;
      const Node& node = nodes_[entry.node];
      const std::size_t begin = std::max<std::size_t>(node.begin, range.begin),
                        end = std::min<std::size_t>(node.end, range.end);
      if (begin >= end) continue;
      if (is_leaf(node)) {
        for (std::size_t i = begin; i < end; ++i) best = visit(i, best);
        continue;
      }
      Entry near{entry.node + 1, nodes_[entry.node + 1].box.squared_distance(p)};
      const std::uint32_t second = nodes_[near.node].next;
      Entry far{second, nodes_[second].box.squared_distance(p)};
      if (far.squared_distance < near.squared_distance) std::swap(near, far);
      stack[size++] = far;
      stack[size++] = near;
    }
    return best;
  }

  /// Calls `visit(position)` for the items of `range` in leaves whose box contains `p`, in ascending order,
  /// until it returns true.
  /// \return whether it returned true
  template <class Visit>
  bool any_containing(const Vec3& p, const Range& range, const Visit& visit) const {
    for (std::size_t k = 0; k < nodes_.size();) {
      const Node& node = nodes_[k];
      const std::size_t begin = std::max<std::size_t>(node.begin, range.begin),
                        end = std::min<std::size_t>(node.end, range.end);
      if (begin >= end || !node.box.contains(p)) {
        k = node.next;
        continue;
      }
      if (is_leaf(node))
        for (std::size_t i = begin; i < end; ++i)
          if (visit(i)) return true;
      ++k;
    }
    return false;
  }

  /// Calls `visit(position)`, in ascending order, for the items of all leaves for which `enter(box)` holds on
  /// the leaf and all its ancestors.
  template <class Enter, class Visit>
  void for_each_in(const Enter& enter, const Visit& visit) const {
    for (std::size_t k = 0; k < nodes_.size();) {
      const Node& node = nodes_[k];
      if (!enter(node.box)) {
        k = node.next;
        continue;
      }
      if (is_leaf(node))
        for (std::size_t i = node.begin; i < node.end; ++i) visit(i);
      ++k;
    }
  }

  /// Calls `visit(leaf)` for the leaf `own` (an index into nodes()) and each later leaf whose box intersects
  /// its box. Calling this for every leaf visits each pair once.
  template <class Visit>
  void for_each_later_intersecting_leaf(std::size_t own, const Visit& visit) const {
    const Node& leaf = nodes_[own];
    for (std::size_t k = 0; k < nodes_.size();) {
      const Node& node = nodes_[k];
      if (node.next <= own || !node.box.intersects(leaf.box)) {
        k = node.next;
        continue;
      }
      if (is_leaf(node)) visit(k);
      ++k;
    }
  }

  /// Number of leaves for `items` items.
  static std::size_t leaf_count(std::size_t items, std::size_t leaf_size) {
    return (items + leaf_size - 1) / leaf_size;
  }

 private:
  static constexpr std::size_t stack_size = 64;  // height at most 32, and each level leaves one entry

  std::vector<Node> nodes_;
  std::size_t leaf_size_ = 1;
};

/// Items 0 to boxes.size() - 1 in the Morton order of their boxes' centres.
std::vector<Index> morton_order(std::span<const Box3> boxes);

/// Items 0 to centres.size() - 1, split recursively at the median of the longest side of their boxes into
/// whole leaves, as BoxTree splits its nodes: tighter boxes than in Morton order. The result does not depend
/// on the number of threads.
std::vector<Index> median_order(std::span<const Box3> boxes, std::span<const Vec3> centres,
                                std::size_t leaf_size);

}  // namespace tetwright
