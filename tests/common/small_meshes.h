// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// One positive tet of material 1.
inline TetMesh one_tet() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {1}, {}}; }

/// Two positive tets that share a face.
inline TetMesh two_tets(MaterialTag second = 1) {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 1, 2, 3}, {0, 2, 1, 4}},
          {1, second},
          {}};
}

/// Two positive tets that share only an edge.
inline TetMesh edge_bridge() {
  return {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
          {{0, 2, 3, 1}, {0, 4, 5, 1}},
          {1, 1},
          {}};
}

/// Two positive tets that share only a point.
inline TetMesh point_bridge() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
          {{0, 1, 2, 3}, {0, 5, 4, 6}},
          {1, 1},
          {}};
}

}  // namespace tetwright
