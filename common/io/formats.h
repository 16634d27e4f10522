// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/io/contents/mesh_to_write.h"
#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/contents/surface_with_fields.h"
#include "common/io/names/name_changes.h"
#include "common/label_volume.h"
#include "common/triangle_mesh.h"

namespace tetwright {

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
/// \param files the file appears when these are committed (see atomic_file.h), and writing can be cancelled;
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
