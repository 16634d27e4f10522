// SPDX-License-Identifier: Apache-2.0

// A program of another project: it includes every installed header (all_headers.h lists them) and makes a
// mesh as the README shows.
#include <cstdio>

#include "all_headers.h"

int main() {
  tetwright::TriangleMesh cube;
  for (int k = 0; k < 8; ++k) cube.points.emplace_back(k & 1, k >> 1 & 1, k >> 2);
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  tetwright::MaterialSurface body{"body", 1, cube, "cube"};
  const auto dense =
      tetwright::mesh_surfaces(tetwright::make_mesher_input({body}), {.resolution = 24}, nullptr);
  tetwright::SimplifyOptions options;
  options.target_tets = 2000;
  const tetwright::TetMesh mesh = tetwright::simplify(dense.mesh, options);
  std::printf("%zu tets\n", mesh.tets.size());
  return mesh.tets.size() > 1950 && mesh.tets.size() < 2050 ? 0 : 1;
}
