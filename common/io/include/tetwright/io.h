// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tetwright/embedding.h"
#include "tetwright/files.h"
#include "tetwright/image_volume.h"
#include "tetwright/label_source.h"
#include "tetwright/label_volume.h"
#include "tetwright/partition.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tetwright/value_bins.h"

namespace tetwright {

/// Contents of a file that its reader ignores, to be reported to the user.
struct Dropped {
  std::string what;       ///< plural, for example "quads" or "groups (\"wheel\", \"door\")"
  std::size_t count = 0;  ///< at least 1
  /// True if nothing is lost, since the content follows from the data that are read. Writers derive it again.
  bool restored = false;

  bool operator==(const Dropped&) const = default;
};

/// Counts of items by kind, in the order in which the kinds first appeared.
class KindCounts {
 public:
  /// \param kind a plural
  void add(const std::string& kind, std::size_t n = 1);
  bool empty() const { return counts_.empty(); }
  /// Text for messages: "12 hexahedra and 3 pyramids".
  std::string text() const;
  /// Appends one entry for each kind.
  void append_to(std::vector<Dropped>& dropped) const;

 private:
  std::vector<Dropped> counts_;
};

/// Message that rejects volume cells other than linear tets, with their kinds and numbers and how to convert
/// them.
/// \param first location of the first such cell, for example "element 7"
std::string unsupported_cells(const KindCounts& cells, const std::string& first);

/// Formats the first few names for a message: "a", "b" and 3 more.
std::string quoted_list(const std::vector<std::string>& names);

/// Appends an entry whose `what` ends with the names in brackets and whose count is the number of names.
/// Appends nothing if there are none.
void append_dropped_names(std::vector<Dropped>& dropped, const std::string& what,
                          const std::vector<std::string>& names);

/// Options of the readers of tet meshes.
struct ReadTetMeshOptions {
  /// Cell field to use as the material instead of the default that ReadTetMesh::material_field describes;
  /// empty: the default. If the file has no such field, an InputError lists the fields that it has.
  std::string material_field;
  /// False: a file without that field is read with the default material.
  bool material_field_required = true;
};

/// The result of a reader of tet meshes.
struct ReadTetMesh {
  TetMesh mesh;
  /// Cell field that became mesh.materials; it is removed from mesh.cell_fields. It is the first of these
  /// that the file has:
  /// 1. the field requested by the options;
  /// 2. the format's own field: "medit:ref", "gmsh:physical" or, in a .msh file without physical groups,
  ///   "gmsh:geometrical";
  /// 3. "material", "medit:ref", "gmsh:physical", "MaterialID", "attribute", in this order;
  /// 4. the only integer cell field.
  ///
  /// Empty: the file has none of them, and every tet has material 1.
  std::string material_field = {};
  /// Other contents of the file, by kind. It never lists volume cells other than linear tets, since a file
  /// with such cells is rejected.
  std::vector<Dropped> dropped = {};
};

/// Triangles that a file lists, either with tets or as a surface, and the group of each.
struct FileTriangles {
  void add(const Triangle& ids, std::int64_t group) {
    triangles.push_back(ids);
    groups.push_back(group);
  }
  /// Splits a quad as SurfaceBuilder::add_polygon() does.
  void add_quad(const std::array<Index, 4>& ids, std::int64_t group) {
    add({ids[0], ids[1], ids[2]}, group);
    add({ids[0], ids[2], ids[3]}, group);
  }

