// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/geometry/box_tree.h"
#include "tetwright/label_volume.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Finds the nearest voxel that counts, by blocks of voxels. Built in parallel; all functions may be called
/// concurrently.
class NearestVoxels {
 public:
  /// Group of a voxel; 0 for those that count nowhere.
  using GroupOf = std::function<std::uint32_t(std::size_t voxel)>;

  /// \pre the arguments outlive this object
  NearestVoxels(const LabelGrid& grid, const GroupOf& group_of);

  bool empty() const { return blocks_.empty(); }
  /// The voxel of a group whose centre is nearest to `p`, the first of equally near ones.
  ///
  /// \param group std::nullopt: of any group
  /// \return std::nullopt if there is none
  std::optional<std::size_t> find(const Vec3& p, std::optional<std::uint32_t> group) const;

 private:
  /// A block with voxels of a group.
  struct Block {
    std::uint32_t group;
    std::uint64_t place;  ///< Morton key
    auto operator<=>(const Block&) const = default;
  };

  template <class Visit>
  void for_each_voxel(std::uint64_t block, const Visit& visit) const;
  Box3 box_of(std::uint64_t block) const;

  const LabelGrid& grid_;
  const GroupOf& group_of_;
  std::vector<Block> blocks_;  ///< sorted
  BoxTree tree_;
};

}  // namespace tetwright
