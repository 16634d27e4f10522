// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/triangle_intersection.h"

#include <algorithm>
#include <utility>

#include "common/geometry/predicates.h"

namespace tetwright {

namespace {

using TriangleCorners = std::array<Vec3, 3>;

/// The three coordinate planes, as pairs of coordinate axes.
constexpr std::array<std::pair<int, int>, 3> planes{{{0, 1}, {1, 2}, {2, 0}}};

/// Coordinate plane onto which three points project as a nondegenerate triangle; -1 if they are collinear.
int proper_plane(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int k = 0; k < 3; ++k)
    if (orient2d(a, b, c, planes[k].first, planes[k].second) != 0) return k;
  return -1;
}

bool within(double x, double a, double b) { return std::min(a, b) <= x && x <= std::max(a, b); }

/// Whether r lies between p and q, projected onto the plane (u, v).
/// \pre r is collinear with p and q
bool between(const Vec3& r, const Vec3& p, const Vec3& q, int u, int v) {
  return within(r[u], p[u], q[u]) && within(r[v], p[v], q[v]);
}

/// Whether the closed segments ab and pq meet, projected onto the plane (u, v); a segment may be degenerate.
bool segments_meet_2d(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q, int u, int v) {
  const int oa = orient2d(p, q, a, u, v), ob = orient2d(p, q, b, u, v);
  if (oa == 0 && between(a, p, q, u, v)) return true;
  if (ob == 0 && between(b, p, q, u, v)) return true;
  const int op = orient2d(a, b, p, u, v), oq = orient2d(a, b, q, u, v);
  if (op == 0 && between(p, a, b, u, v)) return true;
  if (oq == 0 && between(q, a, b, u, v)) return true;
  return oa * ob < 0 && op * oq < 0;
}

bool segments_meet_3d(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q) {
  if (orient3d(a, b, p, q) != 0) return false;
  int plane = proper_plane(a, b, p);
  if (plane < 0) plane = proper_plane(a, b, q);
  if (plane < 0) plane = proper_plane(p, q, a);
  if (plane < 0) plane = proper_plane(p, q, b);
  if (plane >= 0) return segments_meet_2d(a, b, p, q, planes[plane].first, planes[plane].second);
  // All four points are collinear and every coordinate is monotone along the line: the segments meet if all
  // three coordinate intervals overlap.
  for (int k = 0; k < 3; ++k)
    if (std::max(a[k], b[k]) < std::min(p[k], q[k]) || std::max(p[k], q[k]) < std::min(a[k], b[k]))
      return false;
  return true;
}

/// Whether the closed segment pq meets the closed triangle t, which may be degenerate (a segment or a point).
/// \param side_p, side_q sides of t's plane on which p and q lie
bool segment_meets_triangle(const Vec3& p, const Vec3& q, int side_p, int side_q, const TriangleCorners& t) {
  if (side_p * side_q > 0) return false;
  if (side_p != 0 || side_q != 0) {
    // The line crosses the plane in one point, which is inside t unless the line passes two edges on
    // different sides.
    const int x = orient3d(p, q, t[0], t[1]), y = orient3d(p, q, t[1], t[2]);
    if (x * y < 0) return false;
    const int z = orient3d(p, q, t[2], t[0]);
    return x * z >= 0 && y * z >= 0;
  }
  const int plane = proper_plane(t[0], t[1], t[2]);
  if (plane < 0)
    return segments_meet_3d(p, q, t[0], t[1]) || segments_meet_3d(p, q, t[1], t[2]) ||
           segments_meet_3d(p, q, t[2], t[0]);
  const auto [u, v] = planes[plane];
  for (int k = 0; k < 3; ++k)
    if (segments_meet_2d(p, q, t[k], t[(k + 1) % 3], u, v)) return true;
  // The segment meets no edge, so it is entirely inside or outside.
  const int x = orient2d(t[0], t[1], p, u, v), y = orient2d(t[1], t[2], p, u, v),
            z = orient2d(t[2], t[0], p, u, v);
  return x == y && y == z;
}

std::array<int, 3> sides(const TriangleCorners& plane, const TriangleCorners& points) {
  std::array<int, 3> side;
  for (int k = 0; k < 3; ++k) side[k] = orient3d(plane[0], plane[1], plane[2], points[k]);
  return side;
}

bool all_on_one_side(const std::array<int, 3>& side) {
  return side[0] != 0 && side[0] == side[1] && side[1] == side[2];
}

bool all_zero(const std::array<int, 3>& side) { return side[0] == 0 && side[1] == 0 && side[2] == 0; }

/// Whether an edge of t separates points of its plane from t: all are strictly on the other side of the line
/// through it than t's third corner. Convex polygons in a plane are apart if and only if an edge of one of
/// them separates them, and this takes a fraction of the tests that all pairs of edges take.
/// \param edges number of t's edges to test; edge k starts at corner k
template <std::size_t N>
bool separates(const TriangleCorners& t, std::size_t edges, const std::array<Vec3, N>& points) {
  const int plane = proper_plane(t[0], t[1], t[2]);
  if (plane < 0) return false;
  const auto [u, v] = planes[plane];
  const int own = orient2d(t[0], t[1], t[2], u, v);
  for (std::size_t k = 0; k < edges; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    if (std::all_of(points.begin(), points.end(),
                    [&, u = u, v = v](const Vec3& p) { return orient2d(a, b, p, u, v) == -own; }))
      return true;
  }
  return false;
}

bool boxes_apart(const TriangleCorners& f, const TriangleCorners& g) {
  for (int k = 0; k < 3; ++k) {
    const auto [f_low, f_high] = std::minmax({f[0][k], f[1][k], f[2][k]});
    const auto [g_low, g_high] = std::minmax({g[0][k], g[1][k], g[2][k]});
    if (f_high < g_low || g_high < f_low) return true;
  }
  return false;
}

bool meet_unconnected(const TriangleCorners& f, const TriangleCorners& g) {
  if (boxes_apart(f, g)) return false;
  const std::array<int, 3> g_side = sides(f, g);
  if (all_on_one_side(g_side)) return false;
  const std::array<int, 3> f_side = sides(g, f);
  if (all_on_one_side(f_side)) return false;
  if (all_zero(f_side) && all_zero(g_side) && (separates(f, 3, g) || separates(g, 3, f))) return false;
  // If two triangles meet, an edge of one meets the other.
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (segment_meets_triangle(f[k], f[next], f_side[k], f_side[next], g)) return true;
    if (segment_meets_triangle(g[k], g[next], g_side[k], g_side[next], f)) return true;
  }
  return false;
}

