// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/surface_imprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>

#include "common/geometry/box_tree.h"
#include "common/mesh/disjoint_sets.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/complex/triangle_subdivision.h"
#include "mesher/tuning/complex_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Imprint = ComplexTuning::Imprint;

using Edge = std::array<Index, 2>;  ///< ascending

/// Something that two triangles of different surfaces have in common and that is not a common point yet. The
/// kinds are ordered by what must come first.
struct Event {
  enum class Kind : std::uint8_t { points, point_on_edge, point_in_triangle, edges_cross, edge_pierces };
  Kind kind;
  Index point = no_index;           ///< points, point_on_edge, point_in_triangle
  Index other = no_index;           ///< points; or the triangle of the last and third kind
  Edge first{}, second{};           ///< edges
  std::uint32_t owner = 0;          ///< surface of the edge or triangle that receives the point
  std::uint32_t second_owner = 0;   ///< surface of the other edge
  auto operator<=>(const Event&) const = default;
};

/// The nearest points of two segments, as fractions.
struct SegmentPair {
  double s, t, squared;
};

SegmentPair nearest_points(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  // Nearly parallel segments are compared from their ends.
  double s = det > Imprint::parallel * uu * vv ? std::clamp((uv * vw - vv * uw) / det, 0.0, 1.0) : 0.0;
  double t = vv > 0 ? (uv * s + vw) / vv : 0;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0;
  }
  return {s, t, (w + s * u - t * v).squaredNorm()};
}

/// The foot of a point on a segment, as a fraction, and its squared distance.
std::pair<double, double> foot_on(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 u = b - a;
  const double s = std::clamp(u.dot(p - a) / u.squaredNorm(), 0.0, 1.0);
  return {s, (a + s * u - p).squaredNorm()};
}

class Imprinter {
 public:
  Imprinter(const SurfaceSoup& soup, double tolerance, Progress* progress)
      : tolerance_(tolerance), squared_(tolerance * tolerance), progress_(progress) {
    result_.points = soup.points;
    result_.gap.assign(soup.points.size(), 0);
    owner_.assign(soup.points.size(), 0);
    for (Index t = 0; t < soup.triangles.size(); ++t) {
      triangles_.push_back({soup.triangles[t], t, soup.surface[t], true});
      for (const Index p : soup.triangles[t]) owner_[p] = soup.surface[t];
    }
    first_new_ = soup.points.size();
  }

  ImprintedSurfaces run() {
    double budget = Imprint::max_new_points;
    for (int round = 0; round < Imprint::max_rounds; ++round) {
      if (progress_) progress_->throw_if_stopped();
      find_pairs(round == 0);
      std::vector<Event> events = find_events();
      add_slivers(events);
      if (events.empty()) {
        result_.unresolved.reset();
        break;
      }
      result_.any = true;
      result_.unresolved = place_of(events.front());
      if (round + 1 == Imprint::max_rounds) break;
      if (events.front().kind == Event::Kind::points) {
        merge(events);
        continue;
      }
      if (budget == Imprint::max_new_points)
        budget = std::max(budget, Imprint::points_per_pair * static_cast<double>(pairs_.size()));
      if (static_cast<double>(result_.points.size() - first_new_) > budget) break;
      insert(events);
    }
    for (const Part& t : triangles_) {
      result_.triangles.push_back(t.ids);
      result_.source.push_back(t.source);
    }
    result_.any |= !pairs_with_common_points().empty();
    return std::move(result_);
  }

 private:
  struct Part {
    Triangle ids;
    Index source;
    std::uint32_t surface;
    bool active;  ///< its box meets that of a triangle of another surface
  };
  struct OnEdge {
    double share;
    Index point;
    bool operator<(const OnEdge& o) const { return share != o.share ? share < o.share : point < o.point; }
  };

  const Vec3& at(Index p) const { return result_.points[p]; }
  std::uint64_t key(const Edge& e) const { return std::uint64_t{e[0]} << 32 | e[1]; }

