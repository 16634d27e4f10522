#include "mesher/surface_input.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "common/error.h"
#include "common/parallel_sort.h"
#include "mesher/ray_crossing.h"

namespace tetwright {

namespace {

std::string place(const Vec3& p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g)", p.x(), p.y(), p.z());
  return text;
}

/// For each point the number of the first one with equal coordinates.
std::vector<Index> first_equal_point(const std::vector<Vec3>& points) {
  const std::size_t slots = std::bit_ceil(2 * points.size() + 1);
  std::vector<Index> table(slots, no_index), first(points.size());
  for (Index i = 0; i < points.size(); ++i) {
    std::uint64_t hash = 0;
    // Adding 0 makes +0 of -0, which compare equal.
    for (int a = 0; a < 3; ++a)
      hash = (hash ^ std::bit_cast<std::uint64_t>(points[i][a] + 0.0)) * 0x9e3779b97f4a7c15u,
      hash ^= hash >> 29;
    std::size_t slot = hash & (slots - 1);
    while (table[slot] != no_index && points[table[slot]] != points[i]) slot = (slot + 1) & (slots - 1);
    if (table[slot] == no_index) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

/// A triangle turned so that its smallest vertex comes first.
Triangle canonical(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// One side of a triangle; sides that join the same two points stand together when sorted.
struct Side {
  std::uint64_t edge;  ///< smaller point << 32 | larger point
  std::uint32_t triangle;
  std::uint32_t forward;  ///< 1 when the triangle runs from the smaller to the larger point
  auto operator<=>(const Side&) const = default;
};

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides(3 * triangles.size());
  parallel_for(0, triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
        sides[3 * t + k] = {std::min(a, b) << 32 | std::max(a, b), static_cast<std::uint32_t>(t), a < b};
      }
  });
  parallel_sort(sides);
  return sides;
}

/// Calls `body(begin, end)` for each group of sides on one edge.
template <class Body>
void for_each_edge(const std::vector<Side>& sides, Body&& body) {
  for (std::size_t i = 0, j; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j].edge == sides[i].edge;) ++j;
    body(i, j);
  }
}

/// Sum of +1 for each side that runs forward and -1 for each that runs back.
int balance(const std::vector<Side>& sides, std::size_t begin, std::size_t end) {
  int sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += sides[i].forward ? 1 : -1;
  return sum;
}

bool balanced(const std::vector<Side>& sides) {
  bool all = true;
  for_each_edge(sides, [&](std::size_t i, std::size_t j) { all &= balance(sides, i, j) == 0; });
  return all;
}

void check_no_holes(const std::vector<Side>& sides, const std::vector<Vec3>& points,
                    const std::string& file) {
  std::size_t open = 0;
  std::uint64_t first_edge = 0;
  for_each_edge(sides, [&](std::size_t i, std::size_t j) {
    if ((j - i) % 2 && open++ == 0) first_edge = sides[i].edge;
  });
  if (open == 0) return;
  const Vec3 middle = 0.5 * (points[first_edge >> 32] + points[first_edge & 0xffffffffu]);
  throw InputError(file, 0,
                   "the surface is not closed: " + std::to_string(open) +
                       (open == 1 ? " boundary edge" : " boundary edges") + ", the first at " +
                       place(middle) + "; close its holes first");
}

