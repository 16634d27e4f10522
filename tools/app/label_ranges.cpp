// SPDX-License-Identifier: Apache-2.0
#include "tools/app/label_ranges.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Removes a label from the beginning of the text.
/// \return false if there is none
bool take_label(std::string_view& text, MaterialTag& label) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), label);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

LabelRange parse_range(const std::string& option, const std::string& text) {
  std::string_view left = text;
  MaterialTag first = 0;
  bool good = take_label(left, first);
  MaterialTag last = first;
  if (good && left.starts_with('-')) {
    left.remove_prefix(1);
    good = take_label(left, last);
  }
  if (!good || !left.empty())
    throw UsageError(option + ": '" + text + "' is neither a label nor a range such as 5-9");
  if (first > last)
    throw UsageError(option + ": '" + text + "' begins with the larger label; did you mean " +
                     std::to_string(last) + "-" + std::to_string(first) + "?");
  return {first, last};
}

}  // namespace

MaterialTag parse_label(const std::string& option, const std::string& text) {
  std::string_view left = text;
  MaterialTag label = 0;
  if (!take_label(left, label) || !left.empty())
    throw UsageError(option + ": '" + text + "' is not a whole number from -2147483648 to 2147483647");
  return label;
}

std::vector<LabelRange> parse_label_ranges(const std::string& option, const std::string& text) {
  std::vector<LabelRange> ranges;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    ranges.push_back(parse_range(option, text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return ranges;
}

}  // namespace tetwright
