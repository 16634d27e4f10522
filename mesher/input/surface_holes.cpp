// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/surface_holes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/geometry/projection_tree.h"
#include "common/geometry/self_intersection.h"
#include "common/message_text.h"
#include "mesher/complex/triangle_subdivision.h"
#include "mesher/input/surface_components.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using Tuning = InputTuning::Holes;
using Edge = std::array<Index, 2>;

/// A connected set of free edges.
struct Rim {
  std::vector<Edge> edges;         ///< as the cap passes them: against the surface's triangles
  std::vector<Index> at_triangle;  ///< the surface's triangle at each edge
  bool balanced = true;            ///< as many edges end at each point as start there
  Vec3 vector = Vec3::Zero();      ///< area times normal of whatever closes it
  Vec3 centre = Vec3::Zero();
  Eigen::AlignedBox3d box;
};

struct Cap {
  std::vector<Triangle> triangles;  ///< by the points of the surface
  std::vector<std::size_t> rims;
  Vec3 vector = Vec3::Zero();  ///< area times normal
  bool kept = true;
};

Vec3 area_vector(const std::vector<Vec3>& points, const Triangle& t) {
  return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]) / 2;
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

class HoleCloser {
 public:
  /// \param triangles oriented consistently, without inner walls
  /// \param component of each triangle
  HoleCloser(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
             const std::vector<Index>& component)
      : points_(points), triangles_(triangles), component_(component) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : points) box.extend(p);
    diagonal_ = box.diagonal().norm();
    for (const Triangle& t : triangles) area_ += area_vector(points, t).norm();
    find_rims();
  }

  bool has_holes() const { return !rims_.empty(); }
  double area() const { return area_; }
  const std::vector<Rim>& rims() const { return rims_; }
  const std::vector<Cap>& caps() const { return caps_; }

  void close_flat() {
    std::vector<std::size_t> flat;
    for (std::size_t r = 0; r < rims_.size(); ++r)
      if (is_flat(r)) flat.push_back(r);
    std::stable_sort(flat.begin(), flat.end(), [&](std::size_t a, std::size_t b) {
      return rims_[a].vector.squaredNorm() > rims_[b].vector.squaredNorm();
    });
    if (flat.size() > Tuning::max_flat) flat.resize(Tuning::max_flat);
    for (const std::vector<std::size_t>& together : in_common_planes(flat)) fill(together);
    drop_degenerate();
    drop_intersecting();
  }

 private:
  void find_rims() {
    std::vector<Index> root(points_.size(), no_index);
    const auto find = [&](Index p) {
      while (root[p] != p) p = root[p] = root[root[p]];
      return p;
    };
    std::vector<std::pair<Edge, Index>> free;
    const std::vector<EdgeUse> uses = edge_uses(triangles_, {});
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      while (j < uses.size() && uses[j].key == uses[i].key) ++j;
      if (j - i != 1) continue;
      auto [a, b] = ends_of(uses[i].key);
      if (uses[i].ascending) std::swap(a, b);
      free.push_back({{a, b}, uses[i].triangle});
      for (const Index p : {a, b})
        if (root[p] == no_index) root[p] = p;
      const Index u = find(a), v = find(b);
      root[std::max(u, v)] = std::min(u, v);
    }
    std::map<Index, std::size_t> number;
    for (const auto& [edge, triangle] : free) {
      const std::size_t r = number.try_emplace(find(edge[0]), rims_.size()).first->second;
      if (r == rims_.size()) rims_.emplace_back();
      rims_[r].edges.push_back(edge);
      rims_[r].at_triangle.push_back(triangle);
    }
    for (Rim& rim : rims_) measure(rim);
  }

  void measure(Rim& rim) const {
    std::map<Index, int> balance;
    double length = 0;
    for (const auto& [a, b] : rim.edges) {
      ++balance[a];
      --balance[b];
      const double own = (points_[b] - points_[a]).norm();
      length += own;
      rim.centre += own * (points_[a] + points_[b]) / 2;
      rim.box.extend(points_[a]).extend(points_[b]);
    }
    rim.centre = length > 0 ? Vec3(rim.centre / length) : points_[rim.edges[0][0]];
    for (const auto& [a, b] : rim.edges)
      rim.vector += (points_[a] - rim.centre).cross(points_[b] - rim.centre) / 2;
    rim.balanced =
        std::all_of(balance.begin(), balance.end(), [](const auto& item) { return item.second == 0; });
  }

  bool lies_in_plane_of(const Rim& rim, const Rim& other) const {
    const Vec3 normal = other.vector.normalized();
    return std::all_of(rim.edges.begin(), rim.edges.end(), [&](const Edge& e) {
      return std::abs(normal.dot(points_[e[0]] - other.centre)) <= Tuning::flat * diagonal_;
    });
  }

  bool is_flat(std::size_t r) const {
    const Rim& rim = rims_[r];
    return rim.balanced && rim.vector.norm() >= Tuning::min_share * area_ && lies_in_plane_of(rim, rim);
  }

  /// Rims that may enclose each other: in one plane, with boxes that overlap.
  std::vector<std::vector<std::size_t>> in_common_planes(const std::vector<std::size_t>& flat) const {
    std::vector<std::vector<std::size_t>> sets;
    std::vector<char> done(flat.size(), 0);
    for (std::size_t i = 0; i < flat.size(); ++i) {
      if (done[i]) continue;
      // Larger rims come first, and a rim that lies within another one is smaller.
      const Rim& outer = rims_[flat[i]];
      sets.push_back({flat[i]});
      for (std::size_t k = i + 1; k < flat.size(); ++k) {
        if (done[k] || !outer.box.intersects(rims_[flat[k]].box) || !lies_in_plane_of(rims_[flat[k]], outer))
          continue;
        done[k] = 1;
        sets.back().push_back(flat[k]);
      }
    }
    return sets;
  }

  /// Adds the caps of rims in one plane: the parts of the plane around which the rims go once.
  void fill(const std::vector<std::size_t>& together) {
    const Rim& outer = rims_[together[0]];
    const Vec3 normal = outer.vector.normalized(), u = normal.unitOrthogonal(), v = normal.cross(u);
    double radius = 0;
    std::map<Index, Index> numbers;  // by point, to those of the subdivision
    std::vector<Index> used;
    for (const std::size_t r : together)
      for (const Edge& e : rims_[r].edges) {
        if (numbers.try_emplace(e[0], static_cast<Index>(used.size())).second) used.push_back(e[0]);
        radius = std::max(radius, (points_[e[0]] - outer.centre).norm());
      }
    // The incircle of an equilateral triangle is half as large as its circumcircle.
    const auto n = static_cast<Index>(used.size());
    std::array<Vec3, 3> corners;
    for (int k = 0; k < 3; ++k) {
      const double angle = 2 * std::numbers::pi * k / 3;
      corners[static_cast<std::size_t>(k)] =
          outer.centre + 4 * radius * (std::cos(angle) * u + std::sin(angle) * v);
    }
    TriangleSubdivision subdivision({n, n + 1, n + 2}, corners);
    for (Index i = 0; i < n; ++i) subdivision.add_inside(i, points_[used[i]]);
    std::map<Edge, std::size_t> rim_of;  // by edge, as the cap passes it
    for (const std::size_t r : together)
      for (const auto& [a, b] : rims_[r].edges) {
        const Index from = numbers.at(a), to = numbers.at(b);
        if (!subdivision.constrain(from, to)) return;
        rim_of[{from, to}] = r;
      }
    take_caps(subdivision.triangles(), n, used, rim_of);
  }

  /// Adds the parts of a subdivided plane around which the rims go once.
  /// \param n number of points in `used`; larger numbers are corners of the triangle around all
  void take_caps(const std::vector<Triangle>& parts, Index n, const std::vector<Index>& used,
                 const std::map<Edge, std::size_t>& rim_of) {
    std::map<Edge, Index> at;
    for (Index t = 0; t < parts.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) at[{parts[t][k], parts[t][(k + 1) % 3]}] = t;
    constexpr int unknown = std::numeric_limits<int>::min();
    std::vector<int> winding(parts.size(), unknown);
    std::vector<Index> piece(parts.size(), no_index);
    std::vector<Index> waiting;
    // Pieces are flooded from the outside inwards; each is entered across a rim.
    std::vector<Index> entries;
    for (Index t = 0; t < parts.size(); ++t)
      if (std::any_of(parts[t].begin(), parts[t].end(), [&](Index p) { return p >= n; })) {
        winding[t] = 0;
        entries.push_back(t);
        break;
      }
    Index pieces = 0;
    std::vector<int> winding_of_piece;
    std::vector<std::set<std::size_t>> rims_of_piece;
    while (!entries.empty()) {
      const Index first = entries.back();
      entries.pop_back();
      if (piece[first] != no_index) continue;
      piece[first] = pieces;
      winding_of_piece.push_back(winding[first]);
      rims_of_piece.emplace_back();
      waiting.push_back(first);
      while (!waiting.empty()) {
        const Index t = waiting.back();
        waiting.pop_back();
        for (std::size_t k = 0; k < 3; ++k) {
          const Index a = parts[t][k], b = parts[t][(k + 1) % 3];
          const auto across = at.find({b, a});
          const auto ahead = rim_of.find({a, b}), back = rim_of.find({b, a});
          const int step = (back != rim_of.end()) - (ahead != rim_of.end());
          if (ahead != rim_of.end()) rims_of_piece.back().insert(ahead->second);
          if (back != rim_of.end()) rims_of_piece.back().insert(back->second);
          if (across == at.end() || piece[across->second] != no_index) continue;
          winding[across->second] = winding[t] + step;
          if (ahead == rim_of.end() && back == rim_of.end()) {
            piece[across->second] = pieces;
            waiting.push_back(across->second);
          } else {
            entries.push_back(across->second);
          }
        }
      }
      ++pieces;
    }
    add_pieces(parts, used, rim_of, piece, winding_of_piece, rims_of_piece);
  }

  void add_pieces(const std::vector<Triangle>& parts, const std::vector<Index>& used,
                  const std::map<Edge, std::size_t>& rim_of, const std::vector<Index>& piece,
                  const std::vector<int>& winding, const std::vector<std::set<std::size_t>>& rims) {
    if (std::any_of(winding.begin(), winding.end(), [](int w) { return std::abs(w) > 1; })) return;
    std::vector<Cap> caps(winding.size());
    std::size_t closed = 0;
    for (std::size_t t = 0; t < parts.size(); ++t) {
      const int w = piece[t] == no_index ? 0 : winding[piece[t]];
      if (w == 0) continue;
      Triangle own = parts[t];
      if (w < 0) std::swap(own[1], own[2]);
      for (std::size_t k = 0; k < 3; ++k) closed += rim_of.contains({own[k], own[(k + 1) % 3]});
      Cap& cap = caps[piece[t]];
      cap.triangles.push_back({used[own[0]], used[own[1]], used[own[2]]});
      cap.vector += area_vector(points_, cap.triangles.back());
    }
    if (closed != rim_of.size()) return;
    for (std::size_t i = 0; i < caps.size(); ++i)
      if (!caps[i].triangles.empty()) {
        caps[i].rims.assign(rims[i].begin(), rims[i].end());
        caps_.push_back(std::move(caps[i]));
      }
  }

  /// Drops caps that lie so close to the rest of the surface that almost nothing is between them.
  void drop_degenerate() {
    std::map<Index, double> area;  // of each component with its caps
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      area[component_[t]] += area_vector(points_, triangles_[t]).norm();
    const auto components_of = [&](const Cap& cap) {
      std::set<Index> all;
      for (const std::size_t r : cap.rims) all.insert(component_[rims_[r].at_triangle[0]]);
      return all;
    };
    for (const Cap& cap : caps_)
      for (const Index c : components_of(cap)) area[c] += cap.vector.norm();
    for (Cap& cap : caps_) {
      double all = 0;
      for (const Index c : components_of(cap)) all += area[c];
      const double own = cap.vector.norm();
      if (own > Tuning::max_ratio * (all - own)) cap.kept = false;
    }
    std::set<Triangle> own;
    for (const Cap& cap : caps_)
      for (const Triangle& t : cap.triangles) own.insert(sorted(t));
    std::set<Triangle> there;
    for (const Triangle& t : triangles_)
      if (const Triangle key = sorted(t); own.contains(key)) there.insert(key);
    for (Cap& cap : caps_)
      cap.kept &= std::none_of(cap.triangles.begin(), cap.triangles.end(),
                               [&](const Triangle& t) { return there.contains(sorted(t)); });
  }

  void drop_intersecting() {
    std::vector<Triangle> all = triangles_;
    std::vector<std::size_t> cap_of;
    for (std::size_t c = 0; c < caps_.size(); ++c)
      if (caps_[c].kept)
        for (const Triangle& t : caps_[c].triangles) {
          all.push_back(t);
          cap_of.push_back(c);
        }
    if (cap_of.empty()) return;
    for (const auto& pair : self_intersections(points_, all))
      for (const Index t : {pair.first, pair.second})
        if (t >= triangles_.size()) caps_[cap_of[t - triangles_.size()]].kept = false;
  }

  const std::vector<Vec3>& points_;
  const std::vector<Triangle>& triangles_;
  const std::vector<Index>& component_;
  double diagonal_ = 0, area_ = 0;
  std::vector<Rim> rims_;
  std::vector<Cap> caps_;
};

