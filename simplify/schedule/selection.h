// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "simplify/constraints/surface_projection.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/operations/objective.h"
#include "simplify/schedule/block_runner.h"
#include "tetwright/simplify.h"

namespace tetwright {

// Selection of the tets and points on which a round works. Call these only while no task runs. They are
// parallel and change nothing; results do not depend on the number of threads. Lists are in the order of the
// mesh's space-filling curve, each item once.

/// The quality below which `percent` of the tets lie; 1 for all tets, 0 for an empty mesh.
float quality_cutoff(const EditableMesh& mesh, double percent);
/// Number of tets by Quality(t), worst first, in equal bins from 0 to 1.
///
/// \pre the objective in force is Objective::Kind::paper, which stores Quality(t)^3
decltype(IterationReport::tets_by_quality) tets_by_quality(const EditableMesh& mesh);
/// Fraction of the tets whose shape is worse than the shape_quality_bound() of a solid angle (steradians),
/// independent of stored qualities.
///
/// \param objective only its shape measure is used.
double share_below(const EditableMesh& mesh, const Objective& objective, double angle);

/// The tets of quality `limit` or less.
std::vector<TetSnapshot> bad_tets(const EditableMesh& mesh, float limit);
/// The points of bad_tets().
std::vector<Index> bad_points(const EditableMesh& mesh, float limit);
/// The tets that share a point with a listed one.
std::vector<TetSnapshot> tets_around(const EditableMesh& mesh, const std::vector<TetSnapshot>& tets);
/// The points of tets_around().
std::vector<Index> points_around(const EditableMesh& mesh, const std::vector<TetSnapshot>& tets);
/// The tets with one of these boundary or interface faces.
///
/// \param faces face_key() of each, ascending.
std::vector<TetSnapshot> tets_with_faces(const EditableMesh& mesh, const std::vector<Triangle>& faces);
/// The points of boundary and interfaces of the regions that `wanted` accepts.
std::vector<Index> interface_points(const EditableMesh& mesh, const std::function<bool(RegionId)>& wanted);
/// The points of the boundary, and of bodies among labels, at which two patches meet off any feature edge, or
/// three off any corner.
std::vector<Index> points_off_features(const EditableMesh& mesh, const SurfaceGrid& grid,
                                       const SurfaceProjection& projection);

}  // namespace tetwright
