// SPDX-License-Identifier: Apache-2.0
#include "tetwright/sizes.h"

#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "common/geometry/box_tree.h"
#include "common/geometry/point_triangle.h"
#include "common/geometry/projection_tree.h"
#include "common/mesh/tet_tree.h"
#include "common/tolerances.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Weighted sum of lengths. Interpolating differences reproduces equal lengths bit by bit.
template <std::size_t n>
double interpolated(const std::array<Index, n>& corners, const std::array<double, n>& weights,
                    const std::vector<double>& lengths) {
  const double first = lengths[corners[0]];
  double sum = first;
  for (std::size_t k = 1; k < n; ++k) sum += weights[k] * (lengths[corners[k]] - first);
  return sum;
}

/// Flags the points that an element uses.
template <class Elements>
std::vector<char> used_points(const Elements& elements, std::size_t points) {
  std::vector<char> used(points, 0);
  for (const auto& element : elements)
    for (const Index p : element) used[p] = 1;
  return used;
}

/// Lengths at the points of a mesh, and which points are used.
class PointLengths {
 public:
  PointLengths(std::vector<double> lengths, std::vector<char> used)
      : lengths_(std::move(lengths)), used_(std::move(used)) {
    TETWRIGHT_CHECK(lengths_.size() == used_.size());
  }
  const std::vector<double>& lengths() const { return lengths_; }
  void for_each(const std::vector<Vec3>& points, const std::function<void(const Vec3&, double)>& f) const {
    for (std::size_t p = 0; p < points.size(); ++p)
      if (used_[p]) f(points[p], lengths_[p]);
  }
  double diagonal(const std::vector<Vec3>& points) const {
    Box3 box;
    for (std::size_t p = 0; p < points.size(); ++p)
      if (used_[p]) box.add(points[p]);
    return (box.high - box.low).norm();
  }

 private:
  std::vector<double> lengths_;
  std::vector<char> used_;
};

class TetMeshSizes : public SizeSource {
 public:
  TetMeshSizes(TetMesh mesh, std::vector<double> lengths, std::string field)
      : SizeSource(std::move(field), mesh.space),
        mesh_(std::move(mesh)),
        of_points_(std::move(lengths), used_points(mesh_.tets, mesh_.points.size())),
        reach_(tolerance::within_mesh * of_points_.diagonal(mesh_.points)),
        tree_(mesh_, TetTree::Order::place) {}

  std::optional<WantedLength> at(const Vec3& place) const override {
    const FoundTet found = tree_.find(place, tree_.all(), reach_);
    if (found.tet == no_index) return {};
    return WantedLength{interpolated(mesh_.tets[found.tet], found.weights, of_points_.lengths()), 0};
  }

  void for_each_value(const std::function<void(const Vec3&, double)>& f) const override {
    of_points_.for_each(mesh_.points, f);
  }

 private:
  const TetMesh mesh_;
  const PointLengths of_points_;
  const double reach_;  ///< maximum distance outside the tets
  const TetTree tree_;  ///< refers to mesh_
};

std::vector<ProjectionTree::Item> items_of(const std::vector<Triangle>& triangles) {
  std::vector<ProjectionTree::Item> items;
  items.reserve(triangles.size());
  for (const Triangle& t : triangles) items.push_back({t, {}});
  return items;
}

class SurfaceSizes : public SizeSource {
 public:
  SurfaceSizes(TriangleMesh surface, std::vector<double> lengths, std::string field)
      : SizeSource(std::move(field), surface.space),
        of_points_(std::move(lengths), used_points(surface.triangles, surface.points.size())),
        tree_(std::move(surface.points), items_of(surface.triangles)) {}

  bool fills_space() const override { return false; }

  std::optional<WantedLength> at(const Vec3& place) const override {
    constexpr double anywhere = std::numeric_limits<double>::infinity();
    const auto hit = tree_.nearest_of(place, anywhere, [](const ProjectionTree::Item&) { return true; });
    if (!hit) return {};
    const ProjectionTree::Item& item = tree_.items()[hit->item];
    const auto weights =
        weights_in_triangle(hit->point, tree_.corner(item, 0), tree_.corner(item, 1), tree_.corner(item, 2));
    return WantedLength{interpolated(item.corners, weights, of_points_.lengths()),
                        (hit->point - place).norm()};
  }

  void for_each_value(const std::function<void(const Vec3&, double)>& f) const override {
    of_points_.for_each(tree_.points(), f);
  }

 private:
  const PointLengths of_points_;
  const ProjectionTree tree_;
};

}  // namespace

std::unique_ptr<const SizeSource> tet_mesh_sizes(TetMesh mesh, std::vector<double> lengths,
                                                 std::string field) {
  return std::make_unique<TetMeshSizes>(std::move(mesh), std::move(lengths), std::move(field));
}

std::unique_ptr<const SizeSource> surface_sizes(TriangleMesh surface, std::vector<double> lengths,
                                                std::string field) {
  return std::make_unique<SurfaceSizes>(std::move(surface), std::move(lengths), std::move(field));
}

}  // namespace tetwright
