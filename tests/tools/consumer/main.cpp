// SPDX-License-Identifier: Apache-2.0
// A program of another project that makes a mesh as shown in the README.
#include <tetwright/prepare.h>

#include <cstdio>

#include "common/error.h"

int main() {
  tetwright::TriangleMesh cube;
  for (int k = 0; k < 8; ++k) cube.points.emplace_back(k & 1, k >> 1 & 1, k >> 2);
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  tetwright::PrepareOptions options;
  options.target.tets = 2000;
  const tetwright::Prepared made = tetwright::prepare({{"cube", cube}}, options);
  std::printf("%zu tets\n", made.mesh.tets.size());
  for (const tetwright::Diagnostic& d : made.diagnostics())
    std::printf("%s: %s\n", tetwright::kind_of(d.code).name, tetwright::diagnostic_text(d).c_str());
  const consumer::Error result{made.falls_short()};
  return result.status;
}
