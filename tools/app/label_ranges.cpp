// SPDX-License-Identifier: Apache-2.0
#include "tools/app/label_ranges.h"

#include <algorithm>
#include <charconv>
#include <optional>
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

/// \return nothing if the text is neither a label nor a range
std::optional<LabelRange> find_range(const std::string& option, const std::string& text) {
  std::string_view left = text;
  MaterialTag first = 0;
  bool good = take_label(left, first);
  MaterialTag last = first;
  if (good && left.starts_with('-')) {
    left.remove_prefix(1);
    good = take_label(left, last);
  }
  if (!good || !left.empty()) return std::nullopt;
  if (first > last)
    throw UsageError(option + ": '" + text + "' begins with the larger label; did you mean " +
                     std::to_string(last) + "-" + std::to_string(first) + "?");
  return LabelRange(first, last);
}

/// The parts of a list between commas.
std::vector<std::string> items_of(const std::string& text) {
  std::vector<std::string> items;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    items.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return items;
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
  for (const std::string& item : items_of(text)) {
    const std::optional<LabelRange> range = find_range(option, item);
    if (!range)
      throw UsageError(std::string(option).append(": '").append(item).append(
          "' is neither a label nor a range such as 5-9"));
    ranges.push_back(*range);
  }
  return ranges;
}

void add_protected_labels(const std::string& text, LabelOptions& options) {
  for (const std::string& item : items_of(text)) {
    if (item.empty()) throw UsageError("--protect-labels: '" + text + "' has an empty item");
    if (const std::optional<LabelRange> range = find_range("--protect-labels", item))
      options.protected_labels.push_back(*range);
    else
      options.protected_names.push_back(item);
  }
}

}  // namespace tetwright
