// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/files/atomic_file.h"
#include "common/io/contents/mesh_to_write.h"
#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/volumes/data_file.h"

namespace tetwright {

/// Reads the tets (Tetrahedron, or Tetrahedron_10 by their corners) of an XDMF file, version 2 or 3: the
/// first uniform grid that has some, with numbers in the text or in an HDF5 file beside it, which `read_file`
/// reads. Attributes of nodes and cells become fields, of which ReadTetMesh describes the material; names of
/// materials are those that write_xdmf() writes. Mixed topologies and other cells of three dimensions are
/// refused, other grids are counted in ReadTetMesh::dropped. `facets` is the file that write_xdmf_facets()
/// writes, if there is one: its triangles are groups of faces, see take_triangles(); one that is of other
/// points is counted in ReadTetMesh::dropped. Throws InputError for anything that is malformed.
ReadTetMesh read_xdmf(std::string_view bytes, const std::string& name, const FileReader& read_file,
                      const ReadTetMeshOptions& options = {}, const std::optional<NamedBytes>& facets = {});

/// The four files of a mesh: the grids "mesh", with the cell attribute "material" and the mesh's fields, and
/// "facet_tags", the triangles of the interfaces, if the mesh has any, with the numbers of their groups (see
/// BoundaryGroups) as the attribute "facet_tags", and the numbers of each as HDF5. The grids have files of
/// their own, since readers take the only grid of a file; the points are in the first HDF5 file for both.
/// Names are Information elements as meshio reads them. `hdf5` is the name of the first file as the others
/// give it. The numbers of tets of ten nodes are in VTK's order.
void write_xdmf_numbers(const MeshToWrite& written, const ByteSink& sink);
void write_xdmf_facet_numbers(const MeshToWrite& written, const ByteSink& sink);
void write_xdmf_mesh(const MeshToWrite& written, const std::string& hdf5, const ByteSink& sink);
void write_xdmf_facets(const MeshToWrite& written, const std::string& hdf5, const ByteSink& sink);

}  // namespace tetwright
