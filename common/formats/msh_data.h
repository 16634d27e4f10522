#pragma once

#include <string>
#include <vector>

#include "common/formats/file_numbers.h"
#include "common/formats/text_scanner.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// Reads what follows "$NodeData" or "$ElementData", up to the end of the section, in either version of the
/// format. `what` is "node" or "element". Items are those of `numbers`, of which there are `items`; those
/// that the section does not name get nan. `missing_allowed`: rows of other items are skipped (elements that
/// are no tets). A section with no row of ours gives a field without values. `room` is how many values the
/// fields of a file may still have: less than what the file can hold, so that short sections do not ask for
/// memory without end; it is lowered. Throws InputError with the line.
MeshField read_msh_data(TextScanner& in, const std::string& what, const FileNumbers& numbers,
                        std::size_t items, bool missing_allowed, std::size_t& room);

/// Appends the fields as sections "$NodeData" or "$ElementData" (`section` without the dollar), numbered from
/// 1. The format knows 1, 3 and 9 components: others are filled up with zeros, and those of more than nine
/// are written one by one, as "name_0" and so on. It knows no integers.
void append_msh_data(std::string& out, const std::string& section, const std::vector<MeshField>& fields,
                     std::size_t items);

/// A name as it may stand in quotes: a quote, backslash or control character becomes an underscore.
std::string msh_name(const std::string& name);

}  // namespace tetwright
