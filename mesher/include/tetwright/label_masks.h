// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/label_volume.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// The grid that several volumes have in common: that of the first one, to a thousandth of a voxel.
class CommonGrid {
 public:
  /// Takes the grid of the first volume, and checks the others. A volume whose file names another anatomical
  /// coordinate system than that of the first one (LabelGrid::space) is converted.
  /// \param file for messages
  /// \throws InputError if the grid is another one, with both
  void add(LabelGrid& grid, const std::string& file);

  const std::string& first_file() const { return first_file_; }
  /// Volumes in other spaces than the first one.
  std::vector<Diagnostic> findings() const;

 private:
  std::string first_file_;
  std::optional<LabelGrid> grid_;  ///< of the first volume
  /// Spaces of volumes, and how many had each: brought into that of the first one, or taken as they are.
  std::map<std::string, std::size_t> converted_, unknown_;
};

/// A mask: the voxels of a volume that have one label.
struct LabelMask {
  std::string name;     ///< of its material
  MaterialTag tag = 0;  ///< of its material; not 0
};

/// Joins masks, each of which names its own voxels, to a segmented volume: masks of organs, or segments that
/// overlap.
class LabelMasks {
 public:
  /// \param rule to which mask a voxel belongs that several have: OverlapRule::later the one that was added
  ///   last, ::first the first one, ::material a material of its own, called a+b after masks a and b
  /// \param tags for names of such materials: those of OverlapRule::material that are not among them get tags
  ///   above all of these and of the masks
  explicit LabelMasks(OverlapRule rule, std::map<std::string, MaterialTag> tags = {})
      : rule_(rule), tags_(std::move(tags)) {}

  /// Adds the masks of a volume. Voxels of labels that are no key of `masks`, and of `outside`, belong to
  /// none. All volumes have the grid of the first one, to a thousandth of a voxel. A volume whose file names
  /// another anatomical coordinate system than that of the first one (LabelGrid::space) is converted. Takes
  /// four bytes for each voxel beside the volume. Parallel; the result does not depend on the number of
  /// threads.
  ///
  /// \param file for messages
  /// \param masks by label
  /// \throws InputError if the grid is another one, or masks overlap and the rule is OverlapRule::error
  /// \throws OutputError if memory does not suffice
  void add(LabelVolume volume, const std::string& file, const std::map<MaterialTag, LabelMask>& masks,
           MaterialTag outside);

  struct Joined {
    /// Has the grid of the first volume, 0 where no mask has a voxel, and the names and colours of all
    /// materials.
    LabelVolume volume;
    /// By pair, in the order of the masks. A voxel in more than two counts where it passed from one to
    /// another.
    std::vector<OverlapReport> overlaps;
    std::vector<Diagnostic> findings;
  };
  /// \param files what the masks come from, for messages
  /// \throws NothingToMeshError if no mask has a voxel
  /// \throws InputError if no tags are left for the materials of OverlapRule::material
  Joined join(const std::string& files) &&;

 private:
  struct Material {
    LabelMask mask;
    std::size_t voxels = 0;  ///< of the mask
  };
  struct Overlap {
    MaterialTag first, second;
    std::size_t voxels, first_voxel;
  };

  void begin(LabelVolume& volume, const std::string& file);
  std::string name_of(MaterialTag tag) const;
  Vec3 centre(std::size_t voxel) const;
  void report(Joined& joined) const;

  OverlapRule rule_;
  std::map<std::string, MaterialTag> tags_;  ///< by name
  LabelVolume result_;
  CommonGrid grid_;
  std::vector<Material> materials_;
  std::vector<Overlap> overlaps_;
  std::vector<bool> in_several_;  ///< by voxel: in several masks; empty: none is
  /// Names of materials of OverlapRule::material. Their labels are -1, -2, ... until all tags are known.
  std::vector<std::string> shared_names_;
};

/// The label of a mask: the one that voxels have besides `outside`.
/// \return `outside` if all voxels have that
/// \throws InputError if there are several
MaterialTag label_of_mask(const LabelVolume& volume, MaterialTag outside, const std::string& file);

}  // namespace tetwright
