// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/solver/linear_elements.h"

#include <utility>

#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

/// Sums element matrices with `components` unknowns at each vertex into the matrix of the mesh.
template <class ElementMatrix>
SparseMatrix assemble(const TetMesh& mesh, int components, ElementMatrix element_matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  const std::size_t unknowns_of_tet = 4 * static_cast<std::size_t>(components);
  entries.reserve(mesh.tets.size() * unknowns_of_tet * unknowns_of_tet);
  for (const Tet& tet : mesh.tets) {
    const auto element = element_matrix(LinearTet(corners_of(mesh, tet)));
    const auto unknown = [&](int local) {
      return static_cast<int>(tet[local / components]) * components + local % components;
    };
    for (int i = 0; i < element.rows(); ++i)
      for (int j = 0; j < element.cols(); ++j) entries.emplace_back(unknown(i), unknown(j), element(i, j));
  }
  const auto unknowns = static_cast<Eigen::Index>(mesh.points.size()) * components;
  SparseMatrix matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

LinearTet::LinearTet(const std::array<Vec3, 4>& corners) {
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], c = corners[3] - corners[0];
  const double determinant = a.cross(b).dot(c);
  volume = determinant / 6;
  gradients[1] = b.cross(c) / determinant;
  gradients[2] = c.cross(a) / determinant;
  gradients[3] = a.cross(b) / determinant;
  gradients[0] = -(gradients[1] + gradients[2] + gradients[3]);
}

std::array<Vec3, 4> corners_of(const TetMesh& mesh, const Tet& tet) {
  return {mesh.points[tet[0]], mesh.points[tet[1]], mesh.points[tet[2]], mesh.points[tet[3]]};
}

Eigen::Matrix4d heat_stiffness(const LinearTet& tet) {
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix(i, j) = tet.volume * tet.gradients[i].dot(tet.gradients[j]);
  return matrix;
}

ElasticMatrix elastic_stiffness(const LinearTet& tet, const Elasticity& material) {
  const double shear = material.young / (2 * (1 + material.poisson));  // Lame's constants
  const double lambda =
      material.young * material.poisson / ((1 + material.poisson) * (1 - 2 * material.poisson));
  ElasticMatrix matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const Vec3 &p = tet.gradients[i], &q = tet.gradients[j];
      matrix.block<3, 3>(3 * i, 3 * j) =
          tet.volume * (lambda * p * q.transpose() + shear * q * p.transpose() +
                        shear * p.dot(q) * Eigen::Matrix3d::Identity());
    }
  return matrix;
}

SparseMatrix heat_matrix(const TetMesh& mesh) {
  return assemble(mesh, 1, [](const LinearTet& tet) { return heat_stiffness(tet); });
}

SparseMatrix elastic_matrix(const TetMesh& mesh, const Elasticity& material) {
  return assemble(mesh, 3, [&](const LinearTet& tet) { return elastic_stiffness(tet, material); });
}

Eigen::VectorXd point_volumes(const TetMesh& mesh) {
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.points.size()));
  for (const Tet& tet : mesh.tets) {
    const double quarter = LinearTet(corners_of(mesh, tet)).volume / 4;
    for (const Index id : tet) volumes[id] += quarter;
  }
  return volumes;
}

std::vector<std::uint8_t> boundary_points(const TetMesh& mesh) {
  std::vector<std::uint8_t> flags(mesh.points.size(), 0);
  for (const MeshFace& face : mesh_faces(mesh.tets, mesh.points.size()))
    if (face.second == no_index)
      for (const Index id : face.ids) flags[id] = 1;
  return flags;
}

void remove_unused_points(TetMesh& mesh) {
  std::vector<Index> old_to_new(mesh.points.size(), no_index);
  std::vector<Vec3> used;
  for (Tet& tet : mesh.tets)
    for (Index& id : tet) {
      if (old_to_new[id] == no_index) {
        old_to_new[id] = static_cast<Index>(used.size());
        used.push_back(mesh.points[id]);
      }
      id = old_to_new[id];
    }
  mesh.points = std::move(used);
  mesh.interfaces.clear();
  mesh.patch_groups.clear();
  mesh.point_fields.clear();
}

FreeSystem::FreeSystem(const SparseMatrix& all, const Eigen::VectorXd& load,
                       const std::vector<std::uint8_t>& fixed, const Eigen::VectorXd& values) {
  constexpr Eigen::Index none = -1;
  std::vector<Eigen::Index> all_to_free(fixed.size(), none);
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) {
      all_to_free[i] = static_cast<Eigen::Index>(free_to_all.size());
      free_to_all.push_back(static_cast<Eigen::Index>(i));
    }
  const auto count = static_cast<Eigen::Index>(free_to_all.size());
  right_side.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) right_side[i] = load[free_to_all[i]];
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(all.nonZeros()));
  for (Eigen::Index column = 0; column < all.outerSize(); ++column)
    for (SparseMatrix::InnerIterator it(all, column); it; ++it) {
      const Eigen::Index row = all_to_free[it.row()];
      if (row == none) continue;
      if (fixed[column])
        right_side[row] -= it.value() * values[column];
      else
        entries.emplace_back(static_cast<int>(row), static_cast<int>(all_to_free[column]), it.value());
    }
  matrix.resize(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
}

Eigen::VectorXd FreeSystem::expand(const Eigen::VectorXd& solution, Eigen::VectorXd values) const {
  for (std::size_t i = 0; i < free_to_all.size(); ++i)
    values[free_to_all[i]] = solution[static_cast<Eigen::Index>(i)];
  return values;
}

}  // namespace tetwright
