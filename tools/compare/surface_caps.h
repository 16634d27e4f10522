// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "common/tet_mesh.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

/// Where surfaces are open.
struct OpenEdges {
  std::size_t count = 0;  ///< edges with one triangle
  /// Those beyond which there is nothing: not those of cracks, where another one runs along within a quarter
  /// of the edge's length.
  ProjectionTree rims;
};

OpenEdges find_open_edges(const MesherInput& surfaces);

/// Tells what closes a surface from what stands for it. Input units.
class CapFinder {
 public:
  /// `surfaces` and `rims` must outlive this.
  CapFinder(const ProjectionTree& surfaces, const ProjectionTree& rims, double diagonal)
      : surfaces_(surfaces), rims_(rims), diagonal_(diagonal) {}

  /// Whether the place is on a cap: the nearest point of the surfaces is on a rim.
  bool is_beyond_rim(const Vec3& place) const;

  /// Triangles of a mesh, of which those that are partly caps are cut into pieces.
  struct Parts {
    ProjectionTree kept, caps;
    double cap_area = 0, area = 0;  ///< of all caps, and of all triangles
  };
  /// A piece of at most 2 % of the diagonal is a cap if its corners and its centre are. Where only some are
  /// it is cut until it is smaller than 0.05 % of the diagonal, and kept then: no distance of what is kept is
  /// more than that too large. Caps over holes that no corner of pieces of 0.5 % shows are kept, too.
  Parts split(const TetMesh& mesh) const;

 private:
  const ProjectionTree &surfaces_, &rims_;
  double diagonal_;
};

}  // namespace tetwright
