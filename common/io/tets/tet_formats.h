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

/// One of the files that a tet mesh is written to.
struct WrittenFile {
  const char* extension;
  /// \param first name, without folders, of the first file of the mesh
  void (*write)(const MeshToWrite& mesh, const std::string& first, const ByteSink& sink);
};

/// A format of tet meshes: its reader, its writer and the contents that it can store.
struct TetFormat {
  const char* extension;
  const char* name;
  /// Readers of a format of one file, and of one of several; both null: only written.
  ReadTetMesh (*read)(std::string_view bytes, const std::string& name,
                      const ReadTetMeshOptions& options) = nullptr;
  ReadTetMesh (*read_files)(const std::string& path, const ReadTetMeshOptions& options) = nullptr;
  std::vector<WrittenFile> write;  ///< empty: only read
  /// Parts of a mesh as the writer names them.
  MeshParts (*parts)(const TetMesh& mesh) = nullptr;
  /// Cell fields that the writer adds itself; no other field may have their names.
  std::vector<std::string> own_cell_fields = {};
  /// The `form` of field_names_to_write().
  std::string (*field_name)(const std::string& name) = nullptr;
  bool point_fields = true;  ///< it may have fields of points when it is read
  // As in TetFormatInfo.
  bool names = true, surfaces = true, patch_names = true, fields = true, second_order = false;
};

/// All formats, in the order in which they are listed; the first of an extension is its default.
const std::vector<TetFormat>& tet_formats();

}  // namespace tetwright
