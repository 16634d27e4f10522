// SPDX-License-Identifier: Apache-2.0
#include "tests/mesher/complex/random_bodies.h"

#include <cmath>
#include <numbers>

#include "tests/mesher/test_surfaces.h"

namespace tetwright {

SurfaceSoup soup_of(const std::vector<TriangleMesh>& surfaces) {
  SurfaceSoup soup;
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
    const auto first = static_cast<Index>(soup.points.size());
    soup.points.insert(soup.points.end(), surfaces[s].points.begin(), surfaces[s].points.end());
    for (const Triangle& t : surfaces[s].triangles) {
      soup.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      soup.surface.push_back(s);
    }
  }
  return soup;
}

TriangleMesh turned(TriangleMesh mesh, double angle, const Vec3& axis) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  for (Vec3& p : mesh.points) p = turn * p;
  return mesh;
}

TriangleMesh make_prism(double radius, double height, const Vec3& centre_below, int sides) {
  TriangleMesh mesh;
  const auto n = static_cast<Index>(sides);
  for (Index k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    // Rounded, so that top and bottom are congruent and differ in nothing but z.
    const Vec3 p(std::round(64 * radius * std::cos(angle)) / 64,
                 std::round(64 * radius * std::sin(angle)) / 64, 0);
    mesh.points.push_back(centre_below + p);
    mesh.points.push_back(centre_below + p + Vec3(0, 0, height));
  }
  for (Index k = 0; k < n; ++k) {
    const Index next = (k + 1) % n;
    mesh.triangles.push_back({2 * k, 2 * next, 2 * next + 1});
    mesh.triangles.push_back({2 * k, 2 * next + 1, 2 * k + 1});
    if (k == 0 || next == 0) continue;
    mesh.triangles.push_back({0, 2 * next, 2 * k});
    mesh.triangles.push_back({1, 2 * k + 1, 2 * next + 1});
  }
  return mesh;
}

std::vector<TriangleMesh> random_bodies(std::uint32_t seed, bool exact) {
  std::mt19937 random(seed), random_shift(seed);
  // Distributions of the standard library differ between its implementations.
  const auto below = [&](std::uint32_t n) { return static_cast<int>(random() % n); };
  const auto quarters = [&](int low, int high) {
    return 0.25 * (low + below(static_cast<std::uint32_t>(high - low + 1)));
  };
  const auto place = [&] {
    const double x = quarters(0, 4), y = quarters(0, 4), z = quarters(0, 4);
    return Vec3(x, y, z);
  };
  std::vector<TriangleMesh> bodies;
  const int count = 2 + below(3);
  while (static_cast<int>(bodies.size()) < count) {
    const Vec3 at = place();
    TriangleMesh body;
    switch (below(3)) {
      case 0: {
        const Vec3 size = Vec3::Constant(0.5) + place() / 2;
        body = make_box(at, at + size);
        break;
      }
      case 1: {
        const double radius = quarters(1, 3), height = quarters(1, 5);
        body = make_prism(radius, height, at, 5 + below(5));
        const int axis = below(3);
        for (Vec3& p : body.points) p = Vec3(p[(3 - axis) % 3], p[(4 - axis) % 3], p[(5 - axis) % 3]);
        break;
      }
      default:
        body = make_sphere(quarters(1, 3), at, 1);
        for (Vec3& p : body.points)
          if (exact) p = (1024 * p).array().round() / 1024;
    }
    if (below(2) == 0) {
      const double angle = 0.1 + 0.01 * below(100);
      body = turned(std::move(body), angle, Vec3(0.1, 0.2, 0.3) + place());
      const double shift = exact ? 0.001 * (1 + static_cast<int>(random_shift() % 97)) : 0;
      for (Vec3& q : body.points) q += shift * Vec3(1, 0.37, -0.61);
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace tetwright
