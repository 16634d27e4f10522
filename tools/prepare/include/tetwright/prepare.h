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

/// A file, read by its extension.
struct InputFile {};

/// The bytes of a file, from a callback.
struct InputStream {
  std::string extension;              ///< decides the format: ".ply"
  std::function<std::string()> read;  ///< called once, when the input is read
};

struct InputSurface {
  TriangleMesh surface;
  std::vector<Dropped> dropped = {};  ///< items of the host's object that are not kept
};

/// A tet mesh before the choice of its material field, as readers of files make it.
struct InputMesh {
  ReadTetMesh read;
  FileTriangles triangles = {};  ///< listed by the host beside the tets
};

/// An input: a file, or a value in memory.
struct Input {
  using Value = std::variant<InputFile, InputStream, InputSurface, InputMesh, LabelVolume>;

  // Implicit, for prepare({"scan.ply"}) and prepare({{"body", surface}}).
  Input(const char* file) : name(file) {}             // NOLINT(google-explicit-constructor)
  Input(std::string file) : name(std::move(file)) {}  // NOLINT(google-explicit-constructor)
  Input(std::string of, Value in_memory) : name(std::move(of)), value(std::move(in_memory)) {}
  Input(std::string of, TriangleMesh surface) : Input(std::move(of), InputSurface{std::move(surface)}) {}
  Input(std::string of, TetMesh mesh) : Input(std::move(of), InputMesh{{std::move(mesh), "material"}}) {}

  /// Names the material; later materials carve earlier ones. For surfaces and level sets.
  Input as(std::string material_name) && {
    material = std::move(material_name);
    return std::move(*this);
  }

  bool is_value() const {
    return !std::holds_alternative<InputFile>(value) && !std::holds_alternative<InputStream>(value);
  }
  /// The kind of a value, or of a file by its extension.
  FileKind kind() const;
  /// The name; for a stream with its extension.
  std::string typed_name() const;
  /// Whether it is a level set or segmented volume in OpenVDB's format, .vdb.
  bool is_vdb_file() const;
  /// The default name of the material: a value's name, or a file's without folders and extension.
  std::string material_name() const;

  std::string name;  ///< names the input in messages; for a file its path
  Value value = InputFile{};
  std::string material;  ///< empty: named after the input
};

/// Read or move out the value of an input; files are read as by the readers of io.h.
///
/// \param dropped may be null; receives the items that were not kept
/// \param waited time spent waiting for a stream, seconds, is added to it
/// \throws UsageError if the extension is of another kind of file
/// \throws InputError as the readers
TriangleMesh take_surface(Input& input, std::vector<Dropped>* dropped, double& waited);
ReadTetMesh take_tet_mesh(Input& input, const ReadTetMeshOptions& options, double& waited);
LabelVolume take_label_volume(Input& input, double& waited);

/// Whether the path has the extension .vdb, in upper or lower case.
bool is_vdb(const std::string& path);

/// A length, absolute or relative to the size of the input.
struct Length {
  double value = 0;  ///< above 0; input units, or percent of the diagonal of the inputs' bounding box
  bool percent = false;

  double in_input_units(double diagonal) const { return percent ? value / 100 * diagonal : value; }
};

/// The length in input units; 0 for std::nullopt.
inline double in_input_units(const std::optional<Length>& length, double diagonal) {
  return length ? length->in_input_units(diagonal) : 0;
}

/// Cells of the dense mesh; for scans.
struct CellOptions {
  /// Number of finest cells along the longest side, 4 to 4096. Without it and `size`, the target, tolerance
  /// or sizes decide; without any of these, 128, or one cell per voxel for segmented volumes.
  std::optional<int> resolution;
  std::optional<double> size;  ///< edge of a finest cell, input units; excludes `resolution`
  bool uniform = false;        ///< finest cells everywhere instead of an octree
  double adaptivity = 0.05;    ///< max error of a coarser cell at a surface, in finest cells
  /// Max number of times cells are halved at thin walls and gaps of a surface, 0 to 8. std::nullopt: 3, or
  /// more where that takes few cells.
  std::optional<int> max_refinement;
  std::optional<Length> min_gap;        ///< closes narrower gaps of a surface
  std::optional<Length> min_thickness;  ///< leaves out thinner walls of a surface
  bool keep_outside = false;            ///< meshes a box around the bodies, as the material `outside`, tag 0
};

/// A layer of material under the surface of the first body.
struct Layer {
  std::string name;
  double thickness = 0;  ///< above 0, input units
};

/// The bodies that surfaces enclose.
struct BodyOptions {
  std::vector<Layer> layers;  ///< of the first surface, outermost first
  NestedRule nested = NestedRule::automatic;
  /// Makes each solid, group or label of a surface's triangles a material of that name instead of a patch.
  bool split_solids = false;
};

