// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tetwright/compare.h"
#include "tetwright/diagnostic.h"
#include "tetwright/io.h"
#include "tetwright/label_volume.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"
#include "tetwright/simplify.h"
#include "tetwright/sizes.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A file, whose extension says what it holds.
struct InputFile {};

/// The bytes of a file from elsewhere.
struct InputStream {
  std::string extension;              ///< says what it holds: ".ply"
  std::function<std::string()> read;  ///< called once, when its turn comes
};

struct InputSurface {
  TriangleMesh surface;
  std::vector<Dropped> dropped = {};  ///< what the host's object had beside it
};

/// A tet mesh as the reader of a file leaves it before it chooses the material.
struct InputMesh {
  ReadTetMesh read;
  FileTriangles triangles = {};  ///< that the host lists beside the tets
};

/// An input: a file, or a value in memory.
struct Input {
  using Value = std::variant<InputFile, InputStream, InputSurface, InputMesh, LabelVolume>;

  // An input is written as what it is: prepare({"scan.ply"}), prepare({{"body", surface}}).
  Input(const char* file) : name(file) {}             // NOLINT(google-explicit-constructor)
  Input(std::string file) : name(std::move(file)) {}  // NOLINT(google-explicit-constructor)
  Input(std::string of, Value in_memory) : name(std::move(of)), value(std::move(in_memory)) {}
  Input(std::string of, TriangleMesh surface) : Input(std::move(of), InputSurface{std::move(surface)}) {}
  Input(std::string of, TetMesh mesh) : Input(std::move(of), InputMesh{{std::move(mesh), "material"}}) {}

  /// Makes it the material of this name; later ones carve earlier ones. For surfaces and level sets.
  Input as(std::string material_name) && {
    material = std::move(material_name);
    return std::move(*this);
  }

  bool is_value() const {
    return !std::holds_alternative<InputFile>(value) && !std::holds_alternative<InputStream>(value);
  }
  /// By the extension of a file, or what a value is.
  FileKind kind() const;
  /// The name, with the extension that a stream is read by.
  std::string typed_name() const;
  /// A level set or a segmented volume of OpenVDB, .vdb.
  bool is_vdb_file() const;
  /// The name of a material that is the whole input: a value's name, a file's without folders and extension.
  std::string material_name() const;

  std::string name;  ///< of a file: its path; names the input in messages
  Value value = InputFile{};
  std::string material;  ///< empty: named after the input
};

/// The readers of formats.h for any input, which is moved out of. The time for which a stream was waited for
/// is added to `waited`, seconds.
TriangleMesh take_surface(Input& input, std::vector<Dropped>* dropped, double& waited);
ReadTetMesh take_tet_mesh(Input& input, const ReadTetMeshOptions& options, double& waited);
LabelVolume take_label_volume(Input& input, double& waited);

/// True for a name with the extension .vdb, in upper or lower case.
bool is_vdb(const std::string& path);

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

/// A segmented volume as it was read: LabelInput without its voxels.
struct VolumeReport {
  explicit VolumeReport(const LabelInput& from)
      : size(from.size),
        origin(from.origin),
        directions(from.directions),
        space(from.space),
        labels(from.materials),
        lost(from.lost),
        outside_parts(from.outside_parts),
        merged_islands(from.merged_islands),
        merged_voxels(from.merged_voxels) {}
  /// The distance between voxels along each axis, input units.
  Vec3 spacing() const { return directions.colwise().norm(); }

  std::array<int, 3> size;
  Vec3 origin;
  Eigen::Matrix3d directions;
  std::string space;
  std::vector<LabelMaterial> labels;
  std::vector<LostLabel> lost;
  LabelParts outside_parts;
  std::size_t merged_islands, merged_voxels;
};

/// The edge lengths that SizeOptions ask for.
struct RequestedSizes {
  SizeLimits limits;
  std::shared_ptr<const SizeSource> source;        ///< null: no size field
  std::shared_ptr<const SizeField> target_length;  ///< likewise

  bool any() const { return target_length || limits.min_edge > 0 || std::isfinite(limits.max_edge); }
};

/// Cells that are larger than was meant, since memory would not hold smaller ones.
struct CoarserCells {
  double asked, used;  ///< edges of the finest cells, input units
  double bytes;        ///< that those asked for would take
};

