// SPDX-License-Identifier: Apache-2.0

// A program of another project that improves its own mesh and reads no files.
#include <cstdio>

#include <tetwright/simplify.h>

int main() {
  tetwright::TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.materials = {1};
  const tetwright::TetMesh improved = tetwright::improve(mesh, {});
  std::printf("%zu tets\n", improved.tets.size());
  return improved.tets.empty() ? 1 : 0;
}
