// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// A range of labels with both ends.
using LabelRange = std::pair<MaterialTag, MaterialTag>;

/// Parses a label: a whole number of 32 bits. Throws UsageError that names `option` and the text.
MaterialTag parse_label(const std::string& option, const std::string& text);

/// Parses labels and ranges of labels, such as "1,5-9,-3--1": a minus after a number makes a range, before a
/// number it is a sign. Throws UsageError that names `option` and the part that is wrong.
std::vector<LabelRange> parse_label_ranges(const std::string& option, const std::string& text);

}  // namespace tetwright
