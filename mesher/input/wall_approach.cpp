// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/wall_approach.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/point_triangle.h"
#include "mesher/tuning/input_tuning.h"

namespace tetwright {

namespace {

using Turning = InputTuning::WallApproach;

/// Whether a ray meets a box.
bool ray_meets(const Box3& box, const Vec3& from, const Vec3& direction) {
  double first = 0, last = HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    if (direction[a] == 0) {
      if (from[a] < box.low[a] || from[a] > box.high[a]) return false;
      continue;
    }
    const double low = (box.low[a] - from[a]) / direction[a], high = (box.high[a] - from[a]) / direction[a];
    first = std::max(first, std::min(low, high));
    last = std::min(last, std::max(low, high));
  }
  return first <= last;
}

/// The distance at which a ray meets a triangle (Möller and Trumbore, 1997), or a negative value.
double ray_meets(const std::array<Vec3, 3>& triangle, const Vec3& from, const Vec3& direction) {
  const Vec3 u = triangle[1] - triangle[0], v = triangle[2] - triangle[0], h = direction.cross(v);
  const double determinant = u.dot(h);
  if (determinant == 0) return -1;
  const Vec3 to = from - triangle[0], q = to.cross(u);
  const double a = to.dot(h) / determinant, b = direction.dot(q) / determinant;
  return a < 0 || b < 0 || a + b > 1 ? -1 : v.dot(q) / determinant;
}

}  // namespace

void WallApproach::Walls::add(const TriangleMesh& surface, std::uint32_t body) {
  const std::vector<Vec3>& p = surface.points;
  for (const auto& [a, b, c] : surface.triangles) {
    if (std::max({a, b, c}) >= p.size()) continue;  // refused when the surface is cleaned
    const Vec3 normal = (p[b] - p[a]).cross(p[c] - p[a]).normalized();
    if (normal.allFinite() && normal.norm() > 0) all.push_back({{p[a], p[b], p[c]}, normal, body});
  }
}

void WallApproach::Walls::build() {
  std::vector<Box3> boxes(all.size());
  std::vector<Vec3> centres(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const Vec3& q : all[i].corners) boxes[i].add(q);
    centres[i] = (all[i].corners[0] + all[i].corners[1] + all[i].corners[2]) / 3;
  }
  const std::vector<Index> order = median_order(boxes, centres, Turning::leaf_size);
  tree = BoxTree(order.size(), Turning::leaf_size, [&](std::size_t i) { return boxes[order[i]]; });
  std::vector<Wall> sorted;
  sorted.reserve(order.size());
  for (const Index i : order) sorted.push_back(all[i]);
  all = std::move(sorted);
}

template <class Visit>
void WallApproach::Walls::for_crossings(const Vec3& from, const Vec3& direction, const Visit& visit) const {
  tree.for_each_in([&](const Box3& box) { return ray_meets(box, from, direction); },
                   [&](std::size_t i) {
                     const double at = ray_meets(all[i].corners, from, direction);
                     if (at >= 0) visit(all[i], at);
                   });
}

WallApproach::WallApproach(std::span<const MaterialSurface> bodies, std::span<const SheetSurface> sheets) {
  for (const MaterialSurface& body : bodies) walls_.add(body.surface, bodies_++);
  for (const SheetSurface& sheet : sheets)
    if (sheet.divides) sheets_.add(sheet.surface, 0);
  walls_.build();
  sheets_.build();
}

/// By parity, which does not depend on how triangles are oriented.
bool WallApproach::is_inside(const Vec3& point) const {
  std::vector<char> odd(bodies_, 0);
  // A direction that hardly any edge of a model is parallel to.
  const Vec3 direction = Vec3(0.5381, 0.2467, 0.8059).normalized();
  walls_.for_crossings(point, direction, [&](const Wall& wall, double) { odd[wall.body] ^= 1; });
  return std::any_of(odd.begin(), odd.end(), [](char is_odd) { return is_odd != 0; });
}

double WallApproach::distance_along(const Vec3& from, const Vec3& direction) const {
  double first = HUGE_VAL;
  walls_.for_crossings(from, direction, [&](const Wall&, double at) { first = std::min(first, at); });
  return first;
}

