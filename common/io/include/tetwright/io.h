// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tetwright/files.h"
#include "tetwright/label_volume.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Contents of a file that its reader ignores, to be reported to the user.
struct Dropped {
  std::string what;       ///< plural, for example "quads" or "groups (\"wheel\", \"door\")"
  std::size_t count = 0;  ///< at least 1
  /// True: nothing is lost, since it follows from the data read. Writers derive it anew.
  bool restored = false;

  bool operator==(const Dropped&) const = default;
};

/// Counts of items by kind, in the order in which the kinds first appeared.
class KindCounts {
 public:
  /// `kind` is a plural.
  void add(const std::string& kind, std::size_t n = 1);
  bool empty() const { return counts_.empty(); }
  /// "12 hexahedra and 3 pyramids"
  std::string text() const;
  /// Appends one entry for each kind.
  void append_to(std::vector<Dropped>& dropped) const;

 private:
  std::vector<Dropped> counts_;
};

/// Message that rejects volume cells other than linear tets: their kinds and numbers, and how to convert
/// them.
/// \param first location of the first of them, for example "element 7"
std::string unsupported_cells(const KindCounts& cells, const std::string& first);

/// Formats the first few names for a message: "a", "b" and 3 more.
std::string quoted_list(const std::vector<std::string>& names);

/// Appends an entry whose `what` ends with the names in brackets and whose count is their number; nothing if
/// there are none.
void append_dropped_names(std::vector<Dropped>& dropped, const std::string& what,
                          const std::vector<std::string>& names);

/// Options of the readers of tet meshes.
struct ReadTetMeshOptions {
  /// Cell field to use as the material instead of the one that ReadTetMesh::material_field describes; empty:
  /// the default. If the file has no such field, an InputError lists its fields.
  std::string material_field;
  /// False: a file without that field is read with the default.
  bool material_field_required = true;
};

/// The result of a reader of tet meshes.
struct ReadTetMesh {
  TetMesh mesh;
  /// Cell field that became mesh.materials; it is removed from mesh.cell_fields. The first of these that the
  /// file has:
  /// 1. the field that the options request;
  /// 2. the format's own: "medit:ref", "gmsh:physical" or, in a .msh file without physical groups,
  ///   "gmsh:geometrical";
  /// 3. "material", "medit:ref", "gmsh:physical", "MaterialID", "attribute", in this order;
  /// 4. the only integer cell field.
  ///
  /// Empty: the file has none of them, and every tet has material 1.
  std::string material_field = {};
  /// Other contents of the file, by kind. Volume cells that are not linear tets are never among them: such a
  /// file is rejected.
  std::vector<Dropped> dropped = {};
};

/// Triangles that a file lists, beside its tets or as a surface, and the group of each.
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

  std::vector<Triangle> triangles;            ///< indices of points; no_index for a point that the file lacks
  std::vector<std::int64_t> groups;           ///< one for each triangle; 0: none
  std::map<std::int64_t, std::string> names;  ///< of the groups that have a name
  /// Form of a name in the format's writer; null: msh_name().
  std::string (*name_form)(const std::string& name) = nullptr;
  std::map<std::int64_t, std::string> comments;  ///< comments of write_medit() on groups
};

/// Turns the groups of the triangles, except derived ones, into patches of `read.mesh`, with their names and
/// numbers: fills `interfaces` and `patch_groups`, which stay empty if all groups are derived ones. A derived
/// group is one that writers make of a pair of materials: all its triangles lie between two materials, or
/// between one and outside; it contains each face there that is in no other group; and it is identified by
/// - its name: pair_name()'s, or with the suffix that write_msh() adds if the input has groups of this name;
/// - or, if the group has one, the comment of write_medit();
/// - or, if it has neither, its number, if that is the one that BoundaryGroups gives the pair and all groups
///   of the file are derived.
///
/// Adds to `read.dropped` the derived groups as restored, and the losses: triangles within a material, those
/// of no tet and no group, and those that are in a group already. A triangle that is listed without a group,
/// too, is no loss. Time and memory are those of find_interfaces().
/// \param group_word the format's term for a group, for example "physical group"
/// \param file named in messages
/// \pre the materials and their names are known
/// \throws InputError for a triangle of a group that is no face of a tet, and for more than 65,535 groups
void take_triangles(const FileTriangles& listed, const std::string& group_word, const std::string& file,
                    ReadTetMesh& read);

/// Message for a file with tets where a surface is needed; to be appended to its name.
std::string surface_expected(std::size_t tets);

/// Returns the triangles as a surface with the groups of the file, unless there is only one and it has no
/// name.
/// \throws InputError if there are none, or for one with a point that does not exist
TriangleMesh surface_of(const FileTriangles& listed, std::vector<Vec3> points, const std::string& file);

