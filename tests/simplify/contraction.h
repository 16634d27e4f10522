// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The mesh with point a collapsed onto b, whatever the shapes: only the connectivity matters.
inline TetMesh contracted(const EditableMesh& mesh, Index a, Index b) {
  TetMesh out;
  std::vector<Index> number(mesh.point_slots(), no_index);
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    if (mesh.dead(t)) continue;
    Tet points = mesh.points(t);
    const bool has_b = std::find(points.begin(), points.end(), b) != points.end();
    const auto at_a = std::find(points.begin(), points.end(), a);
    if (at_a != points.end()) {
      if (has_b) continue;
      *at_a = b;
    }
    for (Index& p : points) {
      if (number[p] == no_index) {
        number[p] = static_cast<Index>(out.points.size());
        out.points.push_back(mesh.position(p));
      }
      p = number[p];
    }
    out.tets.push_back(points);
    out.materials.push_back(mesh.tag(mesh.region(t)));
  }
  return out;
}

}  // namespace tetwright
