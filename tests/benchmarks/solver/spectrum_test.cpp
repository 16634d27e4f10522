// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/solver/spectrum.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "benchmarks/remesher/lattice.h"

namespace tetwright {
namespace {

Eigen::VectorXd elastic_masses(const TetMesh& mesh) {
  const Eigen::VectorXd volumes = point_volumes(mesh);
  Eigen::VectorXd masses(3 * volumes.size());
  for (Eigen::Index i = 0; i < masses.size(); ++i) masses[i] = volumes[i / 3];
  return masses;
}

TEST(Spectrum, LargestFrequencyIsThatOfADenseSolver) {
  for (const double jitter : {0.0, 0.3}) {
    const TetMesh mesh = jittered_lattice(4, jitter, 3);
    const SparseMatrix stiffness = elastic_matrix(mesh, {});
    const Eigen::VectorXd masses = elastic_masses(mesh);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(
        Eigen::MatrixXd(stiffness), Eigen::MatrixXd(masses.asDiagonal()), Eigen::EigenvaluesOnly);
    const double exact = std::sqrt(dense.eigenvalues()[masses.size() - 1]);
    const double found = largest_frequency(stiffness, masses);
    EXPECT_GE(found, exact * (1 - 1e-12));  // a time step derived from it is stable
    EXPECT_LE(found, exact * (1 + 2e-6));
  }
}

/// Growth of central differences from a random state: bounded below the critical step, exceeding any bound
/// above it.
double growth(const SparseMatrix& stiffness, const Eigen::VectorXd& masses, double step) {
  Eigen::VectorXd now = Eigen::VectorXd::LinSpaced(masses.size(), -1, 1).array().sin(), before = now;
  const double start = now.norm();
  for (int i = 0; i < 2000; ++i) {
    const Eigen::VectorXd next =
        2 * now - before - step * step * (stiffness * now).cwiseQuotient(masses).eval();
    before = now;
    now = next;
  }
  return now.norm() / start;
}

TEST(Spectrum, CentralDifferencesAreStableUpToTheStep) {
  const TetMesh mesh = jittered_lattice(4, 0.3, 3);
  const SparseMatrix stiffness = elastic_matrix(mesh, {});
  const Eigen::VectorXd masses = elastic_masses(mesh);
  const double step = 2 / largest_frequency(stiffness, masses);
  EXPECT_LT(growth(stiffness, masses, 0.99 * step), 100);
  EXPECT_GT(growth(stiffness, masses, 1.01 * step), 1e10);
}

/// Regular tet with this edge length.
TetMesh regular_tet(double edge) {
  const double s = edge / std::sqrt(8.0);
  return {{{s, s, s}, {-s, -s, s}, {-s, s, -s}, {s, -s, -s}}, {{0, 1, 2, 3}}, {1}, {}};
}

TEST(Spectrum, ARegularTetHasTheEigenvalueOfTheClosedForm) {
  const TetMesh mesh = regular_tet(3);
  EXPECT_NEAR(mean_regular_edge(mesh), 3, 1e-12);
  // Volume / height^2 times 1 + 1/3, since gradients meet at the cosine -1/3.
  const ElementEigenvalues found = largest_element_eigenvalues(mesh, {}, 3);
  EXPECT_NEAR(found.heat, 1 / (3 * std::sqrt(2.0)), 1e-12);
}

TEST(Spectrum, ElementEigenvaluesBoundThoseOfTheMesh) {
  const TetMesh mesh = jittered_lattice(4, 0.3, 3);
  const ElementEigenvalues found = largest_element_eigenvalues(mesh, {}, 1);
  const auto largest = [](const SparseMatrix& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(Eigen::MatrixXd(matrix),
                                                                Eigen::EigenvaluesOnly);
    return solver.eigenvalues()[matrix.rows() - 1];
  };
  constexpr double tets_at_a_point = 24;  // in Kuhn's lattice
  for (const auto& [element, whole] : {std::pair{found.heat, largest(heat_matrix(mesh))},
                                       std::pair{found.elastic, largest(elastic_matrix(mesh, {}))}}) {
    EXPECT_LE(element, whole * (1 + 1e-12));
    EXPECT_LE(whole, tets_at_a_point * element);
  }
}

}  // namespace
}  // namespace tetwright
