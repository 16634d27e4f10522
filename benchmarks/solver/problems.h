// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "benchmarks/solver/linear_elements.h"

namespace tetwright {

/// Conjugate gradients with the diagonal as preconditioner (Eigen's), from zero, until the residual is below
/// 1e-8 of the right side.
struct Iterations {
  int heat = 0;     ///< unit source, temperature 0 on the held part
  int elastic = 0;  ///< gravity, the held part clamped
};

/// The held part are the points of the boundary in the lowest tenth of the bounding box along its longest
/// axis; gravity pulls along the next axis, and bends the body. Throws std::runtime_error where conjugate
/// gradients do not converge.
Iterations count_iterations(const TetMesh& mesh, const SparseMatrix& heat, const SparseMatrix& elastic);

/// Errors of the solution of a Poisson problem, in shares of the exact solution's norm.
struct PoissonErrors {
  double l2 = 0;
  double energy = 0;  ///< of the gradient
  double interpolation =
      0;  ///< the energy error of the exact values at the points: what no solver can beat by much
};

/// Solves -div grad u = f with the exact u at the boundary's points. u is a sum of three plane waves, the
/// same everywhere in space, so that how well a mesh follows a body's surface does not come into it, but only
/// what its tets make of a smooth field. `wavelengths` fit into the diagonal of the bounding box.
PoissonErrors poisson_errors(const TetMesh& mesh, const SparseMatrix& heat, double wavelengths = 2);

}  // namespace tetwright
