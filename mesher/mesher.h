#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "common/progress.h"
#include "common/reference_surface.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"

namespace tetwright {

struct MesherOptions {
  int resolution = 128;   ///< finest cells along the longest side, 4 to 4096; ignored if voxel_size is given
  double voxel_size = 0;  ///< edge of a finest cell, input units; 0: by resolution
  bool uniform = false;   ///< finest cells everywhere instead of an octree
  double adaptivity =
      0.05;  ///< how far a coarser cell may misplace the interface, finest cells; 0: never coarser
};

/// One closed surface and the material it encloses.
struct MaterialSurface {
  std::string name;
  MaterialTag tag = 0;
  TriangleMesh surface;
  std::string file;  ///< for messages
};

struct MesherReport {
  double cell_size = 0;          ///< edge of a finest cell, input units
  int resolution = 0;            ///< finest cells along the surface's longest side
  std::size_t cells = 0;         ///< leaves of the octree
  std::size_t lattice_tets = 0;  ///< before cutting, without those far outside
  std::size_t specks = 0;        ///< parts and cavities of a single lattice point, left out
  double seconds_sdf = 0, seconds_octree = 0, seconds_lattice = 0, seconds_move = 0, seconds_cut = 0;
};

struct MeshedSurface {
  TetMesh mesh;                                       ///< input units; see README.md for what it promises
  std::shared_ptr<const ReferenceSurface> reference;  ///< the signed distances the mesh was cut from
  MesherReport report;
};

/// What meshing would take.
struct MesherEstimate {
  std::size_t tets = 0;   ///< of the dense mesh, within a third or so
  std::size_t bytes = 0;  ///< largest memory while it is made, on the high side
};

/// Estimates from the surface's area and volume, without meshing. Throws as mesh_surfaces() does for surfaces
/// and options that make no sense.
MesherEstimate estimate_mesh(const std::vector<MaterialSurface>& surfaces, const MesherOptions& options);

/// Closed surfaces to a dense tet mesh with the invariants of README.md, the same bytes for any number of
/// threads. So far for a single material.
///
/// `progress` may be null. Throws UsageError (option values, not one surface), InputError (a surface that is
/// not closed, or too far from the origin for cells this small), NothingToMeshError (no lattice point is
/// inside), OutputError (the mesh would not fit in memory), Interrupted.
MeshedSurface mesh_surfaces(const std::vector<MaterialSurface>& surfaces, const MesherOptions& options,
                            Progress* progress);

/// The resolution that gives about 40 dense tets for each of `target_tets`, which is what a simplification
/// needs to have a choice: at least 32, no more than some 20 million dense tets. Throws InputError as
/// mesh_surfaces() does, UsageError for a target of 0.
int resolution_for_target(const std::vector<MaterialSurface>& surfaces, std::size_t target_tets);

}  // namespace tetwright
