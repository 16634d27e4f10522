// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "common/types.h"

namespace tetwright {

/// Reads the names of the labels of a segmented volume from a text file with one label on each line. All
/// lines together determine the form, one of these:
///
/// - `TAG NAME`: separated by white space or a comma; the name may contain spaces and may be quoted;
/// - colour tables of 3D Slicer (.ctbl) and FreeSurfer: `TAG NAME R G B A`;
/// - label descriptions of ITK-SNAP: `TAG R G B A VISIBLE MESH "NAME"`.
///
/// A comment begins with # or //, at the beginning of a line or after white space. No library reads all of
/// these forms.
/// \param line_numbers receives the line, from 1, that first names each label; may be null
/// \throws InputError if the file cannot be read or has no label, and with the line if a line has no tag or
///   no name, or gives a tag a second name
std::map<MaterialTag, std::string> read_label_names(
    const std::string& path, std::map<MaterialTag, std::size_t>* line_numbers = nullptr);
/// Parses the bytes of such a file; `file` is its name in messages.
std::map<MaterialTag, std::string> parse_label_names(
    std::string_view bytes, const std::string& file,
    std::map<MaterialTag, std::size_t>* line_numbers = nullptr);

}  // namespace tetwright