  void find_pairs(bool all) {
    std::vector<Index> listed;
    for (Index t = 0; t < triangles_.size(); ++t)
      if (all || triangles_[t].active) listed.push_back(t);
    std::vector<Box3> boxes(listed.size());
    std::vector<Vec3> middles(listed.size());
    const Vec3 margin = Vec3::Constant(Imprint::box_margin * tolerance_);
    for (std::size_t i = 0; i < listed.size(); ++i) {
      for (const Index p : triangles_[listed[i]].ids) boxes[i].add(at(p));
      middles[i] = boxes[i].low + boxes[i].high;
      boxes[i].low -= margin;
      boxes[i].high += margin;
      triangles_[listed[i]].active = false;
    }
    const std::vector<Index> order = median_order(boxes, middles, Imprint::leaf_size);
    const BoxTree tree(order.size(), Imprint::leaf_size, [&](std::size_t i) { return boxes[order[i]]; });
    const std::span<const BoxTree::Node> nodes = tree.nodes();
    pairs_ = parallel_collect<Edge>(
        0, nodes.size(), ComplexGrains::nodes,
        [&](std::size_t begin, std::size_t end, std::vector<Edge>& found) {
          for (std::size_t k = begin; k < end; ++k) {
            if (!tree.is_leaf(nodes[k])) continue;
            tree.for_each_later_intersecting_leaf(k, [&](std::size_t l) {
              for (std::size_t i = nodes[k].begin; i < nodes[k].end; ++i)
                for (std::size_t j = std::max<std::size_t>(nodes[l].begin, i + 1); j < nodes[l].end; ++j) {
                  const Index f = order[i], g = order[j];
                  const Index a = listed[f], b = listed[g];
                  if (triangles_[a].surface != triangles_[b].surface && boxes[f].intersects(boxes[g]))
                    found.push_back({std::min(a, b), std::max(a, b)});
                }
            });
          }
        });
    parallel_sort(pairs_);
    for (const auto& [a, b] : pairs_) triangles_[a].active = triangles_[b].active = true;
  }

  std::vector<Edge> pairs_with_common_points() const {
    std::vector<Edge> common;
    for (const Edge& pair : pairs_)
      for (const Index p : triangles_[pair[0]].ids)
        if (has(triangles_[pair[1]].ids, p)) {
          common.push_back(pair);
          break;
        }
    return common;
  }

  static bool has(const Triangle& t, Index p) { return t[0] == p || t[1] == p || t[2] == p; }

  std::vector<Event> find_events() const {
    std::vector<Event> events = parallel_collect<Event>(
        0, pairs_.size(), ComplexGrains::pairs,
        [&](std::size_t begin, std::size_t end, std::vector<Event>& out) {
          for (std::size_t i = begin; i < end; ++i) {
            const Part &a = triangles_[pairs_[i][0]], &b = triangles_[pairs_[i][1]];
            points_against(a, pairs_[i][1], out);
            points_against(b, pairs_[i][0], out);
            edges_against(a, b, out);
            pierce(a, pairs_[i][1], out);
            pierce(b, pairs_[i][0], out);
          }
        });
    parallel_sort_unique(events);
    return events;
  }

