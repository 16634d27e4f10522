// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/partitioning.h"

#include <algorithm>
#include <map>
#include <optional>

#include "common/features/edge_uses.h"
#include "common/geometry/self_intersection.h"
#include "common/mesh/disjoint_sets.h"
#include "common/message_text.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// An edge of one triangle only, as that triangle traverses it.
struct BorderEdge {
  Index from, to;
  Vec3 out;  ///< unit, in the plane of the triangle
};

std::vector<BorderEdge> border_of(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<BorderEdge> border;
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    if (j - i != 1) continue;
    auto [from, to] = ends_of(uses[i].key);
    if (!uses[i].ascending) std::swap(from, to);
    const Triangle& t = triangles[uses[i].triangle];
    const Vec3 normal = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
    const Vec3 out = (points[to] - points[from]).cross(normal).normalized();
    if (out.allFinite()) border.push_back({from, to, out});
  }
  return border;
}

/// The directions away from a border, smoothed over a width: small waves of the border would become folds.
/// Sides of a corner keep their own.
std::vector<Vec3> smooth_directions(const std::vector<Vec3>& points, const std::vector<BorderEdge>& border,
                                    double width) {
  std::vector<Vec3> smooth(border.size());
  const auto middle = [&](const BorderEdge& e) { return Vec3((points[e.from] + points[e.to]) / 2); };
  parallel_for(0, border.size(), InputGrains::border_edges, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 sum = Vec3::Zero();
      for (const BorderEdge& e : border)
        if (e.out.dot(border[i].out) > InputTuning::Partitions::same_side &&
            (middle(e) - middle(border[i])).norm() <= width)
          sum += (points[e.to] - points[e.from]).norm() * e.out;
      smooth[i] = sum.normalized();
    }
  });
  return smooth;
}

/// A point of the border, and the way on from it.
struct BorderPoint {
  Index point;
  Vec3 direction;  ///< unit
  Vec3 normal;     ///< unit, of the surface
  double length;   ///< of the strip
  Index component;
};

/// The points of a border in ascending order. At corners the strip has the full width along both sides.
std::vector<BorderPoint> border_points(const std::vector<Vec3>& points,
                                       const std::vector<Triangle>& triangles,
                                       const std::vector<BorderEdge>& border, double width) {
  DisjointSets components(points.size());
  for (const auto& [a, b, c] : triangles) components.unite(a, b), components.unite(b, c);
  const std::vector<Vec3> directions = smooth_directions(points, border, width);
  struct Sides {
    std::vector<Vec3> outs;
    Vec3 normal = Vec3::Zero();
  };
  std::map<Index, Sides> sides;
  for (std::size_t i = 0; i < border.size(); ++i)
    for (const Index p : {border[i].from, border[i].to}) {
      sides[p].outs.push_back(directions[i]);
      sides[p].normal += (points[border[i].to] - points[border[i].from]).cross(directions[i]);
    }
  std::vector<BorderPoint> found;
  for (const auto& [point, own] : sides) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& out : own.outs) sum += out;
    const Vec3 middle = sum.normalized();
    if (!middle.allFinite()) continue;
    double cosine = 1;
    for (const Vec3& out : own.outs) cosine = std::min(cosine, out.dot(middle));
    found.push_back({point, middle, own.normal.normalized(),
                     width / std::max(cosine, InputTuning::Partitions::min_cosine), components.root(point)});
  }
  return found;
}

/// The turn of a path beside others: it turns little later than these, or the strip would be twisted between
/// them.
std::optional<PathTurn> spread_turn(const std::vector<Vec3>& points, const std::vector<BorderPoint>& border,
                                    const std::vector<std::optional<PathTurn>>& turns, std::size_t i,
                                    const WallApproach& walls, double reach) {
  const BorderPoint& own = border[i];
  const PathTurn* first = turns[i] ? &*turns[i] : nullptr;
  double along = first ? first->along : HUGE_VAL;
  for (std::size_t k = 0; k < border.size(); ++k) {
    if (!turns[k] || border[k].component != own.component ||
        border[k].direction.dot(own.direction) <= InputTuning::Partitions::min_cosine)
      continue;
    const double later = turns[k]->along + InputTuning::Partitions::later *
                                               (points[border[k].point] - points[own.point]).norm();
    if (later < along) along = later, first = &*turns[k];
  }
  if (!first || (turns[i] && first == &*turns[i])) return turns[i];
  const auto turn = walls.turn_beside(*first, points[own.point], own.direction, along, own.length, reach);
  return turn ? turn : turns[i];
}