  std::vector<Triangle> triangles;            ///< point indices; no_index for a point that is not in the file
  std::vector<std::int64_t> groups;           ///< one for each triangle; 0: none
  std::map<std::int64_t, std::string> names;  ///< names of the groups that have one
  /// Converts a name to the form of the format's writer; null: msh_name().
  std::string (*name_form)(const std::string& name) = nullptr;
  std::map<std::int64_t, std::string> comments;  ///< comments of write_medit() on groups, by number
};

/// Turns the groups of the triangles, except derived ones, into patches of `read.mesh`, with their names and
/// numbers. Fills `interfaces` and `patch_groups`, which stay empty if all groups are derived. A derived
/// group is one that writers generate for a pair of materials: all its triangles lie between two materials,
/// or between a material and outside; it contains each face there that is in no other group; and it is
/// identified by
/// - its name: the result of pair_name(), or that with the suffix that write_msh() adds if the input has
///   groups of this name;
/// - or, if the group has one, the comment of write_medit();
/// - or, if it has neither, its number, if BoundaryGroups gives the pair this number and all groups of the
///   file are derived.
///
/// A group whose triangles all lie inside materials, with the same one on both sides, becomes a sheet. Other
/// triangles inside a material are lost: those of groups that also have faces on the boundary or an
/// interface, and groups of more than half of the faces inside materials, which list the faces of the tets.
///
/// Adds to `read.dropped` the derived groups as restored, and the losses: triangles inside a material,
/// triangles without a tet and a group, and triangles that are already in a group. A triangle that is also
/// listed without a group is not lost. Takes the time and memory of find_interfaces().
/// \param group_word the format's term for a group, for example "physical group"
/// \param file file name for messages
/// \pre the materials and their names are known
/// \throws InputError if a triangle of a group is not a face of a tet, or if there are more than 65,535
///   groups
void take_triangles(const FileTriangles& listed, const std::string& group_word, const std::string& file,
                    ReadTetMesh& read);

/// Message for a file with tets where a surface is needed; append it to the file's name.
std::string surface_expected(std::size_t tets);

/// Returns the triangles as a surface with the groups of the file, or without groups if there is only one and
/// it has no name.
/// \throws InputError if there are no triangles, or if one refers to a point that does not exist
TriangleMesh surface_of(const FileTriangles& listed, std::vector<Vec3> points, const std::string& file);

struct MeshParts;

/// A number or name of the input and its replacement in a file, as text; names are quoted.
struct NameChange {
  std::string own, written;
};

/// Numbers and names of the input that a format cannot hold unchanged. Does not list names that writers
/// invent for items without a name.
struct NameChanges {
  std::vector<NameChange> tags, material_names, patch_numbers, patch_names, fields;
};

/// Changes between the mesh and `written`, its materials and surfaces in the format.
NameChanges name_changes(const TetMesh& mesh, const MeshParts& written);

/// Appends the fields whose names differ in `written`.
/// \param written one name for each field
void add_field_changes(const std::vector<MeshField>& fields, const std::vector<std::string>& written,
                       std::vector<NameChange>& changes);

/// A surface with fields at its points.
struct SurfaceWithFields {
  TriangleMesh surface;
  std::vector<MeshField> point_fields;  ///< of surface.points, in the file's order
};

/// Input of a writer of tet meshes: a view that must not outlive the mesh, the nodes and the bins.
struct MeshToWrite {
  // NOLINTNEXTLINE(google-explicit-constructor): every mesh can be written
  MeshToWrite(const TetMesh& of_mesh, const MidsideNodes* nodes = nullptr,
              std::span<const TetBins> of_bins = {})
      : mesh(of_mesh), midside(nodes), bins(of_bins) {}

  const TetMesh& mesh;
  /// Midside nodes that make the tets second-order elements of ten nodes, for formats that support them;
  /// null: linear tets.
  const MidsideNodes* midside;
  /// Divisions of the tets into bins, for formats that hold them (TetFormatInfo::bins). Boundaries and
  /// interfaces are those of the materials all the same, not of the bins.
  std::span<const TetBins> bins;

  /// Fields of the points, extended to the midside nodes if there are any.
  std::vector<MeshField> node_fields() const {
    return midside ? fields_of_nodes(mesh.point_fields, *midside) : mesh.point_fields;
  }

