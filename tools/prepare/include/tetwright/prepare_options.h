// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/face_selection.h"
#include "tetwright/image_input.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/simplify.h"
#include "tetwright/sizes.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tetwright/value_options.h"

namespace tetwright {

/// Cells of the dense mesh. For scans.
struct CellOptions {
  /// Number of finest cells along the longest side, 4 to 4096. Without this and `size`, the target, tolerance
  /// or sizes determine the cells; without any of these there are 128, or one cell per voxel for segmented
  /// volumes.
  std::optional<int> resolution;
  std::optional<double> size;  ///< edge of a finest cell, input units; cannot be combined with `resolution`
  bool uniform = false;        ///< true: finest cells everywhere instead of an octree
  double adaptivity = 0.05;    ///< maximum error of a coarser cell at a surface, in finest cells
  /// Maximum number of times cells are halved at thin walls and gaps of a surface, 0 to 8. std::nullopt: 3,
  /// or more if that takes few cells.
  std::optional<int> max_refinement;
  std::optional<Length> min_gap;        ///< narrower gaps of a surface are closed
  std::optional<Length> min_thickness;  ///< thinner walls of a surface are left out
  bool keep_outside = false;            ///< true: mesh a box around the bodies as material `outside`, tag 0
};

/// A layer of material under the surface of the first body.
struct Layer {
  std::string name;
  double thickness = 0;  ///< above 0, input units
};

/// Bodies enclosed by surfaces.
struct BodyOptions {
  std::vector<Layer> layers;  ///< layers of the first surface, outermost first
  NestedRule nested = NestedRule::automatic;
  /// Gaps and overlaps of different bodies up to this are contact. std::nullopt: 1e-5 of the diagonal.
  std::optional<Length> contact_tolerance;
  OverlapRule overlap = OverlapRule::later;
  RegionOptions regions;  ///< of surfaces that inner walls divide
  /// Names of caps, each for the cap nearest to its point; the others are called cap_1, cap_2 and so on.
  std::vector<RegionSeed> caps;
  /// Borders of Input::as_partition() that end before the boundary of a body are extended by at most this.
  std::optional<Length> extend;
  /// Open surfaces are height fields, which become the tops of blocks (OpenSurfaceOptions::base).
  std::optional<BaseHeight> base;
  /// Open surfaces are the fronts of shells of this thickness (OpenSurfaceOptions::thickness).
  std::optional<Length> thickness;
  /// True: each solid, group or label of a surface's triangles becomes a material of that name instead of a
  /// patch.
  bool split_solids = false;
  /// Coordinate system of surfaces and of a size field whose files name none, see TriangleMesh::space. Empty:
  /// that of the first input.
  std::string surface_space;
};

class BrickScratch;
class ProcessTeam;

/// Meshing and coarsening of a segmented volume in bricks, so that its dense mesh is never in memory at once.
/// For prepare().
struct BrickOptions {
  enum class Use : std::uint8_t {
    automatic,  ///< if the dense mesh would not fit in memory
    never,
    always
  };
  Use use = Use::automatic;
  /// With Use::always: edge of a brick, finest cells before any are halved; a power of two in this range. It
  /// determines the result.
  int cells = 0;
  /// How often bricks are coarsened before all of them are joined, from the second time on in bricks with
  /// other cuts: 1 to max_brick_rounds; 0: as often as the memory requires. It determines the result.
  int rounds = 0;
  /// Folder for finished bricks, made if it does not exist: they need no memory until all are finished, and a
  /// job that was stopped goes on from them. Empty: in memory.
  std::string scratch;
  std::function<void()> when_kept;  ///< called before bricks are written to `scratch`; may be empty
  ProcessTeam* team = nullptr;      ///< processes that share the work, or null; must outlive the call
};
inline constexpr int min_brick_cells = 32, max_brick_cells = 1024, default_brick_cells = 128;
inline constexpr int max_brick_rounds = 3;

inline constexpr std::size_t default_min_voxels = 8;  ///< of LabelOptions

/// Labels of a segmented volume.
struct LabelOptions {
  /// Inclusive ranges of the labels that become materials; empty: all except the outside label.
  std::vector<std::pair<MaterialTag, MaterialTag>> meshed;
  std::string names_file;              ///< file with names of labels; empty: names in the volume
  std::optional<MaterialTag> outside;  ///< label of the outside; std::nullopt: 0
  /// Minimum size of an island, in voxels. Smaller islands join the label that they touch most.
  /// std::nullopt: default_min_voxels.
  std::optional<std::size_t> min_voxels;
  /// Labels that surfaces in the volume do not carve: inclusive ranges, and names.
  std::vector<std::pair<MaterialTag, MaterialTag>> protected_labels;
  std::vector<std::string> protected_names;

  bool protects_any() const { return !protected_labels.empty() || !protected_names.empty(); }
};

/// Images that are divided into materials, see ImageChoice.
struct ImageOptions {
  /// Thresholds; one without a name is called like the input.
  std::vector<IsoValue> isos;
  /// From 0 to 1: points where no channel, or no image of several, exceeds this are outside. std::nullopt:
  /// images are probability maps, and the outside has what they lack to 1.
  std::optional<double> outside_probability;
  std::optional<double> smoothing;  ///< standard deviation, voxels

