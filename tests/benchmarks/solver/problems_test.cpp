// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/solver/problems.h"

#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/remesher/lattice.h"

namespace tetwright {
namespace {

PoissonErrors errors_of_box(int n) {
  const TetMesh mesh = jittered_lattice(n, 0.2, 5);
  return poisson_errors(mesh, heat_matrix(mesh));
}

TEST(Problems, PoissonErrorsConvergeAtTheRatesOfLinearElements) {
  const PoissonErrors coarse = errors_of_box(10), fine = errors_of_box(20);
  const double l2_rate = std::log2(coarse.l2 / fine.l2);
  const double energy_rate = std::log2(coarse.energy / fine.energy);
  EXPECT_NEAR(l2_rate, 2, 0.12);
  EXPECT_NEAR(energy_rate, 1, 0.06);
}

TEST(Problems, TheSolutionIsTheBestInTheEnergyNorm) {
  const PoissonErrors errors = errors_of_box(10);
  EXPECT_GT(errors.energy, 0.01);
  // The solution is the minimum over fields with these boundary values, one of which is the interpolation.
  EXPECT_LT(errors.energy, errors.interpolation);
}

TEST(Problems, IterationsDoNotDependOnUnits) {
  TetMesh mesh = jittered_lattice(8, 0.2, 5);
  const Iterations metres = count_iterations(mesh, heat_matrix(mesh), elastic_matrix(mesh, {}));
  for (Vec3& p : mesh.points) p *= 1024;  // exact, and so are all products
  const Iterations millimetres = count_iterations(mesh, heat_matrix(mesh), elastic_matrix(mesh, {}));
  EXPECT_EQ(metres.heat, millimetres.heat);
  EXPECT_EQ(metres.elastic, millimetres.elastic);
}

TEST(Problems, IterationsGrowWithTheNumberOfPointsAndWithBadShapes) {
  const auto iterations = [](int n, double jitter) {
    const TetMesh mesh = jittered_lattice(n, jitter, 5);
    return count_iterations(mesh, heat_matrix(mesh), elastic_matrix(mesh, {}));
  };
  const Iterations coarse = iterations(6, 0.1), fine = iterations(12, 0.1), bad = iterations(12, 0.33);
  EXPECT_NEAR(static_cast<double>(fine.heat) / coarse.heat, 2, 0.4);  // proportional to 1 / h
  EXPECT_GT(bad.heat, fine.heat);
  EXPECT_GT(bad.elastic, fine.elastic);
}

}  // namespace
}  // namespace tetwright