/// The paths from the points of a border, or none if all are straight.
std::vector<ContinuedPath> turned_paths(const std::vector<Vec3>& points,
                                        const std::vector<BorderPoint>& border, double width,
                                        const WallApproach& walls) {
  const double reach = InputTuning::Partitions::turn_share * width;
  std::vector<std::optional<PathTurn>> turns(border.size());
  const auto for_each_point = [&](const auto& visit) {
    parallel_for(0, border.size(), InputGrains::border_edges, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(i, border[i], points[border[i].point]);
    });
  };
  std::vector<double> distances(border.size());
  for_each_point([&](std::size_t i, const BorderPoint& p, const Vec3& from) {
    distances[i] = walls.distance(from, p.normal, width);
  });
  for_each_point([&](std::size_t i, const BorderPoint& p, const Vec3& from) {
    // A border that runs along a wall leaves no wedge.
    double farthest = 0;
    for (std::size_t k = 0; k < border.size(); ++k)
      if (border[k].component == p.component && (points[border[k].point] - from).norm() <= width)
        farthest = std::max(farthest, distances[k]);
    turns[i] = walls.find_turn(from, p.direction, p.normal, p.length,
                               std::min(reach, InputTuning::Partitions::share_left * farthest));
  });
  if (std::none_of(turns.begin(), turns.end(), [](const auto& turn) { return turn.has_value(); })) return {};
  std::vector<ContinuedPath> paths(border.size());
  for_each_point([&](std::size_t i, const BorderPoint& p, const Vec3& from) {
    paths[i] =
        walls.path(from, p.direction, p.length, reach, spread_turn(points, border, turns, i, walls, reach));
  });
  return paths;
}

/// Adds strips along a border.
/// \param paths of each of its points; none: straight ones
void add_strips(const std::vector<BorderEdge>& edges, const std::vector<BorderPoint>& border,
                const std::vector<ContinuedPath>& paths, Partition& p) {
  std::map<Index, std::vector<Index>> along;  // for each point of the border those of its path
  for (std::size_t i = 0; i < border.size(); ++i) {
    const BorderPoint& own = border[i];
    std::vector<Vec3> places;
    if (paths.empty())
      places.push_back(p.points[own.point] + own.length * own.direction);
    else
      places.assign(paths[i].ends.begin(), paths[i].ends.end());
    std::vector<Index>& numbers = along[own.point];
    numbers.push_back(own.point);
    for (const Vec3& place : places) {
      numbers.push_back(static_cast<Index>(p.points.size()));
      p.points.push_back(place);
    }
  }
  for (const auto& [from, to, out] : edges) {
    const auto a = along.find(from), b = along.find(to);
    if (a == along.end() || b == along.end()) continue;
    for (std::size_t k = 1; k < a->second.size(); ++k) {
      p.triangles.push_back({b->second[k - 1], a->second[k - 1], a->second[k]});
      p.triangles.push_back({b->second[k - 1], a->second[k], b->second[k]});
    }
  }
}

/// A triangle of a strip that meets the surface or a strip, or nothing.
/// \param given number of triangles before strips were added
std::optional<Index> folded(const Partition& p, std::size_t given) {
  const auto folds = self_intersections(p.points, p.triangles);
  const auto of_strip =
      std::find_if(folds.begin(), folds.end(), [&](const auto& pair) { return pair.second >= given; });
  if (of_strip == folds.end()) return {};
  return of_strip->second;
}