/// Turns triangles over so that neighbours across edges of exactly two triangles are wound alike, in each
/// component the way most of its triangles are.
void wind_alike(std::vector<Triangle>& triangles, const std::vector<Side>& sides) {
  struct Neighbour {
    std::uint32_t triangle, other;
    std::uint32_t same_direction;
    auto operator<=>(const Neighbour&) const = default;
  };
  std::vector<Neighbour> neighbours;
  for_each_edge(sides, [&](std::size_t i, std::size_t j) {
    if (j - i != 2) return;
    const std::uint32_t same = sides[i].forward == sides[i + 1].forward;
    neighbours.push_back({sides[i].triangle, sides[i + 1].triangle, same});
    neighbours.push_back({sides[i + 1].triangle, sides[i].triangle, same});
  });
  parallel_sort(neighbours);
  std::vector<std::size_t> start(triangles.size() + 1, 0);
  for (const Neighbour& n : neighbours) ++start[n.triangle + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  enum : std::uint8_t { unseen, kept, turned };
  std::vector<std::uint8_t> state(triangles.size(), unseen);
  std::vector<std::uint32_t> component;  // and at the same time the queue of its flooding
  for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
    if (state[seed] != unseen) continue;
    state[seed] = kept;
    component.assign(1, seed);
    std::size_t against = 0;
    for (std::size_t i = 0; i < component.size(); ++i) {
      const std::uint32_t t = component[i];
      against += state[t] == turned;
      for (std::size_t k = start[t]; k < start[t + 1]; ++k) {
        const Neighbour& n = neighbours[k];
        if (state[n.other] != unseen) continue;
        state[n.other] = (state[t] == turned) != (n.same_direction == 1) ? turned : kept;
        component.push_back(n.other);
      }
    }
    if (2 * against > component.size())
      for (std::uint32_t t : component) state[t] = state[t] == turned ? kept : turned;
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (state[t] == turned) std::swap(triangles[t][1], triangles[t][2]);
}

struct Component {
  std::vector<std::uint32_t> triangles;
  Vec3 low, high;
  double volume = 0;  ///< signed
  bool turn = false;
};

/// The parts of the surface that hang together by edges, in the order of their first triangles.
std::vector<Component> components(const ClosedSurface& s, const std::vector<Side>& sides) {
  std::vector<std::uint32_t> parent(s.triangles.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  for_each_edge(sides, [&](std::size_t i, std::size_t j) {
    for (std::size_t k = i + 1; k < j; ++k) {
      const std::uint32_t a = root(sides[i].triangle), b = root(sides[k].triangle);
      parent[std::max(a, b)] = std::min(a, b);
    }
  });
  std::vector<Component> parts;
  std::vector<std::uint32_t> number(s.triangles.size());
  const Vec3 centre = 0.5 * (s.low + s.high);
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    const std::uint32_t r = root(t);
    const auto& [a, b, c] = s.triangles[t];
    if (r == t) {
      number[t] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
      parts.back().low = parts.back().high = s.points[a];
    }
    Component& part = parts[number[r]];
    part.triangles.push_back(t);
    for (Index v : {a, b, c}) {
      part.low = part.low.cwiseMin(s.points[v]);
      part.high = part.high.cwiseMax(s.points[v]);
    }
    part.volume += (s.points[a] - centre).dot((s.points[b] - centre).cross(s.points[c] - centre)) / 6;
  }
  return parts;
}

/// True if the point is inside the component, whichever way that is wound.
bool contains(const ClosedSurface& s, const Component& part, const Vec3& point) {
  if ((point.array() < part.low.array()).any() || (point.array() > part.high.array()).any()) return false;
  int winding = 0;
  for (std::uint32_t t : part.triangles) {
    const Vec3 &a = s.points[s.triangles[t][0]], &b = s.points[s.triangles[t][1]],
               &c = s.points[s.triangles[t][2]];
    if (std::max({a.x(), b.x(), c.x()}) < point.x() || std::min({a.x(), b.x(), c.x()}) > point.x() ||
        std::max({a.y(), b.y(), c.y()}) < point.y() || std::min({a.y(), b.y(), c.y()}) > point.y())
      continue;
    const int crossing = vertical_crossing(a, b, c, point);
    if (crossing && at_or_above(a, b, c, crossing, point)) winding += crossing;
  }
  return winding != 0;
}

/// Turns outermost components outwards, and with each what it contains, so that cavities stay cavities.
void turn_outwards(ClosedSurface& s, std::vector<Component>& parts) {
  if (std::none_of(parts.begin(), parts.end(), [](const Component& c) { return c.volume < 0; })) return;
  std::vector<std::vector<std::size_t>> containers(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Vec3& point = s.points[s.triangles[parts[i].triangles[0]][0]];
    for (std::size_t j = 0; j < parts.size(); ++j)
      if (i != j && contains(s, parts[j], point)) containers[i].push_back(j);
  }
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (containers[i].empty()) parts[i].turn = parts[i].volume < 0;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j : containers[i])
      if (containers[j].empty()) parts[i].turn = parts[j].turn;
  for (Component& part : parts) {
    if (!part.turn) continue;
    part.volume = -part.volume;
    for (std::uint32_t t : part.triangles) std::swap(s.triangles[t][1], s.triangles[t][2]);
  }
}

}  // namespace

ClosedSurface close_surface(const TriangleMesh& surface, const std::string& file) {
  for (const Vec3& p : surface.points)
    if (!p.allFinite()) throw InputError(file, 0, "a point has a coordinate that is not finite");
  const std::vector<Index> first = first_equal_point(surface.points);
  ClosedSurface s;
  s.triangles.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) {
    Triangle u;
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] >= surface.points.size())
        throw InputError(file, 0,
                         "a triangle names point " + std::to_string(t[k]) + " of " +
                             std::to_string(surface.points.size()));
      u[k] = first[t[k]];
    }
    if (u[0] != u[1] && u[1] != u[2] && u[2] != u[0]) s.triangles.push_back(canonical(u));
  }
  if (s.triangles.empty()) throw InputError(file, 0, "there are no triangles");
  parallel_sort_unique(s.triangles);

  // Points in the order in which the triangles use them.
  std::vector<Index> renumbered(surface.points.size(), no_index);
  for (Triangle& t : s.triangles)
    for (Index& v : t) {
      if (renumbered[v] == no_index) {
        renumbered[v] = static_cast<Index>(s.points.size());
        s.points.push_back(surface.points[v]);
      }
      v = renumbered[v];
    }
  s.low = s.high = s.points[0];
  for (const Vec3& p : s.points) s.low = s.low.cwiseMin(p), s.high = s.high.cwiseMax(p);

  std::vector<Side> sides = sorted_sides(s.triangles);
  check_no_holes(sides, s.points, file);
  if (!balanced(sides)) {
    wind_alike(s.triangles, sides);
    sides = sorted_sides(s.triangles);
    if (!balanced(sides))
      throw InputError(file, 0,
                       "its triangles cannot all be wound the same way (a one-sided surface or inner walls)");
  }
  std::vector<Component> parts = components(s, sides);
  turn_outwards(s, parts);
  s.volume = 0;
  for (const Component& part : parts) s.volume += part.volume;
  s.area = parallel_sum(0, s.triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c] = s.triangles[t];
      sum += 0.5 * (s.points[b] - s.points[a]).cross(s.points[c] - s.points[a]).norm();
    }
    return sum;
  });
  return s;
}

}  // namespace tetwright