/// Default of LabelOptions::min_voxels.
inline constexpr std::size_t default_min_voxels = 8;

/// The labels of a segmented volume.
struct LabelOptions {
  /// Inclusive ranges of the labels that become materials; empty: all but the outside label.
  std::vector<std::pair<MaterialTag, MaterialTag>> meshed;
  std::string names_file;              ///< file with names of labels; empty: names of the volume
  std::optional<MaterialTag> outside;  ///< label of the outside; std::nullopt: 0
  /// Min island size; smaller islands join the label they touch most. std::nullopt: default_min_voxels.
  std::optional<std::size_t> min_voxels;
};

/// Targets of simplification.
struct TargetOptions {
  std::optional<std::size_t> tets;  ///< std::nullopt: as few as the tolerance or sizes allow
  /// Max distance between the surfaces of mesh and input, both ways (Hausdorff distance).
  std::optional<Length> tolerance;
};

/// Target edge lengths, from a file or a source in memory.
struct SizeFieldInput {
  std::string name;                                    ///< path of the file; names the source in messages
  std::shared_ptr<const SizeSource> source = nullptr;  ///< null: the file is read
};

/// Target and bounds of edge lengths.
struct SizeOptions {
  std::optional<SizeFieldInput> field;
  std::optional<Length> min_edge, max_edge;
  std::optional<double> grading;  ///< growth of the target length per distance; default_grading
};

/// Default of ShapeOptions::min_solid_angle, steradians.
inline constexpr double default_min_solid_angle = 0.1;

/// The shapes of tets.
struct ShapeOptions {
  /// Steradians. std::nullopt: default_min_solid_angle, and smaller angles are no shortfall.
  std::optional<double> min_solid_angle;
  ShapeObjective objective = ShapeObjective::both;
  int max_iterations = 100;          ///< of the block loop; improving: max rounds
  bool fix_boundary = false;         ///< keeps points and faces of boundary and interfaces
  std::optional<double> only_below;  ///< improving: works only on tets with a smaller solid angle, steradians
  bool free_count = false;           ///< improving: shapes decide the number of tets

  double bound() const { return min_solid_angle.value_or(default_min_solid_angle); }
};

/// The order of the simplifier's operations.
struct ScheduleOptions {
  Schedule kind = Schedule::tuned;
  double beta = 5;    ///< max edge, in ideal edges, that quality does not penalise
  double gamma = 10;  ///< weight of the surface error
};

/// The unit of limits on memory, bytes.
inline constexpr double gigabyte = 1 << 30;

/// Limits on a run.
struct LimitOptions {
  unsigned threads = 0;            ///< 0: all of the machine
  std::optional<double> seconds;   ///< returns the best mesh so far; results depend on the machine
  std::optional<double> memory;    ///< 2^30 bytes; enlarges cells to fit unless they are set
  double later_bytes_per_tet = 0;  ///< caller's memory per tet of the result, bytes
};

/// Severities of diagnostics, see Diagnostic.
struct AcceptanceOptions {
  bool accept_changes = false;  ///< changes of the solid are notes, not shortfalls
  bool strict = false;          ///< notes are a shortfall
};

/// Data kept beside the mesh in a result.
struct KeepOptions {
  bool reference = true;  ///< Prepared::reference
  bool field = true;      ///< Prepared::field
};

/// Options of prepare(), mesh_scans(), simplify_mesh() and improve_mesh(). prepare() uses all of them;
/// mesh_scans() ignores `shapes` and `schedule`; simplify_mesh() ignores `cells`, `bodies` and `labels`;
/// improve_mesh() uses only `shapes`, `feature_angle`, `order`, `seed`, `limits` and `acceptance`.
struct PrepareOptions {
  CellOptions cells;
  BodyOptions bodies;
  LabelOptions labels;
  FeatureAngle feature_angle;  ///< decides which edges stay sharp
  TargetOptions target;
  SizeOptions sizes;
  ShapeOptions shapes;
  ScheduleOptions schedule;
  int order = 1;               ///< of the elements, 1 or 2; 2 adds midside nodes
  std::string material_field;  ///< cell field of a tet mesh with its materials; empty: default
  std::uint64_t seed = 1;      ///< equal seeds give equal bytes
  LimitOptions limits;
  AcceptanceOptions acceptance;
  KeepOptions keep;
};

/// A segmented volume: LabelInput without its voxels.
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

/// Edge lengths requested by SizeOptions.
struct RequestedSizes {
  SizeLimits limits;
  std::shared_ptr<const SizeSource> source;        ///< null: no size field
  std::shared_ptr<const SizeField> target_length;  ///< null: no size field

  bool any() const { return target_length || limits.min_edge > 0 || std::isfinite(limits.max_edge); }
};

/// Cells that were enlarged to fit into memory.
struct CoarserCells {
  double asked, used;  ///< edges of the finest cells, input units
  double bytes;        ///< estimated memory for cells of size `asked`
};

