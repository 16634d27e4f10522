// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tetwright/mesher.h"

namespace tetwright {

using VoxelLabels = std::function<MaterialTag(int x, int y, int z)>;

/// A volume of voxels of size 1 with its first centre at the origin, no islands merged. 0 is outside.
LabelInput make_labels(const std::array<int, 3>& size, const VoxelLabels& label,
                       const Eigen::Matrix3d& directions = Eigen::Matrix3d::Identity(),
                       const Vec3& origin = Vec3::Zero());

/// A grid of the regions of all voxels, the first axis fastest, and the regions of a grid.
RegionGrid grid_of(const std::array<int, 3>& size, const std::vector<RegionIndex>& regions);
std::vector<RegionIndex> voxels_of(const RegionGrid& grid);

/// Measures how well a mesh of a segmented volume meets its guarantees.
struct LabelComparison {
  std::size_t centres = 0;     ///< voxels that have a neighbour of their label
  std::size_t lost = 0;        ///< such voxels whose centre is not in a tet of their label
  std::array<int, 3> first{};  ///< index of one of them
  std::size_t lone_lost = 0;   ///< voxels without such a neighbour whose centre is in another label
  double moved = 0;            ///< largest distance of an interface from faces of any two labels, voxels
  double moved_of_pair =
      0;  ///< largest distance from faces of its own two labels, voxels; at most `out_of_sight`
  std::size_t moved_far = 0;  ///< triangles more than 0.75 from faces of their labels
  std::size_t moved_far_of_any = 0;
  std::size_t triangles = 0;
  Vec3 farthest = Vec3::Zero();  ///< point of moved_of_pair, index space
  Vec3 farthest_of_any = Vec3::Zero();
  /// By material: volume of its tets divided by that of its voxels.
  std::map<MaterialTag, double> volumes;
  double worst_volume = 0;  ///< largest relative error of a label over `many_voxels`; 0.02 is 2 %
  MaterialTag worst = 0;

  static constexpr double out_of_sight = 3;
  static constexpr std::size_t many_voxels = 1000;
};

/// Centres of outside count too. Distances are measured at the corners, middles of edges and centres of the
/// triangles. Time grows with voxels and triangles; the origin of index space is the first voxel's centre.
LabelComparison compare_with_voxels(const LabelInput& labels, const TetMesh& mesh);

/// For example "lost 0 of 100 centres, ...".
std::string comparison_line(const LabelComparison& f);

/// Index of the region of a material.
RegionIndex region_of(const LabelInput& labels, MaterialTag tag);

}  // namespace tetwright
