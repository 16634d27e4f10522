// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/local_numbers.h"
#include "simplify/operations/proposal.h"

namespace tetwright {

/// What the tets and points that operations changed were before: time and memory go with their number.
class ChangeJournal {
 public:
  struct OldTet {
    Index slot;
    Tet points;  ///< dead_tet: there was none in this slot
    RegionId region;
  };
  struct OldPoint {
    Index point;
    bool existed;
    Vec3 position;  ///< working coordinates
  };

  void clear();
  /// Takes down what a winner is about to change; before its commit, one thread at a time.
  void note(const EditableMesh& mesh, const Proposal& proposal);

  /// In the order in which they were first changed, each once: those that went or changed, and slots that
  /// were given to new ones.
  const std::vector<OldTet>& tets() const { return tets_; }
  const std::vector<OldPoint>& points() const { return points_; }
  /// Of a point of an old tet.
  const OldPoint& point(Index p) const { return points_[point_numbers_.find(p)]; }

 private:
  void note_tet(const EditableMesh& mesh, Index t);
  void note_point(const EditableMesh& mesh, Index p);

  std::vector<OldTet> tets_;
  std::vector<OldPoint> points_;
  LocalNumbers tet_numbers_, point_numbers_;
};

}  // namespace tetwright
