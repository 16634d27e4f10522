// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/height_block.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
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
  std::map<Index, Index> foot;  // by point of a rim
  std::size_t edges = 0;
  for (const HoleRim& rim : find_rims(s.points, s.triangles)) {
    if (!is_outer(rim) || rim.vector.norm() < InputTuning::Holes::min_share * area) continue;
    edges += rim.edges.size();
    const auto below = [&](Index p) {
      const auto [known, is_new] = foot.try_emplace(p, static_cast<Index>(s.points.size()));
      if (is_new) s.points.emplace_back(s.points[p].x(), s.points[p].y(), height);
      return known->second;
    };
    for (std::size_t e = 0; e < rim.edges.size(); ++e) {
      const auto& [a, b] = rim.edges[e];
      const Index under_a = below(a), under_b = below(b), own = s.component[rim.at_triangle[e]];
      s.add({a, b, under_b}, own, side);
      s.add({a, under_b, under_a}, own, side);
    }
  }
  std::vector<HoleRim> rims = find_rims(s.points, s.triangles);
  std::set<Index> feet;
  for (const auto& [top, bottom] : foot) feet.insert(bottom);
  std::erase_if(rims, [&](const HoleRim& rim) { return !feet.contains(rim.edges[0][0]); });
  std::set<std::size_t> closed;
  const std::uint32_t bottom = s.group("base");
  for (const FlatCap& cap : find_flat_caps(s.points, s.triangles, rims, s.component)) {
    if (!cap.kept) continue;
    closed.insert(cap.rims.begin(), cap.rims.end());
    const Index own = s.component[rims[cap.rims[0]].at_triangle[0]];
    for (const Triangle& t : cap.triangles) s.add(t, own, bottom);
  }
  refuse_crossing(s, first_wall, file);
  if (closed.size() < rims.size())
    throw InputError(file, 0,
                     "--base cannot close the surface below its rim at " +
                         place_text(s.points[rims[0].edges[0][0]]) +
                         ": the rim crosses itself as seen from above; repair it there");
  return {
      .code = DiagnosticCode::base_added,
      .what = "an open surface with " + std::to_string(edges) + " edges at its rim",
      .done = "made the top of a block with its base at z = " + short_number(height) + ", as --base requests",
      .places = {lowest_point}};
}

}  // namespace tetwright
