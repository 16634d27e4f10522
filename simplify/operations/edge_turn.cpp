// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/edge_turn.h"

#include <algorithm>
#include <array>

#include "common/geometry/quality.h"

namespace tetwright {

namespace {

/// Degrees; the excess is more than rounding.
constexpr double full_turn = 360.001;

/// A point of a tet after the proposal.
struct Corner {
  Index original;
  Vec3 position;
};

/// The tets at an edge after the proposal.
class EdgeTurn {
 public:
  EdgeTurn(Workspace& ws, const std::array<Index, 2>& ends)
      : mesh_(ws.mesh), proposal_(ws.proposal), walk_(ws.walk), ends_(ends) {}

  /// Sum of their dihedral angles, degrees.
  ///
  /// \param at an end of the edge that the proposal does not change.
  double around(Index at) {
    double sum = 0;
    walk_.any_tet(mesh_, at, [&](Index t) {
      sum += of_standing(t);
      return false;
    });
    if (proposal_.change == Proposal::Change::replace)
      for (const NewTet& t : proposal_.added) sum += angle(t.points);
    return sum;
  }

 private:
  double of_standing(Index t) const {
    const std::vector<Index>& removed = proposal_.removed;
    if (proposal_.change != Proposal::Change::move &&
        std::find(removed.begin(), removed.end(), t) != removed.end())
      return 0;
    return angle(mesh_.points(t));
  }

  Corner corner(Index p) const {
    const bool is_centre = proposal_.change != Proposal::Change::replace && p == proposal_.centre;
    if (p == unnumbered_point || (is_centre && proposal_.change == Proposal::Change::move))
      return {mesh_.original(p), proposal_.position};
    if (is_centre) p = proposal_.target;
    return {mesh_.original(p), mesh_.position(p)};
  }

  /// The tet's dihedral angle at the edge, degrees; 0 if it does not have the edge.
  double angle(const Tet& points) const {
    std::array<Vec3, 4> at;
    std::array<bool, 4> is_end{};
    int ends = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Corner c = corner(points[k]);
      at[k] = c.position;
      is_end[k] = c.original == ends_[0] || c.original == ends_[1];
      ends += is_end[k];
    }
    if (ends < 2) return 0;
    const std::array<double, 6> angles = dihedral_angles(at);
    for (std::size_t e = 0; e < tet_edges.size(); ++e)
      if (is_end[tet_edges[e][0]] && is_end[tet_edges[e][1]]) return angles[e];
    return 0;
  }

  const EditableMesh& mesh_;
  const Proposal& proposal_;
  StarWalk& walk_;
  std::array<Index, 2> ends_;
};

}  // namespace

bool folds_over(Workspace& ws) {
  Proposal& p = ws.proposal;
  for (const std::array<Index, 2>& ends : p.edit.narrow_edges) {
    const auto stays = [&](Index point) {
      const Index original = ws.mesh.original(point);
      const bool changes = (p.change != Proposal::Change::replace && point == p.centre) ||
                           (p.change == Proposal::Change::collapse && point == p.target);
      return (original == ends[0] || original == ends[1]) && !changes;
    };
    const auto at = std::find_if(p.write_set.begin(), p.write_set.end(), stays);
    if (at == p.write_set.end()) continue;
    if (EdgeTurn(ws, ends).around(*at) > full_turn) return true;
    const auto read = static_cast<std::size_t>(at - p.write_set.begin());
    if (read >= p.read_set_size) std::swap(p.write_set[read], p.write_set[p.read_set_size++]);
  }
  return false;
}

}  // namespace tetwright
