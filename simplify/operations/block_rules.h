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

/// No operation may take the number of tets below the minimum; none that adds tets may take it above the
/// maximum.
struct CountBounds {
  std::size_t min = 0, max = std::numeric_limits<std::int64_t>::max();
  bool allow(std::size_t live, std::int64_t change) const {
    const std::int64_t after = static_cast<std::int64_t>(live) + change;
    if (change < 0) return after >= static_cast<std::int64_t>(min);
    return change == 0 || after <= static_cast<std::int64_t>(max);
  }
};

/// The bounds within which all operations of a block stay. Lengths in working coordinates.
struct BlockRules {
  Objective objective;
  double max_error = 0;  ///< E of Cutler, Dorsey & McMillan 2004, section 3
  double gamma = 10;     ///< weight of the volume error
  CountBounds count;
  /// Error(op) takes the net change of each volume, as the paper has it; otherwise the volumes that the
  /// interface triangles sweep are added up.
  bool losses_cancel = false;
  double accept_worse = 0;    ///< annealing: probability of an action that leaves a worse tet than before
  float annealing_floor = 0;  ///< share of the worst quality that such an action must keep
  float good_enough =
      1;  ///< operations whose new tets are all better are accepted, whatever was there before
  /// The number of targets that a collapse tries, in the order of their weight.
  std::size_t max_targets = 4;
  /// Weight, against E, of the distance by which a collapse moves the surface at the removed point; 0: the
  /// volume alone decides, as in the paper.
  double distance_weight = 0;
  /// Collapses take only edges up to the first length, and make none longer than the second.
  double max_collapsed_edge = std::numeric_limits<double>::infinity(),
         max_edge = std::numeric_limits<double>::infinity();
  /// What lengths edges should have; null: any. No operation then leaves an edge that is longer, or shorter,
  /// than its bound and than all edges that it changes were. Where there is a target length, `max_error`,
  /// `max_distance` and `max_deviation` are for edges of the average length, see scale_at().
  const EdgeSizes* sizes = nullptr;
  /// Collapses take only edges that `sizes` calls too short.
  bool collapse_short_only = false;
  /// How far the centre of a new interface triangle may be from the reference (needs `projection`); 0: not
  /// checked. Unlike E it does not add up over several operations.
  double max_distance = 0;
  /// How far a sample of the input's surface may be from the triangle that owns it, and a new triangle from
  /// the input's surface, unless they were as far before (needs SurfaceGrid::samples()).
  double max_deviation = std::numeric_limits<double>::infinity();
  /// fit_to_samples() weights samples by the square of their distances.
  bool fit_farthest = false;
  /// What max_deviation must never exceed.
  double tolerance = std::numeric_limits<double>::infinity();
  /// The mesh has patches (needs `projection`): points move on them and along the creases between them, and
  /// nowhere else where they are flat. A segment of a crease strays from the creases as they came by no more
  /// than this, or than those did that it replaces; 0: no patches.
  double max_crease_distance = 0;
  /// Points of interfaces, junction curves and corners may leave them by up to max_distance (or as far as
  /// they are away already) where that improves the shapes (needs `projection`); those where patches meet,
  /// and those of flat patches, stay.
  bool leave_surface = false;
  /// All tets are positive, and no boundary or interface triangles meet but in what they share: then the mesh
  /// covers no place twice, and where the centre lies within a material, a collapse that leaves positive tets
  /// satisfies the link condition. For an edge between the target and a point of the centre's link that were
  /// joined elsewhere would have to lie inside the star.
  bool embedded = false;
  /// What points of interfaces and junction curves are projected onto; null: they stay in planes of constant
  /// volume.
  const SurfaceProjection* projection = nullptr;

  /// The wanted length of edges at a place over the average one of the mesh to come; 1 without a target
  /// length.
  double scale_at(const Vec3& place) const {
    return sizes && sizes->has_target_length() ? objective.scale_at(place) : 1;
  }
  /// Sets `projection`, and what keeps patches where there are some. `diagonal` of the mesh's bounding box.
  void project_onto(const SurfaceProjection& surfaces, double diagonal);
};

/// Whether an added interface triangle stays near the reference, as far as the rules ask for it. `inside` and
/// `across` are the regions that it separates.
bool near_reference(const BlockRules& rules, const SurfaceGrid::Added& t, RegionId inside, RegionId across);

/// Whether the segments of a crease that end in the star's centre may become one from its neighbour at local
/// number `first` to `to`, and with `second` another one from there.
bool near_crease(const BlockRules& rules, const Star& star, std::size_t first, const Vec3& to,
                 std::optional<std::size_t> second = {});

/// The objective's value for a tet.
float quality_of(const EditableMesh& mesh, const BlockRules& rules, const Tet& t);

}  // namespace tetwright
