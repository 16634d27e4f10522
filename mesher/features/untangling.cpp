// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/untangling.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <deque>

#include "common/portable_math.h"
#include "mesher/tuning/cut_tuning.h"

namespace tetwright {

namespace {

using Eigen::Matrix3d;
using Eigen::VectorXd;
using Limits = CutTuning::Untangling;

/// The distortion of the tets of a mesh, as a function of the points that may move.
class Distortion {
 public:
  Distortion(std::vector<Vec3>& points, std::span<const Tet> tets, std::span<const PointFreedom> freedom)
      : points_(points), start_(points), tets_(tets), freedom_(freedom), first_(points.size()) {
    for (Index p = 0; p < points.size(); ++p) {
      first_[p] = size_of_position_;
      size_of_position_ += freedom[p].dimensions;
    }
    double volume = 0;
    for (const Tet& t : tets) volume += std::abs(edges(t).determinant()) / 6;
    volume /= static_cast<double>(std::max<std::size_t>(1, tets.size()));
    // The edges of a regular tet of the mean volume.
    Matrix3d regular;
    regular << 1, 0.5, 0.5, 0, std::sqrt(3) / 2, std::sqrt(3) / 6, 0, 0, std::sqrt(2.0 / 3);
    size_ = portable_cbrt(6 * volume / regular.determinant());
    from_regular_ = (size_ * regular).inverse();
  }

  /// Edge of a regular tet of the mean volume.
  double size() const { return size_; }
  /// How far all points have moved in their directions.
  VectorXd position() const {
    VectorXd x(size_of_position_);
    for (Index p = 0; p < points_.size(); ++p)
      for (int k = 0; k < freedom_[p].dimensions; ++k)
        x[first_[p] + k] = freedom_[p].directions[k].dot(points_[p] - start_[p]);
    return x;
  }
  void move_to(const VectorXd& x) {
    for (Index p = 0; p < points_.size(); ++p) {
      if (freedom_[p].dimensions == 0) continue;
      points_[p] = start_[p];
      for (int k = 0; k < freedom_[p].dimensions; ++k)
        points_[p] += x[first_[p] + k] * freedom_[p].directions[k];
    }
  }
  double min_determinant() const {
    double least = INFINITY;
    for (const Tet& t : tets_) least = std::min(least, (edges(t) * from_regular_).determinant());
    return least;
  }

  /// Positive, about equal to the determinant where that is large, and to nothing where it is negative.
  static double regularised(double determinant, double epsilon) {
    return (determinant + length(epsilon, determinant)) / 2;
  }

  /// \param gradient receives the derivatives by the coordinates of the points that may move
  double value(double epsilon, VectorXd* gradient) const {
    double sum = 0;
    if (gradient) *gradient = VectorXd::Zero(size_of_position_);
    for (const Tet& t : tets_) {
      const Matrix3d j = edges(t) * from_regular_;
      const double determinant = j.determinant(), chi = regularised(determinant, epsilon);
      const double per_root = portable_inverse_cbrt(chi), shrink = per_root * per_root;
      const double shape = j.squaredNorm() * shrink;
      const double size = (1 + determinant * determinant) / chi;
      sum += shape + size;
      if (!gradient) continue;
      Matrix3d cofactor;
      cofactor.col(0) = j.col(1).cross(j.col(2));
      cofactor.col(1) = j.col(2).cross(j.col(0));
      cofactor.col(2) = j.col(0).cross(j.col(1));
      const double chi_slope = (1 + determinant / length(epsilon, determinant)) / 2;
      const double slope =
          -2.0 / 3 * shape / chi * chi_slope + 2 * determinant / chi - size / chi * chi_slope;
      const Matrix3d by_edges = (2 * shrink * j + slope * cofactor) * from_regular_.transpose();
      add(t[0], -by_edges.rowwise().sum(), *gradient);
      for (int k = 0; k < 3; ++k) add(t[k + 1], by_edges.col(k), *gradient);
    }
    return sum;
  }