/// The nearest wall that a surface with this normal may meet at a narrow angle.
WallApproach::NearestWall WallApproach::nearest(const Vec3& point, const Vec3& normal, double limit) const {
  NearestWall found;
  walls_.tree.nearest(point, limit * limit, walls_.tree.all(), [&](std::size_t i, double best) {
    const Wall& wall = walls_.all[i];
    const double cosine = std::abs(wall.normal.dot(normal));
    if (cosine < Turning::narrow) return best;
    const Vec3 to = closest_point(point, wall.corners[0], wall.corners[1], wall.corners[2]) - point;
    const double squared = to.squaredNorm();
    if (squared >= best) return best;
    const double distance = std::sqrt(squared);
    found = {distance, distance > 0 ? Vec3(to / distance) : Vec3(Vec3::Zero()), cosine};
    return squared;
  });
  return found;
}

double WallApproach::distance(const Vec3& from, const Vec3& normal, double limit) const {
  return is_inside(from) ? std::min(nearest(from, normal, limit).distance, limit) : 0;
}

std::optional<PathTurn> WallApproach::find_turn(const Vec3& from, const Vec3& direction, const Vec3& normal,
                                                double length, double reach) const {
  if (!(reach > 0) || !is_inside(from)) return {};
  const double end = std::min(distance_along(from, direction), length);
  double along = Turning::straight_share * reach;
  for (int step = 0; step < Turning::max_steps && along < end; ++step) {
    const NearestWall wall = nearest(from + along * direction, normal, length + reach);
    const double share =
        std::clamp((wall.cosine - Turning::narrow) / (Turning::narrowest - Turning::narrow), 0.0, 1.0);
    if (wall.distance <= (share + Turning::precision) * reach) {
      if (!(direction.dot(wall.towards) > 0) || is_hidden(from, wall.towards)) return {};
      return PathTurn{along, wall.distance, wall.towards,
                      from + along * direction + wall.distance * wall.towards};
    }
    along += std::max(wall.distance - reach, Turning::precision * reach);
  }
  return {};
}

/// Whether a surface that is continued is between a point and the wall in a direction.
bool WallApproach::is_hidden(const Vec3& point, const Vec3& direction) const {
  const double end = distance_along(point, direction);
  bool found = false;
  sheets_.for_crossings(point, direction,
                        [&](const Wall&, double at) { found |= at > Turning::precision * end && at < end; });
  return found;
}

std::optional<PathTurn> WallApproach::turn_beside(const PathTurn& other, const Vec3& from,
                                                  const Vec3& direction, double along, double length,
                                                  double reach) const {
  // A path that leads away from the wall does not turn onto it.
  if (along >= length || direction.dot(other.towards) <= -Turning::cosine) return {};
  const double farthest = Turning::farthest * reach, end = distance_along(from, direction);
  const Vec3 place = from + along * direction;
  if (along < end) {
    const double distance = distance_along(place, other.towards);
    if (distance > farthest) return {};
    return PathTurn{along, distance, other.towards, place + distance * other.towards};
  }
  // Outside the fold goes on for a while, or it would end in a twist at the wall by which the path leaves.
  if (along > end + farthest) return {};
  const double distance = std::clamp((other.foot - place).dot(other.towards), reach / 2, farthest);
  return PathTurn{along, distance, other.towards, place + distance * other.towards};
}

ContinuedPath WallApproach::path(const Vec3& from, const Vec3& direction, double length, double reach,
                                 const std::optional<PathTurn>& turn) const {
  if (turn) {
    const Vec3& towards = turn->towards;
    const Vec3 beside = (direction - direction.dot(towards) * towards).normalized();
    if (beside.allFinite()) {
      const Vec3 last = Turning::sine * towards + Turning::cosine * beside;
      const Vec3 middle = (direction + last).normalized();
      const Vec3 first = from + turn->along * direction;
      const Vec3 second = first + turn->distance / 2 / middle.dot(towards) * middle;
      // The path ends soon after the wall: others that turn onto it from other sides may come there.
      const double rest = (turn->distance / 2 + reach) / Turning::sine;
      return {{first, second, second + rest * last}};
    }
  }
  // Points on the wall would make facets there as small as rounding.
  const double end = distance_along(from, direction);
  const double first = end < length ? std::min(end + reach, (end + length) / 2) : length / 2;
  const double second = std::min(first + reach, (first + length) / 2);
  return {{from + first * direction, from + second * direction, from + length * direction}};
}

}  // namespace tetwright
