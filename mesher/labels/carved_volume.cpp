// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/carved_volume.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "common/geometry/box_tree.h"
#include "common/geometry/morton.h"
#include "common/geometry/surface_tree.h"
#include "common/random.h"
#include "mesher/domain/narrow_band.h"
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
class Carving {
 public:
  Carving(const LabelInput& labels, const MaterialField& bodies, const std::vector<SurfaceTree>& surfaces)
      : labels_(labels), frame_(bodies.frame()), sampler_(bodies.sampler()), surfaces_(surfaces) {
    const Eigen::Matrix3d edges = frame_.axes.inverse() * labels.directions / frame_.cell_size;
    half_diagonal_ = 0.5 * edges.colwise().norm().sum();
  }
  bool is_inside(const Vec3& index) const { return nearest(index).region != outside_region; }
  /// The fraction of a voxel that is in bodies.
  double share(const Vec3& centre) const {
    const NearestRegion there = nearest(centre);
    if (is_far(there)) return there.region != outside_region ? 1 : 0;
    constexpr int n = LabelTuning::Carving::samples;
    // Random samples in equal cubes: regular ones would err alike in all voxels along a face.
    Random random(
        morton_encode(static_cast<int>(centre[0]), static_cast<int>(centre[1]), static_cast<int>(centre[2])));
    int inside = 0;
    for (int k = 0; k < n * n * n; ++k) {
      const int x = k % n, y = k / n % n, z = k / (n * n);
      Vec3 at;  // in this order, which that of arguments is not
      for (double& along : at) along = random.uniform();
      inside += is_enclosed(centre + ((Vec3(x, y, z) + at) / n - Vec3::Constant(0.5)));
    }
    return static_cast<double>(inside) / (n * n * n);
  }

 private:
  NearestRegion nearest(const Vec3& index) const {
    return sampler_->nearest(frame_.to_grid(labels_.origin + labels_.directions * index));
  }
  /// No surface passes the voxel around a point.
  bool is_far(const NearestRegion& there) const {
    return there.margin > std::min(half_diagonal_, LabelTuning::Carving::far_share * level_set_band);
  }
  bool is_enclosed(const Vec3& index) const {
    const Vec3 at = labels_.origin + labels_.directions * index;
    return std::any_of(surfaces_.begin(), surfaces_.end(),
                       [&](const SurfaceTree& s) { return s.winding_number(at) > 0.5; });
  }

  const LabelInput& labels_;
  const GridFrame& frame_;
  std::unique_ptr<FieldSampler> sampler_;
  const std::vector<SurfaceTree>& surfaces_;
  double half_diagonal_;  ///< of a voxel, lattice units; an upper bound
};

using Pair = std::pair<RegionIndex, RegionIndex>;

struct Taken {
  std::vector<double> voxels;
  std::map<Pair, std::uint64_t> faces;
};

}  // namespace

std::vector<std::uint8_t> protected_regions(const ImplantedVolume& volume) {
  std::vector<std::uint8_t> flags(volume.labels.materials.size() + 1, 0);
  for (std::size_t i = 0; i < volume.labels.materials.size(); ++i)
    flags[i + 1] = std::binary_search(volume.protected_labels.begin(), volume.protected_labels.end(),
                                      volume.labels.materials[i].tag);
  return flags;
}

CarvedLabels measure_carving(const ImplantedVolume& volume, const MaterialField& bodies,
                             const Progress* progress) {
  const LabelInput& labels = volume.labels;
  const std::vector<std::uint8_t> is_protected = protected_regions(volume);
  const VoxelRange range = voxels_of_bodies(volume);
  const auto slices = static_cast<std::size_t>(range.high[2] - range.low[2]);
  std::vector<SurfaceTree> surfaces;
  for (const MesherInput::Body& body : volume.bodies.bodies)
    surfaces.emplace_back(body.surface.points, body.surface.triangles);
  std::vector<Taken> taken(slices);
  parallel_for(0, slices, 1, [&](std::size_t begin, std::size_t end) {
    const Carving carving(labels, bodies, surfaces);
    for (std::size_t i = begin; i < end; ++i) {
      if (progress) progress->throw_if_stopped();
      const int z = range.low[2] + static_cast<int>(i);
      Taken& own = taken[i];
      own.voxels.assign(is_protected.size(), 0);
      for (int y = range.low[1]; y < range.high[1]; ++y)
        for (int x = range.low[0]; x < range.high[0]; ++x) {
          const RegionIndex here = labels.regions.at(x, y, z);
          const Vec3 centre(x, y, z);
          const bool inside = carving.is_inside(centre);
          if (!is_protected[here]) own.voxels[here] += carving.share(centre);
          for (int a = 0; a < 3; ++a) {
            VoxelIndex next{x, y, z};
            if (++next[static_cast<std::size_t>(a)] >= labels.size[static_cast<std::size_t>(a)]) continue;
            const RegionIndex there = labels.regions.at(next[0], next[1], next[2]);
            if (there == here) continue;
            if ((inside && !is_protected[here]) ||
                (!is_protected[there] && carving.is_inside(centre + Vec3::Unit(a))))
              ++own.faces[std::minmax(here, there)];
          }
        }
    }
  });
  const auto label = [&](RegionIndex r) {
    return r == outside_region ? MaterialOrOutside() : labels.materials[r - 1u].tag;
  };
  CarvedLabels result;
  for (const Taken& own : taken) {  // in the order of slices: sums do not depend on the number of threads
    for (std::size_t r = 0; r < own.voxels.size(); ++r)
      if (own.voxels[r] > 0) result.voxels[label(static_cast<RegionIndex>(r))] += own.voxels[r];
    for (const auto& [pair, count] : own.faces)
      result.faces[std::minmax(label(pair.first), label(pair.second))] += count;
  }
  return result;
}

}  // namespace tetwright
