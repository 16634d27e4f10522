// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/imprint_state.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>
#include <span>

#include "common/geometry/box_pairs.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/complex_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Imprint = ComplexTuning::Imprint;

}  // namespace

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

std::pair<double, double> foot_on(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 u = b - a;
  const double s = std::clamp(u.dot(p - a) / u.squaredNorm(), 0.0, 1.0);
  return {s, (a + s * u - p).squaredNorm()};
}

void require_imprint_memory(double bytes) {
  require_memory(bytes, "cutting surfaces along the curves in which they meet",
                 "free some, give a larger --memory-limit, or give surfaces of fewer triangles that cross");
}

void ImprintState::find_pairs(bool all) {
  std::vector<Index> listed;
  for (Index t = 0; t < triangles_.size(); ++t)
    if (all || triangles_[t].active) listed.push_back(t);
  std::vector<Box3> boxes(listed.size());
  const Vec3 margin = Vec3::Constant(Imprint::box_margin * tolerance_);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    for (const Index p : triangles_[listed[i]].ids) boxes[i].add(at(p));
    boxes[i].low -= margin;
    boxes[i].high += margin;
    triangles_[listed[i]].active = false;
  }
  std::atomic<std::size_t> found = 0;
  const double available = available_memory();  // a limit applies to this thread, not to those of a loop
  pairs_ = intersecting_pairs(boxes, [&](Index i, Index k) {
    if (triangles_[listed[i]].surface == triangles_[listed[k]].surface) return false;
    // Relaxed: only a count.
    const std::size_t count = found.fetch_add(1, std::memory_order_relaxed);
    if (count % Imprint::pairs_between_checks == 0) {
      throw_if_stopped();
      const MemoryLimit limit(available);
      require_imprint_memory(Imprint::bytes_per_pair * static_cast<double>(count));
    }
    return true;
  });
  for (ImprintEdge& pair : pairs_) pair = {listed[pair[0]], listed[pair[1]]};
  for (const auto& [a, b] : pairs_) triangles_[a].active = triangles_[b].active = true;
  find_memberships();
}

/// Lists the surfaces of the points and edges of active triangles.
void ImprintState::find_memberships() {
  point_uses_.clear();
  edge_uses_.clear();
  for (const Part& t : triangles_) {
    if (!t.active) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      point_uses_.push_back({t.ids[k], t.surface});
      edge_uses_.push_back({key(ascending_edge(t.ids[k], t.ids[(k + 1) % 3])), t.surface});
    }
  }
  parallel_sort_unique(point_uses_);
  parallel_sort_unique(edge_uses_);
}
bool ImprintState::is_on(Index p, std::uint32_t surface) const {
  return std::binary_search(point_uses_.begin(), point_uses_.end(), Membership{p, surface});
}
bool ImprintState::is_on(const ImprintEdge& e, std::uint32_t surface) const {
  return std::binary_search(edge_uses_.begin(), edge_uses_.end(), Membership{key(e), surface});
}

std::vector<ImprintEvent> ImprintState::find_events() {
  std::vector<char> has_events(pairs_.size(), 0);
  std::vector<ImprintEvent> events = parallel_collect<ImprintEvent>(
      0, pairs_.size(), ComplexGrains::pairs,
      [&](std::size_t begin, std::size_t end, std::vector<ImprintEvent>& out) {
        throw_if_stopped();
        for (std::size_t i = begin; i < end; ++i) {
          const Part &a = triangles_[pairs_[i][0]], &b = triangles_[pairs_[i][1]];
          if (!a.changed && !b.changed) continue;
          const std::size_t before = out.size();
          points_against(a, pairs_[i][1], out);
          points_against(b, pairs_[i][0], out);
          edges_against(pairs_[i], out);
          pierce(a, pairs_[i][1], out);
          pierce(b, pairs_[i][0], out);
          has_events[i] = out.size() > before;
        }
      });
  for (Part& t : triangles_) t.changed = false;
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (has_events[i]) triangles_[pairs_[i][0]].changed = triangles_[pairs_[i][1]].changed = true;
  parallel_sort_unique(events);
  return events;
}

