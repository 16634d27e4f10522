// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Looks for the place of a star's centre at which its worst tet is best, from where it stands: steepest
/// ascent of the worst by the active-set method (Freitag, Jones & Plassmann 1995; Freitag & Ollivier-Gooch
/// 1997), gradients by differences. A point of an interface (dimension 2) moves in the tangent plane and is
/// brought back onto the surface (BlockRules::projection), one of a junction curve (1) along it; without a
/// projection they keep the volumes of both sides. With BlockRules::leave_surface all of them and corners (0)
/// move freely near where they belong: loops of a junction curve that are smaller than a tet open up.
/// Error(op) stays within E. True if a place better than `limit` was found; the star is not changed but for
/// the order of its tets. gradients must be computed.
bool find_place(Workspace& ws, const BlockRules& rules, int dimension, float limit, Placement& found);

/// Moves the centre of the gathered star towards the centroid of its neighbours (section 4 of the paper): of
/// all of them within a material, of those on the same interface, of the two on a junction curve; whole, half
/// or quarter way. Answers done (proposed), material_rule (a corner, or frozen), quality, surface_error,
/// self_intersection, volume. The star is used up.
Outcome smooth(Workspace& ws, const BlockRules& rules);

/// Moves the centre of the gathered star where find_place() says; corners only with leave_surface. Same
/// answers.
Outcome optimise(Workspace& ws, const BlockRules& rules);

}  // namespace tetwright