 private:
  /// Much faster than std::hypot(): neither is near the limits of numbers.
  static double length(double a, double b) { return std::sqrt(a * a + b * b); }
  Matrix3d edges(const Tet& t) const {
    Matrix3d e;
    for (int k = 0; k < 3; ++k) e.col(k) = points_[t[k + 1]] - points_[t[0]];
    return e;
  }
  void add(Index p, const Vec3& slope, VectorXd& gradient) const {
    for (int k = 0; k < freedom_[p].dimensions; ++k)
      gradient[first_[p] + k] += freedom_[p].directions[k].dot(slope);
  }

  std::vector<Vec3>& points_;
  std::vector<Vec3> start_;
  std::span<const Tet> tets_;
  std::span<const PointFreedom> freedom_;
  std::vector<Eigen::Index> first_;  ///< by point, of its coordinates in position()
  Eigen::Index size_of_position_ = 0;
  double size_;
  Matrix3d from_regular_;
};

/// L-BFGS (Nocedal 1980) with halved steps.
/// \return the value reached
double minimise(Distortion& distortion, double epsilon) {
  VectorXd x = distortion.position(), gradient;
  double value = distortion.value(epsilon, &gradient);
  std::deque<std::pair<VectorXd, VectorXd>> pairs;  // steps and changes of the gradient, latest first
  for (int step = 0; step < Limits::max_steps; ++step) {
    VectorXd direction = -gradient;
    std::vector<double> weights;
    for (const auto& [s, y] : pairs) {
      weights.push_back(s.dot(direction) / s.dot(y));
      direction -= weights.back() * y;
    }
    if (!pairs.empty())
      direction *= pairs.front().first.dot(pairs.front().second) / pairs.front().second.squaredNorm();
    for (std::size_t i = pairs.size(); i-- > 0;)
      direction += (weights[i] - pairs[i].second.dot(direction) / pairs[i].first.dot(pairs[i].second)) *
                   pairs[i].first;
    const double slope = gradient.dot(direction);
    if (!(slope < 0)) break;
    double share = pairs.empty() ? Limits::first_step * distortion.size() / direction.norm() : 1;
    VectorXd next, next_gradient;
    double reached = INFINITY;
    for (int halving = 0; halving < Limits::max_halvings; ++halving, share /= 2) {
      next = x + share * direction;
      distortion.move_to(next);
      reached = distortion.value(epsilon, &next_gradient);
      if (reached <= value + Limits::sufficient_decrease * share * slope) break;
    }
    if (!(reached < value)) {
      distortion.move_to(x);
      break;
    }
    const bool has_arrived = value - reached < Limits::min_gain * value;
    if (const VectorXd y = next_gradient - gradient; y.dot(next - x) > 0) pairs.emplace_front(next - x, y);
    if (pairs.size() > Limits::memory) pairs.pop_back();
    x = std::move(next);
    gradient = std::move(next_gradient);
    value = reached;
    if (has_arrived) break;
  }
  return value;
}

}  // namespace

bool untangle(std::vector<Vec3>& points, std::span<const Tet> tets, std::span<const PointFreedom> freedom) {
  Distortion distortion(points, tets, freedom);
  if (!(distortion.size() > 0)) return false;
  double epsilon = 1;
  for (int round = 0; round < Limits::max_rounds; ++round) {
    const double before = distortion.value(epsilon, nullptr), after = minimise(distortion, epsilon);
    const double least = distortion.min_determinant();
    if (least > Limits::min_determinant) return true;
    const double gain = std::max(1 - after / before, Limits::min_reduction);
    const double aim = (1 - gain) * Distortion::regularised(least, epsilon);
    epsilon = least < aim ? 2 * std::sqrt(aim * (aim - least)) : Limits::min_epsilon;
  }
  return distortion.min_determinant() > 0;
}

}  // namespace tetwright
