// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/point_joining.h"

#include <string>

#include "common/mesh/point_table.h"
#include "tetwright/error.h"

namespace tetwright {

JoinedPoints join_points(std::span<const PiecePoints> pieces) {
  std::vector<Vec3> shared;
  for (const PiecePoints& piece : pieces)
    for (std::size_t p = 0; p < piece.points.size(); ++p)
      if (piece.shared[p]) shared.push_back(piece.points[p]);
  PointTable table(shared, shared.size() / 2);
  std::vector<Index> number_of_shared(shared.size(), no_index);
  std::size_t points = 0;
  for (const PiecePoints& piece : pieces) points += piece.points.size();
  if (points >= no_index)
    throw OutputError(std::to_string(points) + " points of parts of a mesh cannot be numbered, at most " +
                      std::to_string(no_index - 1) + " can");
  JoinedPoints joined;
  Index next_shared = 0;
  for (const PiecePoints& piece : pieces) {
    std::vector<Index>& numbers = joined.numbers.emplace_back(piece.points.size());
    for (std::size_t p = 0; p < numbers.size(); ++p) {
      Index* const known = piece.shared[p] ? &number_of_shared[table.add(next_shared++)] : nullptr;
      numbers[p] = known && *known != no_index ? *known : static_cast<Index>(joined.count++);
      if (known) *known = numbers[p];
    }
  }
  return joined;
}

}  // namespace tetwright
