// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/triangle_subdivision.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace tetwright {

namespace {

constexpr std::uint32_t none = 0xffffffffu;
constexpr double unit = 0x1p40;
constexpr std::int64_t whole = std::int64_t{1} << 40;
/// Two diagonals of a quadrangle count as equally good if the sine of the sum of the angles opposite to one
/// is below this: far above rounding, far below what affects shapes.
constexpr double cocircular = 1e-9;

/// Sine of the sum of the angles at c and d opposite to the edge ab; negative if the circle through abc
/// contains d.
double opposite_angles(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ca = a - c, cb = b - c, da = a - d, db = b - d;
  const double cos_c = ca.dot(cb), sin_c = ca.cross(cb).norm(), cos_d = da.dot(db),
               sin_d = da.cross(db).norm();
  const double lengths = std::sqrt(ca.squaredNorm() * cb.squaredNorm() * da.squaredNorm() * db.squaredNorm());
  return lengths > 0 ? (sin_c * cos_d + cos_c * sin_d) / lengths : 0;
}

}  // namespace

TriangleSubdivision::TriangleSubdivision(const Triangle& corners, const std::array<Vec3, 3>& positions) {
  points_ = {{0, 0, corners[0], positions[0]},
             {whole, 0, corners[1], positions[1]},
             {0, whole, corners[2], positions[2]}};
  parts_ = {{{0, 1, 2}, {none, none, none}, {false, false, false}}};
  for (Local i = 0; i < 3; ++i) local_[corners[i]] = i;
}

void TriangleSubdivision::add_on_edge(int edge, double share, Index number, const Vec3& position) {
  const std::int64_t s = std::clamp<std::int64_t>(std::llround(share * unit), 1, whole - 1);
  const std::array<std::array<std::int64_t, 2>, 3> at{{{s, 0}, {whole - s, s}, {0, whole - s}}};
  insert({at[static_cast<std::size_t>(edge)][0], at[static_cast<std::size_t>(edge)][1], number, position});
}

void TriangleSubdivision::add_inside(Index number, const Vec3& position) {
  const Vec3 u = points_[1].position - points_[0].position, v = points_[2].position - points_[0].position,
             p = position - points_[0].position;
  const Vec3 normal = u.cross(v);
  const double squared = normal.squaredNorm();
  if (!(squared > 0)) return;
  const double x = p.cross(v).dot(normal) / squared, y = u.cross(p).dot(normal) / squared;
  const std::int64_t i = std::clamp<std::int64_t>(std::llround(x * unit), 1, whole - 2);
  const std::int64_t k = std::clamp<std::int64_t>(std::llround(y * unit), 1, whole - 1 - i);
  insert({i, k, number, position});
}

bool TriangleSubdivision::constrain(Index a, Index b) {
  const Local u = find(a), v = find(b);
  return u != none && v != none && u != v && constrain_local(u, v);
}

std::vector<Triangle> TriangleSubdivision::triangles() {
  std::vector<std::array<Local, 2>> edges;
  for (const Part& t : parts_)
    for (std::size_t k = 0; k < 3; ++k)
      if (t.across[k] != none) edges.push_back({t.points[(k + 1) % 3], t.points[(k + 2) % 3]});
  make_delaunay(std::move(edges));
  std::vector<Triangle> out;
  out.reserve(parts_.size());
  for (const Part& t : parts_)
    out.push_back({points_[t.points[0]].number, points_[t.points[1]].number, points_[t.points[2]].number});
  return out;
}