/// The share of a cap's rim that turns by more than an angle.
double turning_share(const Cap& cap, const std::vector<Rim>& rims, const std::vector<Vec3>& points,
                     const std::vector<Triangle>& triangles, double angle) {
  const Vec3 normal = cap.vector.normalized();
  double turning = 0, all = 0;
  for (const std::size_t r : cap.rims)
    for (std::size_t i = 0; i < rims[r].edges.size(); ++i) {
      const auto& [a, b] = rims[r].edges[i];
      const double length = (points[b] - points[a]).norm();
      const Vec3 beside = area_vector(points, triangles[rims[r].at_triangle[i]]);
      all += length;
      if (std::atan2(beside.cross(normal).norm(), beside.dot(normal)) > angle) turning += length;
    }
  return all > 0 ? turning / all : 0;
}

/// The group of the triangle at the longest edge of a cap's rim.
std::uint32_t group_beside(const Cap& cap, const std::vector<Rim>& rims, const std::vector<Vec3>& points,
                           const std::vector<Index>& in_surface, const std::vector<std::uint32_t>& groups) {
  double longest = -1;
  std::uint32_t group = 0;
  for (const std::size_t r : cap.rims)
    for (std::size_t i = 0; i < rims[r].edges.size(); ++i) {
      const double length = (points[rims[r].edges[i][1]] - points[rims[r].edges[i][0]]).norm();
      if (length <= longest) continue;
      longest = length;
      group = groups[in_surface[rims[r].at_triangle[i]]];
    }
  return group;
}

