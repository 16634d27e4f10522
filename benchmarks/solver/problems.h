// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "benchmarks/solver/linear_elements.h"

namespace tetwright {

/// Iterations of conjugate gradients with diagonal preconditioner (Eigen's), started at zero, until the
/// residual is below 1e-8 of the right-hand side.
struct Iterations {
  int heat = 0;     ///< unit source, temperature 0 on the held part
  int elastic = 0;  ///< gravity, the held part clamped
};

/// Solves both problems. The held part consists of the boundary points in the lowest tenth of the bounding
/// box along its longest axis. Gravity acts along the next axis and bends the body.
///
/// \throws std::runtime_error if conjugate gradients do not converge.
Iterations count_iterations(const TetMesh& mesh, const SparseMatrix& heat, const SparseMatrix& elastic);

/// Relative errors of the solution of a Poisson problem, in the norm of the exact solution.
struct PoissonErrors {
  double l2 = 0;
  double energy = 0;  ///< L2 error of the gradient
  /// Energy error of the interpolated exact solution; no solver can be much better.
  double interpolation = 0;
};

/// Solves -div grad u = f with the exact u at the boundary points. u is a sum of three plane waves fixed in
/// space, so that the errors depend only on how the tets resolve a smooth field, not on how well a mesh fits
/// the body's surface.
///
/// \param wavelengths number of wavelengths in the diagonal of the bounding box.
PoissonErrors poisson_errors(const TetMesh& mesh, const SparseMatrix& heat, double wavelengths = 2);

}  // namespace tetwright
