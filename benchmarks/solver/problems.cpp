// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/solver/problems.h"

#include <Eigen/IterativeLinearSolvers>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "benchmarks/solver/tet_quadrature.h"

namespace tetwright {

namespace {

/// Relative residual at which iterations stop, a common choice in engineering.
constexpr double iterations_tolerance = 1e-8;
/// Relative residual far below the discretisation errors to be measured.
constexpr double poisson_tolerance = 1e-11;
/// Fraction of the bounding box that is held.
constexpr double held_share = 0.1;

using ConjugateGradient = Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper,
                                                   Eigen::DiagonalPreconditioner<double>>;

struct Solved {
  Eigen::VectorXd solution;
  int iterations;
};

Solved solve(const FreeSystem& system, double tolerance) {
  ConjugateGradient solver;
  solver.setTolerance(tolerance);
  solver.compute(system.matrix);
  Solved result{solver.solve(system.right_side), static_cast<int>(solver.iterations())};
  if (solver.info() != Eigen::Success)
    throw std::runtime_error("conjugate gradients did not converge in " + std::to_string(result.iterations) +
                             " iterations");
  return result;
}

Eigen::AlignedBox3d bounding_box(const TetMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.points) box.extend(p);
  return box;
}

/// Three plane waves in orthogonal directions, none along an axis.
class PlaneWaves {
 public:
  PlaneWaves(const Eigen::AlignedBox3d& box, double wavelengths)
      : origin_(box.min()), number_(2 * std::numbers::pi * wavelengths / box.diagonal().norm()) {
    directions_ << 1, 2, 2, 2, 1, -2, 2, -2, 1;
    directions_ /= 3;
  }
  double value(const Vec3& p) const { return phases(p).array().sin().sum(); }
  Vec3 gradient(const Vec3& p) const {
    return number_ * (directions_.transpose() * phases(p).array().cos().matrix());
  }
  /// -div grad u.
  double source(const Vec3& p) const { return number_ * number_ * value(p); }

 private:
  Vec3 phases(const Vec3& p) const {
    return number_ * (directions_ * (p - origin_)) +
           Vec3(0, 1, 2);  // otherwise all three waves vanish at the origin
  }
  Vec3 origin_;
  double number_;  ///< wave number, radians per input unit
  Eigen::Matrix3d directions_;
};

Eigen::VectorXd source_load(const TetMesh& mesh, const PlaneWaves& exact) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.points.size()));
  for (const Tet& tet : mesh.tets) {
    const auto corners = corners_of(mesh, tet);
    const double volume = LinearTet(corners).volume;
    for (const TetQuadraturePoint& q : tet_quadrature()) {
      const double source = exact.source(q.in(corners));
      for (int i = 0; i < 4; ++i) load[tet[i]] += volume * q.weight * q.barycentric[i] * source;
    }
  }
  return load;
}

struct RelativeErrors {
  double l2, energy;
};

/// Errors of the linear field with these values at the points.
RelativeErrors errors_of(const TetMesh& mesh, const PlaneWaves& exact, const Eigen::VectorXd& values) {
  double l2 = 0, l2_exact = 0, energy = 0, energy_exact = 0;
  for (const Tet& t : mesh.tets) {
    const auto corners = corners_of(mesh, t);
    const LinearTet tet(corners);
    const Eigen::Vector4d at_corners(values[t[0]], values[t[1]], values[t[2]], values[t[3]]);
    Vec3 gradient = Vec3::Zero();
    for (int i = 0; i < 4; ++i) gradient += at_corners[i] * tet.gradients[i];
    for (const TetQuadraturePoint& q : tet_quadrature()) {
      const Vec3 p = q.in(corners);
      const double weight = tet.volume * q.weight, value = exact.value(p);
      const Vec3 slope = exact.gradient(p);
      l2 += weight * std::pow(q.barycentric.dot(at_corners) - value, 2);
      l2_exact += weight * value * value;
      energy += weight * (gradient - slope).squaredNorm();
      energy_exact += weight * slope.squaredNorm();
    }
  }
  return {std::sqrt(l2 / l2_exact), std::sqrt(energy / energy_exact)};
}

}  // namespace

Iterations count_iterations(const TetMesh& mesh, const SparseMatrix& heat, const SparseMatrix& elastic) {
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const double level = box.min()[axis] + held_share * box.sizes()[axis];
  const auto boundary = boundary_points(mesh);
  const Eigen::VectorXd volumes = point_volumes(mesh);
  std::vector<std::uint8_t> cold(mesh.points.size(), 0), clamped(3 * mesh.points.size(), 0);
  Eigen::VectorXd gravity = Eigen::VectorXd::Zero(3 * volumes.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    cold[i] = boundary[i] && mesh.points[i][axis] <= level;
    for (std::size_t a = 0; a < 3; ++a) clamped[3 * i + a] = cold[i];
    gravity[static_cast<Eigen::Index>(3 * i) + (axis + 1) % 3] = volumes[static_cast<Eigen::Index>(i)];
  }
  const FreeSystem heat_system(heat, volumes, cold, Eigen::VectorXd::Zero(volumes.size()));
  const FreeSystem elastic_system(elastic, gravity, clamped, Eigen::VectorXd::Zero(gravity.size()));
  return {solve(heat_system, iterations_tolerance).iterations,
          solve(elastic_system, iterations_tolerance).iterations};
}

PoissonErrors poisson_errors(const TetMesh& mesh, const SparseMatrix& heat, double wavelengths) {
  const PlaneWaves exact(bounding_box(mesh), wavelengths);
  Eigen::VectorXd values(static_cast<Eigen::Index>(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = exact.value(mesh.points[i]);
  const FreeSystem system(heat, source_load(mesh, exact), boundary_points(mesh), values);
  const Eigen::VectorXd solution = system.expand(solve(system, poisson_tolerance).solution, values);
  const RelativeErrors errors = errors_of(mesh, exact, solution);
  return {errors.l2, errors.energy, errors_of(mesh, exact, values).energy};
}

}  // namespace tetwright