  bool any() const { return !isos.empty() || outside_probability || smoothing; }
};

/// Targets of simplification.
struct TargetOptions {
  std::optional<std::size_t> tets;  ///< target number; std::nullopt: as few as the tolerance or sizes allow
  /// Maximum distance between the surfaces of mesh and input in both directions (Hausdorff distance).
  std::optional<Length> tolerance;
};

/// Target edge lengths from a file, or from a source in memory.
struct SizeFieldInput {
  std::string name;                                    ///< path of the file; name of the source in messages
  std::shared_ptr<const SizeSource> source = nullptr;  ///< null: read the file
};

/// Target and bounds of edge lengths.
struct SizeOptions {
  std::optional<SizeFieldInput> field;
  std::optional<Length> min_edge, max_edge;
  std::optional<double> grading;  ///< growth of the target length per distance; default_grading
};

/// Default of ShapeOptions::min_solid_angle, steradians.
inline constexpr double default_min_solid_angle = 0.1;

/// Shapes of tets.
struct ShapeOptions {
  /// Steradians. std::nullopt: default_min_solid_angle, and smaller angles are not a shortfall.
  std::optional<double> min_solid_angle;
  ShapeObjective objective = ShapeObjective::both;
  int max_iterations = 100;          ///< of the block loop; improving: maximum number of rounds
  bool fix_boundary = false;         ///< true: keep points and faces of boundary and interfaces
  std::optional<double> only_below;  ///< improving: only tets with a smaller solid angle, steradians
  bool free_count = false;           ///< improving: the number of tets may change

  double bound() const { return min_solid_angle.value_or(default_min_solid_angle); }
};

/// Order of the simplifier's operations.
struct ScheduleOptions {
  Schedule kind = Schedule::tuned;
  double beta = 5;    ///< maximum edge length, in ideal edges, that quality does not penalise
  double gamma = 10;  ///< weight of the surface error
};

/// Unit of memory limits, bytes.
inline constexpr double gigabyte = 1 << 30;

/// Limits on a run.
struct LimitOptions {
  unsigned threads = 0;            ///< 0: all hardware threads
  std::optional<double> seconds;   ///< time limit for the best mesh so far; the result depends on the machine
  std::optional<double> memory;    ///< 2^30 bytes; cells are enlarged to fit unless their size is set
  double later_bytes_per_tet = 0;  ///< memory that the caller needs for each tet of the result, bytes
};

/// Severities of diagnostics, see Diagnostic.
struct AcceptanceOptions {
  bool accept_changes = false;  ///< true: changes of the solid are notes, not shortfalls
  bool strict = false;          ///< true: notes are a shortfall
};

/// Data kept in addition to the mesh in a result.
struct KeepOptions {
  bool reference = true;  ///< keep Prepared::reference
  bool field = true;      ///< keep Prepared::field
};

/// Faces inside the result at which its two sides are to have points of their own, see part_interfaces(). The
/// names are those of the result; a request without faces is a shortfall.
struct InterfaceRequest {
  /// "A,B": the faces between two materials, given by their names or tags; "all": those between any two
  /// materials; otherwise the name of a sheet or of a group of faces between materials.
  std::string faces;
  bool cohesive = false;  ///< wedges without volume join the two sides; not with order 2
};

/// Options of prepare(), mesh_scans(), simplify_mesh() and improve_mesh(). prepare() uses all of them;
/// mesh_scans() ignores `shapes` and `schedule`; simplify_mesh() ignores `cells`, `labels`, and `bodies`
/// except for `surface_space`; improve_mesh() uses only `shapes`, `values`, `selections`, `parting`,
/// `feature_angle`, `order`, `mesh_space`, `seed`, `limits` and `acceptance`. Only the functions of
/// tet meshes use `mesh_space`.
struct PrepareOptions {
  CellOptions cells;
  BodyOptions bodies;
  LabelOptions labels;
  ImageOptions images;
  VolumeFileOptions volume_file;  ///< spacing of volumes, and contents of .raw files
  BrickOptions bricks;
  FeatureAngle feature_angle;  ///< determines which edges stay sharp
  TargetOptions target;
  SizeOptions sizes;
  ValueOptions values;  ///< images whose values the result has as fields
  /// Sets of boundary faces of the result, as groups. One without faces is a shortfall.
  std::vector<FaceSelection> selections;
  /// Interfaces at which the result parts. Where several requests have a face, those that are cohesive come
  /// first, then the first of the others.
  std::vector<InterfaceRequest> parting;
  ShapeOptions shapes;
  ScheduleOptions schedule;
  int order = 1;               ///< order of the elements, 1 or 2; 2 adds midside nodes
  std::string material_field;  ///< cell field of a tet mesh that gives its materials; empty: default
  /// Anatomical coordinate system of a tet mesh that names none, such as "left-posterior-superior"; empty:
  /// unknown.
  std::string mesh_space;
  std::uint64_t seed = 1;  ///< equal seeds give equal bytes
  LimitOptions limits;
  AcceptanceOptions acceptance;
  KeepOptions keep;
};

}  // namespace tetwright