/// Report of a run. Members of steps that it does not do stay empty.
struct PrepareReport {
  std::vector<std::string> inputs;
  std::size_t input_triangles = 0, input_points = 0;
  std::string material_field;           ///< cell field of a tet mesh with its materials
  std::optional<VolumeReport> volume;   ///< if the input is a segmented volume
  std::vector<Diagnostic> diagnostics;  ///< findings and shortfalls
  std::optional<MesherReport> mesher;
  std::optional<CoarserCells> coarser;
  std::optional<MeshStatistics> dense, result;
  std::vector<FeatureReport> features;  ///< one for each surface, or for the tet mesh
  CreaseCurves creases;                 ///< of all inputs
  std::optional<CreaseComparison> crease_comparison;
  std::optional<CurvingReport> second_order;  ///< with --order 2
  std::vector<PatchComparison> patches;       ///< named or numbered patches of the input
  std::size_t input_limited = 0;  ///< tets of the result below the bound, see input_limited_tets()
  std::vector<SolidComparison> solids;
  std::map<MaterialTag, std::string> material_names;
  /// Red, green and blue, 0 to 1, of the labels of a segmented volume whose file has colours.
  std::map<MaterialTag, std::array<double, 3>> material_colours;
  std::optional<SimplifyReport> simplify;
  double tolerance = 0;                      ///< input units; 0: none
  std::optional<DeviationReport> deviation;  ///< of the result, with a tolerance
  /// Area of the input's surface that the mesh lacks, input units squared. 0 without a tolerance, and if
  /// surfaces may hide each other: some are open, intersect or meet others, or carve them.
  double lost_area() const;
  /// Whether a request was not met. The mesh is valid nonetheless; diagnostics name the request.
  bool falls_short() const;
  RequestedSizes sizes;
  std::optional<EdgeLengthReport> edge_lengths;  ///< if sizes are requested
  double seconds_read = 0, seconds_mesh = 0, seconds_write = 0, seconds_total = 0;
};

/// A mesh with its report and the data it was made from.
struct Prepared {
  TetMesh mesh;                         ///< input units, with its interfaces
  std::optional<MidsideNodes> midside;  ///< with order 2
  PrepareReport report;                 ///< findings, measures and shortfalls
  /// Surface to compare the mesh with: the input surface, the boundary and interfaces of a segmented volume's
  /// dense mesh, or those of the input tet mesh. Null unless KeepOptions::reference.
  std::shared_ptr<const TriangleMesh> reference;
  std::string reference_name;  ///< "the input", "the dense mesh" or "the mesh before"
  /// The signed distances that were meshed, for write_fields(). Null for tet meshes, and unless
  /// KeepOptions::field.
  std::shared_ptr<const MaterialField> field;

  /// Notes and shortfalls.
  const std::vector<Diagnostic>& diagnostics() const { return report.diagnostics; }
  bool falls_short() const { return report.falls_short(); }
};

/// Turns scans (surfaces, level sets, or one segmented volume) into a mesh for simulation: chooses the cells,
/// meshes, simplifies to the target, improves the shapes, and compares the result with the input. Equals the
/// program's command `prepare`, byte for byte with equal options.
///
/// Writes to no stream or file. Uses `options.limits.threads` threads and leaves the limits of oneTBB as they
/// are. Concurrent calls are safe and give the same results as sequential ones.
///
/// \param scans at least one; later surfaces and level sets carve earlier ones; a segmented volume is alone
/// \param options needs a target: a number of tets, a tolerance or a size field
/// \param progress may be null; cancelling it ends the call within a second
/// \return a valid mesh; Prepared::falls_short() tells whether a request was not met
/// \throws UsageError if options are invalid, or do not go together or with the inputs
/// \throws InputError if an input cannot be read or used
/// \throws NothingToMeshError if the inputs enclose nothing to mesh
/// \throws OutputError if the mesh would not fit in memory
/// \throws OutOfTime if the time limit passed before there was a mesh
/// \throws Interrupted if `progress` was cancelled
Prepared prepare(std::vector<Input> scans, const PrepareOptions& options = {}, Progress* progress = nullptr);

/// Makes the dense mesh of scans, without simplification. Needs no target; otherwise as prepare().
Prepared mesh_scans(std::vector<Input> scans, const PrepareOptions& options = {},
                    Progress* progress = nullptr);

/// Simplifies a tet mesh to the target; otherwise as prepare().
Prepared simplify_mesh(Input mesh, const PrepareOptions& options = {}, Progress* progress = nullptr);

/// Improves the shapes of a tet mesh at about the same count. Needs no target; otherwise as prepare().
Prepared improve_mesh(Input mesh, const PrepareOptions& options = {}, Progress* progress = nullptr);

}  // namespace tetwright
