// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/surface_imprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "common/mesh/disjoint_sets.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/complex/imprint_state.h"
#include "mesher/complex/triangle_subdivision.h"
#include "mesher/tuning/complex_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Imprint = ComplexTuning::Imprint;
using Edge = ImprintEdge;
using Event = ImprintEvent;

class Imprinter : private ImprintState {
 public:
  Imprinter(const SurfaceSoup& soup, double tolerance, Progress* progress)
      : ImprintState(tolerance, progress) {
    points_ = soup.points;
    owner_.assign(soup.points.size(), 0);
    for (Index t = 0; t < soup.triangles.size(); ++t) {
      triangles_.push_back({soup.triangles[t], t, soup.surface[t], true, true});
      const auto& [a, b, c] = soup.triangles[t];
      normals_.push_back((at(b) - at(a)).cross(at(c) - at(a)));
      for (const Index p : soup.triangles[t]) owner_[p] = soup.surface[t];
    }
    first_new_ = soup.points.size();
  }

  ImprintedSurfaces run(const ImprintBound& bound) {
    double budget = bound.points;
    for (int round = 0; round < rounds(); ++round) {
      throw_if_stopped();
      find_pairs(round == 0);
      const double bytes = Imprint::bytes_per_triangle * static_cast<double>(triangles_.size()) +
                           Imprint::bytes_per_pair * static_cast<double>(pairs_.size());
      require_imprint_memory(bytes);
      result_.peak_bytes = std::max(result_.peak_bytes, bytes);
      if (round == 0) budget = std::max(budget, bound.per_pair * static_cast<double>(pairs_.size()));
      const std::vector<Event> events = next_events(round);
      if (events.empty()) {
        result_.unresolved.reset();
        break;
      }
      result_.any = true;
      result_.unresolved = place_of(events.front());
      if (round + 1 == rounds()) break;
      if (events.front().kind == Event::Kind::points) {
        merge(events);
        continue;
      }
      const auto adds_point = [](const Event& e) { return e.kind >= Event::Kind::edges_cross; };
      const auto added = std::count_if(events.begin(), events.end(), adds_point);
      result_.too_many_points =
          static_cast<double>(points_.size() - first_new_) + static_cast<double>(added) > budget;
      if (result_.too_many_points) break;
      const double added_bytes = Imprint::bytes_per_event * static_cast<double>(events.size());
      require_imprint_memory(added_bytes);
      result_.peak_bytes = std::max(result_.peak_bytes, bytes + added_bytes);
      insert(events);
    }
    for (const Part& t : triangles_) {
      result_.triangles.push_back(t.ids);
      result_.source.push_back(t.source);
    }
    result_.any |= have_common_points();
    result_.points = std::move(points_);
    return std::move(result_);
  }

 private:
  struct OnEdge {
    double share;
    Index point;
    bool operator<(const OnEdge& o) const { return share != o.share ? share < o.share : point < o.point; }
  };

  /// The events of a round.
  std::vector<Event> next_events(int round) {
    std::vector<Event> events = find_events();
    std::vector<Event> diagonals = take_diagonals(events);
    if (round >= Imprint::first_round_of_slivers && !events.empty()) {
      std::erase_if(events, [&](const Event& e) { return passes_common_point(e); });
      // A curve that three surfaces share may have kinks of up to the tolerance. A sliver at a kink, which
      // only some of them have, would make the others cross forever.
      if (!events.empty())
        if (std::vector<Event> slivers = find_slivers(tolerance_); !slivers.empty()) return slivers;
    }
    if (!events.empty()) return events;
    events = find_slivers(Imprint::flat_share * tolerance_);
    if (events.empty()) events = find_slivers(Imprint::fold_reach * tolerance_, true);
    if (events.empty()) events = std::move(diagonals);
    clean_rounds_ += events.empty() ? 0 : 1;
    return events;
  }

  int rounds() const { return Imprint::max_rounds + std::min(clean_rounds_, Imprint::max_clean_rounds); }

  bool have_common_points() const {
    return std::any_of(pairs_.begin(), pairs_.end(), [&](const Edge& pair) {
      const Triangle& t = triangles_[pair[0]].ids;
      return std::any_of(t.begin(), t.end(), [&](Index p) { return has(triangles_[pair[1]].ids, p); });
    });
  }

  Vec3 place_of(const Event& e) const { return e.point != no_index ? at(e.point) : at(e.first[0]); }

