// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "benchmarks/solver/linear_elements.h"

namespace tetwright {

/// Maximum eigenvalues of the element stiffness matrices. Multiplied by the number of tets at a point, they
/// are upper bounds for the full matrix (Shewchuk, "What is a good linear finite element?", 2002, section 3).
struct ElementEigenvalues {
  double heat = 0;
  double elastic = 0;
};

/// Maximum eigenvalues over all tets, divided by `edge`, a length of the mesh, and by Young's modulus:
/// dimensionless and comparable between meshes of the same size.
ElementEigenvalues largest_element_eigenvalues(const TetMesh& mesh, const Elasticity& material, double edge);

/// Edge of the regular tet with the mesh's mean tet volume.
double mean_regular_edge(const TetMesh& mesh);

/// Maximum angular frequency w of K x = w^2 M x, where M is diagonal: central differences in time are stable
/// up to a step of 2 / w. Lanczos iteration from a random vector. The result is the largest Ritz value plus
/// its error bound, so that a time step derived from it is stable; the bound is below 1e-6 of it.
///
/// \param stiffness K, symmetric.
/// \param masses diagonal of M, above 0.
/// \throws std::runtime_error if the bound is not reached.
double largest_frequency(const SparseMatrix& stiffness, const Eigen::VectorXd& masses);

}  // namespace tetwright
