// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/block_rules.h"

#include "simplify/tuning/tuning.h"

#include <algorithm>

namespace tetwright {

namespace {

using Features = SimplifyTuning::Features;

/// Max distance of sample points of a segment from the feature edges; infinity if one exceeds `at_most`.
/// Where creases were given up a border may be anywhere.
double crease_distance(const SurfaceProjection& projection, const Vec3& p, const Vec3& q, double at_most) {
  double largest = 0;
  for (const double s : Features::segment_parameters) {
    const Vec3 at = p + s * (q - p);
    if (projection.lacks_creases(at)) continue;
    const auto on = projection.onto_curve(at, at_most);
    if (!on) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, (*on - at).norm());
  }
  return largest;
}

}  // namespace

void BlockRules::project_onto(const SurfaceProjection& surfaces, double diagonal) {
  surface.projection = &surfaces;
  surface.max_feature_distance.reset();
  if (!surfaces.has_patches() && !surfaces.has_sheets()) return;
  surface.max_label_distance = Features::max_segment_share * diagonal;
  const double distance =
      Features::max_segment_share * std::min(diagonal, surfaces.creased_size().value_or(diagonal));
  surface.max_feature_distance = std::min(distance, deviation.tolerance.value_or(distance));
}

bool near_crease(const BlockRules& rules, const Star& star, double asked, std::size_t first, const Vec3& to,
                 std::optional<std::size_t> second) {
  double bound = asked;
  const auto fits = [&] {
    return crease_distance(*rules.surface.projection, star.positions[first], to, bound) <= bound &&
           (!second ||
            crease_distance(*rules.surface.projection, to, star.positions[*second], bound) <= bound);
  };
  if (fits()) return true;
  // Allow the distance of the replaced segments.
  const double unbounded = (star.positions[first] - star.centre_position).norm();
  for (std::size_t p = 0; p < star.points.size(); ++p)
    if (star.edge_dimension(p) == 1)
      if (const double d =
              crease_distance(*rules.surface.projection, star.positions[p], star.centre_position, unbounded);
          d <= unbounded)
        bound = std::max(bound, d);
  return bound > asked && fits();
}

bool near_reference(const BlockRules& rules, const SurfaceGrid::Added& t, RegionId inside, RegionId across) {
  if (!rules.surface.projection || !rules.surface.max_distance) return true;
  const auto& p = t.triangle.points;
  const Vec3 centre = (p[0] + p[1] + p[2]) / 3;
  return rules.surface.projection
      ->onto_surface(centre, inside, across, t.patch, *rules.surface.max_distance * rules.scale_at(centre))
      .has_value();
}

float quality_of(const EditableMesh& mesh, const BlockRules& rules, const Tet& t) {
  return rules.objective(mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]), mesh.position(t[3]));
}

}  // namespace tetwright
