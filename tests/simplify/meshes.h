// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/random.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// n.x by n.y by n.z unit cubes of six tets each (Kuhn 1960: all around the diagonal, so neighbours agree).
/// Points without a tet are omitted.
///
/// \param material returns the tag of the cube at these coordinates; std::nullopt for no cube.
inline TetMesh grid_mesh(std::array<int, 3> n,
                         const std::function<std::optional<MaterialTag>(int, int, int)>& material) {
  TetMesh mesh;
  const auto number = [&](int x, int y, int z) {
    return static_cast<Index>(x + (n[0] + 1) * (y + (n[1] + 1) * z));
  };
  constexpr int paths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const auto tag = material(x, y, z);
        if (!tag) continue;
        for (int k = 0; k < 6; ++k) {
          std::array<int, 3> at{x, y, z};
          Tet t;
          t[0] = number(at[0], at[1], at[2]);
          for (int i = 0; i < 3; ++i) {
            ++at[paths[k][i]];
            t[i + 1] = number(at[0], at[1], at[2]);
          }
          if (k >= 3) std::swap(t[2], t[3]);  // odd paths have the opposite orientation
          mesh.tets.push_back(t);
          mesh.materials.push_back(*tag);
        }
      }
  std::vector<Index> new_number(static_cast<std::size_t>((n[0] + 1) * (n[1] + 1) * (n[2] + 1)), no_index);
  for (Tet& t : mesh.tets)
    for (Index& p : t) {
      if (new_number[p] == no_index) {
        new_number[p] = static_cast<Index>(mesh.points.size());
        mesh.points.emplace_back(p % (n[0] + 1), p / (n[0] + 1) % (n[1] + 1), p / ((n[0] + 1) * (n[1] + 1)));
      }
      p = new_number[p];
    }
  return mesh;
}

inline TetMesh grid_mesh(int n) {
  return grid_mesh({n, n, n}, [](int, int, int) { return std::optional<MaterialTag>(1); });
}

/// Moves every point slightly, without inverting a tet of grid_mesh.
inline void jitter(TetMesh& mesh, std::uint64_t seed, double amount = 0.1) {
  Random random(seed);
  // One statement each: the order in which arguments are evaluated depends on the compiler.
  for (Vec3& p : mesh.points)
    for (int a = 2; a >= 0; --a) p[a] += amount * (random.uniform() - 0.5);
}

}  // namespace tetwright
