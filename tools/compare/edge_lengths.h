// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/sizes/size_field.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// An edge is as long as it should be within this factor of the wanted length.
inline constexpr double edge_length_factor = 1.5;

/// The lengths of a mesh's edges against those that are wanted, and their bounds. Input units.
struct EdgeLengthReport {
  /// The edge that breaks a bound by most; its length is 0 where none does.
  struct Offender {
    double length = 0;
    Vec3 place = Vec3::Zero();  ///< its middle
    std::size_t count = 0;      ///< of edges that break the bound
  };
  std::size_t edges = 0;
  double shortest = 0, longest = 0;
  Offender above_max, below_min;
  // With a target length; else 0.
  std::size_t within = 0;              ///< edges within edge_length_factor of it
  double median = 0;                   ///< of lengths over wanted ones
  std::size_t with_target_length = 0;  ///< edges in all, or 0 without a target length
  double within_share() const {
    return with_target_length ? static_cast<double>(within) / static_cast<double>(with_target_length) : 1;
  }
};

/// `target_length` may be null; `min_edge` 0 and `max_edge` infinite are no bounds.
EdgeLengthReport compare_edge_lengths(const TetMesh& mesh, const SizeField* target_length,
                                      const SizeSource* source, double min_edge, double max_edge);

}  // namespace tetwright
