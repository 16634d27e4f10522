// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/undo_intersections.h"

#include <algorithm>
#include <cstdint>

#include "common/geometry/predicates.h"
#include "common/geometry/self_intersection.h"

namespace tetwright {

void undo_intersections(std::vector<Vec3>& points, const std::vector<Tet>& tets,
                        const std::vector<Triangle>& faces, const std::vector<Vec3>& before) {
  std::vector<std::uint8_t> is_back(points.size(), 0);
  const auto put_back = [&](Index p) {
    const bool moves = !is_back[p] && points[p] != before[p];
    is_back[p] = 1;
    points[p] = before[p];
    return moves;
  };
  for (bool again = true; again;) {
    again = false;
    for (const auto& [f, g] : self_intersections(points, faces))
      for (const Index t : {f, g})
        for (const Index p : faces[t]) again |= put_back(p);
    if (!again) return;
    for (bool turned = true; turned;) {
      turned = false;
      for (const Tet& t : tets) {
        if (std::none_of(t.begin(), t.end(), [&](Index p) { return is_back[p] != 0; })) continue;
        if (orient3d(points[t[0]], points[t[1]], points[t[2]], points[t[3]]) > 0) continue;
        for (const Index p : t) turned |= put_back(p);
      }
    }
  }
}

}  // namespace tetwright
