// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/carved_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "common/geometry/box_tree.h"
#include "common/geometry/morton.h"
#include "common/geometry/surface_tree.h"
#include "common/random.h"
#include "mesher/tuning/label_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// The voxels whose centres the box of the bodies contains, and one more on each side.
struct VoxelRange {
  VoxelIndex low, high;
};

VoxelRange voxels_of_bodies(const ImplantedVolume& volume) {
  const LabelInput& labels = volume.labels;
  const Eigen::Matrix3d to_index = labels.directions.inverse();
  Box3 box;
  for (const MesherInput::Body& body : volume.bodies.bodies)
    for (const Vec3& p : body.surface.points) box.add(to_index * (p - labels.origin));
  VoxelRange range{};
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    range.low[a] = std::clamp(static_cast<int>(std::floor(box.low[axis])) - 1, 0, labels.size[a]);
    range.high[a] = std::clamp(static_cast<int>(std::ceil(box.high[axis])) + 2, range.low[a], labels.size[a]);
  }
  return range;
}

/// Tells how much of voxels bodies take. Near their surfaces winding numbers decide, since distances between
/// voxels round off edges.
class VoxelShares {
 public:
  VoxelShares(const LabelInput& labels, const MaterialField& bodies, const std::vector<SurfaceTree>& surfaces)
      : labels_(labels), frame_(bodies.frame()), sampler_(bodies.sampler()), surfaces_(surfaces) {
    const Eigen::Matrix3d edges = frame_.axes.inverse() * labels.directions / frame_.cell_size;
    // Distances are known close to surfaces only.
    for (int a = 0; a < 3; ++a)
      parts_[a] =
          std::max(1, static_cast<int>(std::ceil(edges.col(a).norm() / LabelTuning::Carving::max_part)));
    for (int k = 0; k < 4; ++k) {
      Vec3 corner = edges.col(0) / parts_[0];
      for (int a = 1; a < 3; ++a) corner += (k >> (a - 1) & 1 ? -1 : 1) * edges.col(a) / parts_[a];
      half_diagonal_ = std::max(half_diagonal_, 0.5 * corner.norm());
    }
  }
  bool is_inside(const Vec3& index) const { return nearest(index).region != outside_region; }
  /// Calls `add(body, share)` for the parts of a voxel that are in bodies; several times for one of them.
  template <class Add>
  void for_each(const Vec3& centre, const Add& add) const {
    const int count = parts_[0] * parts_[1] * parts_[2];
    // Random samples in equal cubes: regular ones would err alike in all voxels along a face.
    Random random(
        morton_encode(static_cast<int>(centre[0]), static_cast<int>(centre[1]), static_cast<int>(centre[2])));
    for (int k = 0; k < count; ++k) {
      const Vec3 size(1.0 / parts_[0], 1.0 / parts_[1], 1.0 / parts_[2]);
      const int layer = k / (parts_[0] * parts_[1]);
      const Vec3 part(k % parts_[0], k / parts_[0] % parts_[1], layer);
      const Vec3 low = centre - Vec3::Constant(0.5) + part.cwiseProduct(size);
      const NearestRegion there = nearest(low + 0.5 * size);
      if (there.margin > half_diagonal_ + LabelTuning::Carving::uncertain) {
        if (there.region != outside_region) add(std::size_t{there.region} - 1, 1.0 / count);
        continue;
      }
      constexpr int n = LabelTuning::Carving::samples;
      for (int i = 0; i < n * n * n; ++i) {
        const int slice = i / (n * n);
        const Vec3 cube(i % n, i / n % n, slice);
        Vec3 at;  // in this order, which that of arguments is not
        for (double& along : at) along = random.uniform();
        if (const auto body = body_at(low + ((cube + at) / n).cwiseProduct(size)))
          add(*body, 1.0 / (count * n * n * n));
      }
    }
  }

 private:
  NearestRegion nearest(const Vec3& index) const {
    return sampler_->nearest(frame_.to_grid(labels_.origin + labels_.directions * index));
  }
  std::optional<std::size_t> body_at(const Vec3& index) const {
    if (const NearestRegion there = nearest(index); there.margin > LabelTuning::Carving::uncertain)
      return there.region == outside_region ? std::nullopt : std::optional(std::size_t{there.region} - 1);
    const Vec3 at = labels_.origin + labels_.directions * index;
    for (std::size_t b = surfaces_.size(); b-- > 0;)  // later bodies carve earlier ones
      if (surfaces_[b].winding_number(at) > 0.5) return b;
    return {};
  }

  const LabelInput& labels_;
  const GridFrame& frame_;
  std::unique_ptr<FieldSampler> sampler_;
  const std::vector<SurfaceTree>& surfaces_;
  std::array<int, 3> parts_{};  ///< into which a voxel is divided along each axis
  double half_diagonal_ = 0;    ///< of a part, lattice units
};