/// A hole with the points of the rims.
SurfaceHole hole_of(const std::vector<const Rim*>& rims, const std::vector<Triangle>& triangles,
                    const std::vector<Vec3>& points) {
  SurfaceHole hole;
  std::map<Index, Index> numbers;
  const auto number = [&](Index p) {
    const auto [known, added] = numbers.try_emplace(p, static_cast<Index>(hole.points.size()));
    if (added) hole.points.push_back(points[p]);
    return known->second;
  };
  for (const Rim* rim : rims)
    for (const auto& [a, b] : rim->edges) {
      const Index from = number(a);
      hole.rim.push_back({from, number(b)});
    }
  for (const auto& [a, b, c] : triangles) {
    const Index first = number(a), second = number(b);
    hole.triangles.push_back({first, second, number(c)});
  }
  return hole;
}

SurfaceHole open_hole(const Rim& rim, const std::vector<Vec3>& points) {
  SurfaceHole hole = hole_of({&rim}, {}, points);
  hole.size = rim.vector.norm();
  const auto centre = static_cast<Index>(hole.points.size());
  hole.points.push_back(rim.centre);
  for (const auto& [a, b] : hole.rim) hole.triangles.push_back({a, b, centre});
  return hole;
}

/// Whether an edge has one triangle only.
bool has_free_edges(const std::vector<Triangle>& triangles) {
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    if (j - i == 1) return true;
  }
  return false;
}

