#pragma once

#include "simplify/task.h"

namespace tetwright {

/// Moves the star's centre towards the centroid of its neighbours (Cutler, Dorsey & McMillan 2004, section
/// 4): of all inside a material, of those on the same interface for a point of one, of the two on the same
/// junction curve for a point of one; corners stay. A point of an interface slides within the plane in which
/// no volume changes (exact for a single material's boundary: its volume is linear in the point). Half and
/// quarter steps are tried where the whole one does not help.
///
/// The task holds the closed star that `task.star` was gathered from. done: the point was moved and its
/// poorest tet is better than before. Otherwise nothing was changed.
Outcome smooth(Task& task, const BlockRules& rules);

/// Moves the centre to where its poorest tet is best, as a compass search finds it (Kolda, Lewis & Torczon
/// 2003, section 1.1): along the axes inside a material, in the plane of constant volume on an interface,
/// along the curve on a junction. Slower than smooth() and better: Freitag & Ollivier-Gooch 1997 show that
/// optimising the worst shape beats centroids. Same contract.
Outcome optimise(Task& task, const BlockRules& rules);

}  // namespace tetwright
