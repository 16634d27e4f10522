// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

using SparseMatrix = Eigen::SparseMatrix<double>;
using ElasticMatrix = Eigen::Matrix<double, 12, 12>;

/// An isotropic material: Young's modulus and Poisson's ratio.
struct Elasticity {
  double young = 1;
  double poisson = 0.3;
};

/// What linear finite elements need of a tet: its volume and the constant gradients of the four functions
/// that are 1 at one vertex and 0 at the others. The tet must be positive.
struct LinearTet {
  double volume;
  std::array<Vec3, 4> gradients;
  explicit LinearTet(const std::array<Vec3, 4>& corners);
};

std::array<Vec3, 4> corners_of(const TetMesh& mesh, const Tet& tet);

/// Stiffness matrix of a tet for -div grad u, unit conductivity.
Eigen::Matrix4d heat_stiffness(const LinearTet& tet);
/// Stiffness matrix of a tet for linear elasticity; unknown 3 i + a is the displacement of vertex i along
/// axis a.
ElasticMatrix elastic_stiffness(const LinearTet& tet, const Elasticity& material);

/// The matrices of a mesh, whole, with no boundary condition. All tets must be positive.
SparseMatrix heat_matrix(const TetMesh& mesh);
SparseMatrix elastic_matrix(const TetMesh& mesh, const Elasticity& material);

/// The volume that each point stands for: a quarter of each of its tets. Unit density times this is the
/// lumped mass.
Eigen::VectorXd point_volumes(const TetMesh& mesh);

/// Flags of the points of faces that belong to one tet only.
std::vector<std::uint8_t> boundary_points(const TetMesh& mesh);

/// Takes out the points that no tet uses, for which a matrix would have an empty row.
void remove_unused_points(TetMesh& mesh);

/// The equations of the unknowns that are free when those flagged in `fixed` have the values in `values`.
struct FreeSystem {
  SparseMatrix matrix;
  Eigen::VectorXd right_side;
  std::vector<Eigen::Index> free_to_all;

  FreeSystem(const SparseMatrix& all, const Eigen::VectorXd& load, const std::vector<std::uint8_t>& fixed,
             const Eigen::VectorXd& values);
  /// The whole solution: `values` with the free ones replaced.
  Eigen::VectorXd expand(const Eigen::VectorXd& solution, Eigen::VectorXd values) const;
};

}  // namespace tetwright
