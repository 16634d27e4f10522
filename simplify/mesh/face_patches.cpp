// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/face_patches.h"

#include <algorithm>

namespace tetwright {

Triangle face_key(Triangle points) {
  std::sort(points.begin(), points.end());
  return points;
}

FacePatches renumbered(const FacePatches& patches, const std::vector<Index>& numbers) {
  FacePatches result;
  for (const auto& [points, patch] : patches)
    result.emplace(face_key({numbers[points[0]], numbers[points[1]], numbers[points[2]]}), patch);
  return result;
}

void put_patches(const FacePatches& patches, std::vector<InterfaceTriangle>& triangles) {
  if (patches.empty()) return;
  for (InterfaceTriangle& t : triangles)
    if (const auto known = patches.find(face_key(t.ids)); known != patches.end()) t.patch = known->second;
}

}  // namespace tetwright