  /// Points of `a` near points, edges and the interior of triangle `t`.
  void points_against(const Part& a, Index t, std::vector<Event>& out) const {
    const Part& b = triangles_[t];
    for (const Index p : a.ids) {
      if (has(b.ids, p)) continue;
      bool found = false;
      for (const Index q : b.ids)
        if ((at(p) - at(q)).squaredNorm() <= squared_) {
          out.push_back({Event::Kind::points, std::min(p, q), std::max(p, q), {}, {}, 0, 0});
          found = true;
        }
      if (found) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge e = ascending_edge(b.ids[k], b.ids[(k + 1) % 3]);
        const auto [share, squared] = foot_on(at(p), at(e[0]), at(e[1]));
        if (squared > squared_ || !(share > 0 && share < 1)) continue;
        out.push_back({Event::Kind::point_on_edge, p, no_index, e, {}, b.surface, 0});
        found = true;
      }
      if (found) continue;
      const Vec3 &x = at(b.ids[0]), u = at(b.ids[1]) - x, v = at(b.ids[2]) - x, w = at(p) - x;
      const Vec3 normal = u.cross(v);
      const double squared = normal.squaredNorm(), height = normal.dot(w);
      if (!(squared > 0) || height * height > squared_ * squared) continue;
      const double s = w.cross(v).dot(normal), r = u.cross(w).dot(normal);
      if (s > 0 && r > 0 && s + r < squared)
        out.push_back({Event::Kind::point_in_triangle, p, t, {}, {}, b.surface, 0});
    }
  }

  void edges_against(const Part& a, const Part& b, std::vector<Event>& out) const {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        Edge e = ascending_edge(a.ids[i], a.ids[(i + 1) % 3]), f = ascending_edge(b.ids[k], b.ids[(k + 1) % 3]);
        if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) continue;
        const SegmentPair near = nearest_points(at(e[0]), at(e[1]), at(f[0]), at(f[1]));
        if (near.squared > squared_ || !(near.s > 0 && near.s < 1 && near.t > 0 && near.t < 1)) continue;
        const auto ends_near = [&](const Edge& x, const Edge& y) {
          return std::any_of(x.begin(), x.end(), [&](Index p) {
            return foot_on(at(p), at(y[0]), at(y[1])).second <= squared_;
          });
        };
        if (ends_near(e, f) || ends_near(f, e)) continue;
        std::uint32_t first = a.surface, second = b.surface;
        if (f < e) {
          std::swap(e, f);
          std::swap(first, second);
        }
        out.push_back({Event::Kind::edges_cross, no_index, no_index, e, f, first, second});
      }
  }

  /// Edges of `a` that pierce triangle `t`.
  void pierce(const Part& a, Index t, std::vector<Event>& out) const {
    const Part& b = triangles_[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge e = ascending_edge(a.ids[i], a.ids[(i + 1) % 3]);
      if (has(b.ids, e[0]) || has(b.ids, e[1])) continue;
      const auto share = crossing(e, b.ids);
      if (!share) continue;
      const Vec3 p = at(e[0]) + *share * (at(e[1]) - at(e[0]));
      bool near = false;
      for (std::size_t k = 0; k < 3; ++k)
        near |= foot_on(p, at(b.ids[k]), at(b.ids[(k + 1) % 3])).second <= squared_;
      for (const Index end : e) near |= (at(end) - p).squaredNorm() <= squared_;
      if (!near) out.push_back({Event::Kind::edge_pierces, no_index, t, e, {}, a.surface, b.surface});
    }
  }

  /// Where an edge crosses the interior of a triangle, with both ends farther than the tolerance from its
  /// plane.
  std::optional<double> crossing(const Edge& e, const Triangle& t) const {
    const Vec3 &x = at(t[0]), u = at(t[1]) - x, v = at(t[2]) - x, normal = u.cross(v);
    const double squared = normal.squaredNorm();
    const double from = normal.dot(at(e[0]) - x), to = normal.dot(at(e[1]) - x);
    if (!(squared > 0) || !(from * to < 0) || from * from <= squared_ * squared ||
        to * to <= squared_ * squared)
      return {};
    const double share = from / (from - to);
    const Vec3 w = at(e[0]) + share * (at(e[1]) - at(e[0])) - x;
    const double s = w.cross(v).dot(normal), r = u.cross(w).dot(normal);
    if (!(s > 0 && r > 0 && s + r < squared)) return {};
    return share;
  }

  /// Triangles that imprinting has made flat: their middle point is put on the longest edge.
  void add_slivers(std::vector<Event>& events) const {
    const double limit = Imprint::flat_share * Imprint::flat_share * squared_;
    std::vector<Event> found;
    for (const Part& t : triangles_) {
      if (!t.active) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge e = ascending_edge(t.ids[(k + 1) % 3], t.ids[(k + 2) % 3]);
        const auto [share, squared] = foot_on(at(t.ids[k]), at(e[0]), at(e[1]));
        if (squared <= limit && share > 0 && share < 1)
          found.push_back({Event::Kind::point_on_edge, t.ids[k], no_index, e, {}, t.surface, 0});
      }
    }
    if (found.empty()) return;
    events.insert(events.end(), found.begin(), found.end());
    parallel_sort_unique(events);
  }

  Vec3 place_of(const Event& e) const { return e.point != no_index ? at(e.point) : at(e.first[0]); }

  void note_gap(Index p, double gap) { result_.gap[p] = std::max(result_.gap[p], gap); }

  /// Merges points; each group takes the position of its earliest surface's point.
  void merge(const std::vector<Event>& events) {
    DisjointSets sets(result_.points.size());
    for (const Event& e : events)
      if (e.kind == Event::Kind::points) sets.unite(e.point, e.other);
    std::vector<Index> best(result_.points.size());
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
      for (Index& p : t.ids) {
        const Index kept = best[sets.root(p)];
        if (kept == p) continue;
        note_gap(kept, std::max((at(kept) - at(p)).norm(), result_.gap[p]));
        p = kept;
      }
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
              if (const double d = (points_[q] - p).squaredNorm(); d < squared || (d == squared && q < best)) {
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
    PointGrid grid(tolerance_, result_.points);
    std::vector<char> listed(result_.points.size(), 0);
    for (const Part& t : triangles_)
      if (t.active)
        for (const Index p : t.ids)
          if (!listed[p]) {
            listed[p] = 1;
            grid.add(p);
          }
    const auto point_at = [&](const Vec3& place, std::uint32_t owner) {
      if (const Index known = grid.find(place); known != no_index) return known;
      const auto added = static_cast<Index>(result_.points.size());
      result_.points.push_back(place);
      result_.gap.push_back(0);
      owner_.push_back(owner);
      grid.add(added);
      return added;
    };
    for (const Event& e : events) {
      switch (e.kind) {
        case Event::Kind::points:
          break;
        case Event::Kind::point_on_edge: {
          const auto [share, squared] = foot_on(at(e.point), at(e.first[0]), at(e.first[1]));
          if (squared > 4 * squared_) break;  // another event has moved the point away
          note_gap(e.point, std::sqrt(squared));
          if (e.owner < owner_[e.point]) {
            result_.points[e.point] = at(e.first[0]) + share * (at(e.first[1]) - at(e.first[0]));
            owner_[e.point] = e.owner;
          }
          put_on_edge(e.point, e.first);
          break;
        }
        case Event::Kind::point_in_triangle: {
          const Triangle& t = triangles_[e.other].ids;
          const Vec3 &x = at(t[0]), normal = (at(t[1]) - x).cross(at(t[2]) - x);
          const Vec3 step = normal * (normal.dot(at(e.point) - x) / normal.squaredNorm());
          note_gap(e.point, step.norm());
          if (e.owner < owner_[e.point]) {
            result_.points[e.point] -= step;
            owner_[e.point] = e.owner;
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
          note_gap(p, std::sqrt(near.squared));
          put_on_edge(p, e.first);
          put_on_edge(p, e.second);
          break;
        }
        case Event::Kind::edge_pierces: {
          // Points moved since the event was found may have changed the crossing; then the next round finds it.
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
    for (const auto& [a, b] : pairs_) {
      if (!is_touched[a] && !is_touched[b]) continue;
      add_segments(a, b, points, on_edges, segments);
    }
    std::vector<std::vector<Triangle>> parts(touched.size());
    parallel_for(0, touched.size(), ComplexGrains::divided, [&](std::size_t begin, std::size_t end) {
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
        next.push_back({ids, triangles_[t].source, triangles_[t].surface, true});
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

  double tolerance_, squared_;
  Progress* progress_;
  ImprintedSurfaces result_;
  std::size_t first_new_ = 0;
  std::vector<std::uint32_t> owner_;  ///< earliest surface on which each point lies
  std::vector<Part> triangles_;
  std::vector<Edge> pairs_;  ///< of triangles of different surfaces whose boxes meet
};

}  // namespace

ImprintedSurfaces imprint_surfaces(const SurfaceSoup& soup, double tolerance, Progress* progress) {
  return Imprinter(soup, tolerance, progress).run();
}

}  // namespace tetwright
