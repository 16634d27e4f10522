// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/names/mesh_parts.h"
#include "common/mesh/mesh_pieces.h"
#include "tetwright/file_sharing.h"
#include "tetwright/files.h"
#include "tetwright/io.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// One of the files in which a tet mesh is written.
struct WrittenFile {
  const char* extension;
  /// \param first name, without folders, of the first file of the mesh
  void (*write)(const MeshToWrite& mesh, const std::string& first, const ByteSink& sink);
  void (*add)(const MeshToWrite& mesh, Hdf5Writer& file) = nullptr;  ///< the same, if it is an HDF5 file
};

/// How a format holds a mesh in parts, each with the tets of others next to it.
struct PartFiles {
  std::vector<std::string> (*names)(const std::string& path, PartNumber parts) = nullptr;  ///< of the files
  /// Writes all files. Null: the first ones are those of the pieces, in ascending order.
  /// \param share as for write_tet_mesh()
  void (*write)(const MeshPieces& pieces, const std::string& path, OutputFiles& files,
                const FileSharing* share) = nullptr;
  void (*write_piece)(const MeshPiece& piece, const DividedMesh& whole, const ByteSink& sink) = nullptr;
  /// Writes the last file. Null: there are only pieces.
  /// \param stem its name without folders and extension
  void (*write_index)(const DividedMesh& whole, const std::string& stem, const ByteSink& sink) = nullptr;
  // Fields that the writer adds itself, as TetFormat::own_cell_fields.
  std::vector<std::string> own_point_fields = {}, own_cell_fields = {};

  explicit operator bool() const { return write || write_piece; }
};

/// A tet mesh format: its reader, its writer and the contents that it can store.
struct TetFormat {
  const char* extension;
  const char* name;
  /// Reader of a format with one file, or with several. If both are null, the format can only be written.
  ReadTetMesh (*read)(std::string_view bytes, const std::string& name,
                      const ReadTetMeshOptions& options) = nullptr;
  ReadTetMesh (*read_files)(const std::string& path, const ReadTetMeshOptions& options) = nullptr;
  /// Files of a mesh that is not divided. Empty: the format can only be read or holds only parts, so that an
  /// undivided mesh is written as one part.
  std::vector<WrittenFile> write = {};
  PartFiles part_files = {};
  /// Parts of a mesh, with the names that the writer gives them.
  MeshParts (*parts)(const TetMesh& mesh) = nullptr;
  /// Cell fields that the writer adds itself; no other field may have their names.
  std::vector<std::string> own_cell_fields = {};
  /// The argument `form` of field_names_to_write().
  std::string (*field_name)(const std::string& name) = nullptr;
  bool point_fields = true;  ///< may have point fields when it is read
  // Meaning as in TetFormatInfo.
  bool names = true, surfaces = true, patch_names = true, fields = true, second_order = false, wedges = false;
  BinsAs bins = BinsAs::none;
  bool moduli = false, inner_surfaces = true, single_precision = false;
  /// Library that this build lacks, without which the format is not written; null: none.
  const char* missing_library = nullptr;
};

/// All formats in the order in which they are listed. The first one with an extension is its default.
const std::vector<TetFormat>& tet_formats();

/// Contents that a format can store.
TetFormatInfo info_of(const TetFormat& format);

/// Removes the names of cohesive elements from those of the materials, like which files have them.
void drop_names_of_cohesive(TetMesh& mesh);

}  // namespace tetwright
