// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/box_tree.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A part of a triangle between planes of the axes.
struct TriangleReference {
  Index triangle;
  Box3 box;  ///< contains that part
};

/// The boxes of triangles, of long ones in several parts (early split clipping, Ernst & Greiner 2007): the
/// box of a long sliver is mostly empty, so that a search would visit slivers far away. Parts are halved
/// until they are as short as the number of parts allows, at most three more for each triangle and
/// 256. In the order of triangles; O(n). \pre finite coordinates, so far from the largest double that
/// their differences are finite
std::vector<TriangleReference> split_references(std::span<const std::array<Vec3, 3>> triangles);

/// A bounding volume hierarchy over triangles of any shape, each in as many leaves as it has parts
/// (split_references()). Stores boxes and numbers of triangles, not their corners. Immutable after
/// construction; all functions may be called concurrently. Built in O(n log n); about 130 bytes for each
/// part.
class ReferenceTree {
 public:
  ReferenceTree() = default;
  explicit ReferenceTree(std::span<const std::array<Vec3, 3>> triangles);

  /// Number of parts of all triangles.
  std::size_t references() const { return triangles_.size(); }
  /// Whether a triangle has several parts.
  bool is_split(std::size_t triangle) const { return is_split_[triangle] != 0; }

  /// As BoxTree::nearest(). Triangles with several parts may be visited several times.
  /// \param visit `visit(triangle, best)` returns the minimum of `best` and the squared distance of the
  /// triangle
  template <class Visit>
  double nearest(const Vec3& p, double squared_limit, const Visit& visit) const {
    return tree_.nearest(p, squared_limit, tree_.all(),
                         [&](std::size_t i, double best) { return visit(triangles_[i], best); });
  }
  /// As BoxTree::for_each_in(). Triangles with several parts may be visited several times.
  template <class Enter, class Visit>
  void for_each_in(const Enter& enter, const Visit& visit) const {
    tree_.for_each_in(enter, [&](std::size_t i) { visit(triangles_[i]); });
  }

 private:
  BoxTree tree_;
  std::vector<Index> triangles_;        ///< of each part, in tree order
  std::vector<std::uint8_t> is_split_;  ///< by triangle
};

}  // namespace tetwright
