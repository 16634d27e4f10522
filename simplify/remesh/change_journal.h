// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/local_numbers.h"
#include "simplify/operations/proposal.h"

namespace tetwright {

/// Records the previous state of all tets and points changed by operations. Time and memory are proportional
/// to their number.
class ChangeJournal {
 public:
  struct OldTet {
    Index slot;
    Tet points;  ///< dead_tet: the slot was free
    RegionId region;
  };
  struct OldPoint {
    Index point;
    bool existed;
    Vec3 position;  ///< working coordinates
  };

  void clear();
  /// Records the state of all elements that a winner is about to change. One thread at a time.
  /// \pre The winner is not committed yet.
  void note(const EditableMesh& mesh, const Proposal& proposal);

  /// The tets that were removed or changed, and the slots assigned to new ones; each once, in order of first
  /// change.
  const std::vector<OldTet>& tets() const { return tets_; }
  const std::vector<OldPoint>& points() const { return points_; }
  /// \pre p is a point of an old tet.
  const OldPoint& point(Index p) const { return points_[point_numbers_.find(p)]; }

 private:
  void note_tet(const EditableMesh& mesh, Index t);
  void note_point(const EditableMesh& mesh, Index p);

  std::vector<OldTet> tets_;
  std::vector<OldPoint> points_;
  LocalNumbers tet_numbers_, point_numbers_;
};

}  // namespace tetwright
