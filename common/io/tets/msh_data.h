// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/io/elements/file_numbers.h"
#include "common/io/encodings/msh_numbers.h"
#include "common/io/text/text_scanner.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// Reads the rest of a section "$NodeData" or "$ElementData" after its keyword, in either version of the
/// format. The field has a value for each of the `items` items of `numbers`, NaN for those that the section
/// does not list; no values if no row is left.
/// \param like rows are binary if it is
/// \param what "node" or "element"
/// \param missing_allowed rows of other items are skipped (elements that are not tets); otherwise they are
///   errors
/// \param room number of values that further fields of the file may have; lowered. Bounds the memory that
///   many short sections for many items would take
/// \throws InputError with the line
MeshField read_msh_data(TextScanner& in, const MshNumbers& like, const std::string& what,
                        const FileNumbers& numbers, std::size_t items, bool missing_allowed,
                        std::size_t& room);

/// Fields of the tets, extended by values for the triangles of the interfaces, which follow them: those of
/// the tets on the side of their `material`. Some readers (meshio 5.0) require one for each element.
std::vector<MeshField> fields_of_elements(const TetMesh& mesh);

/// Appends the fields as sections "$NodeData" or "$ElementData"; items are numbered from 1. The format has
/// fields of 1, 3 and 9 components: others are padded with zeros, and one of more than nine is written as one
/// field for each component, "name_0" and so on. It has no integers. Rows are binary in binary files,
/// little-endian.
/// \param section keyword without the dollar
/// \param order of the rows, as the file lists the items (empty: ascending), since meshio 5.0 ignores their
///   numbers in text
void append_msh_data(std::string& out, const std::string& section, const std::vector<MeshField>& fields,
                     std::size_t items, bool binary = false, const std::vector<std::size_t>& order = {});

/// Converts a name for use in quotes: a quote, backslash or control character becomes an underscore, invalid
/// UTF-8 a replacement character, which other readers need. At most 120 bytes: Gmsh 4.8.4 accepts 127 for the
/// name, the rest is for the suffixes of equal names, and cannot load a file with 245.
std::string msh_name(const std::string& name);

}  // namespace tetwright
