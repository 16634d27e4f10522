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

/// Kinds of files, which their extension tells, in upper or lower case.
enum class FileKind {
  surface,   ///< .ply .obj .stl .off .vtp; to be read .3mf .glb too
  tet_mesh,  ///< see tet_format_table()
  volume,    ///< .nrrd; to be read .nhdr .mhd .mha .nii .nii.gz .inr .inr.gz too
  unknown
};

/// What a file is to be used for: some formats are read but not written.
enum class FileUse { read, write };

FileKind file_kind(const std::string& path, FileUse use = FileUse::read);

/// ".ply .obj .stl .off", for messages and help.
std::string known_extensions(FileKind kind, FileUse use = FileUse::read);

/// Whether read_surface() reads files of this extension: surfaces, and .msh and .mesh, which hold a surface
/// or a tet mesh.
bool may_hold_surface(const std::string& path);

/// What a format of tet meshes has a place for when it is written.
struct TetFormatInfo {
  std::string name;       ///< as write_tet_mesh() takes it: "msh41-binary"
  std::string extension;  ///< ".msh"
  bool names;             ///< of materials
  bool surfaces;          ///< boundary and interface triangles, by groups
  bool patch_names;       ///< of these groups
  bool fields;            ///< of points and tets
  bool second_order;      ///< tets of ten nodes
};

/// The formats of tet meshes that can be written. An extension's first one is taken where none is named.
std::vector<TetFormatInfo> written_tet_formats();

/// The one that a tet mesh of this path is written in: `name`'s, or where that is empty its extension's.
/// Throws UsageError if there is none.
TetFormatInfo written_tet_format(const std::string& path, const std::string& name = {});

/// What it makes of tags, numbers and names of the mesh that it cannot hold as they are; of what it has no
/// place for there is nothing here.
NameChanges written_name_changes(const TetMesh& mesh, const std::string& path, const std::string& name = {});

/// The format that write_surface() and write_interfaces() choose. Throws UsageError if there is none.
struct SurfaceFormatInfo {
  std::string extension;
  bool names;  ///< of groups of triangles
};
SurfaceFormatInfo written_surface_format(const std::string& path, const std::string& format = {});

/// What write_interfaces() makes of the names of patches that the format cannot hold as they are.
std::vector<NameChange> written_interface_name_changes(const TetMesh& mesh, const std::string& path,
                                                       const std::string& format = {});

/// Whether files with this extension may give numbers to points, which then are the fields of
/// read_surface_with_fields() or of read_tet_mesh().
bool may_hold_point_fields(const std::string& path);

/// Their extensions, as known_extensions() gives them.
std::string point_field_extensions();

/// The name of a file without folders and extension; .nii.gz and .inr.gz are removed whole.
std::string file_stem(const std::string& path);

/// Reads a file. Throws UsageError if the extension is not one of the kind asked for, InputError if the file
/// is missing, unreadable or malformed, or a tet mesh is too large or too small (require_measurable()). A
/// .node and an .ele file of one name in one folder are a pair, which either of them names. A header of a
/// volume may name another file with the voxels. What a surface file holds beside points and faces is
/// appended to `dropped`, unless that is null; a tet mesh comes with its own list.
TriangleMesh read_surface(const std::string& path, std::vector<Dropped>* dropped = nullptr);
ReadTetMesh read_tet_mesh(const std::string& path, const ReadTetMeshOptions& options = {});
LabelVolume read_label_volume(const std::string& path);

/// The same of a file's bytes, such as a stream's, of a format that is one file: `extension` tells which, and
/// messages call them `name`. Throws UsageError where the extension is none of those of streams().
TriangleMesh read_surface_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                                std::vector<Dropped>* dropped = nullptr);
ReadTetMesh read_tet_mesh_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                                const ReadTetMeshOptions& options = {});
LabelVolume read_label_volume_bytes(std::string_view bytes, const std::string& name,
                                    const std::string& extension);

/// The extensions that are read from streams, ".ply .obj", and whether one is.
std::string streamed_extensions();
bool streams(const std::string& extension);

/// Reads the surface of a file together with the fields of its points; nothing for a tet mesh, by its
/// extension or since there are tets in it. Throws UsageError for surfaces of an extension that
/// may_hold_point_fields() doesn't know, else as read_surface() does.
std::optional<SurfaceWithFields> read_surface_with_fields(const std::string& path);

/// Writes a file whole or not at all; coordinates come back bit by bit. With `files` it appears when these
/// are committed (see atomic_file.h), and writing can be cancelled; "-" is standard output. Throws UsageError
/// if the extension is not one of the kind, OutputError if the file can't be written, Interrupted if
/// cancelled. A tet mesh is written in written_tet_format(), and as several files if that has several: their
/// names differ in the extension. `format` of the others is an extension, "ply" or ".ply", in place of the
/// path's.
void write_surface(const TriangleMesh& mesh, const std::string& path, OutputFiles* files = nullptr,
                   const std::string& format = {});
void write_tet_mesh(const MeshToWrite& mesh, const std::string& path, OutputFiles* files = nullptr,
                    const std::string& format = {});
/// The boundary and the interfaces of the mesh by themselves, as a surface with their names.
void write_interfaces(const TetMesh& mesh, const std::string& path, OutputFiles* files = nullptr,
                      const std::string& format = {});
void write_label_volume(const LabelVolume& volume, const std::string& path, OutputFiles* files = nullptr,
                        const std::string& format = {});

/// All files that write_tet_mesh() writes for a path.
std::vector<std::string> files_of_tet_mesh(const std::string& path, const std::string& format = {});

/// The file, and those that are read with it because of its name: the parts of TetGen's and XDMF meshes and
/// of .hdr with .img. They need not exist.
std::vector<std::string> files_of_input(const std::string& path);

/// To be called before any work: throws UsageError if the extension or the format is not one of `kind`,
/// OutputError if the folder is missing or not writable or what is there is not a regular file.
void check_output_path(const std::string& path, FileKind kind = FileKind::tet_mesh,
                       const std::string& format = {});

}  // namespace tetwright
