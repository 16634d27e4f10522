// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/surface_cleaning.h"

#include <algorithm>
#include <bit>

#include "common/geometry/predicates.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/input/surface_components.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// For each point the index of the first one with equal coordinates.
std::vector<Index> first_equal_point(const std::vector<Vec3>& points) {
  const std::size_t slots = std::bit_ceil(2 * points.size() + 1);
  std::vector<Index> table(slots, no_index), first(points.size());
  for (Index i = 0; i < points.size(); ++i) {
    std::uint64_t hash = 0;
    // Adding 0 turns -0 into +0; the two compare equal.
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

/// Rotates a triangle so that its smallest vertex comes first.
Triangle canonical(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// True if the corners are on one line, exactly.
bool flat(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a;
  if (u.cross(v).squaredNorm() > tolerance::collinear_squared * u.squaredNorm() * v.squaredNorm())
    return false;
  return orient2d(a, b, c, 0, 1) == 0 && orient2d(a, b, c, 1, 2) == 0 && orient2d(a, b, c, 2, 0) == 0;
}

}  // namespace

std::vector<Vec3> keep_used(const std::vector<Vec3>& points, std::vector<Triangle>& triangles) {
  std::vector<Index> renumbered(points.size(), no_index);
  for (const Triangle& t : triangles)
    for (Index v : t) renumbered[v] = 0;
  std::vector<Vec3> used;
  for (Index i = 0; i < points.size(); ++i)
    if (renumbered[i] != no_index) {
      renumbered[i] = static_cast<Index>(used.size());
      used.push_back(points[i]);
    }
  for (Triangle& t : triangles)
    for (Index& v : t) v = renumbered[v];
  return used;
}

CleanedSurface clean_surface(const TriangleMesh& surface, const std::string& file,
                             std::vector<Diagnostic>& findings) {
  if (surface.triangles.empty()) throw InputError(file, 0, "there are no triangles");
  for (const Vec3& p : surface.points)
    if (!p.allFinite()) throw InputError(file, 0, "a point has a coordinate that is not finite");
  const std::vector<Index> first = first_equal_point(surface.points);

  struct Entry {
    Index low, middle, high;
    Index turned;  ///< 1 if wound low, high, middle
    Index number;  ///< in the file
    auto operator<=>(const Entry&) const = default;
    bool same_corners(const Entry& e) const { return low == e.low && middle == e.middle && high == e.high; }
  };
  std::vector<Entry> entries;
  entries.reserve(surface.triangles.size());
  std::vector<char> used(surface.points.size(), 0);
  std::size_t collapsed = 0, repeated = 0, flats = 0;
  std::optional<Vec3> collapsed_place, repeated_place, flat_place, merged_place, unused_place;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const Triangle& t = surface.triangles[i];
    Triangle u;
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] >= surface.points.size())
        throw InputError(file, 0,
                         "a triangle refers to point " + std::to_string(t[k]) + " of " +
                             std::to_string(surface.points.size()));
      used[t[k]] = 1;
      u[k] = first[t[k]];
    }
    if (u[0] == u[1] || u[1] == u[2] || u[2] == u[0]) {
      if (collapsed++ == 0) collapsed_place = surface.points[u[0]];
      continue;
    }
    u = canonical(u);
    entries.push_back({u[0], std::min(u[1], u[2]), std::max(u[1], u[2]), u[1] > u[2], static_cast<Index>(i)});
  }
  parallel_sort(entries);

  CleanedSurface result;
  result.triangles.reserve(entries.size());
  for (std::size_t i = 0, j; i < entries.size(); i = j) {
    for (j = i + 1; j < entries.size() && entries[j].same_corners(entries[i]);) ++j;
    if (j - i > 1 && repeated == 0) repeated_place = surface.points[entries[i].low];
    repeated += j - i - 1;
    result.two_sided.push_back(entries[i].turned != entries[j - 1].turned);
    result.even.push_back((j - i) % 2 == 0);
    // Entries with the same winding are adjacent, so the middle entry has the winding of the majority.
    const Entry& e = entries[i + (j - i - 1) / 2];
    result.triangles.push_back(e.turned ? Triangle{e.low, e.high, e.middle}
                                        : Triangle{e.low, e.middle, e.high});
    if (surface.triangle_groups.empty()) continue;
    const Index in_file = std::min_element(entries.begin() + static_cast<std::ptrdiff_t>(i),
                                           entries.begin() + static_cast<std::ptrdiff_t>(j),
                                           [](const Entry& a, const Entry& b) { return a.number < b.number; })
                              ->number;
    result.groups.push_back(surface.triangle_groups[in_file]);
  }

  // Points keep their order, so that the first finding is the first in the file.
  std::size_t merged = 0, unused = 0;
  for (Index i = 0; i < used.size(); ++i) {
    if (!used[i] && unused++ == 0) unused_place = surface.points[i];
    if (used[i] && first[i] != i && merged++ == 0) merged_place = surface.points[i];
  }
  for (const Triangle& t : result.triangles) {
    const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
    if (flat(a, b, c) && flats++ == 0) flat_place = a;
  }
  result.points = keep_used(surface.points, result.triangles);
  if (flats == result.triangles.size())
    throw InputError(file, 0, "all triangles are flat, without any area; write the surface again");
  add_finding(findings, DiagnosticCode::points_merged, "points that coincide with an earlier one", merged,
              merged_place, "merged");
  add_finding(findings, DiagnosticCode::points_unused, "points that no triangle uses", unused, unused_place,
              "left out");
  add_finding(findings, DiagnosticCode::triangles_collapsed, "triangles with equal corners", collapsed,
              collapsed_place, "left out");
  add_finding(findings, DiagnosticCode::triangles_repeated, "repeated triangles", repeated, repeated_place,
              "one of each kept");
  add_finding(findings, DiagnosticCode::triangles_flat, "triangles with all corners on a line", flats,
              flat_place, "kept, they join their neighbours");
  return result;
}

}  // namespace tetwright
