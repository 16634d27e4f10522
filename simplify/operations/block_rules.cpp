// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/block_rules.h"

#include <algorithm>

namespace tetwright {

namespace {

/// Max distance of a feature segment from the input's feature edges, as a share of the mesh's diagonal.
constexpr double max_crease_share = 0.001;
/// Parameters along a segment at which its distance from the feature edges is sampled.
constexpr double segment_samples[] = {0.25, 0.5, 0.75};

/// Max distance of the samples from the feature edges, or infinity if one exceeds `at_most`.
double crease_distance(const SurfaceProjection& projection, const Vec3& p, const Vec3& q, double at_most) {
  double largest = 0;
  for (const double s : segment_samples) {
    const Vec3 at = p + s * (q - p);
    const auto on = projection.onto_curve(at, at_most);
    if (!on) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, (*on - at).norm());
  }
  return largest;
}

}  // namespace

void BlockRules::project_onto(const SurfaceProjection& surfaces, double diagonal) {
  projection = &surfaces;
  max_crease_distance = surfaces.has_patches() ? std::min(max_crease_share * diagonal, tolerance) : 0;
}

bool near_crease(const BlockRules& rules, const Star& star, std::size_t first, const Vec3& to,
                 std::optional<std::size_t> second) {
  double bound = rules.max_crease_distance;
  const auto fits = [&] {
    return crease_distance(*rules.projection, star.positions[first], to, bound) <= bound &&
           (!second || crease_distance(*rules.projection, to, star.positions[*second], bound) <= bound);
  };
  if (fits()) return true;
  // Allow the distance of the segments that are replaced.
  const double unbounded = (star.positions[first] - star.centre_position).norm();
  for (std::size_t p = 0; p < star.points.size(); ++p)
    if (star.edge_dimension(p) == 1)
      if (const double d =
              crease_distance(*rules.projection, star.positions[p], star.centre_position, unbounded);
          d <= unbounded)
        bound = std::max(bound, d);
  return bound > rules.max_crease_distance && fits();
}

bool near_reference(const BlockRules& rules, const SurfaceGrid::Added& t, RegionId inside, RegionId across) {
  if (!rules.projection || !(rules.max_distance > 0)) return true;
  const auto& p = t.triangle.points;
  const Vec3 centre = (p[0] + p[1] + p[2]) / 3;
  return rules.projection
      ->onto_surface(centre, inside, across, t.patch, rules.max_distance * rules.scale_at(centre))
      .has_value();
}

float quality_of(const EditableMesh& mesh, const BlockRules& rules, const Tet& t) {
  return rules.objective(mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]), mesh.position(t[3]));
}

}  // namespace tetwright