/// Whether a voxel or one that touches it belongs to a protected label.
bool is_beside_protected(const LabelInput& labels, const std::vector<std::uint8_t>& is_protected,
                         const VoxelIndex& at) {
  for (int k = 0; k < 27; ++k) {
    const VoxelIndex next{at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1};
    bool is_in = true;
    for (std::size_t a = 0; a < 3; ++a) is_in &= next[a] >= 0 && next[a] < labels.size[a];
    if (is_in && is_protected[labels.regions.at(next[0], next[1], next[2])]) return true;
  }
  return false;
}

using Pair = std::pair<RegionIndex, RegionIndex>;

struct Taken {
  std::vector<double> voxels;
  std::map<Pair, std::uint64_t> faces;
  std::vector<BodyInLabels> bodies;
};

}  // namespace

std::vector<std::uint8_t> protected_regions(const ImplantedVolume& volume) {
  std::vector<std::uint8_t> flags(volume.labels.materials.size() + 1, 0);
  for (std::size_t i = 0; i < volume.labels.materials.size(); ++i)
    flags[i + 1] = std::binary_search(volume.protected_labels.begin(), volume.protected_labels.end(),
                                      volume.labels.materials[i].tag);
  return flags;
}

Carving measure_carving(const ImplantedVolume& volume, const MaterialField& bodies,
                        const Progress* progress) {
  const LabelInput& labels = volume.labels;
  const std::vector<std::uint8_t> is_protected = protected_regions(volume);
  const bool any_protected = !volume.protected_labels.empty();
  const VoxelRange range = voxels_of_bodies(volume);
  const auto slices = static_cast<std::size_t>(range.high[2] - range.low[2]);
  std::vector<SurfaceTree> surfaces;
  for (const MesherInput::Body& body : volume.bodies.bodies)
    surfaces.emplace_back(body.surface.points, body.surface.triangles);
  std::vector<Taken> taken(slices);
  parallel_for(0, slices, 1, [&](std::size_t begin, std::size_t end) {
    const VoxelShares shares(labels, bodies, surfaces);
    for (std::size_t i = begin; i < end; ++i) {
      if (progress) progress->throw_if_stopped();
      const int z = range.low[2] + static_cast<int>(i);
      Taken& own = taken[i];
      own.voxels.assign(is_protected.size(), 0);
      own.bodies.resize(surfaces.size());
      for (int y = range.low[1]; y < range.high[1]; ++y)
        for (int x = range.low[0]; x < range.high[0]; ++x) {
          const RegionIndex here = labels.regions.at(x, y, z);
          const Vec3 centre(x, y, z);
          std::optional<bool> beside;
          shares.for_each(centre, [&](std::size_t body, double share) {
            if (!is_protected[here]) own.voxels[here] += share;
            BodyInLabels& of_body = own.bodies[body];
            of_body.in_volume += share;
            if (here != outside_region) of_body.in_labels += share;
            if (is_protected[here]) of_body.in_protected += share;
            if (any_protected && !beside) beside = is_beside_protected(labels, is_protected, {x, y, z});
            if (beside.value_or(false)) of_body.beside_protected += share;
          });
          const bool inside = shares.is_inside(centre);
          for (int a = 0; a < 3; ++a) {
            VoxelIndex next{x, y, z};
            if (++next[static_cast<std::size_t>(a)] >= labels.size[static_cast<std::size_t>(a)]) continue;
            const RegionIndex there = labels.regions.at(next[0], next[1], next[2]);
            if (there == here) continue;
            if ((inside && !is_protected[here]) ||
                (!is_protected[there] && shares.is_inside(centre + Vec3::Unit(a))))
              ++own.faces[std::minmax(here, there)];
          }
        }
    }
  });
  const auto label = [&](RegionIndex r) {
    return r == outside_region ? MaterialOrOutside() : labels.materials[r - 1u].tag;
  };
  Carving result;
  result.bodies.resize(surfaces.size());
  for (const Taken& own : taken) {  // in the order of slices: sums do not depend on the number of threads
    for (std::size_t r = 0; r < own.voxels.size(); ++r)
      if (own.voxels[r] > 0) result.labels.voxels[label(static_cast<RegionIndex>(r))] += own.voxels[r];
    for (const auto& [pair, count] : own.faces)
      result.labels.faces[std::minmax(label(pair.first), label(pair.second))] += count;
    for (std::size_t b = 0; b < own.bodies.size(); ++b) {
      BodyInLabels& all = result.bodies[b];
      all.in_volume += own.bodies[b].in_volume;
      all.in_labels += own.bodies[b].in_labels;
      all.in_protected += own.bodies[b].in_protected;
      all.beside_protected += own.bodies[b].beside_protected;
    }
  }
  return result;
}

}  // namespace tetwright