/// Points of `a` near points, edges and the interior of triangle `t`.
void ImprintState::points_against(const Part& a, Index t, std::vector<ImprintEvent>& out) const {
  const Part& b = triangles_[t];
  for (const Index p : a.ids) {
    // A point of both surfaces may be near other parts of either, as points of one surface may.
    if (is_on(p, b.surface)) continue;
    bool found = false;
    for (const Index q : b.ids)
      if ((at(p) - at(q)).squaredNorm() <= squared_) {
        out.push_back({ImprintEvent::Kind::points, std::min(p, q), std::max(p, q), {}, {}, 0, 0});
        found = true;
      }
    if (found) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const ImprintEdge e = ascending_edge(b.ids[k], b.ids[(k + 1) % 3]);
      const auto [share, squared] = foot_on(at(p), at(e[0]), at(e[1]));
      if (squared > squared_ || !(share > 0 && share < 1)) continue;
      out.push_back({ImprintEvent::Kind::point_on_edge, p, no_index, e, {}, b.surface, 0});
      found = true;
    }
    if (found) continue;
    const Vec3 &x = at(b.ids[0]), u = at(b.ids[1]) - x, v = at(b.ids[2]) - x, w = at(p) - x;
    const Vec3 normal = u.cross(v);
    const double squared = normal.squaredNorm(), height = normal.dot(w);
    if (!(squared > 0) || height * height > squared_ * squared) continue;
    const double s = w.cross(v).dot(normal), r = u.cross(w).dot(normal);
    if (s > 0 && r > 0 && s + r < squared)
      out.push_back({ImprintEvent::Kind::point_in_triangle, p, t, {}, {}, b.surface, 0});
  }
}

void ImprintState::edges_against(const ImprintEdge& pair, std::vector<ImprintEvent>& out) const {
  const Part &a = triangles_[pair[0]], &b = triangles_[pair[1]];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      ImprintEdge e = ascending_edge(a.ids[i], a.ids[(i + 1) % 3]),
                  f = ascending_edge(b.ids[k], b.ids[(k + 1) % 3]);
      if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) continue;
      if (is_on(e, b.surface) || is_on(f, a.surface)) continue;
      const SegmentPair near = nearest_points(at(e[0]), at(e[1]), at(f[0]), at(f[1]));
      if (near.squared > squared_ || !(near.s > 0 && near.s < 1 && near.t > 0 && near.t < 1)) continue;
      const auto ends_near = [&](const ImprintEdge& x, const ImprintEdge& y) {
        return std::any_of(x.begin(), x.end(),
                           [&](Index p) { return foot_on(at(p), at(y[0]), at(y[1])).second <= squared_; });
      };
      if (ends_near(e, f) || ends_near(f, e)) {
        if (near.squared <= Imprint::flat_share * Imprint::flat_share * squared_)
          out.push_back({ImprintEvent::Kind::diagonals, pair[0], pair[1], e, f, a.surface, b.surface});
        continue;
      }
      std::uint32_t first = a.surface, second = b.surface;
      if (f < e) {
        std::swap(e, f);
        std::swap(first, second);
      }
      out.push_back({ImprintEvent::Kind::edges_cross, no_index, no_index, e, f, first, second});
    }
}

/// Edges of `a` that pierce triangle `t`.
void ImprintState::pierce(const Part& a, Index t, std::vector<ImprintEvent>& out) const {
  const Part& b = triangles_[t];
  for (std::size_t i = 0; i < 3; ++i) {
    const ImprintEdge e = ascending_edge(a.ids[i], a.ids[(i + 1) % 3]);
    if (has(b.ids, e[0]) || has(b.ids, e[1]) || is_on(e, b.surface)) continue;
    const auto share = crossing(e, b.ids);
    if (!share) continue;
    const Vec3 p = at(e[0]) + *share * (at(e[1]) - at(e[0]));
    bool near = false;
    for (std::size_t k = 0; k < 3; ++k)
      near |= foot_on(p, at(b.ids[k]), at(b.ids[(k + 1) % 3])).second <= squared_;
    for (const Index end : e) near |= (at(end) - p).squaredNorm() <= squared_;
    if (!near) out.push_back({ImprintEvent::Kind::edge_pierces, no_index, t, e, {}, a.surface, b.surface});
  }
}

