// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/files/atomic_file.h"
#include "common/io/contents/mesh_to_write.h"
#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/names/mesh_parts.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// A file that a tet mesh is written as.
struct WrittenFile {
  const char* extension;
  /// `first` is the name, without folders, of the first file that the mesh is written as.
  void (*write)(const MeshToWrite& mesh, const std::string& first, const ByteSink& sink);
};

/// A format of tet meshes: how files of its extension are read and written, and what it has a place for.
struct TetFormat {
  const char* extension;
  const char* name;
  /// Of a format of one file, and of one of several; both null: only written.
  ReadTetMesh (*read)(std::string_view bytes, const std::string& name,
                      const ReadTetMeshOptions& options) = nullptr;
  ReadTetMesh (*read_files)(const std::string& path, const ReadTetMeshOptions& options) = nullptr;
  std::vector<WrittenFile> write;  ///< empty: only read
  /// What the writer calls the parts of a mesh.
  MeshParts (*parts)(const TetMesh& mesh) = nullptr;
  /// Names of cell fields that the writer adds itself; no other field may have them.
  std::vector<std::string> own_cell_fields = {};
  /// As field_names_to_write() takes it.
  std::string (*field_name)(const std::string& name) = nullptr;
  bool point_fields = true;  ///< when it is read
  // As in TetFormatInfo.
  bool names = true, surfaces = true, patch_names = true, fields = true, second_order = false;
};

/// All of them, in the order in which they are listed; the first of an extension is the one that it stands
/// for.
const std::vector<TetFormat>& tet_formats();

}  // namespace tetwright