double degrees_of(const FeatureAngle& angle) {
  constexpr double automatic = 35;  // as of find_patches()
  constexpr double never = 360;
  return angle.rule == FeatureAngle::Rule::off       ? never
         : angle.rule == FeatureAngle::Rule::degrees ? angle.degrees
                                                     : automatic;
}

}  // namespace

std::vector<SurfaceHole> close_flat_holes(CleanedSurface& surface, std::vector<SurfaceRegion>& groups,
                                          const std::string& file, const CapOptions& options,
                                          std::vector<Diagnostic>& findings) {
  std::vector<SurfaceHole> holes;
  if (!has_free_edges(surface.triangles)) return holes;
  std::vector<Triangle> oriented = surface.triangles;
  std::vector<Diagnostic> unused;
  const std::vector<SurfaceComponent> components =
      split_into_components(surface.points, oriented, surface.two_sided, file, unused);
  std::vector<Triangle> triangles;  // of components, without inner walls
  std::vector<Index> in_surface, component;
  for (Index c = 0; c < components.size(); ++c)
    for (const Index t : components[c].triangles) {
      triangles.push_back(oriented[t]);
      in_surface.push_back(t);
      component.push_back(c);
    }
  HoleCloser closer(surface.points, triangles, component);
  if (!closer.has_holes()) return holes;
  if (options.close_flat) closer.close_flat();

  const std::vector<Rim>& rims = closer.rims();
  std::vector<char> closed(rims.size(), 0);
  std::size_t edges = 0;
  std::optional<Vec3> place;
  const double angle = degrees_of(options.feature_angle) * std::numbers::pi / 180;
  for (const Cap& cap : closer.caps()) {
    if (!cap.kept) continue;
    std::vector<const Rim*> own;
    for (const std::size_t r : cap.rims) {
      own.push_back(&rims[r]);
      closed[r] = 1;
      edges += rims[r].edges.size();
    }
    if (!place) place = surface.points[own[0]->edges[0][0]];
    SurfaceHole& hole = holes.emplace_back(hole_of(own, cap.triangles, surface.points));
    hole.flat = true;
    hole.size = cap.vector.norm();
    hole.sharp = hole.size >= Tuning::min_sharp_share * closer.area() &&
                 turning_share(cap, rims, surface.points, triangles, angle) > Tuning::sharp_share;
    if (hole.sharp && surface.groups.empty()) {
      groups.insert(groups.begin(), SurfaceRegion{});
      surface.groups.assign(surface.triangles.size(), 0);
    }
    if (hole.sharp) {
      hole.group = static_cast<std::uint32_t>(groups.size());
      groups.emplace_back();
    }
    const std::uint32_t group = surface.groups.empty() || hole.sharp
                                    ? hole.group
                                    : group_beside(cap, rims, surface.points, in_surface, surface.groups);
    surface.triangles.insert(surface.triangles.end(), cap.triangles.begin(), cap.triangles.end());
    const std::size_t count = surface.triangles.size();
    surface.two_sided.resize(count, 0);
    surface.even.resize(count, 0);
    if (!surface.groups.empty()) surface.groups.resize(count, group);
  }
  add_finding(findings, DiagnosticCode::holes_closed, "boundary edges of flat holes", edges, place,
              "closed in the planes of their rims");
  for (std::size_t r = 0; r < rims.size(); ++r)
    if (!closed[r]) holes.push_back(open_hole(rims[r], surface.points));
  order_holes(holes);
  return holes;
}

