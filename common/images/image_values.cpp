// SPDX-License-Identifier: Apache-2.0
#include "tetwright/image_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/geometry/box_tree.h"
#include "common/images/grid_box.h"
#include "common/images/nearest_voxels.h"
#include "common/images/voxel_weights.h"
#include "common/message_text.h"
#include "common/parallel/parallel_sort.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr std::size_t tets_grain = 128, points_grain = 1024, voxels_grain = std::size_t{1} << 18;
constexpr std::size_t slices = 50, min_slice = 10'000;  // between reports of progress
/// Tets have a part outside the image, or voxels that count, only above this part of their volume: grids and
/// meshes of the same object meet up to rounding of the file's coordinates.
constexpr double negligible_part = 1e-6;

InputError elsewhere(const LabelGrid& image, const Box3& box, const std::string& image_name,
                     const std::string& other) {
  return boxes_apart(image_name, "no part of the image is in " + other, "the image", box_of(image), "that",
                     box);
}

/// Weighted statistics of voxels.
class VoxelStatistics {
 public:
  void add(double value, double weight, bool significant) {
    if (!any_) base_ = value;
    any_ = true;
    const double difference = value - base_;
    weight_ += weight;
    sum_ += weight * difference;
    squares_ += weight * difference * difference;
    if (!significant) return;
    minimum_ = std::min(minimum_, value);
    maximum_ = std::max(maximum_, value);
  }
  double weight() const { return weight_; }
  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }
  /// Rounding must not bring it outside the range of the values.
  double mean() const { return std::clamp(base_ + sum_ / weight_, minimum_, maximum_); }
  double deviation() const {
    const double mean = sum_ / weight_;
    return std::sqrt(std::max(0.0, squares_ / weight_ - mean * mean));
  }

 private:
  bool any_ = false;
  double base_ = 0, weight_ = 0, sum_ = 0, squares_ = 0;
  double minimum_ = std::numeric_limits<double>::infinity(),
         maximum_ = -std::numeric_limits<double>::infinity();
};

/// Groups of voxels that count at the points: those of all materials of the tets there.
class GroupsOfPoints {
 public:
  GroupsOfPoints(const TetMesh& mesh, const ImageMask& mask) : mask_(mask) {
    if (!mask.depends_on_material()) return;
    first_.assign(mesh.points.size(), 0);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const std::uint32_t group = mask.group_for(mesh.materials[t]);
      if (group == 0) continue;
      for (const Index p : mesh.tets[t])
        if (first_[p] == 0)
          first_[p] = group;
        else if (first_[p] != group)
          more_.emplace_back(p, group);
    }
    std::sort(more_.begin(), more_.end());
    more_.erase(std::unique(more_.begin(), more_.end()), more_.end());
  }
  bool has(Index p, std::uint32_t group) const {
    return first_.empty()
               ? group == 1
               : group == first_[p] || std::binary_search(more_.begin(), more_.end(), std::pair(p, group));
  }
  /// One of them; std::nullopt if there is none.
  std::optional<std::uint32_t> one(Index p) const {
    if (first_.empty()) return 1;
    return first_[p] == 0 ? std::nullopt : std::optional(first_[p]);
  }

 private:
  const ImageMask& mask_;
  std::vector<std::uint32_t> first_;  ///< of each point; 0: none; empty: group 1 counts everywhere
  std::vector<std::pair<Index, std::uint32_t>> more_;
};

/// The work of one call.
class Sampler {
 public:
  Sampler(const TetMesh& mesh, const ImageVolume& image, const ImageMask& mask,
          const ImageValueOptions& options, Progress* progress)
      : mesh_(mesh),
        image_(image),
        voxels_(image.channels.at(options.channel)),
        mask_(mask),
        options_(options),
        progress_(progress),
        to_index_(image.directions.inverse()),
        group_of_([this](std::size_t voxel) { return group_of(voxel); }) {}

