// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "simplify/constraints/edge_sizes.h"
#include "simplify/constraints/surface_grid.h"
#include "simplify/constraints/surface_projection.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/star.h"
#include "simplify/operations/objective.h"

namespace tetwright {

/// Bounds of the number of tets: no operation may take it below the minimum, and none that adds tets above
/// the maximum.
struct CountBounds {
  std::size_t min = 0, max = std::numeric_limits<std::int64_t>::max();
  bool allow(std::size_t live, std::int64_t change) const {
    const std::int64_t after = static_cast<std::int64_t>(live) + change;
    if (change < 0) return after >= static_cast<std::int64_t>(min);
    return change == 0 || after <= static_cast<std::int64_t>(max);
  }
};

/// The bounds that all operations of a block respect. Lengths in working coordinates.
struct BlockRules {
  Objective objective;
  double max_error = 0;  ///< E of Cutler, Dorsey & McMillan 2004, section 3
  double gamma = 10;     ///< weight of the volume error
  CountBounds count;
  /// Error(op) takes the net volume changes, as in the paper; otherwise it adds up the volumes that the
  /// interface triangles sweep.
  bool losses_cancel = false;
  /// Annealing: probability of accepting an action that leaves a worse tet than before.
  double accept_worse = 0;
  float annealing_floor = 0;  ///< min share of the worst quality that such an action keeps
  /// Operations whose new tets are all better than this are accepted, whatever was there before.
  float good_enough = 1;
  /// Max number of targets that a collapse tries, in the order of their weight.
  std::size_t max_targets = 4;
  /// Weight, relative to E, of the distance by which a collapse moves the surface at the removed point; 0:
  /// the volume alone decides, as in the paper.
  double distance_weight = 0;
  /// Max length of an edge that is collapsed, and of an edge that a collapse makes.
  double max_collapsed_edge = std::numeric_limits<double>::infinity(),
         max_edge = std::numeric_limits<double>::infinity();
  /// Target lengths of edges; null: none. No operation then leaves an edge that violates a bound by more than
  /// all edges that the operation changes did before. With a target length, `max_error`, `max_distance` and
  /// `max_deviation` apply to edges of the average length; see scale_at().
  const EdgeSizes* sizes = nullptr;
  /// Collapses only edges that `sizes` calls too short.
  bool collapse_short_only = false;
  /// Max distance of a new interface triangle's centroid from the reference (needs `projection`); 0: not
  /// checked. Unlike E it does not add up over several operations.
  double max_distance = 0;
  /// Max distance of a sample of the input's surface from the triangle that owns it, and of a new triangle
  /// from the input's surface, unless they were as far before (needs SurfaceGrid::samples()).
  double max_deviation = std::numeric_limits<double>::infinity();
  /// fit_to_samples() weights samples by their squared distance.
  bool fit_farthest = false;
  /// Upper limit of max_deviation.
  double tolerance = std::numeric_limits<double>::infinity();
  /// Max distance of a feature segment from the input's feature edges; a segment may keep the distance of
  /// those it replaces. 0: the mesh has no patches. With patches (needs `projection`) points move on their
  /// patch and along the feature edges between patches, and never leave a flat patch.
  double max_crease_distance = 0;
  /// Lets points of interfaces, junction curves and corners leave them by up to max_distance, or as far as
  /// they are off already, if that improves the shapes (needs `projection`). Points where patches meet, and
  /// points of flat patches, stay.
  bool leave_surface = false;
  /// All tets are positive, and boundary and interface triangles intersect only in shared vertices and edges:
  /// the mesh is embedded. If the centre lies within a material, a collapse that leaves positive tets then
  /// satisfies the link condition: an edge elsewhere that joins the target to a point of the centre's link
  /// would have to lie inside the star.
  bool embedded = false;
  /// Target of the projection of points on interfaces and junction curves; null: they stay in planes of
  /// constant volume.
  const SurfaceProjection* projection = nullptr;

  /// Target edge length at a point over the average one of the simplified mesh; 1 without a target length.
  double scale_at(const Vec3& place) const {
    return sizes && sizes->has_target_length() ? objective.scale_at(place) : 1;
  }
  /// Sets `projection`, and max_crease_distance if there are patches.
  ///
  /// \param diagonal of the mesh's bounding box, working coordinates.
  void project_onto(const SurfaceProjection& surfaces, double diagonal);
};

/// Whether an added interface triangle stays near the reference, if the rules require it.
///
/// \param inside, across the regions that it separates.
bool near_reference(const BlockRules& rules, const SurfaceGrid::Added& t, RegionId inside, RegionId across);

/// Whether the feature segments that end in the star's centre may be replaced by one from link point `first`
/// to `to`, and with `second` by another one from `to` to that link point. Link points by local number.
bool near_crease(const BlockRules& rules, const Star& star, std::size_t first, const Vec3& to,
                 std::optional<std::size_t> second = {});

/// Value of the objective for a tet.
float quality_of(const EditableMesh& mesh, const BlockRules& rules, const Tet& t);

}  // namespace tetwright
