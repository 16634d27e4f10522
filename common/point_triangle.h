#pragma once

#include "common/types.h"

namespace tetwright {

/// Squared distance of a point from a triangle (Ericson 2005, section 5.1.5). A degenerate triangle counts as
/// the segment or point it is.
double squared_distance(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace tetwright
