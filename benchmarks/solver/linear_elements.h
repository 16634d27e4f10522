// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

using SparseMatrix = Eigen::SparseMatrix<double>;
using ElasticMatrix = Eigen::Matrix<double, 12, 12>;

/// An isotropic material: Young's modulus and Poisson's ratio.
struct Elasticity {
  double young = 1;
  double poisson = 0.3;
};

/// A tet of linear finite elements: its volume and the constant gradients of the four basis functions, each
/// of which is 1 at one vertex and 0 at the others.
/// \pre The tet is positive.
struct LinearTet {
  double volume;
  std::array<Vec3, 4> gradients;
  explicit LinearTet(const std::array<Vec3, 4>& corners);
};

std::array<Vec3, 4> corners_of(const TetMesh& mesh, const Tet& tet);

/// Stiffness matrix of a tet for -div grad u with unit conductivity.
Eigen::Matrix4d heat_stiffness(const LinearTet& tet);
/// Stiffness matrix of a tet for linear elasticity; unknown 3 i + a is the displacement of vertex i along
/// axis a.
ElasticMatrix elastic_stiffness(const LinearTet& tet, const Elasticity& material);

/// Full matrices of a mesh, without boundary conditions.
/// \pre All tets are positive.
SparseMatrix heat_matrix(const TetMesh& mesh);
SparseMatrix elastic_matrix(const TetMesh& mesh, const Elasticity& material);

/// Volume of each point: a quarter of the volume of its tets. With unit density these are the lumped masses.
Eigen::VectorXd point_volumes(const TetMesh& mesh);

/// By point: 1 if it belongs to a face of exactly one tet.
std::vector<std::uint8_t> boundary_points(const TetMesh& mesh);

/// Removes points that no tet uses; a matrix would have empty rows for them.
void remove_unused_points(TetMesh& mesh);

/// Equations of the free unknowns; the unknowns flagged in `fixed` have the given `values`.
struct FreeSystem {
  SparseMatrix matrix;
  Eigen::VectorXd right_side;
  std::vector<Eigen::Index> free_to_all;

  FreeSystem(const SparseMatrix& all, const Eigen::VectorXd& load, const std::vector<std::uint8_t>& fixed,
             const Eigen::VectorXd& values);
  /// Full solution: `values`, with the free unknowns replaced.
  Eigen::VectorXd expand(const Eigen::VectorXd& solution, Eigen::VectorXd values) const;
};

}  // namespace tetwright
