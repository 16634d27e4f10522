// SPDX-License-Identifier: Apache-2.0
#include "mesher/thin/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "common/geometry/box_pairs.h"
#include "common/geometry/point_triangle.h"
#include "common/geometry/ray_crossing.h"
#include "common/geometry/triangle_intersection.h"
#include "common/mesh/disjoint_sets.h"
#include "common/tolerances.h"
#include "mesher/level_sets/hole_caps.h"
#include "mesher/tuning/distance_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

SurfaceDistance::SurfaceDistance(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                 std::size_t closed, const TriangleMesh& caps, bool intersects_itself)
    : intersects_itself_(intersects_itself) {
  const std::size_t surface = triangles.size(), count = surface + caps.triangles.size();
  std::vector<std::array<Vec3, 3>> corners(count);
  std::vector<Box3> boxes(count);
  std::vector<Vec3> middles(count);  // times 3
  parallel_for(0, count, DistanceGrains::elements, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        corners[t][k] = t < surface ? points[triangles[t][k]] : caps.points[caps.triangles[t - surface][k]];
        boxes[t].add(corners[t][k]);
      }
      middles[t] = corners[t][0] + corners[t][1] + corners[t][2];
    }
  });
  const auto area_of = [&](std::size_t first, std::size_t last) {
    double area = 0;
    for (std::size_t t = first; t < last; ++t)
      area += (corners[t][1] - corners[t][0]).cross(corners[t][2] - corners[t][0]).norm();
    return area;
  };
  const bool caps_are_walls =
      area_of(surface, count) <= DistanceTuning::Caps::max_wall_share * area_of(0, surface);
  const std::vector<Index> order = median_order(boxes, middles, DistanceTuning::Triangles::leaf_size);
  triangles_.resize(count);
  normals_.resize(count);
  parts_.resize(count);
  parallel_for(0, count, DistanceGrains::elements, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, c] = triangles_[i] = corners[order[i]];
      const Vec3 normal = (b - a).cross(c - a);
      const double length = normal.norm();
      normals_[i] = length > 0 ? Vec3(normal / length) : Vec3(Vec3::Zero());
      parts_[i] = order[i] < closed                      ? Part::closed
                  : order[i] < surface || caps_are_walls ? Part::open
                                                         : Part::cap;
    }
  });
  tree_ = ReferenceTree(triangles_);
  if (closed < surface) open_.emplace(points, triangles.subspan(closed));
  find_sides(triangles, order);
}

std::vector<std::uint8_t> SurfaceDistance::find_clear(std::span<const Triangle> triangles,
                                                      const std::vector<Index>& order) const {
  const std::size_t surface = triangles.size();
  std::vector<std::uint8_t> is_clear(surface, 1);
  if (!intersects_itself_ && order.size() == surface) return is_clear;
  std::vector<std::array<Vec3, 3>> corners(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) corners[order[i]] = triangles_[i];
  std::vector<Box3> boxes(order.size());
  for (std::size_t t = 0; t < order.size(); ++t) {
    for (const Vec3& c : corners[t]) boxes[t].add(c);
    if (t < surface) continue;
    const Vec3 around = Vec3::Constant(DistanceTuning::Caps::clear_distance);
    boxes[t] = {boxes[t].low - around, boxes[t].high + around};
  }
  for (const auto& [f, g] : intersecting_pairs(boxes, [&](Index t, Index u) {
         if (t >= surface) return false;
         return u >= surface || (intersects_itself_ &&
                                 triangles_intersect({triangles[t], corners[t]}, {triangles[u], corners[u]}));
       })) {
    is_clear[f] = 0;
    if (g < surface) is_clear[g] = 0;
  }
  return is_clear;
}

