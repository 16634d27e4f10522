// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tetwright/compare.h"
#include "tetwright/diagnostic.h"
#include "tetwright/face_selection.h"
#include "tetwright/image_input.h"
#include "tetwright/image_volume.h"
#include "tetwright/io.h"
#include "tetwright/label_volume.h"
#include "tetwright/loop_times.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/parted_interfaces.h"
#include "tetwright/prepare_options.h"
#include "tetwright/progress.h"
#include "tetwright/simplify.h"
#include "tetwright/sizes.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tetwright/value_options.h"

namespace tetwright {

/// A file, whose format is given by its extension.
struct InputFile {};

/// The bytes of a file, provided by a callback.
struct InputStream {
  std::string extension;              ///< determines the format, such as ".ply"
  std::function<std::string()> read;  ///< called once, when the input is read
};

struct InputSurface {
  TriangleMesh surface;
  std::vector<Dropped> dropped = {};  ///< parts of the host's object that are not kept
};

/// A tet mesh as returned by file readers, before its material field is chosen.
struct InputMesh {
  ReadTetMesh read;
  FileTriangles triangles = {};  ///< triangles that the host lists in addition to the tets
};

/// An input: a file, or a value in memory.
struct Input {
  using Value = std::variant<InputFile, InputStream, InputSurface, InputMesh, LabelVolume, ImageVolume>;

  // Implicit, to allow prepare({"scan.ply"}) and prepare({{"body", surface}}).
  Input(const char* file) : name(file) {}             // NOLINT(google-explicit-constructor)
  Input(std::string file) : name(std::move(file)) {}  // NOLINT(google-explicit-constructor)
  Input(std::string of, Value in_memory) : name(std::move(of)), value(std::move(in_memory)) {}
  Input(std::string of, TriangleMesh surface) : Input(std::move(of), InputSurface{std::move(surface)}) {}
  Input(std::string of, TetMesh mesh) : Input(std::move(of), InputMesh{{std::move(mesh), "material"}}) {}

  /// Sets the name of the material. For surfaces, level sets and masks; later materials carve earlier ones.
  Input as(std::string material_name) && {
    material = std::move(material_name);
    return std::move(*this);
  }
  /// Makes the input, a volume, a mask also if it is the only one. Its material has the name in the file, or
  /// that of the file.
  Input as_mask() && {
    mask = true;
    return std::move(*this);
  }
  /// Makes the input an open surface inside the bodies of the other inputs, whose faces the mesh has under
  /// this name (SheetSurface).
  Input as_sheet(std::string sheet_name) && {
    role = Role::sheet;
    return std::move(*this).as(std::move(sheet_name));
  }
  /// Makes the input an open surface that cuts the bodies of the other inputs into materials.
  Input as_partition(std::string sheet_name) && {
    role = Role::partition;
    return std::move(*this).as(std::move(sheet_name));
  }

  bool is_value() const {
    return !std::holds_alternative<InputFile>(value) && !std::holds_alternative<InputStream>(value);
  }
  /// Kind of the value, or of the file by its extension.
  FileKind kind() const;
  /// Name of the input; for a stream with its extension.
  std::string typed_name() const;
  /// Whether the input is a level set or segmented volume in OpenVDB's format, .vdb.
  bool is_vdb_file() const;
  /// Default name of the material: a value's name, or a file's name without folders and extension.
  std::string material_name() const;

  std::string name;  ///< name of the input in messages; the path of a file
  Value value = InputFile{};
  std::string material;  ///< or the name of a sheet; empty: the name of the input
  bool mask = false;     ///< a volume with one material, see LabelMasks; several volumes always are
  VolumeFileOptions volume_file = {};  ///< of a volume in a file; prepare() sets PrepareOptions::volume_file
  enum class Role : std::uint8_t { body, sheet, partition };
  Role role = Role::body;
};

/// Reads or moves out the value of an input; files are read by the readers of io.h. Volumes in files are read
/// only when their source is.
///
/// Volumes in memory are labels as well as images if their values allow it: take_label_volume() takes an
/// image of one channel and whole numbers, take_image() labels.
///
/// \param dropped receives the contents that were not kept; may be null
/// \param waited time spent waiting for a stream, seconds; added to the previous value
/// \throws UsageError if the extension belongs to another kind of file
/// \throws InputError in the cases of the readers
TriangleMesh take_surface(Input& input, std::vector<Dropped>* dropped, double& waited);
ReadTetMesh take_tet_mesh(Input& input, const ReadTetMeshOptions& options, double& waited);
std::unique_ptr<LabelSource> take_label_source(Input& input, double& waited);
LabelVolume take_label_volume(Input& input, double& waited);
ImageVolume take_image(Input& input, double& waited);

/// Whether the path has the extension .vdb, in upper or lower case.
bool is_vdb(const std::string& path);

/// Description of a segmented volume: LabelInput without its voxels.
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
        merged_voxels(from.merged_voxels),
        contacts(from.contacts),
        fused(from.fused) {}
  /// Distance between voxels along each axis, input units.
  Vec3 spacing() const { return directions.colwise().norm(); }

