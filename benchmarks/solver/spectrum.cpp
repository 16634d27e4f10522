// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/solver/spectrum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "common/random.h"

namespace tetwright {

namespace {

/// Relative error of a Ritz value that is sufficient for a table.
constexpr double ritz_tolerance = 1e-6;
/// Maximum number of Lanczos steps; extreme eigenvalues of finite element matrices take several tens.
constexpr int max_steps = 3000;
constexpr int steps_between_tests = 10;

struct RitzValue {
  double value;
  double error;  ///< maximum distance from the nearest eigenvalue
};

/// Largest eigenvalue of the tridiagonal Lanczos matrix, and the residual norm of its vector.
RitzValue largest_ritz_value(const std::vector<double>& diagonal, const std::vector<double>& off_diagonal) {
  const auto n = static_cast<Eigen::Index>(diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal.data(), n),
                                Eigen::Map<const Eigen::VectorXd>(off_diagonal.data(), n - 1));
  return {solver.eigenvalues()[n - 1], std::abs(off_diagonal[n - 1] * solver.eigenvectors()(n - 1, n - 1))};
}

}  // namespace

ElementEigenvalues largest_element_eigenvalues(const TetMesh& mesh, const Elasticity& material, double edge) {
  ElementEigenvalues largest;
  for (const Tet& t : mesh.tets) {
    const LinearTet tet(corners_of(mesh, t));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> heat(heat_stiffness(tet), Eigen::EigenvaluesOnly);
    const Eigen::SelfAdjointEigenSolver<ElasticMatrix> elastic(elastic_stiffness(tet, material),
                                                               Eigen::EigenvaluesOnly);
    largest.heat = std::max(largest.heat, heat.eigenvalues()[3]);
    largest.elastic = std::max(largest.elastic, elastic.eigenvalues()[11]);
  }
  return {largest.heat / edge, largest.elastic / (edge * material.young)};
}

double mean_regular_edge(const TetMesh& mesh) {
  const double mean_volume = point_volumes(mesh).sum() / static_cast<double>(mesh.tets.size());
  return std::cbrt(6 * std::sqrt(2.0) * mean_volume);  // the volume of the regular tet is edge^3 / (6 sqrt 2)
}

double largest_frequency(const SparseMatrix& stiffness, const Eigen::VectorXd& masses) {
  // K x = w^2 M x has the eigenvalues of the symmetric M^-1/2 K M^-1/2.
  const Eigen::VectorXd scale = masses.cwiseSqrt().cwiseInverse();
  Random random(1);
  Eigen::VectorXd vector(masses.size()), previous = Eigen::VectorXd::Zero(masses.size());
  for (double& x : vector) x = 2 * random.uniform() - 1;
  vector.normalize();
  std::vector<double> diagonal, off_diagonal;
  for (int step = 1; step <= max_steps; ++step) {
    Eigen::VectorXd next = scale.cwiseProduct(stiffness * scale.cwiseProduct(vector));
    if (step > 1) next -= off_diagonal.back() * previous;
    diagonal.push_back(next.dot(vector));
    next -= diagonal.back() * vector;
    off_diagonal.push_back(next.norm());
    // A small mesh may have no further eigenvectors with a component in the start vector.
    const bool exhausted = off_diagonal.back() <= ritz_tolerance * diagonal.front() || step == masses.size();
    if (exhausted || step % steps_between_tests == 0) {
      const RitzValue ritz = largest_ritz_value(diagonal, off_diagonal);
      if (exhausted || ritz.error <= ritz_tolerance * ritz.value) return std::sqrt(ritz.value + ritz.error);
    }
    previous = vector;
    vector = next / off_diagonal.back();
  }
  throw std::runtime_error("the largest frequency was not found in " + std::to_string(max_steps) + " steps");
}

}  // namespace tetwright
