// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/io/encodings/hdf5_writer.h"
#include "common/io/volumes/data_file.h"
#include "tetwright/files.h"
#include "tetwright/io.h"

namespace tetwright {

/// Reads the tets (Tetrahedron, or Tetrahedron_10 reduced to their corners) of an XDMF file, version 2 or 3:
/// the first uniform grid that has some, with numbers in the text or in an HDF5 file next to it. Attributes
/// of nodes and cells become fields; ReadTetMesh describes which of them is the material. Names of materials
/// are those written by write_xdmf_mesh(). Mixed topologies and other three-dimensional cells are rejected;
/// other grids are counted in ReadTetMesh::dropped.
/// \param read_file reads the HDF5 file
/// \param facets file of write_xdmf_facets(), if there is one: its triangles become groups of faces, see
///   take_triangles(); a file for other points is counted in ReadTetMesh::dropped
/// \throws InputError for malformed contents
ReadTetMesh read_xdmf(std::string_view bytes, const std::string& name, const FileReader& read_file,
                      const ReadTetMeshOptions& options = {}, const std::optional<NamedBytes>& facets = {});

/// Write the four files of a mesh: the grid "mesh", with the cell attribute "material" and the mesh's fields;
/// the grid "facet_tags", the interface triangles, if any, with the numbers of their groups (see
/// BoundaryGroups) as the attribute "facet_tags"; and the numbers of each as HDF5. Each grid has its own
/// file, since readers expect a single grid in a file; the first HDF5 file has the points of both. Names are
/// Information elements, as meshio reads them. Tets of ten nodes are in VTK's order.
/// \param hdf5 name of the first HDF5 file, as the others refer to it
void add_xdmf_numbers(const MeshToWrite& written, Hdf5Writer& file);
void add_xdmf_facet_numbers(const MeshToWrite& written, Hdf5Writer& file);
void write_xdmf_mesh(const MeshToWrite& written, const std::string& hdf5, const ByteSink& sink);
void write_xdmf_facets(const MeshToWrite& written, const std::string& hdf5, const ByteSink& sink);

}  // namespace tetwright