  ImageValues take(const std::string& image_name, const std::string& mesh_name) {
    find_range();
    const std::size_t count = mesh_.tets.size();
    values_.mean.assign(count, 0);
    for (const auto& [asked, values] :
         {std::pair(options_.minimum, &values_.minimum), std::pair(options_.maximum, &values_.maximum),
          std::pair(options_.deviation, &values_.deviation)})
      if (asked) values->assign(count, 0);
    findings_.assign(count, 0);
    take_tets();
    if (std::all_of(findings_.begin(), findings_.end(), [](std::uint8_t f) { return (f & outside) != 0; })) {
      Box3 box;
      for (const Tet& tet : mesh_.tets)
        for (const Index p : tet) box.add(mesh_.points[p]);
      throw elsewhere(image_, box, image_name, mesh_name);
    }
    take_points();
    take_nearest(image_name);
    return std::move(values_);
  }

 private:
  enum Finding : std::uint8_t { partly = 1, outside = 2, none_counts = 4 };

  std::uint32_t group_of(std::size_t voxel) const {
    return std::isfinite(voxels_[voxel]) ? mask_.group(voxel) : 0;
  }
  Vec3 index_of(const Vec3& p) const { return to_index_ * (p - image_.origin); }
  Vec3 centroid(std::size_t t) const {
    Vec3 sum = Vec3::Zero();
    for (const Index p : mesh_.tets[t]) sum += mesh_.points[p] / 4;
    return sum;
  }
  void find_range() {
    struct Range {
      double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
      std::size_t not_finite = 0;
    };
    const std::vector<Range> ranges = parallel_collect<Range>(
        0, voxels_.size(), voxels_grain, [&](std::size_t begin, std::size_t end, std::vector<Range>& out) {
          Range& range = out.emplace_back();
          for (std::size_t i = begin; i < end; ++i) {
            const double value = voxels_[i];
            if (!std::isfinite(value)) {
              ++range.not_finite;
              continue;
            }
            range.low = std::min(range.low, value);
            range.high = std::max(range.high, value);
          }
        });
    Range all;
    for (const Range& range : ranges) {
      all.low = std::min(all.low, range.low);
      all.high = std::max(all.high, range.high);
      all.not_finite += range.not_finite;
    }
    values_.not_finite = all.not_finite;
    if (all.low <= all.high) {
      values_.lowest = all.low;
      values_.highest = all.high;
    }
  }

  void take_tets() {
    const std::size_t count = mesh_.tets.size(), slice = std::max(min_slice, count / slices + 1);
    for (std::size_t from = 0; from < count; from += slice) {
      parallel_for(from, std::min(count, from + slice), tets_grain, [&](std::size_t begin, std::size_t end) {
        if (progress_ && progress_->stopped()) return;
        VoxelWeights weights(image_.size);
        for (std::size_t t = begin; t < end; ++t) take_tet(t, weights);
      });
      if (!progress_) continue;
      progress_->throw_if_stopped();
      progress_->update(static_cast<double>(std::min(count, from + slice)) / static_cast<double>(count));
    }
  }

  void take_tet(std::size_t t, VoxelWeights& weights) {
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = index_of(mesh_.points[mesh_.tets[t][i]]);
    const std::uint32_t group = mask_.group_for(mesh_.materials[t]);
    VoxelStatistics statistics;
    const VoxelWeights::Measures measures =
        weights.for_each_run(corners, [&](std::size_t voxel, const double* shares, std::size_t count) {
          for (std::size_t i = 0; i < count; ++i)
            if (shares[i] != 0 && group != 0 && group_of(voxel + i) == group)
              statistics.add(voxels_[voxel + i], shares[i], shares[i] > weights.rounding());
        });
    const double negligible = negligible_part * measures.volume;
    std::uint8_t finding = 0;
    if (measures.inside <= negligible)
      finding = outside;
    else if (measures.inside < measures.volume - negligible)
      finding = partly;
    if (statistics.weight() <= negligible || statistics.minimum() > statistics.maximum()) {
      findings_[t] = static_cast<std::uint8_t>(finding | none_counts);
      return;
    }
    findings_[t] = finding;
    values_.mean[t] = statistics.mean();
    if (options_.minimum) values_.minimum[t] = statistics.minimum();
    if (options_.maximum) values_.maximum[t] = statistics.maximum();
    if (options_.deviation) values_.deviation[t] = statistics.deviation();
  }