  std::array<int, 3> size;
  Vec3 origin;
  Eigen::Matrix3d directions;
  std::string space;
  std::vector<LabelMaterial> labels;
  std::vector<LostLabel> lost;
  LabelParts outside_parts;
  std::size_t merged_islands, merged_voxels;
  std::vector<LabelContact> contacts;  ///< of the voxels as read
  std::vector<FusedParts> fused;       ///< by the merging of islands
  std::vector<UsedIso> isos = {};      ///< of an image
};

/// Edge lengths requested by SizeOptions.
struct RequestedSizes {
  SizeLimits limits;
  std::shared_ptr<const SizeSource> source;        ///< null: no size field
  std::shared_ptr<const SizeField> target_length;  ///< null: no size field

  bool any() const { return target_length || limits.min_edge > 0 || std::isfinite(limits.max_edge); }
};

/// The option that would open gaps closed by the size of cells; neither if none is known.
struct GapOpening {
  std::optional<std::size_t> target_tets;
  std::optional<int> max_refinement;
};

/// Cells that were enlarged to fit into memory.
struct CoarserCells {
  double asked, used;  ///< edges of the finest cells, input units
  double bytes;        ///< estimated memory for cells of size `asked`
};

/// How a segmented volume was meshed in bricks.
struct BrickReport {
  int cells = 0;                  ///< edge of a brick, finest cells before any are halved
  std::size_t bricks = 0;         ///< number of bricks
  int rounds = 1;                 ///< how often they were coarsened, each time in other bricks
  std::size_t repeated = 0;       ///< times that a brick was made again with more cells around it
  std::size_t surfaces_kept = 0;  ///< bricks made again with their boundary as it is, since it met another's
  std::size_t resumed = 0;        ///< bricks of all rounds that were finished before
  std::vector<std::size_t> by_helpers;  ///< bricks made by others of a team, by round; empty without one
  std::size_t coarse_tets = 0;          ///< tets of all coarsened bricks
  double scratch_bytes = 0;             ///< of all bricks' files
};

class BrickScratch;

/// Report of a run. Members that belong to steps which are not run stay empty.
struct PrepareReport {
  std::vector<std::string> inputs;
  std::size_t input_triangles = 0, input_points = 0;
  std::string space;                   ///< of surfaces or the tet mesh, see TetMesh::space
  std::string material_field;          ///< cell field of a tet mesh that gives its materials
  std::optional<VolumeReport> volume;  ///< if the input is a segmented volume
  /// Coordinate system of the first input, and so of the result; empty: unknown.
  const std::string& space_of_result() const { return volume ? volume->space : space; }
  std::vector<Diagnostic> diagnostics;  ///< findings and shortfalls
  std::optional<MesherReport> mesher;
  std::optional<CoarserCells> coarser;
  std::optional<BrickReport> bricks;  ///< if the volume was meshed in bricks
  GapOpening gap_opening;
  std::vector<MinTets> min_tets;  ///< of prepare() with a target, by material, see min_tets()
  std::optional<MeshStatistics> dense, result;
  std::vector<ContactReport> contacts;  ///< of bodies that meet, by pair
  std::vector<OverlapReport> overlaps;  ///< of bodies that cross, by pair
  std::vector<FeatureReport> features;  ///< one for each surface, or one for the tet mesh
  CreaseCurves creases;                 ///< creases of all inputs
  std::optional<CreaseComparison> crease_comparison;
  std::optional<CurvingReport> second_order;  ///< with --order 2
  std::vector<PatchComparison> patches;       ///< named or numbered patches of the input
  std::vector<SelectedFaces> selected;        ///< as PrepareOptions::selections requests them
  std::vector<PartedInterface> parted;        ///< interfaces of the result with points for each side
  std::optional<CapReport> caps;              ///< faces that close holes, if the surfaces have any
  std::size_t input_limited = 0;  ///< tets below the bound because of the input, see input_limited_tets()
  std::vector<SolidComparison> solids;
  std::map<MaterialTag, std::string> material_names;
  /// Red, green and blue, 0 to 1, of the labels of a segmented volume whose file has colours.
  std::map<MaterialTag, std::array<double, 3>> material_colours;
  std::optional<SimplifyReport> simplify;
  double tolerance = 0;                      ///< input units; 0: none
  std::optional<DeviationReport> deviation;  ///< deviation of the result, if there is a tolerance
  /// Area of the input's surface that is missing in the mesh, input units squared. 0 without a tolerance, and
  /// if surfaces may hide each other: some are open, intersect or meet others, or carve them.
  double lost_area() const;
  /// Whether a request was not met. The mesh is valid in any case; diagnostics name the request.
  bool falls_short() const;
  RequestedSizes sizes;
  std::optional<EdgeLengthReport> edge_lengths;  ///< if sizes are requested
  std::vector<ValueReport> values;               ///< one for each image
  std::vector<BinsReport> bins;                  ///< as ValueOptions::bins requests them
  double seconds_read = 0, seconds_mesh = 0, seconds_write = 0, seconds_total = 0;
  LoopTimes loops_read, loops_mesh, loops_write, loops_total;  ///< loops of these stages
};

