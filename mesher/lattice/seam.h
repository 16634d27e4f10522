// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/morton.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/lattice/labelled_lattice.h"

namespace tetwright {

/// A point near an interface, with all changes of its state while points were moved.
struct SeamPoint {
  MortonKey key;  ///< LatticePoints::keys
  /// Hash of the point's region, of its priority among those to be moved, and of every later position with
  /// the pass that moved it there; `not_near` if it is not near an interface.
  std::uint64_t history;
  static constexpr std::uint64_t not_near = 0;
  auto operator<=>(const SeamPoint&) const = default;
};

/// The points around the border of a brick by which the lattices of adjacent bricks are compared.
///
/// Each lattice point belongs to the brick that contains it. A brick's lattice extends beyond the brick,
/// where it may differ from the whole volume's, since it ends somewhere. Points are moved one after another
/// in an order that their priorities and positions decide, and each step reads states up to two edges away.
/// Hence, if every point that such steps of a brick read beyond the brick has the same history in the brick
/// to which it belongs, all bricks' own points together have a history in which every step followed from what
/// it read: by induction over the order, that of the whole volume's lattice. The points around the brick's
/// tets are compared, too, since cuts depend on them.
struct Seam {
  /// Own points that steps of other bricks may read, ascending.
  std::vector<SeamPoint> offered;
  /// Points of other bricks that own steps may have read, and those around the brick's tets, ascending. Each
  /// must be among those that another brick offers, or, if it is not near, must not.
  std::vector<SeamPoint> needed;
};

/// Records histories in a lattice and finds its seam.
class SeamRecorder {
 public:
  /// Starts recording: sets LabelledLattice::histories.
  /// \param lattice whose points have not been moved; must outlive the recorder
  /// \param brick finest cells
  SeamRecorder(LabelledLattice& lattice, const CellBox& brick);

  /// Whether a point belongs to the brick.
  bool is_inside(Index point) const { return inside_[point] != 0; }
  /// The seam after points were moved; ends recording.
  Seam finish();

 private:
  LabelledLattice& lattice_;
  std::vector<MortonKey> keys_;       ///< by point
  std::vector<std::uint8_t> inside_;  ///< by point: 1 if it belongs to the brick
};

}  // namespace tetwright