  std::size_t nodes() const { return mesh.points.size() + (midside ? midside->points.size() : 0); }
  const Vec3& node(std::size_t i) const {
    return i < mesh.points.size() ? mesh.points[i] : midside->points[i - mesh.points.size()];
  }
};

/// Writes the bytes that `content` produces to a file named `path`.
using FileWriter =
    std::function<void(const std::string& path, const std::function<void(const ByteSink&)>& content)>;

/// Reads the names of a segmented volume's labels from a text file with one label on each line. The file has
/// one of these forms, which is determined from all its lines:
///
/// - `TAG NAME`: separated by white space or a comma; the name may contain spaces and may be quoted;
/// - colour tables of 3D Slicer (.ctbl) and FreeSurfer: `TAG NAME R G B A`;
/// - label descriptions of ITK-SNAP: `TAG R G B A VISIBLE MESH "NAME"`.
///
/// A comment starts with # or //, at the beginning of a line or after white space. No library reads all of
/// these forms.
/// \param line_numbers receives the line, from 1, that first names each label; may be null
/// \throws InputError if the file cannot be read or has no label; with the line, if a line has no tag or no
///   name, or gives a tag a second name
std::map<MaterialTag, std::string> read_label_names(
    const std::string& path, std::map<MaterialTag, std::size_t>* line_numbers = nullptr);
/// Parses the content of such a file.
/// \param file file name for messages
std::map<MaterialTag, std::string> parse_label_names(
    std::string_view bytes, const std::string& file,
    std::map<MaterialTag, std::size_t>* line_numbers = nullptr);

class OutputFiles;
struct FileSharing;

/// Kind of a file, determined by the extension in upper or lower case, or of a folder to read, by its files.
enum class FileKind {
  surface,   ///< .ply .obj .stl .off .vtp; read only: .3mf .glb
  tet_mesh,  ///< see tet_format_table()
  /// .nrrd; read only: .nhdr .mhd .mha .nii .nii.gz .hdr .img .inr .inr.gz, .zarr .tif .tiff .h5 .hdf5, and
  /// .npy, .raw, .dcm, folders with zarr arrays, DICOM or TIFF files, and patterns of TIFF files
  /// ("slice_*.tif"). DICOM files are also known by their content
  volume,
  unknown
};

/// Direction of access: some formats can be read but not written.
enum class FileUse { read, write };

FileKind file_kind(const std::string& path, FileUse use = FileUse::read);

/// List of extensions for messages and help: ".ply .obj .stl .off".
std::string known_extensions(FileKind kind, FileUse use = FileUse::read);

/// Whether a path is a DICOM file by its extension or its content, or a folder with one.
bool is_dicom(const std::string& path);

/// Whether read_surface() accepts files with this extension: surface formats, and .msh and .mesh, which hold
/// a surface or a tet mesh.
bool may_hold_surface(const std::string& path);

/// How a format holds bins of tets.
enum class BinsAs : std::uint8_t {
  none,                ///< only as a field, if it has fields
  sets,                ///< as sets of tets with names, beside the materials
  materials,           ///< instead of the materials: their tets are divided, by the leading division alone
  materials_and_sets,  ///< likewise, and other divisions as sets
};

/// Contents that a tet mesh format can store when it is written.
struct TetFormatInfo {
  std::string name;       ///< for write_tet_mesh(): "msh41-binary"
  std::string extension;  ///< ".msh"
  bool names;             ///< names of materials
  bool surfaces;          ///< boundary and interface triangles, by groups
  bool patch_names;       ///< names of these groups
  bool fields;            ///< fields of points and tets
  bool second_order;      ///< tets of ten nodes
  bool wedges;            ///< cohesive elements, see TetMesh::wedges; of meshes that are not in parts
  bool parts;             ///< meshes in parts, see TetPartition
  BinsAs bins;            ///< of meshes that are not in parts
  bool moduli;            ///< elastic constants of bins
  bool inner_surfaces;    ///< of these triangles also those between materials and of sheets
  /// Coordinates are rounded to single precision, with the losses that single_precision_loss() finds.
  bool single_precision;
};

/// Losses if the coordinates of a mesh are rounded to single precision.
struct SinglePrecisionLoss {
  std::size_t tets = 0;       ///< positive tets that become flat or negative, by exact signs
  std::size_t points = 0;     ///< how many different points fewer there are
  Vec3 first = Vec3::Zero();  ///< centre of the first such tet, input units
};
SinglePrecisionLoss single_precision_loss(const TetMesh& mesh);

/// Tet mesh formats that can be written. The first one with an extension is its default.
std::vector<TetFormatInfo> written_tet_formats();

/// Format in which a tet mesh is written to `path`: the one called `name`, or the extension's default if
/// `name` is empty.
/// \param parts above 0: the mesh is divided into so many parts. Then it is the extension's first format that
///   can hold parts
/// \throws UsageError if there is none
TetFormatInfo written_tet_format(const std::string& path, const std::string& name = {}, PartNumber parts = 0);

/// Tags, numbers and names of the mesh that this format stores in another form. Does not list contents that
/// it cannot store at all.
/// \param parts as in written_tet_format()
NameChanges written_name_changes(const TetMesh& mesh, const std::string& path, const std::string& name = {},
                                 PartNumber parts = 0);

/// Format that write_surface() and write_interfaces() choose.
/// \throws UsageError if there is none
struct SurfaceFormatInfo {
  std::string extension;
  bool names;  ///< stores names of groups of triangles
};
SurfaceFormatInfo written_surface_format(const std::string& path, const std::string& format = {});

/// Names of patches that write_interfaces() stores in another form, since the format cannot hold them.
std::vector<NameChange> written_interface_name_changes(const TetMesh& mesh, const std::string& path,
                                                       const std::string& format = {});

/// Whether files with this extension may have point fields, which read_surface_with_fields() or
/// read_tet_mesh() returns.
bool may_hold_point_fields(const std::string& path);

/// Extensions of such files, formatted like known_extensions().
std::string point_field_extensions();

/// File name without folders and extension; .nii.gz and .inr.gz count as one extension.
std::string file_stem(const std::string& path);

/// Facts that files of volumes do not give, or that replace those of the file.
struct VolumeFileOptions {
  /// Voxels along each axis of a .raw file, the axis that varies fastest first. Such files have voxels alone.
  std::optional<std::array<int, 3>> dimensions = {};
  /// Type of the voxels of a .raw file: int8, uint8, int16, uint16, int32, uint32, int64, uint64, float16,
  /// float32 or float64, with le or be for the byte order ("uint16be"); little-endian without.
  std::string voxel_type = {};
  /// Distance between voxels along each axis, input units; replaces that of the file.
  std::optional<Vec3> spacing = {};
};

/// Checks the options before files are read.
/// \throws UsageError if a size is below 1, the type unknown, or a spacing not above 0
void check_volume_options(const VolumeFileOptions& options);

/// Reads a file. A .node and an .ele file with the same name in one folder are a pair; `path` may name
/// either. The header of a volume may refer to another file with the voxels.
/// \param dropped receives the contents of a surface file other than points and faces; may be null. A tet
///   mesh has its own list
/// \throws UsageError if the extension is not of the requested kind
/// \throws InputError if the file is missing, unreadable or malformed, or a tet mesh is too large or too
///   small (require_measurable())
TriangleMesh read_surface(const std::string& path, std::vector<Dropped>* dropped = nullptr);
ReadTetMesh read_tet_mesh(const std::string& path, const ReadTetMeshOptions& options = {});
LabelVolume read_label_volume(const std::string& path, const VolumeFileOptions& options = {});
/// Reads the values of an image: gray values, distances or probabilities, in all formats of volumes. NIfTI's
/// slope and intercept are applied. The values are rounded to 32-bit floats.
///
/// Channels are the items of NIfTI's axis of times or vectors, of NRRD's axis of a kind that is not spatial
/// (list, vector), of the axis "c" of zarr and HDF5 or the first of four axes without names, MetaImage's and
/// INR's numbers of a voxel, and channels of ImageJ and OME-TIFF.
/// \throws InputError also at the first value that is not finite, and if the file is a segmentation whose
///   segments overlap
/// \throws OutputError if the values, 4 bytes for each voxel and channel, exceed available_memory()
ImageVolume read_image(const std::string& path, const VolumeFileOptions& options = {});

/// Number of layers of a segmentation whose segments overlap (.seg.nrrd of 3D Slicer), from its header; 1 for
/// other volumes.
/// \throws UsageError if the path is not that of a volume
/// \throws InputError if it is missing, or its header is malformed
std::int64_t label_layers(const std::string& path);
/// Reads all layers of a segmentation. Each has the names and colours of its segments. Exceptions as for
/// read_label_volume().
std::vector<LabelVolume> read_label_layers(const std::string& path, const VolumeFileOptions& options = {});

struct LabelSourceOptions {
  /// Decoded chunks that the source keeps, bytes. Each concurrent call of LabelSource::read() takes the
  /// memory of a chunk beside them, encoded and decoded.
  std::size_t cache_bytes = std::size_t{1} << 28;
  VolumeFileOptions file = {};
};

/// Opens a segmented volume to read its labels box by box.
///
/// - Uncompressed .nrrd, .nhdr, .mhd, .mha, .nii, .hdr and .img files, .npy and .raw are read by ranges of
///   bytes.
/// - `.zarr` folders (zarr 2 and 3, OME-Zarr), `FOLDER.zarr/ARRAY` and other folders with the metadata of
/// zarr
///   are decoded by chunks, `.h5` and `.hdf5` files, `FILE.h5:/DATASET`, too.
/// - `.tif` and `.tiff` files and folders of them are decoded by strips and tiles.
/// - Compressed .nrrd, .nhdr, .mhd, .mha, .nii and .nii.gz files, text, and .inr files are read as a whole
/// and
///   served from memory: LabelSource::in_memory().
///
/// The axis that varies fastest in the file is the first one: x of arrays with the axes z, y, x.
/// \throws UsageError if the path is not that of a volume
/// \throws InputError if it is missing, unreadable or malformed, or has no volume of labels
std::unique_ptr<LabelSource> open_label_source(const std::string& path,
                                               const LabelSourceOptions& options = {});

/// Reads the bytes of a file, for example from a stream, in a format of one file.
/// \param name file name for messages
/// \param extension selects the format
/// \throws UsageError unless streams(extension)
TriangleMesh read_surface_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                                std::vector<Dropped>* dropped = nullptr);
ReadTetMesh read_tet_mesh_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                                const ReadTetMeshOptions& options = {});
LabelVolume read_label_volume_bytes(std::string_view bytes, const std::string& name,
                                    const std::string& extension, const VolumeFileOptions& options = {});
