// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/features/surface_patches.h"
#include "common/geometry/quality.h"
#include "common/sizes/size_field.h"
#include "common/types.h"
#include "mesher/input/surface_repair.h"
#include "simplify/schedule/options.h"

namespace tetwright {

/// A length that may depend on the size of the input.
struct Length {
  double value = 0;  ///< above 0; input units, or percent of the diagonal of the inputs' bounding box
  bool percent = false;

  double in_input_units(double diagonal) const { return percent ? value / 100 * diagonal : value; }
};

/// In input units; 0 for a length that is not asked for.
inline double in_input_units(const std::optional<Length>& length, double diagonal) {
  return length ? length->in_input_units(diagonal) : 0;
}

/// The cells of the dense mesh. For scans.
struct CellOptions {
  /// Finest cells along the longest side, 4 to 4096. Not asked for, nor `size`: what the target, the
  /// tolerance or the sizes need; without any of these 128, and one cell to a voxel for segmented volumes.
  std::optional<int> resolution;
  std::optional<double> size;  ///< edge of a finest cell, input units; instead of `resolution`
  bool uniform = false;        ///< finest cells everywhere instead of an octree
  double adaptivity = 0.05;    ///< max error of a coarser cell at a surface, finest cells
  /// How many times cells are halved where walls and gaps of a surface are thin, 0 to 8. Not asked for: 3,
  /// and more where that takes few cells.
  std::optional<int> max_refinement;
  std::optional<Length> min_gap;        ///< narrower gaps of a surface are closed
  std::optional<Length> min_thickness;  ///< thinner walls of a surface are left out
  bool keep_outside = false;            ///< meshes a box around the bodies, as the material `outside`, tag 0
};

/// A material under the surface of the first body.
struct Layer {
  std::string name;
  double thickness = 0;  ///< above 0, input units
};

/// The bodies that surfaces enclose.
struct BodyOptions {
  std::vector<Layer> layers;  ///< of the first surface, the outermost one first
  NestedRule nested = NestedRule::automatic;
  /// Each solid, group or label of a surface's triangles is a material by its name instead of a patch.
  bool split_solids = false;
};

/// Default of LabelOptions::min_voxels.
inline constexpr std::size_t default_min_voxels = 8;

/// The labels of a segmented volume.
struct LabelOptions {
  /// Inclusive ranges of the labels that become materials; empty: all but the outside label.
  std::vector<std::pair<MaterialTag, MaterialTag>> meshed;
  std::string names_file;              ///< names of labels; empty: those of the volume
  std::optional<MaterialTag> outside;  ///< the label that means outside; not asked for: 0
  /// Smaller islands are merged into what they touch most; not asked for: default_min_voxels.
  std::optional<std::size_t> min_voxels;
};

/// How many tets, and how near.
struct TargetOptions {
  std::optional<std::size_t> tets;  ///< not asked for: as few as the tolerance or the sizes allow
  /// Max distance of any point of the mesh's surface and of the input's from the other.
  std::optional<Length> tolerance;
};

/// Edge lengths that are wanted: a file, or a source in memory.
struct SizeFieldInput {
  std::string name;                                    ///< of the file; names the source in messages
  std::shared_ptr<const SizeSource> source = nullptr;  ///< null: the file is read
};

/// Lengths of edges.
struct SizeOptions {
  std::optional<SizeFieldInput> field;
  std::optional<Length> min_edge, max_edge;
  std::optional<double> grading;  ///< growth of the wanted length over distance; default_grading
};

/// Default of ShapeOptions::min_solid_angle, steradians.
inline constexpr double default_min_solid_angle = 0.1;

/// The shapes of tets.
struct ShapeOptions {
  /// Steradians. Not asked for: default_min_solid_angle, and smaller angles are no shortfall.
  std::optional<double> min_solid_angle;
  ShapeObjective objective = ShapeObjective::both;
  int max_iterations = 100;          ///< of the block loop, or rounds of improving
  bool fix_boundary = false;         ///< keeps points and faces of the boundary and of interfaces
  std::optional<double> only_below;  ///< improving: works only on tets with a smaller solid angle, steradians
  bool free_count = false;           ///< improving: the number of tets may become what good shapes need

  double bound() const { return min_solid_angle.value_or(default_min_solid_angle); }
};

/// The order of the simplifier's operations.
struct ScheduleOptions {
  Schedule kind = Schedule::tuned;
  double beta = 5;    ///< largest edge, in ideal edges, that quality does not penalise
  double gamma = 10;  ///< weight of the surface error
};

/// The unit of limits on memory, bytes.
inline constexpr double gigabyte = 1 << 30;

/// Limits on a run.
struct LimitOptions {
  unsigned threads = 0;            ///< 0: those of the machine
  std::optional<double> seconds;   ///< ends with the best mesh so far; results then depend on the machine
  std::optional<double> memory;    ///< 2^30 bytes; cells that nobody asked for become larger to fit
  double later_bytes_per_tet = 0;  ///< memory that the caller needs for each tet of the result, bytes
};

/// Which diagnostics make a result fall short, see Diagnostic.
struct AcceptanceOptions {
  bool accept_changes = false;  ///< another solid than the input's is a note
  bool strict = false;          ///< a note is a shortfall
};

/// Values that a result keeps beside the mesh.
struct KeepOptions {
  bool reference = true;  ///< the surface that the mesh is compared with
  bool field = true;      ///< the signed distances that were meshed
};

/// Options of prepare() and its relatives. prepare() uses all of them, each relative the groups that concern
/// it: mesh_scans() not `shapes` and `schedule`, simplify_mesh() not `cells`, `bodies` and `labels`,
/// improve_mesh() only `shapes`, `feature_angle`, `order`, `seed`, `limits` and `acceptance`.
struct PrepareOptions {
  CellOptions cells;
  BodyOptions bodies;
  LabelOptions labels;
  FeatureAngle feature_angle;  ///< which edges stay sharp
  TargetOptions target;
  SizeOptions sizes;
  ShapeOptions shapes;
  ScheduleOptions schedule;
  int order = 1;               ///< of the elements: 2 has nodes in the middle of the edges
  std::string material_field;  ///< of a tet mesh: the cell field with the materials; empty: by its name
  std::uint64_t seed = 1;      ///< the same seed gives the same bytes
  LimitOptions limits;
  AcceptanceOptions acceptance;
  KeepOptions keep;
};

}  // namespace tetwright
