// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/laid_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "mesher/complex/imprint_state.h"
#include "mesher/complex/triangle_places.h"
#include "mesher/complex/triangle_subdivision.h"
#include "mesher/tuning/complex_tuning.h"

namespace tetwright {

namespace {

using Adoption = ComplexTuning::Adoption;
using Edge = std::array<Index, 2>;

/// Points and segments that divide a surface's triangles.
struct Cuts {
  std::map<Edge, std::map<double, Index>> on_edges;  ///< by ascending edge and share
  std::map<Index, std::vector<Index>> inside;        ///< by triangle
  std::map<Index, std::set<Edge>> segments;          ///< by triangle

  /// \return false if there is another point
  bool put_on_edge(const Edge& e, double share, Index p) {
    const auto [known, is_new] = on_edges[e].insert({share, p});
    return is_new || known->second == p;
  }
};

class CurveLayer {
 public:
  CurveLayer(std::span<const Triangle> surface, double tolerance, std::vector<Vec3>& points)
      : tolerance_(tolerance), snap_(Adoption::snap * tolerance), points_(points) {
    out_.triangles.assign(surface.begin(), surface.end());
    for (Index t = 0; t < surface.size(); ++t) out_.source.push_back(t);
  }

  std::optional<LaidCurves> run(const NearCurves& curves) {
    if (!lay_points(curves) || !lay_segments(curves)) return {};
    std::set<Edge> edges;
    for (const Triangle& t : out_.triangles)
      for (std::size_t k = 0; k < 3; ++k) edges.insert(ascending_edge(t[k], t[(k + 1) % 3]));
    for (const std::vector<Index>& chain : out_.chains)
      for (std::size_t i = 0; i + 1 < chain.size(); ++i)
        if (!edges.contains(ascending_edge(chain[i], chain[i + 1]))) return {};
    return std::move(out_);
  }

 private:
  /// A point of a chain: one of the surface, or where the chain crosses an edge.
  struct Link {
    double share;  ///< of the segment
    Index point = no_index;
    Edge edge{};
    double edge_share = 0;
  };
  struct Frame {
    Vec3 up, side;  ///< the surface's normal, and across the segment; unit vectors
  };