ImageVolume read_image_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                             const VolumeFileOptions& options = {});

/// Extensions that can be read from streams, such as ".ply .obj", and whether `extension` is one of them.
std::string streamed_extensions();
bool streams(const std::string& extension);

/// Reads a surface with its point fields.
/// \return std::nullopt for a tet mesh, as determined by the extension or because the file has tets
/// \throws UsageError if may_hold_point_fields() is false for the extension of a surface, and in the cases of
///   read_surface()
std::optional<SurfaceWithFields> read_surface_with_fields(const std::string& path);

/// Writes a file completely or not at all; coordinates round-trip bit by bit. A tet mesh is written in
/// written_tet_format(); if that has several files, they differ in their extensions.
/// \param path "-" is standard output
/// \param files the file appears when these are committed (see files.h), and writing can be cancelled; null:
///   the file appears at once
/// \param format an extension, "ply" or ".ply", used instead of the path's; for tet meshes the name of a
///   format
/// \throws UsageError if the extension is not of the required kind
/// \throws OutputError if the file cannot be written
/// \throws Interrupted if cancelled
void write_surface(const TriangleMesh& mesh, const std::string& path, OutputFiles* files = nullptr,
                   const std::string& format = {});
void write_tet_mesh(const MeshToWrite& mesh, const std::string& path, OutputFiles* files = nullptr,
                    const std::string& format = {});