  /// Merges points; each group takes the position of its earliest surface's point.
  void merge(const std::vector<Event>& events) {
    DisjointSets sets(points_.size());
    for (const Event& e : events)
      if (e.kind == Event::Kind::points) sets.unite(e.point, e.other);
    std::vector<Index> best(points_.size());
    for (Index p = 0; p < best.size(); ++p) best[p] = p;
    const auto earlier = [&](Index p, Index q) {
      if (owner_[p] != owner_[q]) return owner_[p] < owner_[q];
      const Vec3 &a = at(p), &b = at(q);
      for (int k = 0; k < 3; ++k)
        if (a[k] != b[k]) return a[k] < b[k];
      return p < q;
    };
    for (Index p = 0; p < best.size(); ++p)
      if (Index& of_group = best[sets.root(p)]; earlier(p, of_group)) of_group = p;
    for (Part& t : triangles_)
      for (Index& p : t.ids)
        if (const Index kept = best[sets.root(p)]; kept != p) p = kept, t.changed = true;
    drop_collapsed();
  }

  void drop_collapsed() {
    std::erase_if(triangles_, [](const Part& t) {
      return t.ids[0] == t.ids[1] || t.ids[1] == t.ids[2] || t.ids[2] == t.ids[0];
    });
  }

  /// Points by cells of their coordinates.
  class PointGrid {
   public:
    PointGrid(double reach, const std::vector<Vec3>& points) : reach_(reach), points_(points) {}
    void add(Index p) { cells_[hash(cell(points_[p]))].push_back(p); }
    /// The nearest point within the reach.
    Index find(const Vec3& p) const {
      Index best = no_index;
      double squared = reach_ * reach_;
      const auto low = cell(p - Vec3::Constant(reach_)), high = cell(p + Vec3::Constant(reach_));
      for (std::int64_t x = low[0]; x <= high[0]; ++x)
        for (std::int64_t y = low[1]; y <= high[1]; ++y)
          for (std::int64_t z = low[2]; z <= high[2]; ++z) {
            const auto known = cells_.find(hash({x, y, z}));
            if (known == cells_.end()) continue;
            for (const Index q : known->second)
              if (const double d = (points_[q] - p).squaredNorm();
                  d < squared || (d == squared && q < best)) {
                squared = d;
                best = q;
              }
          }
      return best;
    }

   private:
    using Cell = std::array<std::int64_t, 3>;
    Cell cell(const Vec3& p) const {
      Cell c;
      for (int a = 0; a < 3; ++a)
        c[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::floor(p[a] / (2 * reach_)));
      return c;
    }
    static std::uint64_t hash(const Cell& c) {
      std::uint64_t h = 0;
      for (const std::int64_t x : c) {
        h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
        h ^= h >> 29;
      }
      return h;
    }
    double reach_;
    const std::vector<Vec3>& points_;
    std::unordered_map<std::uint64_t, std::vector<Index>> cells_;
  };

