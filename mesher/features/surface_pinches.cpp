// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/surface_pinches.h"

#include <algorithm>
#include <map>
#include <set>

#include "common/features/edge_uses.h"

namespace tetwright {

namespace {

/// The faces at a point, each as its two other points.
using Star = std::vector<std::array<Index, 2>>;

/// The points of each fan of faces around a point, and the number of its faces.
struct Fan {
  std::set<Index> points;
  std::size_t faces = 0;
};

std::vector<Fan> fans_of(const Star& star) {
  std::vector<Fan> fans;
  for (const std::array<Index, 2>& face : star) {
    Fan joined{{face.begin(), face.end()}, 1};
    std::erase_if(fans, [&](const Fan& fan) {
      if (!fan.points.contains(face[0]) && !fan.points.contains(face[1])) return false;
      joined.points.insert(fan.points.begin(), fan.points.end());
      joined.faces += fan.faces;
      return true;
    });
    fans.push_back(std::move(joined));
  }
  return fans;
}

/// The points of all fans but the one with the most faces; of equal ones, that with the smallest point.
std::vector<Index> beside_largest(const std::vector<Fan>& fans) {
  const auto largest = std::max_element(fans.begin(), fans.end(), [](const Fan& a, const Fan& b) {
    return a.faces != b.faces ? a.faces < b.faces : *a.points.begin() > *b.points.begin();
  });
  std::vector<Index> beside;
  for (auto fan = fans.begin(); fan != fans.end(); ++fan)
    if (fan != largest) beside.insert(beside.end(), fan->points.begin(), fan->points.end());
  std::sort(beside.begin(), beside.end());
  return beside;
}

}  // namespace

SurfacePinches find_pinches(std::span<const Triangle> faces, std::span<const std::uint32_t> surfaces,
                            const std::function<bool(Index)>& considers) {
  std::map<std::uint32_t, std::vector<Triangle>> by_surface;
  for (std::size_t f = 0; f < faces.size(); ++f) by_surface[surfaces[f]].push_back(faces[f]);
  SurfacePinches found;
  for (const auto& [surface, own] : by_surface) {
    const std::vector<EdgeUse> uses = edge_uses(own, {});
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      while (j < uses.size() && uses[j].key == uses[i].key) ++j;
      if (j - i > 2) found.edges.push_back({ends_of(uses[i].key), surface});
    }
    std::map<Index, Star> stars;
    for (const auto& [a, b, c] : own) {
      if (considers(a)) stars[a].push_back({b, c});
      if (considers(b)) stars[b].push_back({c, a});
      if (considers(c)) stars[c].push_back({a, b});
    }
    for (const auto& [p, star] : stars)
      if (const std::vector<Fan> fans = fans_of(star); fans.size() > 1)
        found.points.push_back({p, surface, beside_largest(fans)});
  }
  return found;
}

}  // namespace tetwright