struct MeshParts;

/// A number or name of the input and its replacement in a file, as text; names are in quotes.
struct NameChange {
  std::string own, written;
};

/// Numbers and names of the input that a format cannot hold unchanged. Names that writers invent where there
/// is none are not among them.
struct NameChanges {
  std::vector<NameChange> tags, material_names, patch_numbers, patch_names, fields;
};

/// Changes between the mesh and `written`, the materials and surfaces in the format.
NameChanges name_changes(const TetMesh& mesh, const MeshParts& written);

/// Appends the fields whose names differ in `written`, which has one for each.
void add_field_changes(const std::vector<MeshField>& fields, const std::vector<std::string>& written,
                       std::vector<NameChange>& changes);

/// A surface with the fields of its points.
struct SurfaceWithFields {
  TriangleMesh surface;
  std::vector<MeshField> point_fields;  ///< of surface.points, in the file's order
};

/// Input of a writer of tet meshes: a view that must not outlive the mesh and the nodes.
struct MeshToWrite {
  // NOLINTNEXTLINE(google-explicit-constructor): every mesh is something to write
  MeshToWrite(const TetMesh& of_mesh, const MidsideNodes* nodes = nullptr) : mesh(of_mesh), midside(nodes) {}

  const TetMesh& mesh;
  /// Midside nodes that make the tets second-order elements of ten nodes, for writers that support them;
  /// null: linear tets.
  const MidsideNodes* midside;

  /// Fields of the points and, if there are any, of the midside nodes.
  std::vector<MeshField> node_fields() const {
    return midside ? fields_of_nodes(mesh.point_fields, *midside) : mesh.point_fields;
  }

  std::size_t nodes() const { return mesh.points.size() + (midside ? midside->points.size() : 0); }
  const Vec3& node(std::size_t i) const {
    return i < mesh.points.size() ? mesh.points[i] : midside->points[i - mesh.points.size()];
  }
};

/// Writes one file named `path` with the bytes that `content` produces.
using FileWriter =
    std::function<void(const std::string& path, const std::function<void(const ByteSink&)>& content)>;

/// Reads the names of the labels of a segmented volume from a text file with one label on each line. All
/// lines together determine the form, one of these:
///
/// - `TAG NAME`: separated by white space or a comma; the name may contain spaces and may be quoted;
/// - colour tables of 3D Slicer (.ctbl) and FreeSurfer: `TAG NAME R G B A`;
/// - label descriptions of ITK-SNAP: `TAG R G B A VISIBLE MESH "NAME"`.
///
/// A comment begins with # or //, at the beginning of a line or after white space. No library reads all of
/// these forms.
/// \param line_numbers receives the line, from 1, that first names each label; may be null
/// \throws InputError if the file cannot be read or has no label, and with the line if a line has no tag or
///   no name, or gives a tag a second name
std::map<MaterialTag, std::string> read_label_names(
    const std::string& path, std::map<MaterialTag, std::size_t>* line_numbers = nullptr);
/// Parses the bytes of such a file; `file` is its name in messages.
std::map<MaterialTag, std::string> parse_label_names(
    std::string_view bytes, const std::string& file,
    std::map<MaterialTag, std::size_t>* line_numbers = nullptr);

class OutputFiles;

/// Kinds of files, determined by the extension in upper or lower case.
enum class FileKind {
  surface,   ///< .ply .obj .stl .off .vtp; only read: .3mf .glb
  tet_mesh,  ///< see tet_format_table()
  volume,    ///< .nrrd; only read: .nhdr .mhd .mha .nii .nii.gz .inr .inr.gz
  unknown
};

/// Direction of access: some formats are read but not written.
enum class FileUse { read, write };

FileKind file_kind(const std::string& path, FileUse use = FileUse::read);

/// ".ply .obj .stl .off", for messages and help.
std::string known_extensions(FileKind kind, FileUse use = FileUse::read);

/// Whether read_surface() accepts files of this extension: those of surfaces, and .msh and .mesh, which hold
/// a surface or a tet mesh.
bool may_hold_surface(const std::string& path);

/// Contents that a format of tet meshes can store when it is written.
struct TetFormatInfo {
  std::string name;       ///< for write_tet_mesh(): "msh41-binary"
  std::string extension;  ///< ".msh"
  bool names;             ///< of materials
  bool surfaces;          ///< boundary and interface triangles, by groups
  bool patch_names;       ///< of these groups
  bool fields;            ///< of points and tets
  bool second_order;      ///< tets of ten nodes
};

/// Formats of tet meshes that can be written. The first one of an extension is its default.
std::vector<TetFormatInfo> written_tet_formats();