  /// Inserts points into edges and triangles and divides these.
  void insert(const std::vector<Event>& events) {
    std::unordered_map<std::uint64_t, std::vector<OnEdge>> on_edges;
    std::unordered_map<Index, std::vector<Index>> inside;
    const auto put_on_edge = [&](Index p, const Edge& e) {
      if (p == e[0] || p == e[1]) return;
      std::vector<OnEdge>& list = on_edges[key(e)];
      if (std::any_of(list.begin(), list.end(), [&](const OnEdge& o) { return o.point == p; })) return;
      list.push_back({foot_on(at(p), at(e[0]), at(e[1])).first, p});
    };
    const auto put_inside = [&](Index p, Index t) {
      if (has(triangles_[t].ids, p)) return;
      std::vector<Index>& list = inside[t];
      if (std::find(list.begin(), list.end(), p) == list.end()) list.push_back(p);
    };
    PointGrid grid(tolerance_, points_);
    std::vector<char> listed(points_.size(), 0);
    for (const Part& t : triangles_)
      if (t.active)
        for (const Index p : t.ids)
          if (!listed[p]) {
            listed[p] = 1;
            grid.add(p);
          }
    const auto point_at = [&](const Vec3& place, std::uint32_t owner) {
      if (const Index known = grid.find(place); known != no_index) return known;
      const auto added = static_cast<Index>(points_.size());
      points_.push_back(place);
      owner_.push_back(owner);
      grid.add(added);
      return added;
    };
    std::vector<char> moved(points_.size(), 0);
    std::size_t inserted = 0;
    for (const Event& e : events) {
      if (inserted++ % ComplexGrains::pairs == 0) throw_if_stopped();
      switch (e.kind) {
        case Event::Kind::points:
        case Event::Kind::diagonals:
          break;
        case Event::Kind::point_on_edge: {
          const auto [share, squared] = foot_on(at(e.point), at(e.first[0]), at(e.first[1]));
          if (squared > Imprint::moved_away * squared_) break;  // by another event
          if (e.owner < owner_[e.point]) {
            points_[e.point] = at(e.first[0]) + share * (at(e.first[1]) - at(e.first[0]));
            owner_[e.point] = e.owner;
            moved[e.point] = 1;
          }
          put_on_edge(e.point, e.first);
          break;
        }
        case Event::Kind::point_in_triangle: {
          const Triangle& t = triangles_[e.other].ids;
          const Vec3 &x = at(t[0]), normal = (at(t[1]) - x).cross(at(t[2]) - x);
          const Vec3 step = normal * (normal.dot(at(e.point) - x) / normal.squaredNorm());
          if (e.owner < owner_[e.point]) {
            points_[e.point] -= step;
            owner_[e.point] = e.owner;
            moved[e.point] = 1;
          }
          put_inside(e.point, e.other);
          break;
        }
        case Event::Kind::edges_cross: {
          const SegmentPair near =
              nearest_points(at(e.first[0]), at(e.first[1]), at(e.second[0]), at(e.second[1]));
          const bool first = e.owner <= e.second_owner;
          const Edge& kept = first ? e.first : e.second;
          const Index p = point_at(at(kept[0]) + (first ? near.s : near.t) * (at(kept[1]) - at(kept[0])),
                                   std::min(e.owner, e.second_owner));
          put_on_edge(p, e.first);
          put_on_edge(p, e.second);
          break;
        }
        case Event::Kind::edge_pierces: {
          // Points moved since the event was found may have changed the crossing; then the next round finds
          // it.
          const auto share = crossing(e.first, triangles_[e.other].ids);
          if (!share) break;
          const Index p = point_at(at(e.first[0]) + *share * (at(e.first[1]) - at(e.first[0])),
                                   std::min(e.owner, e.second_owner));
          put_on_edge(p, e.first);
          put_inside(p, e.other);
          break;
        }
      }
    }
    for (Part& t : triangles_)
      t.changed |= std::any_of(t.ids.begin(), t.ids.end(), [&](Index p) { return moved[p] != 0; });
    for (auto& [edge, list] : on_edges) std::sort(list.begin(), list.end());
    divide(on_edges, inside);
  }

  using EdgePoints = std::unordered_map<std::uint64_t, std::vector<OnEdge>>;

  /// The points of an edge in order, with its ends.
  std::vector<Index> chain(Index a, Index b, const EdgePoints& on_edges) const {
    std::vector<Index> out{a};
    const auto known = on_edges.find(key(ascending_edge(a, b)));
    if (known != on_edges.end()) {
      for (const OnEdge& o : known->second) out.push_back(o.point);
      if (a > b) std::reverse(out.begin() + 1, out.end());
    }
    out.push_back(b);
    return out;
  }