/// Finds on which sides of triangles the inside is. That changes only where something meets the surface: one
/// triangle tells it for all that are connected with it by edges of two triangles each, oriented alike.
/// Triangles whose normal is determined by rounding do not tell, nor do those so near another one that a
/// point beside them may be beyond that.
void SurfaceDistance::find_sides(std::span<const Triangle> triangles, const std::vector<Index>& order) {
  const std::vector<std::uint8_t> is_clear = find_clear(triangles, order);
  struct Use {
    Index low, high, triangle;
    bool forwards;
    auto ends() const { return std::pair(low, high); }
  };
  std::vector<Use> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(t), a < b});
    }
  parallel_sort(uses, [](const Use& a, const Use& b) {
    return std::tuple(a.low, a.high, a.triangle, a.forwards) <
           std::tuple(b.low, b.high, b.triangle, b.forwards);
  });
  DisjointSets components(triangles.size());
  for (std::size_t i = 0, j; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].ends() == uses[i].ends();) ++j;
    if (j - i == 2 && uses[i].forwards != uses[i + 1].forwards && is_clear[uses[i].triangle] &&
        is_clear[uses[i + 1].triangle])
      components.unite(uses[i].triangle, uses[i + 1].triangle);
  }
  const auto height = [&](std::size_t i) {
    const auto& [a, b, c] = triangles_[i];
    const double longest =
        std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    return longest > 0 ? (b - a).cross(c - a).norm() / longest : 0;
  };
  const auto middle = [](const std::array<Vec3, 3>& t) { return Vec3((t[0] + t[1] + t[2]) / 3); };
  std::vector<std::size_t> highest(triangles.size(), order.size());  // by component
  std::vector<double> heights(order.size());
  const auto tells = [&](std::size_t i) { return order[i] < triangles.size() && is_clear[order[i]]; };
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!tells(i)) continue;
    heights[i] = height(i);
    std::size_t& best = highest[components.root(order[i])];
    if (heights[i] > DistanceTuning::Triangles::min_height &&
        (best == order.size() || heights[i] > heights[best]) && is_alone(middle(triangles_[i])))
      best = i;
  }
  std::vector<Sides> of_component(triangles.size(), Sides::unknown);
  parallel_for(0, triangles.size(), DistanceGrains::sided_components,
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t c = begin; c < end; ++c) {
                   if (highest[c] == order.size()) continue;
                   const Vec3 from = middle(triangles_[highest[c]]),
                              step = DistanceTuning::Triangles::side_distance * normals_[highest[c]];
                   const bool behind = inside(from - step), in_front = inside(from + step);
                   of_component[c] = behind && in_front ? Sides::both
                                     : behind           ? Sides::behind
                                     : in_front         ? Sides::unknown
                                                        : Sides::neither;
                 }
               });
  sides_.assign(order.size(), Sides::unknown);
  for (std::size_t i = 0; i < order.size(); ++i)
    if (tells(i) && heights[i] > DistanceTuning::Triangles::min_height)
      sides_[i] = of_component[components.root(order[i])];
}

std::optional<bool> SurfaceDistance::known_boundary(std::size_t triangle) const {
  if (sides_[triangle] == Sides::unknown) return std::nullopt;
  return sides_[triangle] == Sides::behind;
}

std::optional<SurfacePlace> SurfaceDistance::nearest(const Vec3& point, double at_most) const {
  std::size_t nearest = triangles_.size();
  Vec3 place = point;
  double squared_distance = at_most * at_most, alignment = 0;
  bool is_in_front = false, is_behind = false, is_certain = false;  // of the closest triangles
  tree_.nearest(point, squared_distance, [&](std::size_t t, double best) {
    if (normals_[t].isZero(0)) return best;
    const auto& [a, b, c] = triangles_[t];
    const Vec3 p = closest_point(point, a, b, c);
    const double squared = (p - point).squaredNorm();
    if (squared > squared_distance * (1 + DistanceTuning::Triangles::tie)) return best;
    const double height = normals_[t].dot(point - p), aligned = std::abs(height);
    const bool is_tie =
        nearest < triangles_.size() && squared >= squared_distance * (1 - DistanceTuning::Triangles::tie);
    if (!is_tie) is_in_front = is_behind = false, is_certain = true;
    (height > 0 ? is_in_front : is_behind) = true;
    is_certain = is_certain && sides_[t] != Sides::unknown && (!is_tie || sides_[t] == sides_[nearest]) &&
                 height * height > DistanceTuning::Triangles::min_side_share * squared;
    // Among equally close triangles choose the one that faces the point most directly, then the first, so
    // that the result does not depend on the search order.
    if (is_tie && (aligned < alignment || (aligned == alignment && t > nearest))) return best;
    nearest = t;
    place = p;
    squared_distance = std::min(squared_distance, squared);
    alignment = aligned;
    return squared_distance * (1 + DistanceTuning::Triangles::tie);
  });
  if (nearest == triangles_.size()) return std::nullopt;
  // If the closest point is a corner, the directions of the surface from there form a polygon of great
  // circles. With the point in front of all of its sides, the opposite direction is behind all, thus within
  // the polygon, with the solid in it; and the other way round. With sides of both kinds nothing is known.
  const double min_distance = DistanceTuning::Triangles::min_side_distance;
  int side = 0;
  if (is_certain && is_in_front != is_behind && squared_distance > min_distance * min_distance)
    side = sides_[nearest] == Sides::both || (is_behind && sides_[nearest] == Sides::behind) ? -1 : 1;
  return SurfacePlace{place, normals_[nearest], side, parts_[nearest] == Part::cap, known_boundary(nearest)};
}

