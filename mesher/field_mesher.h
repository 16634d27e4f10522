// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesher/cut/cutting.h"
#include "mesher/cut/sheet_faces.h"
#include "mesher/cut/thin_wall_recovery.h"
#include "mesher/domain/material_field.h"
#include "mesher/domain/refinement_regions.h"
#include "mesher/mesh_estimate.h"
#include "tetwright/loop_times.h"
#include "tetwright/mesher.h"

namespace tetwright {

/// Reports the stages of meshing to a Progress (may be null) and measures their times and loops.
class Stages {
 public:
  explicit Stages(Progress* progress) : progress_(progress) {}
  void begin(const char* name) {
    throw_if_stopped();
    if (progress_) progress_->begin_stage(name);
    start_ = std::chrono::steady_clock::now();
    loops_before_ = loop_times();
  }
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  LoopTimes loops() const { return loop_times() - loops_before_; }
  /// Delegates to Progress.
  void throw_if_stopped() const {
    if (progress_) progress_->throw_if_stopped();
  }
  Progress* progress() const { return progress_; }

 private:
  Progress* progress_;
  std::chrono::steady_clock::time_point start_;
  LoopTimes loops_before_;
};

/// The edge of a finest cell, input units.
/// \param longest_side of the input, input units
/// \param max_coordinate largest absolute coordinate of the input, input units
/// \throws UsageError for option values out of range
/// \throws InputError about `file` if coordinates are too large for cells this small
double finest_cell_size(const MesherOptions& options, double longest_side, double max_coordinate,
                        const std::string& file);

/// How many times cells of this frame can be halved. Lattice points must still have distinct numbers and, at
/// coordinates of this size, distinct positions.
int max_possible_refinement(const GridFrame& frame, double max_coordinate);

/// Converts to input units.
ThickenedWallsReport thickened_report(const ThickenedWalls& left, const GridFrame& frame);

/// A mesh of a field, without the faces of sheets.
struct FieldMesh {
  DenseMesh dense;
  std::optional<SheetParts> parts;  ///< if the field has sheets
};

/// The reference for simplify() of a mesh of the field.
/// \param mesh its points and interfaces with their patches
std::shared_ptr<const ReferenceSurface> reference_of(const TetMesh& mesh,
                                                     std::shared_ptr<const MaterialField> field);

/// Names the patches 1 to 6 of `interfaces`, on the sides of a volume's box: "border_x_min" and so on for the
/// coordinate along which the axis runs most; with the name of its material in front ("bone:border_x_min") if
/// several reach that side.
/// \param faces of the dense mesh, which decide whether several do
void name_border_patches(const std::vector<InterfaceTriangle>& faces, const GridFrame& frame, TetMesh& mesh);

/// Transforms a mesh of the field to input units, with its interfaces and its reference surface.
/// \param cut lattice units
void set_mesh(CutMesh cut, std::shared_ptr<const MaterialField> field, DenseMesh& result);

/// A flag for each region of the field: 1 if it is among `regions`.
std::vector<std::uint8_t> regions_there(const MaterialField& field, const std::vector<RegionIndex>& regions);

/// Meshes a field: builds the octree and the lattice, moves points, cuts tets, and transforms the result to
/// input units.
/// \param interface_voxels of the field
/// \param finer cells to be halved
/// \param report its remaining fields are filled in
/// \param validate_regions receives a flag for each region, 0 if nothing is left of it; throws if that region
///   is required
/// \pre the current stage is "octree"
/// \throws OutputError if the memory does not suffice
/// \throws Interrupted and whatever `validate_regions` throws
FieldMesh mesh_field(std::shared_ptr<const MaterialField> field, std::vector<MortonKey> interface_voxels,
                     RefinementRegions finer, const MesherOptions& options, const MemoryModel& memory,
                     MesherReport report, Stages& stages,
                     const std::function<void(const std::vector<std::uint8_t>&)>& validate_regions);

}  // namespace tetwright
