// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tetwright/partition.h"

namespace tetwright {

/// The parts that have a tet at each point of a mesh.
class PartPoints {
 public:
  /// \param of_tets `corners` points of each tet: 4, or 6 for midside nodes
  PartPoints(std::span<const Index> of_tets, std::size_t corners, std::size_t points,
             const TetPartition& partition);

  /// Smallest part at the point, which owns it; 0 if it has no tet.
  PartNumber owner(Index point) const { return owners_[point] == none ? 0 : owners_[point]; }
  bool has_tet(Index point) const { return owners_[point] != none; }
  bool is_shared(Index point) const { return shared_[point] != 0; }
  /// Calls `use(point, part)` for each point and each part with a tet at it, ascending by point and part.
  template <class Use>
  void for_each(const Use& use) const {
    std::size_t at = 0;
    for (Index p = 0; p < owners_.size(); ++p)
      if (!shared_[p]) {
        if (owners_[p] != none) use(p, owners_[p]);
      } else {
        for (; at < uses_.size() && uses_[at].first == p; ++at) use(p, uses_[at].second);
      }
  }
  /// Adds to `parts` the parts with a tet at a shared point.
  void add_parts(Index point, std::vector<PartNumber>& parts) const;

 private:
  static constexpr PartNumber none = UINT32_MAX;
  std::vector<PartNumber> owners_;
  std::vector<std::uint8_t> shared_;                ///< 1: several parts have a tet at the point
  std::vector<std::pair<Index, PartNumber>> uses_;  ///< for shared points, ascending, each once
};

/// Calls `use(part, tet)` for each ghost of each part, ascending by tet, then by part.
template <class Use>
void for_each_ghost(const TetMesh& mesh, const TetPartition& partition, const PartPoints& points,
                    const Use& use) {
  std::vector<PartNumber> parts;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    parts.clear();
    for (const Index p : mesh.tets[t])
      if (points.is_shared(p)) points.add_parts(p, parts);
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    for (const PartNumber part : parts)
      if (part != partition.of(t)) use(part, t);
  }
}

}  // namespace tetwright
