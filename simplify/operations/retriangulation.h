#pragma once

#include <vector>

#include "simplify/mesh/cavity.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/free_slots.h"

namespace tetwright {

/// Replaces the tets of a cavity by the new ones that fill it. Keeps its memory from cavity to cavity; one
/// for each worker.
class Retriangulation {
 public:
  /// Links the new tets with each other and with the tets around, and gives all their points a living
  /// incident tet. Faces of the cavity's hull that no new tet has must have been on the boundary of the mesh.
  /// The caller has locked every point of the old and new tets, has reserved slots for as many tets as are
  /// added beyond the removed ones, and has changed the count.
  void carry_out(EditableMesh& mesh, FreeSlots& free_tets, const Cavity& cavity);

 private:
  /// A face of a new tet, or of the cavity's hull as seen from outside.
  struct Side {
    Triangle key;  ///< ids ascending
    Index tet;     ///< slot of the new tet, or the tet outside
    std::uint8_t face;
    bool outer;
  };
  void collect_hull(const EditableMesh& mesh, const Cavity& cavity);
  void write_tets(EditableMesh& mesh, FreeSlots& free_tets, const Cavity& cavity);
  void link_sides(EditableMesh& mesh);

  std::vector<Side> sides_;
  std::vector<Index> slots_;  ///< of the added tets
};

}  // namespace tetwright
