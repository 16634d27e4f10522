// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Solid over a polygon of the xy plane from z = 0 to `height`. The polygon is counter-clockwise and
/// star-shaped around `centre`, the mirror image of its first point.
inline TriangleMesh extruded(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& centre,
                             double height) {
  TriangleMesh mesh;
  const auto n = static_cast<Index>(polygon.size());
  for (const double z : {0.0, height})
    for (const Eigen::Vector2d& p : polygon) mesh.points.emplace_back(p.x(), p.y(), z);
  for (const double z : {0.0, height}) mesh.points.emplace_back(centre.x(), centre.y(), z);
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    mesh.triangles.push_back({2 * n, j, i});
    mesh.triangles.push_back({2 * n + 1, n + i, n + j});
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
  }
  return mesh;
}

inline TriangleMesh unit_cube() { return extruded({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {0.5, 0.5}, 1); }

/// A block of volume 3/4 with a concave edge.
inline TriangleMesh l_block() {
  return extruded({{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}}, {0.25, 0.25}, 1);
}

/// A cylinder with `facets` facets.
inline TriangleMesh cylinder(int facets, double radius = 0.5, double height = 1) {
  std::vector<Eigen::Vector2d> circle;
  for (int i = 0; i < facets; ++i) {
    const double a = 2 * std::numbers::pi * i / facets;
    circle.emplace_back(radius * std::cos(a), radius * std::sin(a));
  }
  return extruded(circle, {0, 0}, height);
}

/// Rotates the mesh so that no face is parallel to an axis.
inline TriangleMesh turned(TriangleMesh mesh) {
  const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()) *
                                    Eigen::AngleAxisd(0.9, Vec3(3, -1, 2).normalized()))
                                       .toRotationMatrix();
  for (Vec3& p : mesh.points) p = rotation * p;
  return mesh;
}

}  // namespace tetwright
