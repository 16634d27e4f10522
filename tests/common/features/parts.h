// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "common/random.h"
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

/// A square plate with flat sides and base, whose upper side is noise.
inline TriangleMesh terrain(Index n) {
  Random random(5);
  TriangleMesh s;
  const auto add_grid = [&](const Vec3& origin, const Vec3& u, const Vec3& v, double noise) {
    const auto first = static_cast<Index>(s.points.size());
    for (Index i = 0; i <= n; ++i)
      for (Index j = 0; j <= n; ++j)
        s.points.emplace_back(origin + (i * u + j * v) / n + Vec3(0, 0, noise * (random.uniform() - 0.5)));
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) {
        const Index a = first + i * (n + 1) + j, b = a + n + 1;
        s.triangles.push_back({a, b, b + 1});
        s.triangles.push_back({a, b + 1, a + 1});
      }
  };
  add_grid(Vec3(0, 0, 1), Vec3::UnitX(), Vec3::UnitY(), 0.4 / n);
  // The walls hang from the points of the rim.
  std::vector<Index> rim;
  for (Index i = 0; i < n; ++i) rim.push_back(i * (n + 1));
  for (Index j = 0; j < n; ++j) rim.push_back(n * (n + 1) + j);
  for (Index i = n; i > 0; --i) rim.push_back(i * (n + 1) + n);
  for (Index j = n; j > 0; --j) rim.push_back(j);
  const auto first = static_cast<Index>(s.points.size()), count = static_cast<Index>(rim.size());
  for (const Index p : rim) s.points.emplace_back(s.points[p].x(), s.points[p].y(), 0);
  for (Index k = 0; k < count; ++k) {
    const Index a = rim[k], b = rim[(k + 1) % count], c = first + k, d = first + (k + 1) % count;
    s.triangles.push_back({a, c, d});
    s.triangles.push_back({a, d, b});
  }
  const auto middle = static_cast<Index>(s.points.size());
  s.points.emplace_back(0.5, 0.5, 0);
  for (Index k = 0; k < count; ++k) s.triangles.push_back({first + (k + 1) % count, first + k, middle});
  return s;
}

/// A strip of length 32 and width 2, folded along its middle by 45 degrees up to `sharp`, then gradually
/// less, down to 20.
inline TriangleMesh folded_strip(Index sharp) {
  constexpr Index n = 32;
  TriangleMesh s;
  for (Index y = 0; y <= n; ++y) {
    const double angle = y <= sharp ? 45 : std::max(20.0, 45 - 3.0 * (y - sharp));
    for (Index x = 0; x <= 2; ++x)
      s.points.emplace_back(x, y, x < 2 ? 0 : std::tan(angle * std::numbers::pi / 180));
  }
  for (Index y = 0; y < n; ++y)
    for (Index x = 0; x < 2; ++x) {
      const Index a = 3 * y + x;
      s.triangles.push_back({a, a + 1, a + 4});
      s.triangles.push_back({a, a + 4, a + 3});
    }
  return s;
}

/// A block whose top is a folded_strip().
inline TriangleMesh folded_block(Index sharp) {
  TriangleMesh s = folded_strip(sharp);
  const auto below = static_cast<Index>(s.points.size());
  for (Index p = 0; p < below; ++p) s.points.emplace_back(s.points[p].x(), s.points[p].y(), -2);
  const std::vector<Triangle> top = s.triangles;
  for (const auto& [a, b, c] : top) s.triangles.push_back({below + a, below + c, below + b});
  std::set<std::array<Index, 2>> edges;
  for (const Triangle& t : top)
    for (int k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
  for (const auto& [a, b] : edges) {
    if (edges.contains({b, a})) continue;
    s.triangles.push_back({b, a, below + a});
    s.triangles.push_back({b, below + a, below + b});
  }
  return s;
}

}  // namespace tetwright
