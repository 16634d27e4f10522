// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "tetwright/mesher_input.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Boundary edges of surfaces.
struct OpenEdges {
  std::size_t count = 0;  ///< number of edges with one triangle
  /// Boundary edges, except those of cracks: edges that have another boundary edge within a quarter of their
  /// length.
  ProjectionTree rims;
};

OpenEdges find_open_edges(const MesherInput& surfaces);

/// Distinguishes the parts of a mesh that close holes of a surface (caps) from those that follow it. Input
/// units.
class CapFinder {
 public:
  /// \pre `surfaces` and `rims` outlive this.
  CapFinder(const ProjectionTree& surfaces, const ProjectionTree& rims, double diagonal)
      : surfaces_(surfaces), rims_(rims), diagonal_(diagonal) {}

  /// Whether the point is on a cap: the closest point of the surfaces lies on a rim.
  bool is_beyond_rim(const Vec3& place) const;

  /// Triangles of a mesh; those that are partly caps are cut into pieces.
  struct Parts {
    ProjectionTree kept, caps;
    double cap_area = 0, area = 0;  ///< area of the caps, and of all triangles
  };
  /// Splits a mesh into caps and the rest. A piece of at most 2 % of the diagonal is a cap if its corners and
  /// centre are on a cap. If only some of them are, the piece is cut until it is below 0.05 % of the
  /// diagonal, and then kept; so distances of kept pieces are too large by at most that. Caps over holes so
  /// small that no corner of a piece of 0.5 % is on them are kept, too.
  Parts split(const TetMesh& mesh) const;

 private:
  const ProjectionTree &surfaces_, &rims_;
  double diagonal_;
};

}  // namespace tetwright
