// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "benchmarks/solver/linear_elements.h"

namespace tetwright {

/// The largest eigenvalues of the element stiffness matrices, which bound that of the whole matrix from above
/// by the number of tets at a point (Shewchuk, "What is a good linear finite element?", 2002, section 3).
struct ElementEigenvalues {
  double heat = 0;
  double elastic = 0;
};

/// Over all tets, divided by `edge`, a length of the mesh, and by Young's modulus: without dimension, and in
/// the same units for meshes of the same size.
ElementEigenvalues largest_element_eigenvalues(const TetMesh& mesh, const Elasticity& material, double edge);

/// The edge of the regular tet of the mesh's mean volume.
double mean_regular_edge(const TetMesh& mesh);

/// The largest angular frequency w of K x = w^2 M x, where M is the diagonal `masses` (> 0) and K is
/// symmetric: central differences in time are stable up to a step of 2 / w. By the Lanczos iteration from a
/// random vector; the largest Ritz value and the bound of its error are added, so that a step from it is
/// stable, and the bound is below 1e-6 of it. Throws std::runtime_error if it does not get there.
double largest_frequency(const SparseMatrix& stiffness, const Eigen::VectorXd& masses);

}  // namespace tetwright
