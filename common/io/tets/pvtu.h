// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/io/volumes/data_file.h"
#include "common/mesh/mesh_pieces.h"
#include "tetwright/files.h"
#include "tetwright/io.h"

namespace tetwright {

/// Reads a parallel VTK XML file (.pvtu) with its pieces (.vtu), each relative to the folder of the first.
/// Pieces with the arrays GlobalNodeId and GlobalCellId are joined by these numbers: the tets without the
/// mark of ghosts (vtkGhostType), in ascending order, and all points. Their groups of faces are restored (see
/// take_triangles()). Pieces without these numbers are joined as read_vtu() joins those of one file.
/// \throws InputError, with the piece and the number, if a tet is in two pieces or in none, a number is twice
///   in a piece, a ghost differs from its owner's tet, or pieces give a point different coordinates or
///   values; if a number is not between -2^53 and 2^53, a piece is named twice, or by a path that is absolute
///   or has a part ".."; and in the cases of read_vtu()
/// \throws OutputError if the numbered pieces need more than available_memory()
/// \param read_file reads all of these files
ReadTetMesh read_pvtu(const std::string& path, const ReadTetMeshOptions& options,
                      const FileReader& read_file);

/// Files of the pieces that a .pvtu file names; none if it cannot be read.
std::vector<std::string> pieces_of_pvtu(const std::string& path);

/// Writes a piece of a mesh as a .vtu file: its tets as cells with the arrays of elements/vtk_pieces.h,
/// materials, names and fields as write_vtu() writes them. A process needs only its own piece.
void write_vtu_piece(const MeshPiece& piece, const DividedMesh& whole, const ByteSink& sink);

/// Writes the .pvtu file that names the pieces.
/// \param stem name of the files, without folders and extension
void write_pvtu_index(const DividedMesh& whole, const std::string& stem, const ByteSink& sink);

/// The .pvtu file and its pieces NAME_0.vtu, NAME_1.vtu and so on.
std::vector<std::string> files_of_pvtu(const std::string& path, PartNumber parts);

}  // namespace tetwright