bool SurfaceDistance::is_ball_empty(const Vec3& center, double radius) const {
  const double limit = radius * radius;
  return tree_.nearest(center, limit, [&](std::size_t t, double best) {
    if (normals_[t].isZero(0) || parts_[t] == Part::cap) return best;
    const auto& [a, b, c] = triangles_[t];
    if (const double height = normals_[t].dot(center - a); height * height >= limit) return best;
    // One is enough: nothing is nearer than a negative distance.
    return (closest_point(center, a, b, c) - center).squaredNorm() < limit ? -1 : best;
  }) >= limit;
}

bool SurfaceDistance::inside(const Vec3& point) const {
  int winding = 0;
  std::vector<Index> counted;  // of the triangles in several parts, which may be visited several times
  tree_.for_each_in(
      [&](const Box3& box) {
        return box.low.x() <= point.x() && point.x() <= box.high.x() && box.low.y() <= point.y() &&
               point.y() <= box.high.y() && box.low.z() <= point.z();
      },
      [&](std::size_t t) {
        if (parts_[t] != Part::closed) return;
        const auto& [a, b, c] = triangles_[t];
        const int crossing = vertical_crossing(a, b, c, point);
        if (crossing == 0 || !at_or_above(a, b, c, crossing, point)) return;
        if (tree_.is_split(t)) {
          if (std::find(counted.begin(), counted.end(), t) != counted.end()) return;
          counted.push_back(static_cast<Index>(t));
        }
        winding += crossing;
      });
  if (!open_) return winding > 0;
  static const Vec3 offset(tolerance::winding_offset[0], tolerance::winding_offset[1],
                           tolerance::winding_offset[2]);
  return winding + open_->winding_number(point + offset) >= DistanceTuning::Caps::inside_winding;
}

std::optional<SurfacePlace> SurfaceDistance::nearest_facing(const Vec3& point, const Vec3& normal,
                                                            double facing, double below,
                                                            bool in_front) const {
  const double limit = below * below;
  SurfacePlace wall;
  const double found = tree_.nearest(point, limit, [&](std::size_t t, double best) {
    if (!(normals_[t].dot(normal) < -facing) || parts_[t] == Part::cap) return best;
    const auto& [a, b, c] = triangles_[t];
    if (in_front && (point - a).dot(normals_[t]) < 0) return best;
    const Vec3 p = closest_point(point, a, b, c);
    const double squared = (p - point).squaredNorm();
    if (squared >= best) return best;
    wall = {p, normals_[t], 0, false, known_boundary(t)};
    return squared;
  });
  if (!(found < limit)) return std::nullopt;
  return wall;
}

bool SurfaceDistance::is_boundary(const SurfacePlace& place) const {
  if (!intersects_itself_) return true;
  return place.is_boundary && is_alone(place.point) ? *place.is_boundary : has_inside_behind(place);
}

bool SurfaceDistance::is_alone(const Vec3& point) const {
  const double radius = 2 * DistanceTuning::Triangles::side_distance, limit = radius * radius;
  std::size_t first = triangles_.size();
  return tree_.nearest(point, limit, [&](std::size_t t, double best) {
    if (t == first) return best;
    const auto& [a, b, c] = triangles_[t];
    if ((closest_point(point, a, b, c) - point).squaredNorm() >= limit) return best;
    if (first < triangles_.size()) return -1.0;  // nothing is nearer: ends the search
    first = t;
    return best;
  }) >= 0;
}

bool SurfaceDistance::has_inside_behind(const SurfacePlace& place) const {
  return inside(place.point - DistanceTuning::Triangles::side_distance * place.normal) &&
         !inside(place.point + DistanceTuning::Triangles::side_distance * place.normal);
}

double SurfaceDistance::thickness(const SurfacePlace& place, Side side, double facing, double at_most) const {
  if (place.on_cap) return at_most;
  const Vec3 direction = side == Side::gap ? place.normal : Vec3(-place.normal);
  double radius = 0.5 * at_most;
  std::optional<SurfacePlace> wall;
  for (int step = 0; step < DistanceTuning::Triangles::max_shrinks && radius > 0; ++step) {
    const std::optional<SurfacePlace> nearer =
        nearest_facing(place.point + radius * direction, place.normal, facing,
                       radius * (1 - DistanceTuning::Triangles::min_shrink));
    if (!nearer) break;
    wall = nearer;
    const Vec3 chord = wall->point - place.point;
    const double along = chord.dot(direction);
    const double next = along > 0 ? chord.squaredNorm() / (2 * along) : 0;
    if (next >= radius * (1 - DistanceTuning::Triangles::min_shrink)) break;
    radius = next;
  }
  if (wall && !(is_boundary(place) && is_boundary(*wall))) return at_most;
  return 2 * radius;
}

}  // namespace tetwright
