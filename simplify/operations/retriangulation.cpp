#include "simplify/operations/retriangulation.h"

#include <algorithm>

#include "common/error.h"
#include "common/mesh/face_buckets.h"

namespace tetwright {

void Retriangulation::carry_out(EditableMesh& mesh, FreeSlots& free_tets, const Cavity& cavity) {
  sides_.clear();
  slots_.clear();
  collect_hull(mesh, cavity);
  write_tets(mesh, free_tets, cavity);
  link_sides(mesh);
  for (std::size_t i = 0; i < slots_.size(); ++i)
    for (Index p : cavity.added[i].points) {
      mesh.set_incident_tet(p, slots_[i]);
      mesh.touch(p);
    }
  for (std::size_t i = cavity.added.size(); i < cavity.removed.size(); ++i) {
    mesh.store_points(cavity.removed[i], dead_tet);
    free_tets.give_back(cavity.removed[i]);
  }
}

void Retriangulation::collect_hull(const EditableMesh& mesh, const Cavity& cavity) {
  const auto is_removed = [&](Index t) {
    return std::find(cavity.removed.begin(), cavity.removed.end(), t) != cavity.removed.end();
  };
  for (Index t : cavity.removed) {
    const TetRecord& r = mesh.tet(t);
    for (int f = 0; f < 4; ++f) {
      const Index across = r.neighbours[f];
      if (across == no_index || is_removed(across)) continue;
      const Triangle key = sorted_face(r.points, f).vertices;
      // By its vertices: two tets may share more than one face.
      int back = 0;
      while (back < 4 && (mesh.tet(across).neighbours[back] != t ||
                          sorted_face(mesh.tet(across).points, back).vertices != key))
        ++back;
      TETWRIGHT_CHECK(back < 4);  // links are mutual
      sides_.push_back({key, across, static_cast<std::uint8_t>(back), true});
    }
  }
}

void Retriangulation::write_tets(EditableMesh& mesh, FreeSlots& free_tets, const Cavity& cavity) {
  for (std::size_t i = 0; i < cavity.added.size(); ++i) {
    const NewTet& n = cavity.added[i];
    const Index slot = i < cavity.removed.size() ? cavity.removed[i] : free_tets.take();
    slots_.push_back(slot);
    mesh.store_points(slot, n.points);
    mesh.set_region(slot, n.region);
    mesh.set_quality(slot, n.quality);
    for (int f = 0; f < 4; ++f) {
      mesh.set_neighbour(slot, f, no_index);
      sides_.push_back({sorted_face(n.points, f).vertices, slot, static_cast<std::uint8_t>(f), false});
    }
  }
}

void Retriangulation::link_sides(EditableMesh& mesh) {
  std::sort(sides_.begin(), sides_.end(),
            [](const Side& x, const Side& y) { return x.key != y.key ? x.key < y.key : x.tet < y.tet; });
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    if (i + 1 < sides_.size() && sides_[i].key == sides_[i + 1].key) {
      const Side &x = sides_[i], &y = sides_[i + 1];
      mesh.set_neighbour(x.tet, x.face, y.tet);
      mesh.set_neighbour(y.tet, y.face, x.tet);
      ++i;
    } else {
      TETWRIGHT_CHECK(!sides_[i].outer);  // a hole would open
    }
  }
}

}  // namespace tetwright
