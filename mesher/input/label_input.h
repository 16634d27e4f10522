// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/label_volume.h"
#include "common/progress.h"
#include "mesher/domain/regions.h"
#include "mesher/input/surface_repair.h"

namespace tetwright {

/// Selects the labels of a segmented volume that are meshed, and names them.
struct LabelChoice {
  /// Labels that become materials, as inclusive ranges; all others are outside. Empty: all but the outside
  /// label.
  std::vector<std::pair<MaterialTag, MaterialTag>> labels;
  std::map<MaterialTag, std::string> names;  ///< labels without a name are called label_N
  /// The file that `names` were read from, and the line of each, for messages; may be empty.
  std::string names_file;
  std::map<MaterialTag, std::size_t> name_lines;
  MaterialTag outside_label = 0;
  /// Face-connected islands of fewer voxels are merged into the region they touch most; 0 or 1: none.
  std::size_t min_voxels = 8;
};

/// Range of the number of parts that a region of voxels may have: at least those that touch at a corner or
/// more, at most those connected by faces. Unlimited if not counted.
struct LabelParts {
  std::size_t touching = 0, by_faces = std::numeric_limits<std::size_t>::max();
  std::optional<Vec3> smallest_place;  ///< centre of a voxel of the smallest part by faces, input units
};

/// A label that is meshed.
struct LabelMaterial {
  std::string name;
  MaterialTag tag = 0;             ///< the label
  std::size_t voxels = 0;          ///< after merging small islands, 1 or more
  std::size_t voxels_in_file = 0;  ///< before merging
  LabelParts parts = {};           ///< after merging
};

/// A chosen label that is not meshed because all of it was in small islands.
struct LostLabel {
  MaterialTag tag = 0;
  std::string name;
  std::size_t voxels = 0;
  Vec3 place = Vec3::Zero();  ///< centre of one of its voxels, input units
};

/// A segmented volume, ready to be meshed.
struct LabelInput {
  std::string file;
  std::array<int, 3> size{};
  Vec3 origin = Vec3::Zero();
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  std::string space;  ///< see LabelVolume
  /// Region of each voxel, first axis fastest: 0 is outside, i + 1 is materials[i].
  std::vector<RegionIndex> regions;
  std::vector<LabelMaterial> materials;  ///< by ascending tag
  std::vector<LostLabel> lost;           ///< by ascending tag
  std::size_t merged_islands = 0;        ///< including those of the outside
  std::size_t merged_voxels = 0;
  /// Parts of the outside that do not reach the border of the volume. Parts are not counted in volumes of
  /// 2^32 voxels or more.
  LabelParts outside_parts;
  std::vector<InputFinding> findings;  ///< changes to the input, for the user

  std::size_t voxel_count() const { return regions.size(); }
};

/// Chooses the labels and merges islands of fewer than `min_voxels` voxels into their neighbours, see
/// merge_small_islands(). If no island has that many voxels, nothing is merged and a finding says so. The
/// result does not depend on the number of threads.
///
/// \param progress may be null
/// \throws UsageError for impossible ranges and names: the outside label is chosen, two labels share a name,
///   a label is called "outside"
/// \throws InputError for impossible names that come from a file, a chosen label that does not exist (with a
///   list of those that do), or more than 60,000 labels
/// \throws NothingToMeshError if all voxels are outside
/// \throws Interrupted
LabelInput make_label_input(LabelVolume volume, const std::string& file, const LabelChoice& choice,
                            Progress* progress);

}  // namespace tetwright
