// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/io/elements/file_numbers.h"
#include "common/io/encodings/msh_numbers.h"
#include "common/io/text/text_scanner.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Reads the rest of a section "$NodeData" or "$ElementData" after its keyword, in either version of the
/// format. The field has a value for each of the `items` items of `numbers`, NaN for items that the section
/// does not list. The field has no values if no row belongs to an item.
/// \param like rows have its encoding, text or binary
/// \param what "node" or "element"
/// \param missing_allowed rows of other items are skipped (elements that are not tets); otherwise they are
///   errors
/// \param room number of values that further fields of the file may have; decreased by this call. Bounds the
///   memory that many short sections for many items would take
/// \throws InputError with the line
MeshField read_msh_data(TextScanner& in, const MshNumbers& like, const std::string& what,
                        const FileNumbers& numbers, std::size_t items, bool missing_allowed,
                        std::size_t& room);

/// Fields of the tets, extended to the interface triangles, which follow the tets: a triangle gets the values
/// of the tet on the side of its `material`. Some readers (meshio 5.0) require a value for each element.
std::vector<MeshField> fields_of_elements(const TetMesh& mesh);

/// Appends the fields as sections "$NodeData" or "$ElementData"; items are numbered from 1. The format has
/// fields of 1, 3 and 9 components: other fields are padded with zeros, and one with more than nine
/// components is written as one field for each component, "name_0" and so on. It has no integers. Rows are
/// binary in binary files, little-endian.
/// \param section keyword without the dollar sign
/// \param order order in which the file lists the items (empty: ascending); rows must follow it, since meshio
///   5.0 ignores their numbers in text files
/// \param numbers numbers of the items in the file; empty: from 1
void append_msh_data(std::string& out, const std::string& section, const std::vector<MeshField>& fields,
                     std::size_t items, bool binary = false, const std::vector<std::size_t>& order = {},
                     const std::vector<std::size_t>& numbers = {});

/// Converts a name to a form for quotes: quotes, backslashes and control characters become underscores, and
/// invalid UTF-8 becomes replacement characters, which other readers require. At most 120 bytes: Gmsh 4.8.4
/// accepts names of 127 bytes, which leaves room for the suffixes of equal names, and cannot load a file with
/// one of 245.
std::string msh_name(const std::string& name);

}  // namespace tetwright
