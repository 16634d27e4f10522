// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Divides a segment into equal pieces of at most `length` and joins successive pieces that are lost, or are
/// not, so that long segments lose only a part.
/// \param is_lost is_lost(p, q) for a piece
/// \param visit visit(p, q, lost) from `a` to `b`; the first p and the last q are `a` and `b` themselves
template <class IsLost, class Visit>
void for_each_run(const Vec3& a, const Vec3& b, double length, const IsLost& is_lost, const Visit& visit) {
  const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / length)));
  Vec3 first = a, from = a;
  bool lost = false;
  for (int k = 0; k < pieces; ++k) {
    const Vec3 to = k + 1 == pieces ? b : Vec3(a + (b - a) * (k + 1) / pieces);
    const bool now = is_lost(from, to);
    if (k > 0 && now != lost) {
      visit(first, from, lost);
      first = from;
    }
    lost = now;
    from = to;
  }
  visit(first, b, lost);
}

}  // namespace tetwright
