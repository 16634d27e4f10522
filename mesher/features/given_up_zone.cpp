// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/given_up_zone.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/geometry/point_triangle.h"
#include "common/geometry/self_intersection.h"

namespace tetwright {

GivenUpZone::GivenUpZone(std::vector<Causes> by_body, double cell) : cell_(cell) {
  for (Causes& causes : by_body) {
    any_ |= !causes.items.empty();
    only_crossings_.push_back(causes.only_crossings);
    bodies_.emplace_back(std::move(causes.points), std::move(causes.items));
  }
}

namespace {

using Corners = std::array<Vec3, 3>;

/// Adds the points in which edges of `of` pierce a triangle.
void add_piercings(const Corners& of, const Corners& triangle, double slack, std::vector<Vec3>& found) {
  const Vec3& apex = triangle[0];
  const Vec3 normal = (triangle[1] - apex).cross(triangle[2] - apex);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = of[k], &b = of[(k + 1) % 3];
    const double from = normal.dot(a - apex), to = normal.dot(b - apex);
    if (from == to || (from > 0) == (to > 0)) continue;
    const Vec3 p = a + (b - a) * (from / (from - to));
    if (squared_distance(p, triangle[0], triangle[1], triangle[2]) <= slack * slack) found.push_back(p);
  }
}

double area2(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).squaredNorm(); }

double size_of(const Corners& t) {
  return std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
}

}  // namespace

void add_self_crossings(const RepairedSurface& surface, GivenUpZone::Causes& causes) {
  const auto corners_of = [&](Index t) {
    const auto& [a, b, c] = surface.triangles[t];
    return Corners{surface.points[a], surface.points[b], surface.points[c]};
  };
  for (const auto& [f, g] : self_intersections(surface.points, surface.triangles)) {
    const Corners s = corners_of(f), t = corners_of(g);
    const double slack = CellTuning::GivenUp::on_triangle * std::max(size_of(s), size_of(t));
    std::vector<Vec3> ends;
    add_piercings(s, t, slack, ends);
    add_piercings(t, s, slack, ends);
    if (ends.size() < 2) {
      // They overlap in one plane, or touch: the smaller one covers what they have in common.
      const Corners& smaller = area2(s) < area2(t) ? s : t;
      causes.add(smaller[0], smaller[1], smaller[2]);
      continue;
    }
    const auto farther = [&](const Vec3& p, const Vec3& q) {
      return (p - ends[0]).squaredNorm() < (q - ends[0]).squaredNorm();
    };
    const Vec3& last = *std::max_element(ends.begin() + 1, ends.end(), farther);
    causes.add(ends[0], last, last);
  }
}

}  // namespace tetwright
