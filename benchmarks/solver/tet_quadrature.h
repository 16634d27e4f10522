// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A quadrature point: its barycentric coordinates, and its fraction of the tet's volume.
struct TetQuadraturePoint {
  Eigen::Vector4d barycentric;
  double weight;

  Vec3 in(const std::array<Vec3, 4>& corners) const {
    return barycentric[0] * corners[0] + barycentric[1] * corners[1] + barycentric[2] * corners[2] +
           barycentric[3] * corners[3];
  }
};

/// Four Gauss points along each axis of a cube collapsed to the tet (Stroud, "Approximate Calculation of
/// Multiple Integrals", 1971, section 2.5): 64 points inside the tet with positive weights, exact for
/// polynomials of degree 5. The weights add up to 1.
const std::vector<TetQuadraturePoint>& tet_quadrature();

}  // namespace tetwright
