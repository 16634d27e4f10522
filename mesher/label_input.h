#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/label_volume.h"
#include "common/progress.h"
#include "mesher/regions.h"
#include "mesher/surface_input.h"

namespace tetwright {

/// What of a segmented volume is to be meshed, and how it is called.
struct LabelChoice {
  /// Labels that become materials, as ranges with both ends; empty: all but the outside label. What is not
  /// chosen is outside.
  std::vector<std::pair<MaterialTag, MaterialTag>> labels;
  std::map<MaterialTag, std::string> names;  ///< labels without one are called label_N
  MaterialTag outside_label = 0;
  /// Face-connected islands of fewer voxels are merged into what they touch most; 0 or 1: none.
  std::size_t min_voxels = 8;
};

/// A label that is meshed.
struct LabelMaterial {
  std::string name;
  MaterialTag tag = 0;             ///< the label
  std::size_t voxels = 0;          ///< after small islands were merged, 1 or more
  std::size_t voxels_in_file = 0;  ///< before
};

/// A label of the file that is lost, since all of it was in small islands.
struct LostLabel {
  MaterialTag tag = 0;
  std::string name;
  std::size_t voxels = 0;
};

/// A segmented volume made ready for meshing.
struct PreparedLabels {
  std::string file;
  std::array<int, 3> size{};
  Vec3 origin = Vec3::Zero();
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  std::string space;  ///< see LabelVolume
  /// Of each voxel: 0 is outside, i + 1 is materials[i]; the first axis fastest.
  std::vector<RegionIndex> regions;
  std::vector<LabelMaterial> materials;  ///< by ascending tag
  std::vector<LostLabel> lost;           ///< by ascending tag
  std::size_t merged_islands = 0;        ///< those of outside among them
  std::size_t merged_voxels = 0;
  std::vector<InputFinding> findings;  ///< what was found and done, for the user

  std::size_t voxel_count() const { return regions.size(); }
};

/// Chooses the labels and merges islands of fewer than `min_voxels` voxels (face-connected, of outside too)
/// into the neighbour that they share most voxel faces with: the smallest first, ties by the lowest voxel
/// index, between equal neighbours the smallest region; an island that grew by others is counted anew. Where
/// no island reaches the number, nothing is merged and the findings say so. The same for any number of
/// threads.
///
/// Throws UsageError (ranges and names that cannot be: the outside label chosen, two labels of one name, one
/// called "outside"), InputError (a chosen label that isn't there, with those that are; more than 60,000
/// labels), NothingToMeshError (all voxels are outside), Interrupted.
PreparedLabels prepare_labels(LabelVolume volume, const std::string& file, const LabelChoice& choice,
                              Progress* progress);

}  // namespace tetwright
