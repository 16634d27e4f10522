// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/io/encodings/hdf5_writer.h"
#include "common/mesh/mesh_pieces.h"
#include "tetwright/file_sharing.h"
#include "tetwright/files.h"

namespace tetwright {

/// Contents of a mesh in pieces as a VTKHDF file: an UnstructuredGrid of version 1.0 with the arrays of
/// elements/vtk_pieces.h, materials, names and fields as in .pvtu files. Needs memory for the whole file and
/// its numbers. Not safe for concurrent use, since the HDF5 library is not.
class VtkHdfWriter {
 public:
  /// \param whole must outlive this object
  explicit VtkHdfWriter(const DividedMesh& whole);
  ~VtkHdfWriter();

  /// Adds a piece; all must be added, in ascending order.
  void add(const MeshPiece& piece);
  /// Adds the contents of the file, once all pieces are added.
  void write(Hdf5Writer& file) const;

 private:
  struct Arrays;
  const DividedMesh& whole_;
  std::unique_ptr<Arrays> arrays_;
};

/// Converts a name to one for a dataset, in which slashes would make groups.
std::string vtkhdf_name(const std::string& name);

/// Writes the file of all pieces.
/// \param share as for write_tet_mesh()
void write_vtkhdf(const MeshPieces& pieces, const std::string& path, OutputFiles& files,
                  const FileSharing* share);

}  // namespace tetwright
