#pragma once

#include <string>

#include "common/formats/read_tet_mesh_result.h"
#include "common/label_volume.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Files by their extension, upper or lower case.
enum class FileKind {
  surface,   ///< .ply .obj .stl .off
  tet_mesh,  ///< .vtu .msh .mesh; to be read .vtk .node .ele too
  volume,    ///< .nrrd; to be read .nhdr .mhd .mha .nii .nii.gz .inr .inr.gz too
  unknown
};

/// Some formats are read but not written.
enum class FileUse { read, write };

FileKind file_kind(const std::string& path, FileUse use = FileUse::read);

/// ".ply .obj .stl .off", for messages and help.
std::string known_extensions(FileKind kind, FileUse use = FileUse::read);

/// A file's name without folders and extension; .nii.gz and .inr.gz go whole.
std::string file_stem(const std::string& path);

/// Reads a file. Throws UsageError if the extension is not one of the kind asked for, InputError if the file
/// is missing, unreadable or makes no sense. A .node and an .ele file are a pair, named by either: the other
/// one stands beside it under the same name. A header of a volume may name another file with the voxels.
TriangleMesh read_surface(const std::string& path);
ReadTetMesh read_tet_mesh(const std::string& path, const ReadTetMeshOptions& options = {});
LabelVolume read_label_volume(const std::string& path);

/// Writes a file whole or not at all (see atomic_file.h); coordinates come back bit by bit. Throws UsageError
/// if the extension is not one of the kind, OutputError if it can't be written.
void write_surface(const TriangleMesh& mesh, const std::string& path);
void write_tet_mesh(const TetMesh& mesh, const std::string& path);
void write_label_volume(const LabelVolume& volume, const std::string& path);

/// To be called before any work: throws UsageError if the extension is not one of `kind`, OutputError if the
/// folder is missing or not writable or what is there is not a regular file.
void check_output_path(const std::string& path, FileKind kind = FileKind::tet_mesh);

}  // namespace tetwright
