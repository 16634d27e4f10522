// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "mesher/cut/backtracking_displacement.h"
#include "mesher/features/crease_labels.h"
#include "mesher/features/feature_surface.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The point of a boundary point's patch, crease or corner nearest to a position, within
/// CutTuning::Fitting::target_reach cells; nothing if it has none.
/// \param at input units
/// \param cell size of the cells at the surface, input units
/// \param planes of the border of a volume in which the point must stay, see FeatureSurface::border_planes()
std::optional<Vec3> feature_target(const FeatureSurface& surface, const FeatureLabel& label, const Vec3& at,
                                   double cell, unsigned planes = 0);

/// Moves points to their targets that hold each other back: each group of them goes to its targets at once,
/// and the points around give way, within their patch or along their crease if they are on the boundary,
/// until all tets are positive (untangle()). Groups for which that fails, or of more than
/// CutTuning::JointFitting::max_group points, stay. Serial.
/// \param waiting points and the steps to their targets
/// \param cell size of the cells at the surface, input units
void move_jointly(TetMesh& mesh, const FeatureSurface& surface, const CreaseLabels& labels,
                  const std::vector<PointMove>& waiting, double cell);

}  // namespace tetwright