/// Whether triangles that share one vertex meet elsewhere.
/// \param f_other, g_other endpoints of the edges opposite the shared vertex
bool meet_beside_vertex(const TriangleCorners& f, const TriangleCorners& g, const Vec3& shared,
                        const std::array<const Vec3*, 2>& f_other,
                        const std::array<const Vec3*, 2>& g_other) {
  const int f0 = orient3d(g[0], g[1], g[2], *f_other[0]), f1 = orient3d(g[0], g[1], g[2], *f_other[1]);
  if (f0 * f1 > 0) return false;
  const int g0 = orient3d(f[0], f[1], f[2], *g_other[0]), g1 = orient3d(f[0], f[1], f[2], *g_other[1]);
  if (g0 * g1 > 0) return false;
  if (f0 == 0 && f1 == 0 && g0 == 0 && g1 == 0) {
    // Two sectors of a plane with a common tip are apart if a side of one separates the other one from it.
    const std::array<Vec3, 2> f_ends{*f_other[0], *f_other[1]}, g_ends{*g_other[0], *g_other[1]};
    if (separates({f_ends[0], shared, f_ends[1]}, 2, g_ends) ||
        separates({g_ends[0], shared, g_ends[1]}, 2, f_ends))
      return false;
  }
  return segment_meets_triangle(*f_other[0], *f_other[1], f0, f1, g) ||
         segment_meets_triangle(*g_other[0], *g_other[1], g0, g1, f);
}

/// Whether triangles that share the edge ab meet elsewhere; p and q are the vertices opposite it.
bool meet_beside_edge(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q) {
  if (orient3d(a, b, p, q) != 0) return false;
  for (const auto& [u, v] : planes) {
    const int side = orient2d(a, b, p, u, v);
    if (side != 0) return side == orient2d(a, b, q, u, v);
  }
  // abp is degenerate. Beyond the shared edge it can meet only a degenerate triangle on the same line.
  if (proper_plane(a, b, q) >= 0 || proper_plane(a, p, q) >= 0) return false;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax(a[k], b[k]);
    if ((p[k] < low && q[k] < low) || (p[k] > high && q[k] > high)) return true;
  }
  return false;
}

}  // namespace

bool triangles_intersect(const MeshTriangle& f, const MeshTriangle& g) {
  // Shared vertices, each id once, and the remaining vertices of each triangle.
  std::array<const Vec3*, 3> shared{}, f_other{}, g_other{};
  std::size_t shared_count = 0, f_count = 0, g_count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::find(g.ids.begin(), g.ids.end(), f.ids[i]) == g.ids.end())
      f_other[f_count++] = &f.points[i];
    else if (std::find(f.ids.begin(), f.ids.begin() + i, f.ids[i]) == f.ids.begin() + i)
      shared[shared_count++] = &f.points[i];
    if (std::find(f.ids.begin(), f.ids.end(), g.ids[i]) == f.ids.end()) g_other[g_count++] = &g.points[i];
  }
  if (shared_count == 0) return meet_unconnected(f.points, g.points);
  if (shared_count == 3) return true;
  // Only a triangle with a repeated vertex can consist of shared vertices.
  if (f_count == 0 || g_count == 0) return false;
  if (shared_count == 2) return meet_beside_edge(*shared[0], *shared[1], *f_other[0], *g_other[0]);
  return meet_beside_vertex(f.points, g.points, *shared[0], {f_other[0], f_other[f_count - 1]},
                            {g_other[0], g_other[g_count - 1]});
}

}  // namespace tetwright
