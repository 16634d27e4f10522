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
  // With a wish; else 0.
  std::size_t within = 0;  ///< edges within edge_length_factor of it
  double median = 0;       ///< of lengths over wanted ones
  std::size_t wished = 0;  ///< edges in all, or 0 without a wish
  double within_share() const {
    return wished ? static_cast<double>(within) / static_cast<double>(wished) : 1;
  }
};

/// `wish` may be null; `min_edge` 0 and `max_edge` infinite are no bounds.
EdgeLengthReport compare_edge_lengths(const TetMesh& mesh, const SizeField* wish, const SizeSource* source,
                                      double min_edge, double max_edge);

}  // namespace tetwright
