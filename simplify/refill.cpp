#include "simplify/refill.h"

#include <algorithm>

#include "common/error.h"

namespace tetwright {

namespace {

/// A face of a new tet, or of the cavity's hull as seen from outside.
struct Side {
  Triangle key;  ///< ids ascending
  Index tet;     ///< slot of the new tet, or the tet outside
  std::uint8_t face;
  bool outer;
};

Triangle face_key(const Tet& t, int f) {
  Triangle k{t[tet_faces[f][0]], t[tet_faces[f][1]], t[tet_faces[f][2]]};
  if (k[0] > k[1]) std::swap(k[0], k[1]);
  if (k[1] > k[2]) std::swap(k[1], k[2]);
  if (k[0] > k[1]) std::swap(k[0], k[1]);
  return k;
}

}  // namespace

void refill(Task& task, const Cavity& cavity) {
  EditableMesh& mesh = task.mesh;
  thread_local std::vector<Side> sides;
  thread_local std::vector<Index> slots;
  sides.clear();
  slots.clear();
  const auto goes = [&](Index t) {
    return std::find(cavity.removed.begin(), cavity.removed.end(), t) != cavity.removed.end();
  };
  for (Index t : cavity.removed) {
    const TetRecord& r = mesh.tet(t);
    for (int f = 0; f < 4; ++f) {
      const Index beyond = r.neighbours[f];
      if (beyond == no_index || goes(beyond)) continue;
      const Triangle key = face_key(r.points, f);
      // By its points: two tets may share more than one face.
      int back = 0;
      while (mesh.tet(beyond).neighbours[back] != t || face_key(mesh.tet(beyond).points, back) != key) ++back;
      sides.push_back({key, beyond, static_cast<std::uint8_t>(back), true});
    }
  }
  for (std::size_t i = 0; i < cavity.added.size(); ++i) {
    const NewTet& n = cavity.added[i];
    const Index slot = i < cavity.removed.size() ? cavity.removed[i] : task.slots.take();
    slots.push_back(slot);
    mesh.store_points(slot, n.points);
    mesh.set_region(slot, n.region);
    mesh.set_quality(slot, n.quality);
    for (int f = 0; f < 4; ++f) {
      mesh.set_neighbour(slot, f, no_index);
      sides.push_back({face_key(n.points, f), slot, static_cast<std::uint8_t>(f), false});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& x, const Side& y) { return x.key != y.key ? x.key < y.key : x.tet < y.tet; });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool paired = i + 1 < sides.size() && sides[i].key == sides[i + 1].key;
    if (paired) {
      const Side &x = sides[i], &y = sides[i + 1];
      mesh.set_neighbour(x.tet, x.face, y.tet);
      mesh.set_neighbour(y.tet, y.face, x.tet);
      ++i;
    } else {
      TETWRIGHT_CHECK(!sides[i].outer);  // else a hole would open
    }
  }
  for (std::size_t i = 0; i < slots.size(); ++i)
    for (Index p : cavity.added[i].points) {
      mesh.set_hint(p, slots[i]);
      mesh.touch(p);
    }
  for (std::size_t i = cavity.added.size(); i < cavity.removed.size(); ++i) {
    mesh.store_points(cavity.removed[i], {no_index, no_index, no_index, no_index});
    task.slots.give_back(cavity.removed[i]);
  }
}

}  // namespace tetwright