  void divide(const EdgePoints& on_edges, const std::unordered_map<Index, std::vector<Index>>& inside) {
    // Points of the triangles to be divided.
    std::vector<Index> touched;
    std::vector<std::vector<Index>> points(triangles_.size());
    for (Index t = 0; t < triangles_.size(); ++t) {
      const Triangle& ids = triangles_[t].ids;
      bool any = inside.contains(t);
      for (std::size_t k = 0; k < 3 && !any; ++k)
        any = on_edges.contains(key(ascending_edge(ids[k], ids[(k + 1) % 3])));
      if (any) touched.push_back(t);
      if (!any && !triangles_[t].active) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<Index> along = chain(ids[k], ids[(k + 1) % 3], on_edges);
        points[t].insert(points[t].end(), along.begin(), along.end() - 1);
      }
      if (const auto own = inside.find(t); own != inside.end())
        points[t].insert(points[t].end(), own->second.begin(), own->second.end());
      std::sort(points[t].begin(), points[t].end());
    }
    std::vector<char> is_touched(triangles_.size(), 0);
    for (const Index t : touched) is_touched[t] = 1;
    std::vector<std::vector<Edge>> segments(triangles_.size());
    std::size_t compared = 0;
    for (const auto& [a, b] : pairs_) {
      if (compared++ % ComplexGrains::pairs == 0) throw_if_stopped();
      if (!is_touched[a] && !is_touched[b]) continue;
      add_segments(a, b, points, on_edges, segments);
    }
    std::vector<std::vector<Triangle>> parts(touched.size());
    parallel_for(0, touched.size(), ComplexGrains::divided, [&](std::size_t begin, std::size_t end) {
      throw_if_stopped();
      for (std::size_t i = begin; i < end; ++i)
        parts[i] = divided(touched[i], on_edges, inside, segments[touched[i]]);
    });
    std::vector<Part> next;
    next.reserve(triangles_.size());
    std::size_t i = 0;
    for (Index t = 0; t < triangles_.size(); ++t) {
      if (!is_touched[t]) {
        next.push_back(triangles_[t]);
        continue;
      }
      for (const Triangle& ids : parts[i])
        next.push_back({ids, triangles_[t].source, triangles_[t].surface, true, true});
      ++i;
    }
    triangles_ = std::move(next);
    drop_collapsed();
  }

  /// The segments that triangles a and b have in common must be edges of both.
  void add_segments(Index a, Index b, const std::vector<std::vector<Index>>& points,
                    const EdgePoints& on_edges, std::vector<std::vector<Edge>>& segments) const {
    std::vector<Index> common;
    std::set_intersection(points[a].begin(), points[a].end(), points[b].begin(), points[b].end(),
                          std::back_inserter(common));
    common.erase(std::unique(common.begin(), common.end()), common.end());
    if (common.size() < 2) return;
    const auto is_common = [&](Index p) { return std::binary_search(common.begin(), common.end(), p); };
    const auto add_chains = [&](Index from, Index to) {
      const Triangle& ids = triangles_[from].ids;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<Index> along = chain(ids[k], ids[(k + 1) % 3], on_edges);
        for (std::size_t i = 0; i + 1 < along.size(); ++i)
          if (is_common(along[i]) && is_common(along[i + 1]))
            segments[to].push_back(ascending_edge(along[i], along[i + 1]));
      }
    };
    add_chains(a, b);
    add_chains(b, a);
    // Along the line in which the planes cross.
    Index low = common[0], high = common[1];
    double longest = -1;
    for (const Index p : common)
      if (const double d = (at(p) - at(common[0])).squaredNorm(); d > longest) longest = d, high = p;
    longest = -1;
    for (const Index p : common)
      if (const double d = (at(p) - at(high)).squaredNorm(); d > longest) longest = d, low = p;
    const double reach = Imprint::line_reach * tolerance_;
    for (const Index p : common)
      if (foot_on(at(p), at(low), at(high)).second > reach * reach) return;
    std::vector<OnEdge> order;
    order.reserve(common.size());
    for (const Index p : common) order.push_back({foot_on(at(p), at(low), at(high)).first, p});
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      const Edge e = ascending_edge(order[i].point, order[i + 1].point);
      segments[a].push_back(e);
      segments[b].push_back(e);
    }
  }

  std::vector<Triangle> divided(Index t, const EdgePoints& on_edges,
                                const std::unordered_map<Index, std::vector<Index>>& inside,
                                std::vector<Edge> segments) const {
    const Triangle& ids = triangles_[t].ids;
    // With its own point on its longest edge it vanishes.
    for (std::size_t k = 0; k < 3; ++k) {
      const auto known = on_edges.find(key(ascending_edge(ids[k], ids[(k + 1) % 3])));
      if (known != on_edges.end() &&
          std::any_of(known->second.begin(), known->second.end(),
                      [&](const OnEdge& o) { return o.point == ids[(k + 2) % 3]; }))
        return {};
    }
    TriangleSubdivision division(ids, {at(ids[0]), at(ids[1]), at(ids[2])});
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = ids[k], b = ids[(k + 1) % 3];
      const auto known = on_edges.find(key(ascending_edge(a, b)));
      if (known == on_edges.end()) continue;
      for (const OnEdge& o : known->second)
        if (!has(ids, o.point))
          division.add_on_edge(static_cast<int>(k), a < b ? o.share : 1 - o.share, o.point, at(o.point));
    }
    if (const auto own = inside.find(t); own != inside.end()) {
      std::vector<Index> sorted = own->second;
      std::sort(sorted.begin(), sorted.end());
      for (const Index p : sorted) division.add_inside(p, at(p));
    }
    std::sort(segments.begin(), segments.end());
    segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
    for (const auto& [a, b] : segments) division.constrain(a, b);
    return division.triangles();
  }

  ImprintedSurfaces result_;
  std::size_t first_new_ = 0;
  int clean_rounds_ = 0;              ///< rounds so far that removed slivers, folds or diagonals only
  std::vector<std::uint32_t> owner_;  ///< earliest surface on which each point lies
};

}  // namespace

ImprintedSurfaces imprint_surfaces(const SurfaceSoup& soup, double tolerance, Progress* progress,
                                   const ImprintBound& bound) {
  return Imprinter(soup, tolerance, progress).run(bound);
}

}  // namespace tetwright