/// 1 if c is to the left of the line from a to b, -1 to the right, 0 on it.
int TriangleSubdivision::side(Local a, Local b, Local c) const {
  const Point &p = points_[a], &q = points_[b], &r = points_[c];
  const __int128 value =
      static_cast<__int128>(q.x - p.x) * (r.y - p.y) - static_cast<__int128>(q.y - p.y) * (r.x - p.x);
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

int TriangleSubdivision::slot(Local part, Local point) const {
  const auto& p = parts_[part].points;
  return p[0] == point ? 0 : p[1] == point ? 1 : 2;
}

void TriangleSubdivision::link(Local part, Local before, Local after) {
  if (part == none) return;
  for (Local& across : parts_[part].across)
    if (across == before) {
      across = after;
      return;
    }
}

TriangleSubdivision::Local TriangleSubdivision::find(Index number) const {
  const auto known = local_.find(number);
  return known == local_.end() ? none : known->second;
}

TriangleSubdivision::Local TriangleSubdivision::insert(const Point& point) {
  const auto added = static_cast<Local>(points_.size());
  points_.push_back(point);
  // Walk towards the point. Exact predicates on a triangulation of a convex polygon: a walk that turns at the
  // first edge in its way ends, except for cycles of non-Delaunay parts, after which every part is tried.
  Local part = last_ < parts_.size() ? last_ : 0;
  std::array<int, 3> sides{};
  const auto look = [&](Local t) {
    int outside = -1;
    for (int k = 0; k < 3; ++k) {
      const auto& p = parts_[t].points;
      sides[static_cast<std::size_t>(k)] =
          side(p[static_cast<std::size_t>((k + 1) % 3)], p[static_cast<std::size_t>((k + 2) % 3)], added);
      if (sides[static_cast<std::size_t>(k)] < 0 && outside < 0) outside = k;
    }
    return outside;
  };
  int outside = look(part);
  for (std::size_t step = 0; outside >= 0 && step < 2 * parts_.size() + 8; ++step) {
    part = parts_[part].across[static_cast<std::size_t>(outside)];
    if (part == none) break;
    outside = look(part);
  }
  if (part == none || outside >= 0)
    for (part = 0; part < parts_.size() && look(part) >= 0; ++part) {
    }
  if (part == parts_.size()) {
    points_.pop_back();
    return none;
  }
  const auto zeros = std::count(sides.begin(), sides.end(), 0);
  if (zeros >= 2) {  // on a point: two edges pass through it
    const std::size_t between = sides[0] != 0 ? 0 : sides[1] != 0 ? 1 : 2;
    points_.pop_back();
    return local_[point.number] = parts_[part].points[between];
  }
  local_[point.number] = added;
  std::vector<std::array<Local, 2>> edges;
  if (zeros == 1)
    split_edge(part, sides[0] == 0 ? 0 : sides[1] == 0 ? 1 : 2, added);
  else
    split_part(part, added);
  last_ = points_[added].part;
  for (const Local t : parts_around(added)) {
    const auto k = static_cast<std::size_t>(slot(t, added));
    edges.push_back({parts_[t].points[(k + 1) % 3], parts_[t].points[(k + 2) % 3]});
  }
  make_delaunay(std::move(edges));
  return added;
}

void TriangleSubdivision::split_part(Local part, Local point) {
  const Part old = parts_[part];
  const auto b = static_cast<Local>(parts_.size()), c = b + 1;
  const auto [p, q, r] = old.points;
  parts_[part] = {{point, q, r}, {old.across[0], b, c}, {old.fixed[0], false, false}};
  parts_.push_back({{p, point, r}, {part, old.across[1], c}, {false, old.fixed[1], false}});
  parts_.push_back({{p, q, point}, {part, b, old.across[2]}, {false, false, old.fixed[2]}});
  link(old.across[1], part, b);
  link(old.across[2], part, c);
  points_[p].part = b;
  points_[q].part = points_[r].part = points_[point].part = part;
}

void TriangleSubdivision::split_edge(Local part, int edge, Local point) {
  const auto k = static_cast<std::size_t>(edge);
  const Local other = parts_[part].across[k];
  const auto halve = [&](Local t, std::size_t opposite, Local added) {
    // t = (o, a, b) becomes (o, a, point), and the added part (o, point, b).
    const Part old = parts_[t];
    const std::size_t i = (opposite + 1) % 3, j = (opposite + 2) % 3;
    const Local o = old.points[opposite], a = old.points[i], b = old.points[j];
    parts_[t] = {{o, a, point}, {none, added, old.across[j]}, {old.fixed[opposite], false, old.fixed[j]}};
    parts_[added] = {{o, point, b}, {none, old.across[i], t}, {old.fixed[opposite], old.fixed[i], false}};
    link(old.across[i], t, added);
    points_[o].part = points_[a].part = points_[point].part = t;
    points_[b].part = added;
  };
  const auto added = static_cast<Local>(parts_.size());
  parts_.emplace_back();
  if (other == none) {
    halve(part, k, added);
    return;
  }
  const auto beyond = static_cast<Local>(parts_.size());
  parts_.emplace_back();
  std::size_t opposite = 0;
  while (parts_[other].across[opposite] != part) ++opposite;
  halve(part, k, added);           // (o, a, point), (o, point, b)
  halve(other, opposite, beyond);  // (d, b, point), (d, point, a)
  parts_[part].across[0] = beyond;
  parts_[beyond].across[0] = part;
  parts_[added].across[0] = other;
  parts_[other].across[0] = added;
}

/// Whether the edge opposite slot `edge` of a part is the diagonal of a strictly convex quadrangle.
bool TriangleSubdivision::can_flip(Local part, int edge) const {
  const auto k = static_cast<std::size_t>(edge);
  const Local other = parts_[part].across[k];
  if (other == none || parts_[part].fixed[k]) return false;
  std::size_t o = 0;
  while (parts_[other].across[o] != part) ++o;
  const Local c = parts_[part].points[k], a = parts_[part].points[(k + 1) % 3],
              b = parts_[part].points[(k + 2) % 3], d = parts_[other].points[o];
  return side(c, a, d) > 0 && side(d, b, c) > 0;
}

void TriangleSubdivision::flip(Local part, int edge) {
  const auto k = static_cast<std::size_t>(edge);
  const Local other = parts_[part].across[k];
  std::size_t o = 0;
  while (parts_[other].across[o] != part) ++o;
  const Part p = parts_[part], q = parts_[other];
  const Local c = p.points[k], a = p.points[(k + 1) % 3], b = p.points[(k + 2) % 3], d = q.points[o];
  // p = (c, a, b), q = (d, b, a).
  const Local beyond_a = p.across[(k + 1) % 3], beyond_b = p.across[(k + 2) % 3],
              other_b = q.across[(o + 1) % 3], other_a = q.across[(o + 2) % 3];
  parts_[part] = {{c, a, d}, {other_b, other, beyond_b}, {q.fixed[(o + 1) % 3], false, p.fixed[(k + 2) % 3]}};
  parts_[other] = {{c, d, b}, {other_a, beyond_a, part}, {q.fixed[(o + 2) % 3], p.fixed[(k + 1) % 3], false}};
  link(other_b, other, part);
  link(beyond_a, part, other);
  points_[c].part = points_[a].part = points_[d].part = part;
  points_[b].part = other;
}

bool TriangleSubdivision::should_flip(Local part, int edge) const {
  if (!can_flip(part, edge)) return false;
  const auto k = static_cast<std::size_t>(edge);
  const Local other = parts_[part].across[k];
  std::size_t o = 0;
  while (parts_[other].across[o] != part) ++o;
  const Point &c = points_[parts_[part].points[k]], &a = points_[parts_[part].points[(k + 1) % 3]],
              &b = points_[parts_[part].points[(k + 2) % 3]], &d = points_[parts_[other].points[o]];
  const double angles = opposite_angles(a.position, b.position, c.position, d.position);
  if (std::abs(angles) > cocircular) return angles < 0;
  return std::min(c.number, d.number) < std::min(a.number, b.number);
}

void TriangleSubdivision::make_delaunay(std::vector<std::array<Local, 2>> edges) {
  // Flips end, since each lowers the paraboloid; the bound guards against rounding of near ties.
  std::size_t left = 16 * parts_.size() + 64;
  while (!edges.empty()) {
    const auto [a, b] = edges.back();
    edges.pop_back();
    Local part;
    int edge;
    if (!find_edge(a, b, part, edge) || !should_flip(part, edge)) continue;
    if (left-- == 0) return;
    const auto k = static_cast<std::size_t>(edge);
    const Local c = parts_[part].points[k];
    const Local other = parts_[part].across[k];
    std::size_t o = 0;
    while (parts_[other].across[o] != part) ++o;
    const Local d = parts_[other].points[o];
    flip(part, edge);
    for (const std::array<Local, 2>& e :
         {std::array{c, a}, std::array{a, d}, std::array{d, b}, std::array{b, c}})
      edges.push_back(e);
  }
}

std::vector<TriangleSubdivision::Local> TriangleSubdivision::parts_around(Local point) const {
  std::vector<Local> around;
  const Local first = points_[point].part;
  Local t = first;
  do {  // counter-clockwise
    around.push_back(t);
    t = parts_[t].across[(static_cast<std::size_t>(slot(t, point)) + 1) % 3];
  } while (t != none && t != first);
  if (t == first) return around;
  for (t = parts_[first].across[(static_cast<std::size_t>(slot(first, point)) + 2) % 3]; t != none;
       t = parts_[t].across[(static_cast<std::size_t>(slot(t, point)) + 2) % 3])
    around.push_back(t);
  return around;
}

bool TriangleSubdivision::find_edge(Local a, Local b, Local& part, int& edge) const {
  for (const Local t : parts_around(a))
    for (int k = 0; k < 3; ++k)
      if (const auto i = static_cast<std::size_t>(k);
          (parts_[t].points[(i + 1) % 3] == a && parts_[t].points[(i + 2) % 3] == b) ||
          (parts_[t].points[(i + 1) % 3] == b && parts_[t].points[(i + 2) % 3] == a)) {
        part = t;
        edge = k;
        return true;
      }
  return false;
}

bool TriangleSubdivision::constrain_local(Local a, Local b) {
  while (a != b && a != none) a = constrain_first(a, b);
  return a == b;
}

/// Makes the segment from a to b an edge, up to the first point on it.
/// \return that point, or `none` if an earlier segment is in the way
TriangleSubdivision::Local TriangleSubdivision::constrain_first(Local a, Local b) {
  const auto fix = [&](Local u, Local v) {
    Local part;
    int edge;
    if (!find_edge(u, v, part, edge)) return false;
    const auto k = static_cast<std::size_t>(edge);
    parts_[part].fixed[k] = true;
    if (const Local other = parts_[part].across[k]; other != none) {
      std::size_t o = 0;
      while (parts_[other].across[o] != part) ++o;
      parts_[other].fixed[o] = true;
    }
    return true;
  };
  if (fix(a, b)) return b;
  const auto between = [&](Local p) {  // on the line: ahead of a
    const auto along = [&](Local q) {
      return static_cast<__int128>(points_[q].x - points_[a].x) * (points_[b].x - points_[a].x) +
             static_cast<__int128>(points_[q].y - points_[a].y) * (points_[b].y - points_[a].y);
    };
    return along(p) > 0;
  };
  // The part at a that the segment enters, or a point on the segment.
  Local part = none;
  for (const Local t : parts_around(a)) {
    const auto k = static_cast<std::size_t>(slot(t, a));
    const Local p = parts_[t].points[(k + 1) % 3], q = parts_[t].points[(k + 2) % 3];
    for (const Local on : {p, q})
      if (side(a, b, on) == 0 && between(on)) return fix(a, on) ? on : none;
    if (side(a, b, p) < 0 && side(a, b, q) > 0) part = t;
  }
  if (part == none) return none;
  std::deque<std::array<Local, 2>> crossed;
  Local end = b;
  int edge = slot(part, a);
  while (true) {
    const auto k = static_cast<std::size_t>(edge);
    const Local p = parts_[part].points[(k + 1) % 3], q = parts_[part].points[(k + 2) % 3];
    if (parts_[part].fixed[k] || parts_[part].across[k] == none) return none;
    crossed.push_back({p, q});
    const Local next = parts_[part].across[k];
    std::size_t o = 0;
    while (parts_[next].across[o] != part) ++o;
    const Local apex = parts_[next].points[o];
    if (apex == b) break;
    const int where = side(a, b, apex);
    if (where == 0) {
      end = apex;
      break;
    }
    part = next;
    edge = slot(next, where > 0 ? q : p);
  }
  for (std::size_t left = 4 * crossed.size() * crossed.size() + 64; !crossed.empty(); --left) {
    if (left == 0) return none;
    const auto [p, q] = crossed.front();
    crossed.pop_front();
    Local t;
    int e;
    if (!find_edge(p, q, t, e)) continue;
    if (!can_flip(t, e)) {
      crossed.push_back({p, q});
      continue;
    }
    const auto k = static_cast<std::size_t>(e);
    const Local c = parts_[t].points[k], other = parts_[t].across[k];
    std::size_t o = 0;
    while (parts_[other].across[o] != t) ++o;
    const Local d = parts_[other].points[o];
    flip(t, e);
    const bool still = c != a && c != end && d != a && d != end && side(a, end, c) * side(a, end, d) < 0;
    if (still) crossed.push_back({c, d});
  }
  return fix(a, end) ? end : none;
}

}  // namespace tetwright
