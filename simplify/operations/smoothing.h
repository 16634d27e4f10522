// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Searches for the position of a star's centre that makes its worst tet best: steepest ascent of the worst
/// quality by the active-set method (Freitag, Jones & Plassmann 1995; Freitag & Ollivier-Gooch 1997), with
/// gradients by finite differences, starting at the current position.
///
/// A point of an interface (dimension 2) moves in the tangent plane and is projected back onto the surface
/// (SurfaceBounds::projection); a point of a junction curve (1) moves along it. Without a projection both
/// preserve the volumes of both sides. With SurfaceBounds::leave_surface these points and corners (0) move
/// freely near their surface, curve or corner, which can open loops of a junction curve smaller than a tet.
/// Error(op) stays within E. Changes only the order of the star's tets.
///
/// \param limit quality that the worst tet must exceed.
/// \param found receives the position, if there is one.
/// \return whether a position was found.
/// \pre Gradients are computed.
bool find_position(Workspace& ws, const BlockRules& rules, int dimension, float limit, Placement& found);

/// Moves the centre of the gathered star towards a centroid (section 4 of the paper): within a material of
/// all neighbours, on an interface of the neighbours on it, on a junction curve of the two neighbours along
/// it. Tries the whole, half and quarter step. Modifies the star.
///
/// \return done (proposed), material_rule (a corner, or frozen), quality, surface_error, self_intersection or
///   volume.
Outcome smooth(Workspace& ws, const BlockRules& rules);

/// Moves the centre of the gathered star to the position found by find_position(); corners only with
/// SurfaceBounds::leave_surface.
///
/// \return as smooth().
Outcome optimise(Workspace& ws, const BlockRules& rules);

}  // namespace tetwright
