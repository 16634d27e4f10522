// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/surface_deviation.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"
#include "tools/compare/crease_comparison.h"
#include "tools/compare/solid_comparison.h"

namespace tetwright {

/// A mesh beside the surfaces that it should have. Input units.
struct SurfaceComparison {
  /// Something that may not be farther from its counterpart than a tolerance.
  struct Bound {
    double upper;      ///< infinite where there is no counterpart
    std::string what;  ///< "the mesh is up to 1.5 from the surface, at (0, 1, 2)"
  };

  double diagonal = 0;           ///< of the surfaces' bounding box
  std::size_t outside_tets = 0;  ///< of the material that --keep-outside makes: not compared
  bool inverted = false;         ///< all other tets, which count as turned
  SurfaceDeviation from_mesh, from_surfaces;
  std::size_t open_edges = 0;  ///< edges of the surfaces with one triangle
  /// Parts of the mesh that close the surfaces there: their nearest points of the surfaces are on such edges.
  /// They are left out of `from_mesh`.
  struct Caps {
    SurfaceDeviation from_mesh;  ///< of the caps alone
    double area = 0, share = 0;  ///< and of all of the mesh's area that is compared
  };
  std::optional<Caps> caps;
  /// Of one closed surface: volume, components, handles and cavities beside those of the mesh's boundary.
  std::optional<SolidComparison> solid;
  /// Where the surfaces have any: their creases beside the mesh's edges that turn at least half as far as a
  /// crease does, and the mesh's creases beside such edges of the surfaces.
  std::optional<CreaseComparison> creases, mesh_creases;
  bool intersecting = false;      ///< some surface intersects itself
  bool creases_left_out = false;  ///< and such a one has creases, which are not compared

  /// What is proven: no point of one is farther from the other than this, no place of a crease of the
  /// surfaces from such an edge of the mesh, no corner of them from a point of it. Creases of the mesh are
  /// not among them: where tets are large a round face has some.
  std::vector<Bound> bounds() const;
  /// The largest one.
  double upper() const;
};

/// Compares the boundary of the mesh without the outside that it may keep, and its interfaces too if there
/// are several surfaces, with all of them together, whatever the mesh was made from. Distances are from the
/// surfaces as they are given; volume, topology and creases are theirs once equal points are joined and
/// triangles wound alike. `names` are those of the surfaces' files, for messages. The mesh has its
/// interfaces. Throws InputError as make_mesher_input() and find_patches() do, and UsageError where only the
/// outside is meshed.
SurfaceComparison compare_with_surfaces(const TetMesh& mesh, const std::vector<TriangleMesh>& surfaces,
                                        const std::vector<std::string>& names);

/// The lines that `check` prints, without their ends.
std::vector<std::string> comparison_lines(const SurfaceComparison& comparison);

/// Whether all is within the tolerance (input units), and what is not.
std::string tolerance_line(const SurfaceComparison& comparison, double tolerance);

}  // namespace tetwright