/// A mesh with its report and the data from which it was made.
struct Prepared {
  TetMesh mesh;                         ///< input units, with its interfaces
  std::optional<MidsideNodes> midside;  ///< with order 2
  std::vector<TetBins> bins;            ///< as ValueOptions::bins requests them
  PrepareReport report;                 ///< findings, measures and shortfalls
  /// Surface with which to compare the mesh: the input surface, the boundary and interfaces of a segmented
  /// volume's dense mesh, or those of the input tet mesh. Null unless KeepOptions::reference.
  std::shared_ptr<const TriangleMesh> reference;
  std::string reference_name;  ///< "the input", "the dense mesh" or "the mesh before"
  /// Signed distances that were meshed, for write_fields(). Null for tet meshes, and unless
  /// KeepOptions::field.
  std::shared_ptr<const MaterialField> field;
  /// The folder of finished bricks, locked, with BrickOptions::scratch; carry_out() leaves it to the caller,
  /// who removes them once the mesh is safe. prepare() does so itself.
  std::shared_ptr<const BrickScratch> scratch;

  /// Notes and shortfalls.
  const std::vector<Diagnostic>& diagnostics() const { return report.diagnostics; }
  bool falls_short() const { return report.falls_short(); }
};

/// Turns scans (surfaces, level sets, one segmented volume, or masks) into a mesh for simulation: chooses the
/// cells, meshes, simplifies to the target, improves the shapes, and compares the result with the input.
/// Gives the same bytes as the program's command `prepare` with the same options.
///
/// Writes to no stream or file. Uses `options.limits.threads` threads and does not change the limits of
/// oneTBB. Concurrent calls are safe and give the same results as sequential ones.
///
/// \param scans at least one; later surfaces and level sets carve earlier ones; a segmented volume must be
///   the only input
/// \param options must have a target: a number of tets, a tolerance or a size field
/// \param progress may be null; cancelling it ends the call within a second
/// \return a valid mesh; Prepared::falls_short() tells whether a request was not met
/// \throws UsageError if options are invalid, or cannot be combined with each other or the inputs
/// \throws InputError if an input cannot be read or used
/// \throws NothingToMeshError if the inputs enclose nothing to mesh
/// \throws OutputError if the mesh would not fit in memory
/// \throws OutOfTime if the time limit passed before there was a mesh
/// \throws Interrupted if `progress` was cancelled
Prepared prepare(std::vector<Input> scans, const PrepareOptions& options = {}, Progress* progress = nullptr);

/// Makes the dense mesh of scans, without simplification. Needs no target; otherwise like prepare().
Prepared mesh_scans(std::vector<Input> scans, const PrepareOptions& options = {},
                    Progress* progress = nullptr);

/// Simplifies a tet mesh to the target; otherwise like prepare().
Prepared simplify_mesh(Input mesh, const PrepareOptions& options = {}, Progress* progress = nullptr);

/// Improves the shapes of a tet mesh at about the same number of tets. Needs no target; otherwise like
/// prepare().
Prepared improve_mesh(Input mesh, const PrepareOptions& options = {}, Progress* progress = nullptr);

/// Adds the values of images to a tet mesh, which otherwise stays as it is, with its fields. Uses only
/// `values`, `material_field`, `mesh_space`, `limits` and `acceptance`.
Prepared add_values(Input mesh, const PrepareOptions& options, Progress* progress = nullptr);

}  // namespace tetwright
