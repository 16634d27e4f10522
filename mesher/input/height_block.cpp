// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/height_block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/geometry/predicates.h"
#include "common/geometry/self_intersection.h"
#include "common/message_text.h"
#include "mesher/input/flat_caps.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

Vec3 centre_of(const OrientedSurface& s, const Triangle& t) {
  return (s.points[t[0]] + s.points[t[1]] + s.points[t[2]]) / 3;
}

/// Turns open components up. Throws InputError if triangles of one face down then.
void turn_up(OrientedSurface& s, const std::string& file) {
  std::vector<double> projected(s.closed.size(), 0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    projected[s.component[t]] += area_vector(s.points, s.triangles[t]).z();
  std::size_t count = 0;
  double largest = 0;
  Vec3 place = Vec3::Zero();
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.closed[s.component[t]]) continue;
    Triangle& own = s.triangles[t];
    if (projected[s.component[t]] < 0) std::swap(own[1], own[2]);
    if (orient2d(s.points[own[0]], s.points[own[1]], s.points[own[2]], 0, 1) >= 0) continue;
    const double area = area_vector(s.points, own).norm();
    if (count++ == 0 || area > largest) largest = area, place = centre_of(s, own);
  }
  if (count > 0)
    throw InputError(file, 0,
                     "--base needs a height field, and the surface overhangs at " + place_text(place) + " (" +
                         std::to_string(count) +
                         " triangles face down); remove the overhang, or use --thicken D for a shell");
}

/// Whether the outside is beyond a rim, not a hole of the component.
bool is_outer(const HoleRim& rim) { return rim.vector.z() < 0; }

/// Points of rims that lie above each other, and the walls between them.
class Columns {
 public:
  explicit Columns(OrientedSurface& s) : s_(s) {}

  /// Adds a point unless it is known.
  void add(Index point) {
    std::vector<Index>& column = columns_[key(point)];
    if (std::find(column.begin(), column.end(), point) == column.end()) column.push_back(point);
  }
  /// Adds a point of the base below each column.
  void add_feet(double height) {
    for (auto& [xy, column] : columns_) {
      std::sort(column.begin(), column.end(),
                [&](Index a, Index b) { return s_.points[a].z() > s_.points[b].z(); });
      column.push_back(static_cast<Index>(s_.points.size()));
      s_.points.emplace_back(xy.first, xy.second, height);
    }
  }
  /// Adds the wall below an edge, none below a vertical one. Its sides have all points of the columns, so
  /// that walls meet in common edges.
  void add_wall(const std::array<Index, 2>& edge, Index component, std::uint32_t group) {
    if (key(edge[0]) == key(edge[1])) return;
    const std::vector<Index>&a = columns_.at(key(edge[0])), &b = columns_.at(key(edge[1]));
    auto i = std::find(a.begin(), a.end(), edge[0]), k = std::find(b.begin(), b.end(), edge[1]);
    while (i + 1 != a.end() || k + 1 != b.end()) {
      const bool along_b =
          k + 1 != b.end() && (i + 1 == a.end() || s_.points[*(k + 1)].z() >= s_.points[*(i + 1)].z());
      const Index next = along_b ? *(k + 1) : *(i + 1);
      s_.add({*i, *k, next}, component, group);
      ++(along_b ? k : i);
    }
  }

 private:
  std::pair<double, double> key(Index p) const { return {s_.points[p].x(), s_.points[p].y()}; }

  OrientedSurface& s_;
  std::map<std::pair<double, double>, std::vector<Index>> columns_;  ///< by x and y, from the top
};

/// Throws InputError with the position where walls cross, if some do.
void refuse_crossing(const OrientedSurface& s, std::size_t first_wall, const std::string& file) {
  for (const auto& [a, b] : self_intersections(s.points, s.triangles))
    if (b >= first_wall)
      throw InputError(file, 0,
                       "the walls that --base adds below the rim cross each other or the surface at " +
                           place_text(centre_of(s, s.triangles[b])) +
                           ": seen from above, parts of the surface lie over others; give only one of them");
}

}  // namespace

Diagnostic add_base(OrientedSurface& s, const std::string& file, const BaseHeight& base) {
  turn_up(s, file);
  s.name_open("top");
  double lowest = HUGE_VAL, area = 0;
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low, lowest_point = low;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.closed[s.component[t]]) continue;
    area += area_vector(s.points, s.triangles[t]).norm();
    for (const Index p : s.triangles[t]) {
      low = low.cwiseMin(s.points[p]);
      high = high.cwiseMax(s.points[p]);
      if (s.points[p].z() < lowest) lowest = s.points[p].z(), lowest_point = s.points[p];
    }
  }
  const double width = std::max(high.x() - low.x(), high.y() - low.y());
  const double height = base.value_or(lowest - InputTuning::OpenSurfaces::base_depth * width);
  if (!(height < lowest))
    throw UsageError("--base " + short_number(height) + " is not below the surface, whose lowest point is " +
                     place_text(lowest_point) + "; choose a lower one, or --base auto");

  const std::uint32_t side = s.group("side");
  const std::size_t first_wall = s.triangles.size();
  std::vector<HoleRim> tops = find_rims(s.points, s.triangles);
  std::erase_if(tops, [](const HoleRim& rim) { return !is_outer(rim); });
  const std::size_t specks = std::erase_if(
      tops, [&](const HoleRim& rim) { return rim.vector.norm() < InputTuning::Holes::min_share * area; });
  Columns columns(s);
  std::size_t edges = 0;
  for (const HoleRim& rim : tops)
    for (const auto& [a, b] : rim.edges) {
      columns.add(a);
      columns.add(b);
      ++edges;
    }
  columns.add_feet(height);
  for (const HoleRim& rim : tops)
    for (std::size_t e = 0; e < rim.edges.size(); ++e)
      columns.add_wall(rim.edges[e], s.component[rim.at_triangle[e]], side);
  if (edges == 0)
    throw InputError(file, 0,
                     "--base needs a height field, and the surface is vertical at " +
                         place_text(lowest_point) + "; use --thicken D for a shell");
  std::vector<HoleRim> rims = find_rims(s.points, s.triangles);
  std::erase_if(rims, [&](const HoleRim& rim) { return s.points[rim.edges[0][0]].z() != height; });
  std::set<std::size_t> closed;
  const std::uint32_t bottom = s.group("base");
  for (const FlatCap& cap : find_flat_caps(s.points, s.triangles, rims, s.component, true)) {
    if (!cap.kept) continue;
    closed.insert(cap.rims.begin(), cap.rims.end());
    const Index own = s.component[rims[cap.rims[0]].at_triangle[0]];
    for (const Triangle& t : cap.triangles) s.add(t, own, bottom);
  }
  refuse_crossing(s, first_wall, file);
  for (std::size_t r = 0; r < rims.size(); ++r)
    if (!closed.contains(r))
      throw InputError(file, 0,
                       "--base cannot close the surface below its rim at " +
                           place_text(s.points[rims[r].edges[0][0]]) +
                           ": the rim crosses itself as seen from above; repair it there");
  return {.code = DiagnosticCode::base_added,
          .what = "an open surface with " + std::to_string(edges) + " edges at its rim",
          .done = "made the top of a block with its base at z = " + short_number(height) +
                  ", as --base requests" +
                  (specks == 0 ? "" : "; " + std::to_string(specks) + " tiny parts have none"),
          .places = {lowest_point}};
}

}  // namespace tetwright
