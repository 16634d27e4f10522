// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "mesher/cut/cutting.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/lattice/seam.h"
#include "mesher/volume_field.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// A brick with what tells whether its mesh is that of the whole volume.
struct BrickBorder {
  CellBox brick;
  int halo = 0;  ///< finest cells around the brick whose points were moved with its own
  Seam seam;
};

/// The part of a volume's dense mesh that belongs to a brick.
struct BrickMesh {
  BrickBorder border;
  CutMesh mesh;  ///< the brick's tets, in the order of the whole mesh
  /// 1 for each point that a tet of another brick has, too.
  std::vector<std::uint8_t> shared;
  std::size_t leaves = 0, lattice_tets = 0, isolated_vertices = 0;  ///< of the brick

  void add_to(MesherReport& report) const {
    report.lattice_tets += lattice_tets;
    report.isolated_vertices += isolated_vertices;
    report.cells += leaves;
  }
};

/// The mesh of a volume from its bricks.
struct BrickedMesh {
  CutMesh mesh;
  std::size_t bricks = 0;
  std::size_t repeated = 0;  ///< times that a brick was meshed again, with a larger halo
};

/// Meshes a segmented volume brick by brick: the bricks' tets together are those of the volume meshed whole,
/// with the same coordinates to the last bit, for bricks of any size and position.
///
/// Everything that decides about a tet is near it, but no bound tells how near, since each moved point makes
/// room for its neighbours. A brick is therefore meshed with a halo. Seams tell whether it sufficed
/// (unconfirmed_bricks()); if not, bricks are meshed again with a larger one.
///
/// Immutable after construction; bricks may be meshed concurrently. The field of the whole volume is in
/// memory.
class BrickMesher {
 public:
  /// \param options without MesherOptions::uniform
  /// \param report receives the refinement
  /// \throws Interrupted
  BrickMesher(VolumeField volume, const MesherOptions& options, MesherReport& report, Progress* progress);

  /// The frame of the lattice. Bricks consist of its root cells.
  const GridFrame& frame() const { return field_->frame(); }
  const std::shared_ptr<const MaterialField>& field() const { return field_; }
  /// Edge of a root cell, finest cells.
  int root() const { return 1 << frame().root_level; }
  /// The volume's bricks in Morton order.
  /// \param side finest cells: a power of two, at least a root cell
  std::vector<CellBox> bricks(int side) const;
  /// Meshes a brick.
  /// \param brick finest cells, whole root cells; the last ones along an axis end at frame().cells
  /// \param halo finest cells, one root cell or more
  /// \param progress may be null
  /// \throws Interrupted
  BrickMesh mesh(const CellBox& brick, int halo, Progress* progress) const;
  /// Halo that nearly always suffices, finest cells.
  int usual_halo() const;
  /// Meshes the whole volume by bricks, one after another. The mesh is the same for any size of bricks,
  /// including the order of points and tets.
  /// \param side as for bricks()
  /// \param report receives the numbers of leaves, lattice tets and isolated vertices
  /// \throws Interrupted
  BrickedMesh mesh_all(int side, MesherReport& report, Progress* progress) const;

 private:
  MesherOptions options_;
  std::shared_ptr<const MaterialField> field_;  ///< refined
  RefinementRegions finer_;
  std::vector<MortonKey> interface_voxels_;
};

/// The bricks, by index, whose halo may not have sufficed: those that read a point of another brick which has
/// another history there, and that other one.
/// \param bricks all bricks of a volume
std::vector<std::size_t> unconfirmed_bricks(const std::vector<const BrickBorder*>& bricks);

/// A brick to be made.
struct BrickOrder {
  std::size_t brick;  ///< its index
  int halo;           ///< as for BrickMesher::mesh()
};

/// Has all bricks of a volume made, and those again whose halo may not have sufficed.
/// \param boxes of whole root cells, which fill the frame
/// \param borders receives the bricks' borders, which `make` sets
/// \param make makes bricks; each of them at most once in a call
/// \return how many times a brick was made again
std::size_t make_bricks(const BrickMesher& mesher, const std::vector<CellBox>& boxes,
                        std::vector<BrickBorder>& borders,
                        const std::function<void(const std::vector<BrickOrder>&)>& make);

}  // namespace tetwright
