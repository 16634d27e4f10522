// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>

#include "common/features/edge_uses.h"
#include "common/parallel/bucket_sort.h"
#include "common/parallel/parallel_sort.h"
#include "common/portable_math.h"
#include "tetwright/resources.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles, std::span<const std::uint32_t> groups) {
  std::size_t points = 0;
  for (const Triangle& t : triangles)
    points = std::max(points, std::size_t{*std::max_element(t.begin(), t.end())} + 1);
  const auto use = [&](std::size_t t, std::size_t k) {
    const Index p = triangles[t][k], q = triangles[t][(k + 1) % 3];
    return EdgeUse{std::uint64_t{std::min(p, q)} << 32 | std::max(p, q), groups.empty() ? 0 : groups[t],
                   static_cast<Index>(t), p < q};
  };
  const auto is_before = [](const EdgeUse& x, const EdgeUse& y) {
    if (x.key != y.key) return x.key < y.key;
    return x.group != y.group ? x.group < y.group : x.triangle < y.triangle;
  };
  std::vector<EdgeUse> uses;
  // An endpoint has few edges, so that sorting them takes less time than sorting all edges at once, unless
  // most points have none.
  constexpr std::size_t max_points_per_triangle = 4;
  if (points > max_points_per_triangle * triangles.size()) {
    uses.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) uses.push_back(use(t, k));
    parallel_sort(uses, is_before);
    return uses;
  }
  std::vector<std::size_t> starts;
  bucket_sort(
      triangles.size(), points,
      [&](std::size_t t, const auto& emit) {
        for (std::size_t k = 0; k < 3; ++k) {
          const EdgeUse of_edge = use(t, k);
          emit(std::size_t{ends_of(of_edge.key)[0]}, of_edge);
        }
      },
      [](const EdgeUse& of_edge) { return std::size_t{ends_of(of_edge.key)[0]}; }, starts, uses);
  constexpr std::size_t endpoint_grain = 4096;
  parallel_for(0, points, endpoint_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      std::sort(uses.begin() + static_cast<std::ptrdiff_t>(starts[p]),
                uses.begin() + static_cast<std::ptrdiff_t>(starts[p + 1]), is_before);
  });
  return uses;
}

namespace {

constexpr double corner_turn = 45 * 3.14159265358979323846 / 180;

/// Crease segments at each point; finds the corners among the points.
class CreasePoints {
 public:
  CreasePoints(std::span<const Vec3> points, const std::vector<SurfaceCreases::Segment>& segments,
               std::span<const std::uint8_t> rough)
      : points_(points) {
    for (std::size_t i = 0, j = 0; i < segments.size(); i = j) {
      // Where more than two patches meet, an edge has several segments.
      std::vector<std::array<std::uint16_t, 2>> patches;
      for (; j < segments.size() && segments[j].ends == segments[i].ends; ++j)
        patches.push_back(segments[j].patches);
      for (std::size_t k = 0; k < 2; ++k) {
        AtPoint& at = at_[segments[i].ends[k]];
        if (at.count == 0) at.patches = patches;
        at.mixed |= at.patches != patches;
        for (const auto& [a, b] : patches) at.rough |= !rough.empty() && (rough[a] || rough[b]);
        if (at.count < 2) at.others[at.count] = segments[i].ends[1 - k];
        ++at.count;
      }
    }
  }

  std::vector<Index> corners(double reach) const {
    struct Turn {
      double angle;
      Index point;
    };
    std::vector<Index> corners;
    std::vector<Turn> turns;
    for (const auto& [p, at] : at_)
      if (!at.is_plain())
        corners.push_back(p);
      else if (const double angle = at.rough ? 0 : turn_at(p, at, reach); angle > corner_turn)
        turns.push_back({angle, p});
    std::stable_sort(turns.begin(), turns.end(),
                     [](const Turn& x, const Turn& y) { return x.angle > y.angle; });
    std::set<Index> near_sharper_corner;  // points within `reach` of a sharper corner
    for (const Turn& t : turns) {
      if (near_sharper_corner.contains(t.point)) continue;
      corners.push_back(t.point);
      for (const Index towards : at_.at(t.point).others)
        walk(t.point, towards, reach, [&](Index p) { near_sharper_corner.insert(p); });
    }
    std::sort(corners.begin(), corners.end());
    return corners;
  }