std::optional<double> ImprintState::crossing(const ImprintEdge& e, const Triangle& t) const {
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

std::vector<ImprintEvent> ImprintState::take_diagonals(std::vector<ImprintEvent>& events) const {
  const auto first = std::partition_point(events.begin(), events.end(), [](const ImprintEvent& e) {
    return e.kind < ImprintEvent::Kind::diagonals;
  });
  std::vector<ImprintEvent> out;
  std::set<ImprintEdge> used;
  for (const ImprintEvent& e : std::span(first, events.end())) {
    double least = squared_;
    ImprintEvent nearest;
    std::array<ImprintEdge, 3> own{};
    // The triangle of a common point and an edge near it vanishes, as slivers do.
    const auto look_at = [&](Index p, const ImprintEdge& edge, const Part& t) {
      const auto [share, squared] = foot_on(at(p), at(edge[0]), at(edge[1]));
      if (squared > least || !(share > 0 && share < 1) || !has(t.ids, p)) return;
      least = squared;
      nearest = {ImprintEvent::Kind::point_on_edge, p, no_index, edge, {}, t.surface, 0};
      own = {edge, ascending_edge(p, edge[0]), ascending_edge(p, edge[1])};
    };
    for (const Index p : e.first) look_at(p, e.second, triangles_[e.other]);
    for (const Index p : e.second) look_at(p, e.first, triangles_[e.point]);
    if (nearest.point == no_index ||
        std::any_of(own.begin(), own.end(), [&](const ImprintEdge& x) { return used.contains(x); }))
      continue;
    used.insert(own.begin(), own.end());
    used.insert({e.first, e.second});
    out.push_back(nearest);
  }
  events.erase(first, events.end());
  parallel_sort_unique(out);
  return out;
}

bool ImprintState::passes_common_point(const ImprintEvent& e) const {
  if (e.kind != ImprintEvent::Kind::edges_cross) return false;
  const SegmentPair near = nearest_points(at(e.first[0]), at(e.first[1]), at(e.second[0]), at(e.second[1]));
  const Vec3 place = at(e.first[0]) + near.s * (at(e.first[1]) - at(e.first[0]));
  const auto is_common_end = [&](Index p) {
    return (at(p) - place).squaredNorm() <= Imprint::moved_away * squared_ && is_on(p, e.owner) &&
           is_on(p, e.second_owner);
  };
  return std::any_of(e.first.begin(), e.first.end(), is_common_end) ||
         std::any_of(e.second.begin(), e.second.end(), is_common_end);
}

bool ImprintState::is_folded(const Part& t) const {
  const Vec3& a = at(t.ids[0]);
  return (at(t.ids[1]) - a).cross(at(t.ids[2]) - a).dot(normals_[t.source]) < 0;
}

std::vector<ImprintEvent> ImprintState::find_slivers(double limit, bool only_folds) const {
  std::vector<ImprintEvent> found;
  std::set<ImprintEdge> used;
  for (const Part& t : triangles_) {
    if (!t.active || (only_folds && !is_folded(t))) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index p = t.ids[k];
      const ImprintEdge e = ascending_edge(t.ids[(k + 1) % 3], t.ids[(k + 2) % 3]);
      const auto [share, squared] = foot_on(at(p), at(e[0]), at(e[1]));
      if (squared > limit * limit || !(share > 0 && share < 1)) continue;
      const std::array<ImprintEdge, 3> own{e, ascending_edge(p, e[0]), ascending_edge(p, e[1])};
      if (std::any_of(own.begin(), own.end(), [&](const ImprintEdge& x) { return used.contains(x); }))
        continue;
      used.insert(own.begin(), own.end());
      found.push_back({ImprintEvent::Kind::point_on_edge, p, no_index, e, {}, t.surface, 0});
    }
  }
  parallel_sort_unique(found);
  return found;
}

}  // namespace tetwright
