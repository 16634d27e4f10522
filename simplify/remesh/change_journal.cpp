// SPDX-License-Identifier: Apache-2.0
#include "simplify/remesh/change_journal.h"

namespace tetwright {

void ChangeJournal::clear() {
  tets_.clear();
  points_.clear();
  tet_numbers_.clear();
  point_numbers_.clear();
}

void ChangeJournal::note(const EditableMesh& mesh, const Proposal& proposal) {
  using Change = Proposal::Change;
  // Lists that this kind of change does not use may contain data of an operation tried before.
  if (proposal.change != Change::move)
    for (Index t : proposal.removed) note_tet(mesh, t);
  if (proposal.change != Change::replace)
    for (const Proposal::RatedTet& t : proposal.rated) note_tet(mesh, t.tet);
  for (Index t : proposal.new_tets) note_tet(mesh, t);
  if (proposal.has_new_point) note_point(mesh, proposal.new_point_id);
}

void ChangeJournal::note_tet(const EditableMesh& mesh, Index t) {
  bool added;
  tet_numbers_.number(t, added);
  if (!added) return;
  const Tet points = mesh.points(t);
  tets_.push_back({t, points, mesh.region(t)});
  if (points == dead_tet) return;
  for (Index p : points) note_point(mesh, p);
}

void ChangeJournal::note_point(const EditableMesh& mesh, Index p) {
  bool added;
  point_numbers_.number(p, added);
  if (added) points_.push_back({p, mesh.incident_tet(p) != no_index, mesh.position(p)});
}

}  // namespace tetwright
