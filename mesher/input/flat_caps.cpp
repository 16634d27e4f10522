// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/flat_caps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/geometry/self_intersection.h"
#include "mesher/complex/triangle_subdivision.h"
#include "mesher/tuning/input_tuning.h"

namespace tetwright {

namespace {

using Tuning = InputTuning::Holes;
using Edge = std::array<Index, 2>;

/// Sets everything but the edges.
void measure(HoleRim& rim, const std::vector<Vec3>& points) {
  std::map<Index, int> balance;
  double length = 0;
  for (const auto& [a, b] : rim.edges) {
    ++balance[a];
    --balance[b];
    const double own = (points[b] - points[a]).norm();
    length += own;
    rim.centre += own * (points[a] + points[b]) / 2;
    rim.box.extend(points[a]).extend(points[b]);
  }
  rim.centre = length > 0 ? Vec3(rim.centre / length) : points[rim.edges[0][0]];
  for (const auto& [a, b] : rim.edges)
    rim.vector += (points[a] - rim.centre).cross(points[b] - rim.centre) / 2;
  rim.balanced =
      std::all_of(balance.begin(), balance.end(), [](const auto& item) { return item.second == 0; });
}

Triangle with_ascending_points(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

class FlatCapFinder {
 public:
  FlatCapFinder(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                const std::vector<HoleRim>& rims, const std::vector<Index>& component, bool of_body)
      : points_(points), triangles_(triangles), rims_(rims), component_(component), of_body_(of_body) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : points) box.extend(p);
    diagonal_ = box.diagonal().norm();
    for (const Triangle& t : triangles) area_ += area_vector(points, t).norm();
  }

  std::vector<FlatCap> find() {
    std::vector<std::size_t> flat;
    for (std::size_t r = 0; r < rims_.size(); ++r)
      if (is_flat(r)) flat.push_back(r);
    std::stable_sort(flat.begin(), flat.end(), [&](std::size_t a, std::size_t b) {
      return rims_[a].vector.squaredNorm() > rims_[b].vector.squaredNorm();
    });
    if (flat.size() > Tuning::max_flat && !of_body_) flat.resize(Tuning::max_flat);
    for (const std::vector<std::size_t>& together : in_common_planes(flat)) fill(together);
    if (!of_body_) drop_degenerate();
    drop_intersecting();
    return std::move(caps_);
  }

 private:
  bool lies_in_plane_of(const HoleRim& rim, const HoleRim& other) const {
    const Vec3 normal = other.vector.normalized();
    return std::all_of(rim.edges.begin(), rim.edges.end(), [&](const Edge& e) {
      return std::abs(normal.dot(points_[e[0]] - other.centre)) <= Tuning::flat * diagonal_;
    });
  }

  bool is_flat(std::size_t r) const {
    const HoleRim& rim = rims_[r];
    return rim.balanced && (of_body_ || rim.vector.norm() >= Tuning::min_share * area_) &&
           lies_in_plane_of(rim, rim);
  }

  /// Rims that may enclose each other: in one plane, with boxes that overlap.
  std::vector<std::vector<std::size_t>> in_common_planes(const std::vector<std::size_t>& flat) const {
    std::vector<std::vector<std::size_t>> sets;
    std::vector<char> done(flat.size(), 0);
    for (std::size_t i = 0; i < flat.size(); ++i) {
      if (done[i]) continue;
      // Larger rims come first, and a rim that lies within another one is smaller.
      const HoleRim& outer = rims_[flat[i]];
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
    const HoleRim& outer = rims_[together[0]];
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
    std::vector<FlatCap> caps(winding.size());
    std::size_t closed = 0;
    for (std::size_t t = 0; t < parts.size(); ++t) {
      const int w = piece[t] == no_index ? 0 : winding[piece[t]];
      if (w == 0) continue;
      Triangle own = parts[t];
      if (w < 0) std::swap(own[1], own[2]);
      for (std::size_t k = 0; k < 3; ++k) closed += rim_of.contains({own[k], own[(k + 1) % 3]});
      FlatCap& cap = caps[piece[t]];
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
    const auto components_of = [&](const FlatCap& cap) {
      std::set<Index> all;
      for (const std::size_t r : cap.rims) all.insert(component_[rims_[r].at_triangle[0]]);
      return all;
    };
    for (const FlatCap& cap : caps_)
      for (const Index c : components_of(cap)) area[c] += cap.vector.norm();
    for (FlatCap& cap : caps_) {
      double all = 0;
      for (const Index c : components_of(cap)) all += area[c];
      const double own = cap.vector.norm();
      if (own > Tuning::max_ratio * (all - own)) cap.kept = false;
    }
    std::set<Triangle> own;
    for (const FlatCap& cap : caps_)
      for (const Triangle& t : cap.triangles) own.insert(with_ascending_points(t));
    std::set<Triangle> there;
    for (const Triangle& t : triangles_)
      if (const Triangle key = with_ascending_points(t); own.contains(key)) there.insert(key);
    for (FlatCap& cap : caps_)
      cap.kept &= std::none_of(cap.triangles.begin(), cap.triangles.end(),
                               [&](const Triangle& t) { return there.contains(with_ascending_points(t)); });
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
  const std::vector<HoleRim>& rims_;
  const std::vector<Index>& component_;
  bool of_body_;
  double diagonal_ = 0, area_ = 0;
  std::vector<FlatCap> caps_;
};

}  // namespace

Vec3 area_vector(const std::vector<Vec3>& points, const Triangle& t) {
  return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]) / 2;
}

std::vector<HoleRim> find_rims(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<HoleRim> rims;
  std::vector<Index> root(points.size(), no_index);
  const auto find = [&](Index p) {
    while (root[p] != p) p = root[p] = root[root[p]];
    return p;
  };
  std::vector<std::pair<Edge, Index>> free;
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
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
    const std::size_t r = number.try_emplace(find(edge[0]), rims.size()).first->second;
    if (r == rims.size()) rims.emplace_back();
    rims[r].edges.push_back(edge);
    rims[r].at_triangle.push_back(triangle);
  }
  for (HoleRim& rim : rims) measure(rim, points);
  return rims;
}

std::vector<FlatCap> find_flat_caps(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                    const std::vector<HoleRim>& rims, const std::vector<Index>& component,
                                    bool of_body) {
  return FlatCapFinder(points, triangles, rims, component, of_body).find();
}

}  // namespace tetwright