  const Vec3& at(Index p) const { return points_[p]; }
  Vec3 normal(const Triangle& t) const { return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])); }

  bool lay_points(const NearCurves& curves) {
    const TrianglePlaces places(points_, out_.triangles);
    Cuts cuts;
    std::vector<Index> added;
    for (const Vec3& p : curves.points) {
      const auto found = places.nearest(p, Adoption::reach * tolerance_);
      if (!found) return false;
      const Index laid = point_at(*found, cuts, added);
      if (laid == no_index) return false;
      out_.points.push_back(laid);
    }
    return divide(cuts);
  }

  /// The surface's point at a position on it, a new one unless one is near.
  Index point_at(const TrianglePlaces::Place& place, Cuts& cuts, std::vector<Index>& added) {
    const Triangle& ids = out_.triangles[place.triangle];
    double least = snap_ * snap_;
    Index best = no_index;
    const auto look_at = [&](Index p) {
      const double squared = (at(p) - place.point).squaredNorm();
      if (squared < least) least = squared, best = p;
    };
    for (const Index p : ids) look_at(p);
    if (best != no_index) return best;
    for (const Index p : added) look_at(p);
    if (best != no_index) return best;
    const auto laid = static_cast<Index>(points_.size());
    Edge nearest{};
    double share = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge e = ascending_edge(ids[k], ids[(k + 1) % 3]);
      const auto [s, squared] = foot_on(place.point, at(e[0]), at(e[1]));
      if (squared < least && s > 0 && s < 1) least = squared, nearest = e, share = s;
    }
    if (share < 0) {
      cuts.inside[place.triangle].push_back(laid);
      points_.push_back(place.point);
    } else {
      if (!cuts.put_on_edge(nearest, share, laid)) return no_index;
      const Vec3 p = at(nearest[0]) + share * (at(nearest[1]) - at(nearest[0]));
      points_.push_back(p);
    }
    added.push_back(laid);
    return laid;
  }

  bool lay_segments(const NearCurves& curves) {
    const TrianglePlaces places(points_, out_.triangles);
    std::vector<Vec3> normals(points_.size(), Vec3::Zero());
    for (const Triangle& t : out_.triangles)
      for (const Index p : t) normals[p] += normal(t);
    Cuts cuts;
    for (const auto& [first, last] : curves.segments) {
      const Index p = out_.points[first], q = out_.points[last];
      out_.chains.push_back({p});
      if (p == q) continue;
      const Vec3 along = at(q) - at(p);
      Frame frame;
      frame.up = normals[p].normalized() + normals[q].normalized();
      frame.side = along.cross(frame.up).normalized();
      std::vector<Index> near;
      Box3 box;
      box.add(at(p));
      box.add(at(q));
      for (const Index t : places.in_box(box, Adoption::reach * tolerance_))
        if (normal(out_.triangles[t]).dot(frame.up) > 0) near.push_back(t);
      bool ok = false;
      for (int step = 0; step < Adoption::snap_steps && !ok; ++step) {
        const double snap = snap_ * std::pow(Adoption::snap_step, step);
        ok = add_chain(links(p, q, near, frame, snap), near, cuts);
      }
      if (!ok) return false;
    }
    return divide(cuts);
  }

  /// The points at which a segment passes points of the surface within `snap` and crosses other edges, in
  /// order, with its ends.
  std::vector<Link> links(Index p, Index q, const std::vector<Index>& near, const Frame& frame,
                          double snap) const {
    const double reach = Adoption::reach * tolerance_;
    std::vector<Link> out{{0, p}, {1, q}};
    std::set<Index> own{p, q};
    std::set<Edge> edges;
    for (const Index t : near) {
      const Triangle& ids = out_.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        edges.insert(ascending_edge(ids[k], ids[(k + 1) % 3]));
        if (own.contains(ids[k]) || std::abs(frame.side.dot(at(ids[k]) - at(p))) > snap) continue;
        const auto [share, squared] = foot_on(at(ids[k]), at(p), at(q));
        if (!(share > 0 && share < 1) || squared > reach * reach) continue;
        out.push_back({share, ids[k]});
        own.insert(ids[k]);
      }
    }
    for (const Edge& e : edges) {
      if (own.contains(e[0]) || own.contains(e[1])) continue;
      const double from = frame.side.dot(at(e[0]) - at(p)), to = frame.side.dot(at(e[1]) - at(p));
      if (!(from * to < 0)) continue;
      const double edge_share = from / (from - to);
      const Vec3 place = at(e[0]) + edge_share * (at(e[1]) - at(e[0]));
      const auto [share, squared] = foot_on(place, at(p), at(q));
      if (share > 0 && share < 1 && squared <= reach * reach) out.push_back({share, no_index, e, edge_share});
    }
    std::sort(out.begin(), out.end(), [](const Link& a, const Link& b) {
      return a.share != b.share ? a.share < b.share : std::pair(a.point, a.edge) < std::pair(b.point, b.edge);
    });
    return out;
  }

  /// Adds the points and segments of a chain.
  /// \return false, without a change, unless each link shares a triangle with the next one
  bool add_chain(const std::vector<Link>& links, const std::vector<Index>& near, Cuts& cuts) {
    const auto touches = [&](const Link& link, const Triangle& t) {
      const auto has = [&](Index p) { return t[0] == p || t[1] == p || t[2] == p; };
      return link.point != no_index ? has(link.point) : has(link.edge[0]) && has(link.edge[1]);
    };
    std::vector<Index> through;
    for (std::size_t i = 0; i + 1 < links.size(); ++i) {
      const auto found = std::find_if(near.begin(), near.end(), [&](Index t) {
        return touches(links[i], out_.triangles[t]) && touches(links[i + 1], out_.triangles[t]);
      });
      if (found == near.end() || links[i].share == links[i + 1].share) return false;
      through.push_back(*found);
    }
    std::vector<Index>& chain = out_.chains.back();
    for (std::size_t i = 1; i < links.size(); ++i) {
      const Link& link = links[i];
      Index p = link.point;
      if (p == no_index) {
        p = static_cast<Index>(points_.size());
        const Vec3 place = at(link.edge[0]) + link.edge_share * (at(link.edge[1]) - at(link.edge[0]));
        points_.push_back(place);
        if (!cuts.put_on_edge(link.edge, link.edge_share, p)) return false;
      }
      cuts.segments[through[i - 1]].insert(ascending_edge(chain.back(), p));
      chain.push_back(p);
    }
    return true;
  }

  /// \return false if segments cross
  bool divide(const Cuts& cuts) {
    std::vector<Triangle> triangles;
    std::vector<Index> source;
    for (Index t = 0; t < out_.triangles.size(); ++t) {
      const Triangle& ids = out_.triangles[t];
      const auto inside = cuts.inside.find(t);
      const auto segments = cuts.segments.find(t);
      TriangleSubdivision division(ids, {at(ids[0]), at(ids[1]), at(ids[2])});
      bool any = inside != cuts.inside.end() || segments != cuts.segments.end();
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = ids[k], b = ids[(k + 1) % 3];
        const auto own = cuts.on_edges.find(ascending_edge(a, b));
        if (own == cuts.on_edges.end()) continue;
        any = true;
        double last = -1;
        for (const auto& [share, p] : own->second) {
          if (share - last < Adoption::min_share) return false;
          last = share;
          division.add_on_edge(static_cast<int>(k), a < b ? share : 1 - share, p, at(p));
        }
      }
      if (!any) {
        triangles.push_back(ids);
        source.push_back(out_.source[t]);
        continue;
      }
      if (inside != cuts.inside.end())
        for (const Index p : inside->second) division.add_inside(p, at(p));
      if (segments != cuts.segments.end())
        for (const auto& [a, b] : segments->second)
          if (!division.constrain(a, b)) return false;
      for (const Triangle& part : division.triangles()) {
        triangles.push_back(part);
        source.push_back(out_.source[t]);
      }
    }
    out_.triangles = std::move(triangles);
    out_.source = std::move(source);
    return true;
  }

  double tolerance_, snap_;
  std::vector<Vec3>& points_;
  LaidCurves out_;
};

}  // namespace

std::optional<LaidCurves> lay_curves(const NearCurves& curves, std::span<const Triangle> surface,
                                     double tolerance, std::vector<Vec3>& points) {
  return CurveLayer(surface, tolerance, points).run(curves);
}

}  // namespace tetwright
