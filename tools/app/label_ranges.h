// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tetwright/prepare.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// An inclusive range of labels.
using LabelRange = std::pair<MaterialTag, MaterialTag>;

/// Parses a label, a 32-bit integer.
///
/// \throws UsageError that names `option` and `text`
MaterialTag parse_label(const std::string& option, const std::string& text);

/// Parses labels and ranges of labels, such as "1,5-9,-3--1". A minus after a number denotes a range; before
/// a number it is a sign.
///
/// \throws UsageError that names `option` and the invalid part
std::vector<LabelRange> parse_label_ranges(const std::string& option, const std::string& text);

/// Adds the labels of a list to LabelOptions::protected_labels and protected_names: items that are neither a
/// label nor a range are names.
///
/// \throws UsageError for an empty item, or a range that begins with the larger label
void add_protected_labels(const std::string& text, LabelOptions& options);

}  // namespace tetwright