/// Writes a mesh in parts, each with the tets of other parts that share a point with one of its own, as
/// parallel solvers read them.
/// \throws UsageError also if the format cannot hold parts
/// \param share writes files together with other processes; null: this one writes them
void write_tet_mesh(const MeshToWrite& mesh, const TetPartition& partition, const std::string& path,
                    OutputFiles* files = nullptr, const std::string& format = {},
                    const FileSharing* share = nullptr);
/// Writes the boundary and the interfaces of the mesh as a surface with the names of its groups.
void write_interfaces(const TetMesh& mesh, const std::string& path, OutputFiles* files = nullptr,
                      const std::string& format = {});
void write_label_volume(const LabelVolume& volume, const std::string& path, OutputFiles* files = nullptr,
                        const std::string& format = {});
/// Writes a volume that need not fit into memory, slab by slab, with the memory of a few slabs of 2^24 voxels
/// (standard output keeps all bytes). The file is not compressed, so that open_label_source() reads it by
/// ranges, and has the smallest unsigned type of 8, 16 or 32 bits that holds `largest`.
/// \param progress receives the fraction that is written; null: none
/// \pre all labels are between 0 and `largest`
void write_label_source(const LabelSource& source, MaterialTag largest, const std::string& path,
                        OutputFiles* files = nullptr, const std::string& format = {},
                        Progress* progress = nullptr);

/// Writes an embedding, whose numbers count from 0.
///
/// - .npz: the arrays `tets` (n), `nodes` (n, 4), both of 64-bit integers, `weights` (n, 4) and `distances`
///   (n), both of doubles, as numpy.savez() writes them; without dates, so that the bytes repeat
/// - .json: an object with the same keys
/// \param format "npz" or "json", used instead of the path's extension
void write_embedding(const Embedding& embedding, const std::string& path, OutputFiles* files = nullptr,
                     const std::string& format = {});
/// Checks a path for write_embedding() as check_output_path() does.
void check_embedding_path(const std::string& path, const std::string& format = {});

/// All files that write_tet_mesh() writes for a path.
/// \param parts number of parts; 0: the mesh is not divided
std::vector<std::string> files_of_tet_mesh(const std::string& path, const std::string& format = {},
                                           PartNumber parts = 0);

/// The file at `path` and the files read with it because of its name or content: the other files of TetGen
/// and XDMF meshes, the pieces of a .pvtu file, and the .img file of a .hdr file. They need not exist.
std::vector<std::string> files_of_input(const std::string& path);

/// Checks an output path. Call it before any work.
/// \throws UsageError if the extension or the format is not of `kind`
/// \throws OutputError if the folder is missing or not writable, or anything at `path` is not a regular file
/// \param parts as in files_of_tet_mesh()
void check_output_path(const std::string& path, FileKind kind = FileKind::tet_mesh,
                       const std::string& format = {}, PartNumber parts = 0);

}  // namespace tetwright