/// Continues a surface by strips along its border.
/// \throws InputError if the strips meet each other or the surface
void continue_border(double width, const WallApproach& walls, Partition& p) {
  const std::vector<BorderEdge> edges = border_of(p.points, p.triangles);
  if (edges.size() > InputTuning::Partitions::max_border)
    throw InputError(p.file, 0,
                     "the partition '" + p.name + "' has a border of " + std::to_string(edges.size()) +
                         " edges, and --extend continues at most " +
                         std::to_string(InputTuning::Partitions::max_border) +
                         "; leave out --extend and continue the surface to the boundary yourself");
  const std::vector<BorderPoint> border = border_points(p.points, p.triangles, edges, width);
  const std::size_t given = p.triangles.size(), given_points = p.points.size();
  if (const auto paths = turned_paths(p.points, border, width, walls); !paths.empty()) {
    add_strips(edges, border, paths, p);
    if (!folded(p, given)) return;
    p.triangles.resize(given);
    p.points.resize(given_points);
  }
  add_strips(edges, border, {}, p);
  const std::optional<Index> fold = folded(p, given);
  if (!fold) return;
  const Triangle& t = p.triangles[*fold];
  throw InputError(p.file, 0,
                   "continued by --extend " + short_number(width) + ", the partition '" + p.name +
                       "' would cross itself at " +
                       place_text((p.points[t[0]] + p.points[t[1]] + p.points[t[2]]) / 3) +
                       "; use a smaller --extend, or continue the surface to the boundary yourself");
}

}  // namespace

Partition make_partition(const SheetSurface& surface, double extend, const WallApproach& walls,
                         std::vector<Diagnostic>& findings) {
  std::vector<Diagnostic> own;
  CleanedSurface cleaned = clean_surface(surface.surface, surface.file, own);
  for (Diagnostic& f : own) {
    f.file = surface.file;
    findings.push_back(std::move(f));
  }
  Partition p{surface.name, surface.file, std::move(cleaned.points), std::move(cleaned.triangles), {}};
  const std::size_t given = p.triangles.size();
  if (extend > 0) continue_border(extend, walls, p);
  p.continued.assign(p.triangles.size(), 1);
  std::fill_n(p.continued.begin(), given, 0);
  p.low = p.high = p.points[0];
  for (const Vec3& q : p.points) p.low = p.low.cwiseMin(q), p.high = p.high.cwiseMax(q);
  return p;
}

PartitionedSurface with_partitions(const CleanedSurface& body, const std::vector<SurfaceRegion>& groups,
                                   const std::vector<Partition>& partitions) {
  PartitionedSurface result;
  CleanedSurface& all = result.surface;
  all = body;
  result.groups = groups;
  result.body_triangles = body.triangles.size();
  Vec3 low = body.points[0], high = body.points[0];
  for (const Vec3& q : body.points) low = low.cwiseMin(q), high = high.cwiseMax(q);
  if (all.groups.empty()) {
    all.groups.assign(all.triangles.size(), 0);
    result.groups = {SurfaceRegion{}};
  }
  for (std::uint32_t k = 0; k < partitions.size(); ++k) {
    const Partition& p = partitions[k];
    if ((p.low.array() > high.array()).any() || (p.high.array() < low.array()).any()) continue;
    const auto first = static_cast<Index>(all.points.size());
    const auto group = static_cast<std::uint32_t>(result.groups.size());
    result.groups.push_back({0, p.name});
    all.points.insert(all.points.end(), p.points.begin(), p.points.end());
    for (std::size_t t = 0; t < p.triangles.size(); ++t) {
      const auto& [a, b, c] = p.triangles[t];
      all.triangles.push_back({first + a, first + b, first + c});
      all.groups.push_back(group);
      result.partition.push_back(k);
      result.continued.push_back(p.continued[t]);
    }
  }
  all.two_sided.resize(all.triangles.size(), 0);
  all.even.resize(all.triangles.size(), 0);
  return result;
}

}  // namespace tetwright
