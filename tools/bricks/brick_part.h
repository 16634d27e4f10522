// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/brick_mesher.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/simplify.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A brick's contribution to the mesh of a volume: its dense mesh, coarsened, and all that must be known of
/// the dense one. Lengths in input units.
struct BrickPart {
  BrickBorder border;
  bool kept_surface = false;  ///< BrickTask::keep_surface
  /// Coarsened. Its interfaces are only the faces with a patch: those on the border of the volume.
  TetMesh mesh;
  /// By point of `mesh`: `shared` if other bricks may have it, `on_interface` if it lies on an interface, on
  /// the boundary or where the brick was cut off.
  std::vector<std::uint8_t> flags;
  static constexpr std::uint8_t shared = 1, on_interface = 2;

  /// Boundary and interfaces of the dense mesh, without `cut_faces`; no tets. Thinned if the brick will be
  /// coarsened again (BrickTask::thin).
  TetMesh surface;
  std::vector<std::uint8_t> surface_shared;  ///< by point of `surface`: 1 if other bricks may have it
  /// Faces of the dense mesh that belong to a tet of another brick, too, unless they are on its boundary.
  std::vector<InterfaceTriangle> cut_faces;

  /// Statistics of the dense mesh, without interfaces but for those of `surface` before it was thinned. Only
  /// points that no other brick has are counted, and the volumes in the histogram are relative to the
  /// brick's mean.
  MeshStatistics dense;
  std::size_t leaves = 0, lattice_tets = 0, isolated_vertices = 0;
};

/// A brick to be meshed and coarsened.
struct BrickTask {
  std::size_t brick = 0;  ///< its index
  int halo = 0;           ///< as for BrickMesher::mesh()
  /// Do not coarsen the boundary to the outside: it would meet that of another brick.
  bool keep_surface = false;
  /// Thin the dense surface (BrickRoundsTuning::Surface), since the brick will be coarsened again.
  bool thin = false;
  int round = 1;  ///< from 1
};

/// Meshes and coarsens a brick.
/// \param box of the brick
/// \param density final tets per volume, input units
/// \param options its target and its frozen points are not used
/// \param threshold for the statistics, steradians
/// \throws Interrupted, OutOfTime
BrickPart make_brick_part(const BrickMesher& mesher, const CellBox& box, const BrickTask& task,
                          double density, CoarsenOptions options, double threshold, Progress* progress);

/// BrickPart::flags of a coarsened mesh with its interfaces.
/// \param shared coordinates of the points where it was cut off
std::vector<std::uint8_t> flags_of(const TetMesh& mesh, const std::vector<Vec3>& shared);

}  // namespace tetwright
