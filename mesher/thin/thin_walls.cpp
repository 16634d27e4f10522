// SPDX-License-Identifier: Apache-2.0
#include "mesher/thin/thin_walls.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

void ThinWalls::cover(const std::array<int, 3>& voxel, int depth) {
  std::uint8_t& at = blocks_[block_key(voxel)][place_in_block(voxel)];
  at = std::max(at, static_cast<std::uint8_t>(depth + 1));
}

std::vector<MortonKey> ThinWalls::covered() const {
  std::vector<MortonKey> keys;
  for (const auto& [key, block] : blocks_) {
    const std::array<int, 3> low = morton_decode(key);
    for (int k = 0; k < leaf_points; ++k)
      if (block[static_cast<std::size_t>(k)] > 0)
        keys.push_back(morton_encode(low[0] * leaf_side + k / (leaf_side * leaf_side),
                                     low[1] * leaf_side + k / leaf_side % leaf_side,
                                     low[2] * leaf_side + k % leaf_side));
  }
  parallel_sort(keys);
  return keys;
}

double ThinWalls::changed_distance(const Vec3& point, int depth, Vec3& gradient) const {
  return distance(point, depth, true, gradient);
}

double ThinWalls::true_distance(const Vec3& point, int depth, Vec3& gradient) const {
  return distance(point, depth, false, gradient);
}

double ThinWalls::parallel_thickness(const Vec3& point, int depth) const {
  const double min_shown = std::ldexp(DistanceTuning::Walls::min_shown_cells, -depth);
  const std::optional<SurfacePlace> place = surface_->nearest(point, 1);
  if (!place) return HUGE_VAL;
  const double wall = surface_->thickness(*place, SurfaceDistance::Side::wall,
                                          DistanceTuning::Walls::facing_to_report, min_shown);
  return wall < min_shown ? wall : HUGE_VAL;
}

double ThinWalls::thickness_around(SurfacePlace& place, SurfaceDistance::Side side, double at_most) const {
  const double sign = side == SurfaceDistance::Side::gap ? 1 : -1;
  SurfacePlace at = place;
  // The ball of that thickness is empty within the tolerance of thickness(): there is neither another wall
  // nor another face to go to.
  if (surface_->is_ball_empty(at.point + sign * 0.5 * at_most * at.normal,
                              0.5 * at_most * (1 - DistanceTuning::Triangles::min_shrink)))
    return at_most;
  for (int step = 0;; ++step) {
    const double thickness = surface_->thickness(at, side, DistanceTuning::Walls::facing_to_change, at_most);
    if (thickness < at_most) {
      place = at;
      return thickness;
    }
    if (step == DistanceTuning::Walls::max_steps_beside) return at_most;
    const std::optional<SurfacePlace> beside =
        surface_->nearest(at.point + sign * 0.5 * at_most * at.normal, 0.5 * at_most);
    if (!beside) return at_most;
    at = *beside;
  }
}

bool ThinWalls::is_between(const Vec3& point, const Vec3& normal, double width) const {
  const auto behind = surface_->nearest_facing(point, -normal, DistanceTuning::Walls::facing_to_change, width,
                                               true),
             ahead = surface_->nearest_facing(point, normal, DistanceTuning::Walls::facing_to_change, width,
                                              true);
  if (!behind || !ahead) return false;
  const Vec3 a = behind->point - point, b = ahead->point - point;
  return a.dot(b) <= -DistanceTuning::Walls::min_opposition * a.norm() * b.norm();
}

double ThinWalls::distance(const Vec3& point, int depth, bool thicken, Vec3& gradient) const {
  gradient = Vec3::Zero();
  const double min_shown = std::ldexp(DistanceTuning::Walls::min_shown_cells, -depth);
  const double close_below = std::max(min_shown, limits_.min_gap), omit_below = limits_.min_thickness;
  const double reach = std::max<double>(level_set_band, 0.5 * std::max(close_below, omit_below));
  const std::optional<SurfacePlace> place = surface_->nearest(point, reach);
  const bool inside = place && place->side != 0 ? place->side < 0 : surface_->inside(point);
  if (!place) return inside ? -level_set_band : level_set_band;
  const Vec3 away = point - place->point;
  const double size = away.norm();
  // In front of a gap's mouth the closest point is on its rim, and nothing is closed. For a point on the
  // surface the direction to the closest point is rounding noise.
  const bool beside = size > tolerance::smallest_distance &&
                      std::abs(place->normal.dot(away)) < DistanceTuning::Walls::min_alignment * size;
  // Within a gap no point is farther from the nearest wall than half its width.
  if (!inside && !beside && size <= 0.5 * close_below) {
    SurfacePlace side = *place;
    const double gap = thickness_around(side, SurfaceDistance::Side::gap, close_below);
    if (gap < close_below && (size <= 0.5 * min_shown || is_between(point, side.normal, close_below)))
      return std::max<double>(-level_set_band, -0.5 * (close_below - gap));
  }
  // Values farther away than lattice edges reach are not interpolated.
  const bool near = size < std::ldexp(level_set_band, -depth);
  const double sought = std::max(omit_below, thicken && near ? min_shown : 0.0);
  SurfacePlace side = *place;
  const double wall = sought > 0 ? thickness_around(side, SurfaceDistance::Side::wall, sought) : 0;
  if (wall < omit_below)
    return std::min<double>(level_set_band, std::max(inside ? 0 : size, 0.5 * (omit_below - wall)));
  double value = std::max(size, tolerance::smallest_distance);
  gradient = size > tolerance::smallest_distance ? Vec3(away / size) : place->normal;
  if (inside) {
    value = -value;
    if (size > tolerance::smallest_distance) gradient = -gradient;
  }
  if (thicken && near) value -= 0.5 * std::max(0.0, min_shown - wall);
  return std::clamp<double>(value, -level_set_band, level_set_band);
}

}  // namespace tetwright