void order_holes(std::vector<SurfaceHole>& holes) {
  std::stable_sort(holes.begin(), holes.end(),
                   [](const SurfaceHole& a, const SurfaceHole& b) { return a.size > b.size; });
  const auto lowest = [](const SurfaceHole& hole, double step) {
    std::array<double, 3> best{INFINITY, INFINITY, INFINITY};
    for (const Vec3& p : hole.points)
      best = std::min(best, {std::round(p.z() / step), std::round(p.y() / step), std::round(p.x() / step)});
    return best;
  };
  for (auto first = holes.begin(); first != holes.end();) {
    const double smallest = (1 - Tuning::equal) * first->size;
    const auto last =
        std::find_if(first, holes.end(), [&](const SurfaceHole& h) { return h.size < smallest; });
    if (const double step = Tuning::equal * std::sqrt(first->size); last - first > 1 && step > 0)
      std::stable_sort(first, last, [&](const SurfaceHole& a, const SurfaceHole& b) {
        return lowest(a, step) < lowest(b, step);
      });
    first = last;
  }
}

void name_holes(std::vector<SurfaceHole>& holes, const std::vector<RegionSeed>& seeds,
                const std::set<std::string>& taken, double diagonal) {
  if (!seeds.empty() && holes.empty())
    throw UsageError("there is no cap to call '" + seeds[0].name +
                     "': the surfaces have no holes; leave out --cap");
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> items;
  if (!seeds.empty())
    for (std::uint32_t h = 0; h < holes.size(); ++h) {
      const auto first = static_cast<Index>(points.size());
      points.insert(points.end(), holes[h].points.begin(), holes[h].points.end());
      for (const auto& [a, b, c] : holes[h].triangles)
        items.push_back({{first + a, first + b, first + c}, {h, 0, 0}});
    }
  const ProjectionTree tree(std::move(points), std::move(items));
  std::set<std::string> used = taken;
  std::map<std::size_t, const RegionSeed*> named;
  for (const RegionSeed& seed : seeds) {
    const std::string what = "the cap '" + seed.name + "' at " + place_text(seed.point);
    const auto hit = tree.nearest_of(seed.point, std::numeric_limits<double>::infinity(),
                                     [](const ProjectionTree::Item&) { return true; });
    if (!hit) throw UsageError(what + " is near no hole; choose another point");
    const double distance = (hit->point - seed.point).norm();
    if (distance > Tuning::near * diagonal)
      throw UsageError(what + " is " + short_number(distance) + " from the nearest cap, at " +
                       place_text(hit->point) + ", and at most " + short_number(Tuning::near * diagonal) +
                       " is near; choose a point on the cap");
    const std::size_t hole = tree.items()[hit->item].kind[0];
    const auto [known, added] = named.insert({hole, &seed});
    if (!added && known->second->name != seed.name)
      throw UsageError(what + " is the same as '" + known->second->name + "' at " +
                       place_text(known->second->point) + "; leave one of them out");
    if (added && !used.insert(seed.name).second)
      throw UsageError(what + ": another patch has this name; choose another one");
    holes[hole].name = seed.name;
  }
  std::size_t next = 1;
  for (std::size_t h = 0; h < holes.size(); ++h) {
    if (named.contains(h)) {
      ++next;
      continue;
    }
    std::string name;
    do name = "cap_" + std::to_string(next++);
    while (!used.insert(name).second);
    holes[h].name = std::move(name);
  }
}

}  // namespace tetwright