 private:
  struct AtPoint {
    std::size_t count = 0;                              ///< edges of creases
    std::vector<std::array<std::uint16_t, 2>> patches;  ///< of the first one, by pairs
    std::array<Index, 2> others{};
    bool mixed = false;
    bool rough = false;  ///< at a rough patch
    bool is_plain() const { return count == 2 && !mixed; }
  };

  /// Follows a crease from `from` by way of `towards`. Calls `visit` for each point nearer than `reach` to
  /// `from`.
  /// \return the first point at least `reach` away, or the end of the crease
  template <class Visit>
  Index walk(Index from, Index towards, double reach, const Visit& visit) const {
    Index last = from, now = towards;
    while ((points_[now] - points_[from]).norm() < reach) {
      const AtPoint& at = at_.at(now);
      if (!at.is_plain()) break;
      visit(now);
      const Index next = at.others[0] == last ? at.others[1] : at.others[0];
      if (next == from) break;
      last = now;
      now = next;
    }
    return now;
  }

  double turn_at(Index p, const AtPoint& at, double reach) const {
    const auto ignore = [](Index) {};
    const Vec3 u = (points_[p] - points_[walk(p, at.others[0], reach, ignore)]).normalized(),
               v = (points_[walk(p, at.others[1], reach, ignore)] - points_[p]).normalized();
    return 2 * portable_atan2_upper((u - v).norm(), (u + v).norm());
  }

  std::span<const Vec3> points_;
  std::map<Index, AtPoint> at_;
};

}  // namespace

SurfaceCreases find_creases(std::span<const Vec3> points, std::span<const Triangle> triangles,
                            std::span<const std::uint16_t> patches, double corner_reach,
                            std::span<const std::uint8_t> rough) {
  SurfaceCreases creases;
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i;
    std::set<std::uint16_t> here;
    for (; j < uses.size() && uses[j].key == uses[i].key; ++j) here.insert(patches[uses[j].triangle]);
    for (auto p = here.begin(); p != here.end(); ++p)
      for (auto q = std::next(p); q != here.end(); ++q)
        creases.segments.push_back({ends_of(uses[i].key), {*p, *q}});
    i = j;
  }
  creases.corners = CreasePoints(points, creases.segments, rough).corners(corner_reach);
  return creases;
}

void CreaseCurves::add(const SurfaceCreases& creases, std::span<const Vec3> surface_points) {
  std::map<Index, Index> numbers;
  for (const SurfaceCreases::Segment& s : creases.segments) {
    std::array<Index, 2> ends;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto [known, added] = numbers.emplace(s.ends[k], static_cast<Index>(points.size()));
      if (added) points.push_back(surface_points[s.ends[k]]);
      ends[k] = known->second;
    }
    segments.push_back(ends);
  }
  for (const Index c : creases.corners) corners.push_back(surface_points[c]);
}

void CreaseCurves::add(const CreaseCurves& other) {
  const auto first = static_cast<Index>(points.size());
  points.insert(points.end(), other.points.begin(), other.points.end());
  for (const auto& [a, b] : other.segments) segments.push_back({first + a, first + b});
  corners.insert(corners.end(), other.corners.begin(), other.corners.end());
}

namespace {

/// Faces of each pair of materials, with their patches.
std::map<MaterialPair, std::pair<std::vector<Triangle>, std::vector<std::uint16_t>>> faces_by_pair(
    const TetMesh& mesh) {
  std::map<MaterialPair, std::pair<std::vector<Triangle>, std::vector<std::uint16_t>>> by_pair;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    auto& [triangles, patches] = by_pair[t.pair()];
    triangles.push_back(t.ids);
    patches.push_back(t.patch);
  }
  return by_pair;
}

}  // namespace

CreaseCurves mesh_creases(const TetMesh& mesh) {
  CreaseCurves curves;
  for (const auto& [pair, faces] : faces_by_pair(mesh))
    curves.add(find_creases(mesh.points, faces.first, faces.second), mesh.points);
  return curves;
}

CreaseCurves mesh_junctions(const TetMesh& mesh) {
  CreaseCurves curves;
  for (const auto& [pair, faces] : faces_by_pair(mesh)) {
    SurfaceCreases junctions;
    const std::vector<EdgeUse> uses = edge_uses(faces.first, {});
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      while (j < uses.size() && uses[j].key == uses[i].key) ++j;
      if (j - i != 2) junctions.segments.push_back({ends_of(uses[i].key), {}});
    }
    curves.add(junctions, mesh.points);
  }
  return curves;
}

}  // namespace tetwright
