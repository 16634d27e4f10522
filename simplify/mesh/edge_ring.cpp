// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/edge_ring.h"

#include <algorithm>

namespace tetwright {

Outcome EdgeRing::gather(const EditableMesh& mesh, Index tet, int edge, std::size_t limit) {
  points.clear();
  tets.clear();
  regions.clear();
  behind_interface.clear();
  worst = 1;
  interface_triangles = 0;
  closed = false;
  const Tet& first = mesh.points(tet);
  const int i0 = tet_edges[edge][0], i1 = tet_edges[edge][1];
  const int j0 = tet_edges[5 - edge][0], j1 = tet_edges[5 - edge][1];
  a = first[i0];
  b = first[i1];
  // (i0, i1, j0, j1) of tet_edges is an even permutation except for the edges 02 and 13.
  const bool even = edge != 1 && edge != 4;
  const Index start = first[even ? j0 : j1], second = first[even ? j1 : j0];

  const auto add = [&](Index t, bool interface) {
    tets.push_back(t);
    regions.push_back(mesh.region(t));
    behind_interface.push_back(interface);
    worst = std::min(worst, mesh.quality(t));
  };
  /// The link across the face (a, b, keep) of t, whose fourth point is `leave`.
  const auto across = [&](Index t, Index leave) { return mesh.link(t, mesh.slot_of(t, leave)); };
  /// The point of t other than a, b and `known`.
  const auto fourth = [&](Index t, Index known) {
    for (Index p : mesh.points(t))
      if (p != a && p != b && p != known) return p;
    return no_index;
  };

  const FaceLink before = across(tet, second);  // the face (a, b, start)
  add(tet, before.is_interface());
  points = {start, second};
  for (Index at = tet, leave = start;;) {
    const FaceLink link = across(at, leave);
    const Index next = link.tet();
    if (next == no_index) break;
    if (next == tet) {
      closed = true;
      points.pop_back();
      break;
    }
    if (tets.size() == limit) return Outcome::too_large;
    const Index p = fourth(next, points.back());
    if (p == no_index) return Outcome::too_large;  // a repeated tet in the input: no ring exists
    leave = points.back();                         // next: across (a, b, p)
    add(next, link.is_interface());
    points.push_back(p);
    at = next;
  }
  if (!closed) {
    // Walk the other way and prepend.
    for (Index at = tet, leave = second;;) {
      const Index next = across(at, leave).tet();
      if (next == no_index) break;
      if (tets.size() == limit) return Outcome::too_large;
      const Index p = fourth(next, points.front());
      if (p == no_index) return Outcome::too_large;
      leave = points.front();
      tets.insert(tets.begin(), next);
      regions.insert(regions.begin(), mesh.region(next));
      // The face (a, b, p) of `next` lies opposite the point that the walk comes from.
      behind_interface.insert(behind_interface.begin(), across(next, leave).is_interface());
      worst = std::min(worst, mesh.quality(next));
      points.insert(points.begin(), p);
      at = next;
    }
    interface_triangles = 1;  // the face behind the last tet
  }
  for (const std::uint8_t interface : behind_interface) interface_triangles += interface;
  return Outcome::done;
}

void EdgeRing::begin_at_interface() {
  const std::size_t n = tets.size();
  std::size_t k = 0;
  while (k < n && !behind_interface[k]) ++k;
  if (k == n) return;
  const auto by = static_cast<std::ptrdiff_t>(k);
  std::rotate(tets.begin(), tets.begin() + by, tets.end());
  std::rotate(regions.begin(), regions.begin() + by, regions.end());
  std::rotate(behind_interface.begin(), behind_interface.begin() + by, behind_interface.end());
  std::rotate(points.begin(), points.begin() + by, points.end());
}

}  // namespace tetwright