/// Format in which a tet mesh is written to `path`: that of `name`, or the extension's if `name` is empty.
/// \throws UsageError if there is none
TetFormatInfo written_tet_format(const std::string& path, const std::string& name = {});

/// Tags, numbers and names of the mesh that this format stores in another form. Contents that it cannot store
/// at all are not among them.
NameChanges written_name_changes(const TetMesh& mesh, const std::string& path, const std::string& name = {});

/// Format that write_surface() and write_interfaces() choose.
/// \throws UsageError if there is none
struct SurfaceFormatInfo {
  std::string extension;
  bool names;  ///< of groups of triangles
};
SurfaceFormatInfo written_surface_format(const std::string& path, const std::string& format = {});

/// Names of patches that write_interfaces() stores in another form, since the format cannot hold them.
std::vector<NameChange> written_interface_name_changes(const TetMesh& mesh, const std::string& path,
                                                       const std::string& format = {});

/// Whether files with this extension may have fields of points, which read_surface_with_fields() or
/// read_tet_mesh() returns.
bool may_hold_point_fields(const std::string& path);

/// Extensions of such files, in the form of known_extensions().
std::string point_field_extensions();

/// File name without folders and extension; .nii.gz and .inr.gz are removed whole.
std::string file_stem(const std::string& path);

/// Reads a file. A .node and an .ele file of one name in one folder are a pair, which either of them names. A
/// header of a volume may refer to another file with the voxels.
/// \param dropped receives the contents of a surface file other than points and faces; may be null. A tet
///   mesh comes with its own list
/// \throws UsageError if the extension is not of the requested kind
/// \throws InputError if the file is missing, unreadable or malformed, or a tet mesh is too large or too
///   small (require_measurable())
TriangleMesh read_surface(const std::string& path, std::vector<Dropped>* dropped = nullptr);
ReadTetMesh read_tet_mesh(const std::string& path, const ReadTetMeshOptions& options = {});
LabelVolume read_label_volume(const std::string& path);

/// Reads the bytes of a file, such as those of a stream, in a format of one file.
/// \param name used in messages
/// \param extension selects the format
/// \throws UsageError if `extension` is not one of streams()
TriangleMesh read_surface_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                                std::vector<Dropped>* dropped = nullptr);
ReadTetMesh read_tet_mesh_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                                const ReadTetMeshOptions& options = {});
LabelVolume read_label_volume_bytes(std::string_view bytes, const std::string& name,
                                    const std::string& extension);

/// Extensions that are read from streams, ".ply .obj", and whether one is among them.
std::string streamed_extensions();
bool streams(const std::string& extension);

/// Reads a surface with its fields of points.
/// \return std::nullopt for a tet mesh, by its extension or because the file has tets
/// \throws UsageError for surfaces of an extension that may_hold_point_fields() does not know, and as
///   read_surface()
std::optional<SurfaceWithFields> read_surface_with_fields(const std::string& path);

/// Writes a file whole or not at all; coordinates round-trip bit by bit. A tet mesh is written in
/// written_tet_format(), to several files that differ in extension if the format has several.
/// \param path "-" is standard output
/// \param files the file appears when these are committed (see files.h), and writing can be cancelled;
///   null: at once
/// \param format an extension, "ply" or ".ply", used instead of the path's; for tet meshes the name of a
///   format
/// \throws UsageError if the extension is not of the kind
/// \throws OutputError if the file cannot be written
/// \throws Interrupted if cancelled
void write_surface(const TriangleMesh& mesh, const std::string& path, OutputFiles* files = nullptr,
                   const std::string& format = {});
void write_tet_mesh(const MeshToWrite& mesh, const std::string& path, OutputFiles* files = nullptr,
                    const std::string& format = {});
/// Writes the boundary and the interfaces of the mesh as a surface with their names.
void write_interfaces(const TetMesh& mesh, const std::string& path, OutputFiles* files = nullptr,
                      const std::string& format = {});
void write_label_volume(const LabelVolume& volume, const std::string& path, OutputFiles* files = nullptr,
                        const std::string& format = {});

/// All files that write_tet_mesh() writes for a path.
std::vector<std::string> files_of_tet_mesh(const std::string& path, const std::string& format = {});

/// The file and those read with it because of its name: the parts of TetGen's and XDMF meshes and of .hdr
/// with .img. They need not exist.
std::vector<std::string> files_of_input(const std::string& path);

/// Checks an output path; call it before any work.
/// \throws UsageError if the extension or the format is not of `kind`
/// \throws OutputError if the folder is missing or not writable, or anything at `path` is not a regular file
void check_output_path(const std::string& path, FileKind kind = FileKind::tet_mesh,
                       const std::string& format = {});

}  // namespace tetwright