  void take_points() {
    const GroupsOfPoints groups(mesh_, mask_);
    values_.at_points.assign(mesh_.points.size(), 0);
    missing_points_ = parallel_collect<Index>(
        0, mesh_.points.size(), points_grain,
        [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
          VoxelWeights weights(image_.size);
          for (std::size_t i = begin; i < end; ++i) {
            const auto p = static_cast<Index>(i);
            VoxelStatistics statistics;
            weights.for_each_run(index_of(mesh_.points[p]),
                                 [&](std::size_t voxel, const double* shares, std::size_t count) {
                                   for (std::size_t k = 0; k < count; ++k) {
                                     const std::uint32_t group = group_of(voxel + k);
                                     if (shares[k] != 0 && group != 0 && groups.has(p, group))
                                       statistics.add(voxels_[voxel + k], shares[k], shares[k] > 0);
                                   }
                                 });
            if (statistics.weight() > negligible_part)
              values_.at_points[p] = statistics.mean();
            else
              out.push_back(p);
          }
        });
    if (missing_points_.empty()) return;
    values_.nearest_points = {missing_points_.size(), mesh_.points[missing_points_.front()]};
    groups_of_missing_.reserve(missing_points_.size());
    for (const Index p : missing_points_) groups_of_missing_.push_back(groups.one(p));
  }

  /// Gives tets and points for which no voxel counts the value of the nearest one.
  void take_nearest(const std::string& image_name) {
    std::vector<std::size_t> missing;
    for (std::size_t t = 0; t < findings_.size(); ++t) {
      const auto count = [&](FoundPlaces& found) {
        if (found.count++ == 0) found.first = centroid(t);
      };
      if ((findings_[t] & (partly | outside)) != 0) count(values_.partly_outside);
      if ((findings_[t] & none_counts) == 0) continue;
      count(values_.nearest);
      missing.push_back(t);
    }
    if (missing.empty() && missing_points_.empty()) return;
    const NearestVoxels nearest(image_, group_of_);
    if (nearest.empty())
      throw InputError(image_name, 0,
                       "has no voxel that counts: all are outside the mask, or not finite; check the mask");
    const auto value_at = [&](const Vec3& p, std::optional<std::uint32_t> group) -> double {
      std::optional<std::size_t> voxel = nearest.find(p, group);
      if (!voxel && group) voxel = nearest.find(p, std::nullopt);
      return voxels_[*voxel];
    };
    parallel_for(0, missing.size(), tets_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t t = missing[i];
        const double value = value_at(centroid(t), mask_.group_for(mesh_.materials[t]));
        values_.mean[t] = value;
        if (options_.minimum) values_.minimum[t] = value;
        if (options_.maximum) values_.maximum[t] = value;
      }
    });
    parallel_for(0, missing_points_.size(), tets_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        values_.at_points[missing_points_[i]] =
            value_at(mesh_.points[missing_points_[i]], groups_of_missing_[i]);
    });
  }

  const TetMesh& mesh_;
  const ImageVolume& image_;
  const std::vector<float>& voxels_;
  const ImageMask& mask_;
  const ImageValueOptions& options_;
  Progress* progress_;
  const Eigen::Matrix3d to_index_;
  const NearestVoxels::GroupOf group_of_;
  ImageValues values_;
  std::vector<std::uint8_t> findings_;  ///< of each tet
  std::vector<Index> missing_points_;
  std::vector<std::optional<std::uint32_t>> groups_of_missing_;
};

}  // namespace

void check_image_meets(const LabelGrid& image, const Vec3& low, const Vec3& high,
                       const std::string& image_name, const std::string& other) {
  const Box3 box{low, high};
  if (!box.intersects(box_of(image))) throw elsewhere(image, box, image_name, other);
}

ImageValues image_values(const TetMesh& mesh, const ImageVolume& image, const ImageMask& mask,
                         const ImageValueOptions& options, const std::string& image_name,
                         const std::string& mesh_name, Progress* progress) {
  return Sampler(mesh, image, mask, options, progress).take(image_name, mesh_name);
}

}  // namespace tetwright
