// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/solver/linear_elements.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "benchmarks/remesher/lattice.h"

namespace tetwright {
namespace {

constexpr double rounding = 1e-12;  // relative, for sums of some thousand terms

/// A box of 750 tets of all shapes; inner points are moved by up to a fifth of an edge.
TetMesh irregular_box() { return jittered_lattice(5, 0.2, 7); }

/// Displacements of all points, concatenated.
template <class Field>
Eigen::VectorXd at_points(const TetMesh& mesh, Field field) {
  Eigen::VectorXd values(3 * static_cast<Eigen::Index>(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    values.segment<3>(static_cast<Eigen::Index>(3 * i)) = field(mesh.points[i]);
  return values;
}

/// Solution without load; the fixed unknowns have the values of `field`.
Eigen::VectorXd solve_from_boundary(const SparseMatrix& matrix, const std::vector<std::uint8_t>& fixed,
                                    const Eigen::VectorXd& field) {
  const FreeSystem system(matrix, Eigen::VectorXd::Zero(field.size()), fixed, field);
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system.matrix);
  return system.expand(solver.solve(system.right_side), Eigen::VectorXd::Constant(field.size(), 0) + field);
}

TEST(LinearElements, HeatPassesThePatchTest) {
  const TetMesh mesh = irregular_box();
  const auto fixed = boundary_points(mesh);
  Eigen::VectorXd exact(static_cast<Eigen::Index>(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    exact[static_cast<Eigen::Index>(i)] = 1 + Vec3(2, -3, 0.5).dot(mesh.points[i]);
  ASSERT_GT(std::count(fixed.begin(), fixed.end(), 0), 50);
  const Eigen::VectorXd solution = solve_from_boundary(heat_matrix(mesh), fixed, exact);
  EXPECT_LT((solution - exact).norm(), rounding * exact.norm());
}

TEST(LinearElements, ElasticityPassesThePatchTest) {
  const TetMesh mesh = irregular_box();
  const auto boundary = boundary_points(mesh);
  std::vector<std::uint8_t> fixed(3 * boundary.size());
  for (std::size_t i = 0; i < fixed.size(); ++i) fixed[i] = boundary[i / 3];
  Eigen::Matrix3d slope;
  slope << 1, 2, 3, -4, 5, 6, 0.7, 0.8, -0.9;
  const Eigen::VectorXd exact = at_points(mesh, [&](const Vec3& p) -> Vec3 { return slope * p; });
  const Eigen::VectorXd solution = solve_from_boundary(elastic_matrix(mesh, {}), fixed, exact);
  EXPECT_LT((solution - exact).norm(), rounding * exact.norm());
}

TEST(LinearElements, RigidMotionsMakeNoForce) {
  const TetMesh mesh = irregular_box();
  const SparseMatrix matrix = elastic_matrix(mesh, {});
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 unit = Vec3::Unit(axis);
    for (const Eigen::VectorXd& motion :
         {at_points(mesh, [&](const Vec3&) -> Vec3 { return unit; }),
          at_points(mesh, [&](const Vec3& p) -> Vec3 { return unit.cross(p); })})
      EXPECT_LT((matrix * motion).norm(), rounding * motion.norm());
  }
}

TEST(LinearElements, EnergyOfAUniformStrainIsTheClosedForm) {
  const TetMesh mesh = irregular_box();
  const double volume = 125;
  const Elasticity e{2.0, 0.25};
  const double shear = 0.8, lambda = 0.8;  // E / (2 (1 + nu)) and E nu / ((1 + nu) (1 - 2 nu))
  const SparseMatrix matrix = elastic_matrix(mesh, e);
  const auto energy = [&](const Eigen::VectorXd& u) { return u.dot(matrix * u); };
  const auto stretch = at_points(mesh, [](const Vec3& p) { return Vec3(p.x(), 0, 0); });
  EXPECT_NEAR(energy(stretch), (lambda + 2 * shear) * volume, rounding * volume);
  const auto slide = at_points(mesh, [](const Vec3& p) { return Vec3(p.y(), 0, 0); });
  EXPECT_NEAR(energy(slide), shear * volume, rounding * volume);
}

TEST(LinearElements, MatricesAreSymmetricAndVolumesAddUp) {
  const TetMesh mesh = irregular_box();
  const SparseMatrix matrix = elastic_matrix(mesh, {});
  EXPECT_LT(SparseMatrix(matrix - SparseMatrix(matrix.transpose())).norm(), rounding * matrix.norm());
  EXPECT_NEAR(point_volumes(mesh).sum(), 125, rounding * 125);
}

TEST(LinearElements, UnusedPointsAreRemoved) {
  TetMesh mesh = jittered_lattice(1, 0, 1);
  const SparseMatrix before = heat_matrix(mesh);
  mesh.points.insert(mesh.points.begin(), Vec3(9, 9, 9));
  for (Tet& tet : mesh.tets)
    for (Index& id : tet) ++id;
  remove_unused_points(mesh);
  EXPECT_EQ(mesh.points.size(), 8u);
  EXPECT_NEAR(heat_matrix(mesh).norm(), before.norm(), rounding);
}

}  // namespace
}  // namespace tetwright
