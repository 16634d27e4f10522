// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "tetwright/mesher_input.h"
#include "tetwright/simplify.h"
#include "tools/bricks/brick_part.h"

namespace tetwright {

/// The bricks of a round after the first, equal boxes that are shifted against those of the other rounds. A
/// tet belongs to the brick that contains its centroid; outer bricks extend to infinity.
class ShiftedBricks {
 public:
  /// \param cell edge of a finest cell, input units
  /// \param cells finest cells along the edge of a brick
  /// \param round from 2
  ShiftedBricks(const LabelInput& labels, double cell, int cells, int round);

  std::size_t count() const { return counts_[0] * counts_[1] * counts_[2]; }
  std::size_t brick_at(const Vec3& centroid) const;
  /// The position of each brick in the grid of bricks, for BrickBorder::brick.
  std::vector<CellBox> boxes() const;

 private:
  Vec3 origin_;
  Eigen::Matrix3d to_bricks_;
  std::array<std::size_t, 3> counts_;
};

/// Everything that a brick is regrouped from, copied out of the parts of the round before.
struct BrickPieces {
  CellBox brick;  ///< BrickBorder::brick
  /// The tets of each part that has any in this brick, with the flags of the round before; nothing else.
  std::vector<BrickPart> parts;
  std::vector<Vec3> shared;  ///< points that other bricks have, too
};

/// Joins the pieces of a brick, and coarsens them again.
/// \param density final tets per volume, input units
/// \param field for the reference surface; null: none
/// \param options its target, reference and frozen points are not used
/// \throws Interrupted, OutOfTime
BrickPart coarsen_pieces(BrickPieces pieces, const BrickTask& task, double density,
                         const std::shared_ptr<const MaterialField>& field, CoarsenOptions options,
                         Progress* progress);

/// The parts of a round, regrouped into the bricks of the next one. They need not be in memory together.
///
/// Immutable after construction; pieces may be copied concurrently.
class RegroupedBricks {
 public:
  /// Reads a part of the round before; called concurrently.
  using Read = std::function<std::shared_ptr<const BrickPart>(std::size_t)>;

  /// Reads all parts once.
  /// \param count number of parts
  RegroupedBricks(ShiftedBricks bricks, std::size_t count, Read read, const Progress& progress);

  std::size_t count() const { return bricks_.count(); }
  std::vector<CellBox> boxes() const { return bricks_.boxes(); }
  /// Number of tets of each brick.
  const std::vector<std::size_t>& tets() const { return tets_; }
  /// Number of points at which the parts were cut off.
  std::size_t shared_points() const { return brick_of_shared_.size(); }

  /// \throws Interrupted, OutOfTime; as Read
  BrickPieces pieces(std::size_t brick, const Progress* progress) const;

 private:
  using Brick = std::uint32_t;
  static constexpr Brick none = 0xffffffffu, several = none - 1;

  /// The brick of each tet of a part.
  std::vector<Brick> bricks_of_tets(const TetMesh& mesh) const;
  /// The brick of all tets at each point of part `p`, or `several`.
  std::vector<Brick> bricks_of_points(std::size_t p, const BrickPart& part,
                                      const std::vector<Brick>& of_tets) const;
  /// The part's tets in a brick; its flags are those of the round before.
  /// \param shared receives the points that other bricks have, too
  BrickPart piece(std::size_t p, Brick brick, std::vector<Vec3>& shared) const;

  ShiftedBricks bricks_;
  Read read_;
  std::vector<std::size_t> tets_;
  std::vector<std::vector<Brick>> bricks_of_part_;  ///< ascending
  /// By part: numbers of its shared points, in their order.
  std::vector<std::vector<Index>> shared_of_part_;
  std::vector<Brick> brick_of_shared_;  ///< by number
};

}  // namespace tetwright