/// Everything that a run reports. What it does not do stays empty.
struct PrepareReport {
  std::vector<std::string> inputs;
  std::size_t input_triangles = 0, input_points = 0;
  std::string material_field;           ///< the cell field of a tet mesh that its materials came from
  std::optional<VolumeReport> volume;   ///< if the input is a segmented volume
  std::vector<Diagnostic> diagnostics;  ///< all that was found and falls short
  std::optional<MesherReport> mesher;
  std::optional<CoarserCells> coarser;
  std::optional<MeshStatistics> dense, result;
  std::vector<FeatureReport> features;  ///< of each surface, or of the tet mesh
  CreaseCurves creases;                 ///< of all of them
  std::optional<CreaseComparison> crease_comparison;
  std::optional<CurvingReport> second_order;  ///< with --order 2
  std::vector<PatchComparison> patches;       ///< that the input names or numbers
  std::size_t input_limited = 0;  ///< tets of the result below the bound, see input_limited_tets()
  std::vector<SolidComparison> solids;
  std::map<MaterialTag, std::string> material_names;
  /// Red, green and blue, 0 to 1, of the labels of a segmented volume whose file has colours.
  std::map<MaterialTag, std::array<double, 3>> material_colours;
  std::optional<SimplifyReport> simplify;
  double tolerance = 0;                      ///< input units; 0: none
  std::optional<DeviationReport> deviation;  ///< of the result, with a tolerance
  /// Area of the surface that the mesh does not show although no surface hides any: 0 where some are open,
  /// intersect or meet others, or carve them.
  double lost_area() const;
  /// Whether a request was not met: the mesh is valid, and diagnostics say what.
  bool falls_short() const;
  RequestedSizes sizes;
  std::optional<EdgeLengthReport> edge_lengths;  ///< where sizes are asked for
  double seconds_read = 0, seconds_mesh = 0, seconds_write = 0, seconds_total = 0;
};

/// A mesh, and all that is known about it.
struct Prepared {
  TetMesh mesh;                         ///< input units, with its interface triangles
  std::optional<MidsideNodes> midside;  ///< with order 2
  PrepareReport report;                 ///< what was found and done, and what falls short
  /// The surface that the mesh is compared with: the input's, or the boundary and interfaces of the dense
  /// mesh of a segmented volume, or those of the tet mesh before. Null unless KeepOptions::reference.
  std::shared_ptr<const TriangleMesh> reference;
  std::string reference_name;  ///< "the input", "the dense mesh" or "the mesh before"
  /// The signed distances that were meshed, for write_fields(). Null unless KeepOptions::field, and for tet
  /// meshes.
  std::shared_ptr<const MaterialField> field;

  /// The notes, and the requests that were not met.
  const std::vector<Diagnostic>& diagnostics() const { return report.diagnostics; }
  bool falls_short() const { return report.falls_short(); }
};

/// Turns scans (surfaces, level sets, or one segmented volume) into a mesh for simulation: chooses the cells,
/// meshes, simplifies to the target, improves the shapes, and compares the result with the input. What the
/// program's command of this name does, with the same bytes for the same options.
///
/// Writes to no standard stream, and to no file. Uses `options.limits.threads` threads and leaves the limits
/// of oneTBB as they are. May be called from several threads at a time, with the same results as one after
/// the other. `progress` may be null; cancelling it ends the call within a second.
///
/// Throws UsageError (options), InputError (inputs), NothingToMeshError, OutputError (it would not fit in
/// memory), OutOfTime (there was no mesh yet) and Interrupted.
Prepared prepare(std::vector<Input> scans, const PrepareOptions& options = {}, Progress* progress = nullptr);

/// The dense mesh of scans. Otherwise as prepare().
Prepared mesh_scans(std::vector<Input> scans, const PrepareOptions& options = {},
                    Progress* progress = nullptr);

/// A tet mesh of fewer tets. Otherwise as prepare().
Prepared simplify_mesh(Input mesh, const PrepareOptions& options = {}, Progress* progress = nullptr);

/// Better shapes at about the same count. Otherwise as prepare().
Prepared improve_mesh(Input mesh, const PrepareOptions& options = {}, Progress* progress = nullptr);

}  // namespace tetwright
