// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/body_field.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright {

/// Surfaces as materials 1, 2, ... called m1, m2, ..., followed by layers called l1, l2, ...
inline MesherInput make_input(const std::vector<TriangleMesh>& surfaces,
                              const std::vector<double>& layers = {}) {
  std::vector<MaterialSurface> bodies;
  MaterialTag tag = 0;
  for (const TriangleMesh& s : surfaces) {
    ++tag;
    bodies.push_back({"m" + std::to_string(tag), tag, s, "m" + std::to_string(tag) + ".ply"});
  }
  std::vector<MaterialLayer> shells;
  for (std::size_t i = 0; i < layers.size(); ++i)
    shells.push_back({"l" + std::to_string(i + 1), ++tag, layers[i]});
  return make_mesher_input(std::move(bodies), std::move(shells));
}

inline std::shared_ptr<const MaterialField> make_field(const std::vector<TriangleMesh>& surfaces, double cell,
                                                       const std::vector<double>& layers = {},
                                                       bool uniform = false) {
  const MesherInput input = make_input(surfaces, layers);
  return build_field(input, make_grid_frame(input.low, input.high, cell, uniform), false, {}, {}, {}, nullptr)
      .field;
}

}  // namespace tetwright
