// SPDX-License-Identifier: Apache-2.0
#include "mesher/domain/material_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <new>

#include "common/tolerances.h"
#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

MaterialField::MaterialField(const GridFrame& voxels, std::vector<FieldRegion> regions, double band,
                             int refinement)
    : voxels_(voxels),
      frame_(refined_frame(voxels, refinement)),
      regions_(std::move(regions)),
      refinement_(refinement),
      band_(std::ldexp(band, refinement)) {}

MaterialField::~MaterialField() = default;

double FieldSampler::between(RegionIndex a, RegionIndex b, const Vec3& point, Vec3& gradient) {
  const RegionIndex both[2] = {a, b};
  double values[2];
  Vec3 gradients[2];
  values_and_gradients(point, both, values, gradients);
  gradient = 0.5 * (gradients[0] - gradients[1]);
  return 0.5 * (values[0] - values[1]);
}

bool FieldSampler::project(const RegionSet& regions, Vec3& point, unsigned held_axes) {
  const double smallest_slope = DistanceTuning::Projection::min_slope_share * min_slope_ * min_slope_;
  const double damping = DistanceTuning::Projection::damping_share * min_slope_ * min_slope_;
  // The accuracy of distances depends on the voxel size. Small cells need a small fraction of their own size.
  const double enough = std::min(tolerance::on_interface * per_voxel_, tolerance::on_interface_of_cell);
  const int equations = regions.size() - 1;
  if (equations < 1) return false;
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> slopes(equations, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> misses(equations);
  double values[RegionSet::capacity];
  Vec3 gradients[RegionSet::capacity];
  for (int step = 0; step < DistanceTuning::Projection::steps; ++step) {
    values_and_gradients(point, {regions.begin(), regions.end()}, values, gradients);
    double worst = 0;
    for (int k = 0; k < equations; ++k) {
      misses[k] = 0.5 * (values[0] - values[k + 1]);
      slopes.row(k) = 0.5 * (gradients[0] - gradients[k + 1]).transpose();
      worst = std::max(worst, std::abs(misses[k]));
    }
    for (int a = 0; a < 3; ++a)
      if (held_axes >> a & 1) slopes.col(a).setZero();
    if (worst < enough) {
      const RegionIndex there = nearest(point).region;
      if (regions.contains(there)) return true;
      float third;
      this->values(point, {&there, 1}, &third);
      return third > values[0] - 2 * enough;
    }
    if (equations == 1) {
      const double slope = slopes.row(0).squaredNorm();
      if (slope < smallest_slope) return false;
      point -= slopes.row(0).transpose() * (misses[0] / slope);
    } else {
      // The shortest step that makes all distances equal to first order.
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> square = slopes * slopes.transpose();
      square.diagonal().array() += damping;
      point -= slopes.transpose() * square.partialPivLu().solve(misses);
    }
  }
  return false;
}

/// Borrows one of the field's samplers for the lifetime of this object.
class MaterialField::BorrowedSampler {
 public:
  explicit BorrowedSampler(const MaterialField& field) : field_(field) {
    {
      const std::lock_guard lock(field_.samplers_mutex_);
      if (!field_.samplers_.empty()) {
        sampler_ = std::move(field_.samplers_.back());
        field_.samplers_.pop_back();
      }
    }
    if (!sampler_) sampler_ = field_.sampler();
  }
  ~BorrowedSampler() {
    const std::lock_guard lock(field_.samplers_mutex_);
    try {
      field_.samplers_.push_back(std::move(sampler_));
    } catch (const std::bad_alloc&) {  // the next call makes another one
    }
  }
  BorrowedSampler(const BorrowedSampler&) = delete;
  BorrowedSampler& operator=(const BorrowedSampler&) = delete;
  FieldSampler* operator->() const { return sampler_.get(); }

 private:
  const MaterialField& field_;
  std::unique_ptr<FieldSampler> sampler_;
};

std::optional<RegionIndex> MaterialField::find(MaterialOrOutside region) const {
  if (!region) return outside_region;
  // The outside has a name and a tag only if it is meshed.
  for (std::size_t r = regions_[outside_region].name.empty() ? 1 : 0; r < regions_.size(); ++r)
    if (regions_[r].tag == *region) return static_cast<RegionIndex>(r);
  return std::nullopt;
}

double MaterialField::signed_distance(const Vec3& point, MaterialTag material) const {
  const std::optional<RegionIndex> region = find(material);
  float value = static_cast<float>(band_);
  if (region) BorrowedSampler(*this)->values(frame_.to_grid(point), {&*region, 1}, &value);
  return frame_.cell_size * value;
}

std::optional<Vec3> MaterialField::project(const Vec3& point, MaterialOrOutside first,
                                           MaterialOrOutside second, double max_distance) const {
  const std::optional<RegionIndex> a = find(first), b = find(second);
  if (!a || !b || *a == *b) return std::nullopt;
  RegionSet both;
  both.insert(*a);
  both.insert(*b);
  const Vec3 start = frame_.to_grid(point);
  Vec3 end = start;
  if (!BorrowedSampler(*this)->project(both, end)) return std::nullopt;
  if ((end - start).norm() * frame_.cell_size > max_distance) return std::nullopt;
  return frame_.to_input(end);
}

}  // namespace tetwright
