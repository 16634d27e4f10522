// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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
#include "simplify/tuning/tuning.h"

namespace tetwright {

/// Bounds on the number of tets: no operation may take it below the minimum, and none that adds tets may take
/// it above the maximum.
struct CountBounds {
  std::size_t min = 0, max = std::numeric_limits<std::int64_t>::max();
  bool allow(std::size_t live, std::int64_t change) const {
    const std::int64_t after = static_cast<std::int64_t>(live) + change;
    if (change < 0) return after >= static_cast<std::int64_t>(min);
    return change == 0 || after <= static_cast<std::int64_t>(max);
  }
};

/// Bound on Error(op) of Cutler, Dorsey & McMillan 2004, section 3: the volume by which one operation changes
/// materials.
struct ErrorBound {
  /// E for edges of average length, working coordinates; std::nullopt: unbounded.
  std::optional<double> max = 0;
  double gamma = 10;  ///< weight of the volume error
  /// Error(op) uses net volume changes, as in the paper; otherwise it sums the volumes that the interface
  /// triangles sweep.
  bool losses_cancel = false;

  /// The bound for edges of `scale` times the average length; infinity if there is none.
  double limit(double scale = 1) const {
    return max ? *max * scale : std::numeric_limits<double>::infinity();
  }
};

/// Shapes that an operation may leave. It must improve the worst tet, unless this allows more.
struct Acceptance {
  /// Annealing: probability of accepting an operation that makes the worst tet worse, and min fraction of the
  /// worst quality that it must keep.
  double worse_probability = 0;
  float worse_floor = 0;
  /// Operations whose new tets are all better than this are accepted, whatever the old tets.
  std::optional<float> good_enough;
};

/// Limits that apply to collapses only. Lengths in working coordinates.
struct CollapseLimits {
  /// Max number of targets that a collapse tries, in ascending order of weight.
  std::size_t max_targets = SimplifyTuning::Collapses::max_targets;
  /// Weight, relative to E, of the distance by which a collapse moves the surface at the removed point;
  /// std::nullopt: only the volume counts, as in the paper.
  std::optional<double> distance_weight;
  std::optional<double> max_collapsed_edge;  ///< max length of an edge that is collapsed
  std::optional<double> max_new_edge;        ///< max length of an edge that a collapse creates
  /// Collapses only edges that BlockRules::sizes calls too short.
  /// \pre BlockRules::sizes is set.
  bool short_edges_only = false;
};

/// Distances of the surface from a reference, and how points move along it. Working coordinates.
struct SurfaceBounds {
  /// Surface onto which points of interfaces and junction curves are projected; null: they stay in planes of
  /// constant volume.
  const SurfaceProjection* projection = nullptr;
  /// Max distance of a new interface triangle's centroid from the reference (needs `projection`), for edges
  /// of average length. Unlike E, it does not accumulate over several operations.
  std::optional<double> max_distance;
  /// Max distance of a feature segment from the input's feature edges; a segment may keep the distance of
  /// those it replaces. std::nullopt: the mesh has neither patches nor sheets.
  std::optional<double> max_feature_distance;
  /// As above for curves between labels around bodies, of which max_feature_distance is a share.
  double max_label_distance = 0;
  /// Lets points of interfaces, junction curves and corners leave them by up to max_distance, or by their
  /// current distance if that is larger, if that improves the shapes (needs `projection`). Points where
  /// patches meet, and points of flat patches, never leave.
  bool leave_surface = false;
};

/// Bound on the distance of a sample of the input's surface from the triangle that owns it, and of a new
/// triangle from the input's surface. Distances already larger must not increase. Needs
/// SurfaceGrid::samples(). Working coordinates.
struct DeviationBound {
  std::optional<double> max;        ///< for edges of average length
  std::optional<double> tolerance;  ///< upper limit of the bound, for edges of any length

  /// The bound for edges of `scale` times the average length; infinity if there is none.
  double limit(double scale) const {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    return std::min(tolerance.value_or(unbounded), max ? *max * scale : unbounded);
  }
  /// `max` times a factor, but at most the tolerance; std::nullopt without either.
  std::optional<double> widened(double factor) const {
    if (!max) return tolerance;
    return std::min(tolerance.value_or(std::numeric_limits<double>::infinity()), factor * *max);
  }
};

/// The rules that all operations of a block follow.
struct BlockRules {
  Objective objective;
  CountBounds count;
  ErrorBound error;
  Acceptance acceptance;
  CollapseLimits collapse;
  /// Target lengths of edges; null: none. No operation then leaves an edge that violates a bound by a larger
  /// factor than the worst edge of the changed tets did before. With a target length, ErrorBound::max,
  /// SurfaceBounds::max_distance and DeviationBound::max apply to edges of the average length; see
  /// scale_at().
  const EdgeSizes* sizes = nullptr;
  SurfaceBounds surface;
  DeviationBound deviation;
  /// The mesh is embedded: all tets are positive, and boundary and interface triangles intersect only in
  /// shared vertices and edges. If the centre lies within a material, a collapse that leaves positive tets
  /// then satisfies the link condition, because any other edge from the target to a point of the centre's
  /// link would have to lie inside the star.
  bool embedded = false;

  /// Whether the mesh has patches. If so, points move on their patch and along the feature edges between
  /// patches, and never leave a flat patch.
  bool has_patches() const { return surface.projection && surface.projection->has_patches(); }
  /// ReferenceSurface::first_body_patch()
  PatchId first_body_patch() const {
    return surface.projection ? surface.projection->first_body_patch() : PatchId{0};
  }
  /// Whether these rules hold for the star's centre: the mesh has patches, or the centre lies on a sheet.
  bool keeps_patches(const Star& star) const {
    return has_patches() || (star.sheets && surface.max_feature_distance);
  }
  /// Whether the star's centre may lie on a feature edge: where patches meet, or on a curve of a sheet.
  bool keeps_curves(const Star& star) const {
    return surface.max_feature_distance && (star.creases || star.sheets);
  }
  /// Ratio of the target edge length at a point to the average one of the simplified mesh; 1 without a target
  /// length.
  double scale_at(const Vec3& place) const {
    return sizes && sizes->has_target_length() ? objective.scale_at(place) : 1;
  }
  /// Sets the projection, and the max distance of feature segments if there are patches.
  ///
  /// \param diagonal of the mesh's bounding box, working coordinates.
  void project_onto(const SurfaceProjection& surfaces, double diagonal);
};

/// Whether an added interface triangle stays near the reference; true if the rules do not require it.
///
/// \param inside, across the regions that the triangle separates.
bool near_reference(const BlockRules& rules, const SurfaceGrid::Added& t, RegionId inside, RegionId across);

/// Whether the feature segments that end at the star's centre may be replaced by a segment from link point
/// `first` to `to` and, if `second` is given, by another one from `to` to that link point. Link points are
/// local numbers.
/// \param asked max distance from the curves of the input, or that of the replaced segments if that is larger
/// \pre rules.keeps_curves(star).
bool near_crease(const BlockRules& rules, const Star& star, double asked, std::size_t first, const Vec3& to,
                 std::optional<std::size_t> second = {});

/// Value of the objective for a tet.
float quality_of(const EditableMesh& mesh, const BlockRules& rules, const Tet& t);

}  // namespace tetwright
