#pragma once

#include <array>

#include "common/types.h"

namespace tetwright {

using TetCorners = std::array<Vec3, 4>;

/// The volume that two positive tets have in common: the first is cut by the four planes of the second, piece
/// by piece (Sutherland & Hodgman 1974, in three dimensions). Rounding leaves an error of about 1e-13 of the
/// smaller tet.
double overlap_volume(const TetCorners& first, const TetCorners& second);

}  // namespace tetwright
