#pragma once

#include <array>
#include <cstdint>

#include "common/types.h"

namespace tetwright {

/// Number of a region inside an EditableMesh: a material (its place among the tags in ascending order), or
/// outside.
using RegionId = std::uint32_t;
inline constexpr RegionId outside_id = 0xffffffffu;

/// A tet of an EditableMesh. 40 bytes.
struct TetRecord {
  Tet points;                       ///< no_index four times: dead
  std::array<Index, 4> neighbours;  ///< across the face opposite each point; no_index: outside
  RegionId region;
  float quality;  ///< by the objective of the schedule, rounded
};
static_assert(sizeof(TetRecord) <= 48);

inline constexpr Tet dead_tet{no_index, no_index, no_index, no_index};

/// A face between two regions, one of which may be outside.
struct InterfaceFace {
  Triangle ids;  ///< the normal points out of `inside`
  RegionId inside, across;
};

}  // namespace tetwright
