#pragma once

#include <map>
#include <string>
#include <string_view>

#include "common/types.h"

namespace tetwright {

/// Names of the labels of a segmented volume, from a text file with a label on each line, in one of these
/// forms (which is told by all lines of the file together):
///
/// - `TAG NAME`: white space or a comma between them; the name may hold spaces and stand in quotes;
/// - colour tables of 3D Slicer (.ctbl) and FreeSurfer: `TAG NAME R G B A`;
/// - label descriptions of ITK-SNAP: `TAG R G B A VISIBLE MESH "NAME"`.
///
/// Whole lines and, behind white space, ends of lines after # or // are comments. Throws InputError (the file
/// can't be read, no label in it; with the line: no tag, no name, a tag again with another name).
std::map<MaterialTag, std::string> read_label_names(const std::string& path);
/// The same of a file's bytes; `file` is for messages.
std::map<MaterialTag, std::string> parse_label_names(std::string_view bytes, const std::string& file);

}  // namespace tetwright
