// SPDX-License-Identifier: Apache-2.0
#include "common/io/names/unique_names.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "common/io/text/text_scanner.h"

namespace tetwright {

std::string UniqueNames::key(const std::string& name) const {
  if (!ignore_case_) return name;
  std::string lower = name;
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string UniqueNames::add(const std::string& name) {
  const std::string plain = form_(name);
  std::string unique = plain;
  std::size_t& number = next_.try_emplace(key(plain), 2).first->second;
  while (!used_.insert(key(unique)).second) unique = plain + "_" + std::to_string(number++);
  return unique;
}

std::string UniqueNames::add_pair(const std::string& name) {
  const std::string plain = form_(name), base = key(plain);
  const auto [last, first_time] = last_of_pairs_.try_emplace(base, 0);
  if (first_time)
    for (auto other = used_.lower_bound(base); other != used_.end() && other->starts_with(base); ++other)
      last->second = std::max(last->second, name_suffix(base, *other));
  ++last->second;
  return add(last->second == 1 ? plain : plain + "_" + std::to_string(last->second));
}

std::int64_t name_suffix(const std::string& base, const std::string& name) {
  if (name == base) return 1;
  if (!name.starts_with(base + "_")) return 0;
  std::int64_t n = 0;
  const std::string_view digits = std::string_view(name).substr(base.size() + 1);
  const bool known = parse_number(digits, n) && n >= 2 && n <= std::numeric_limits<std::int32_t>::max();
  return known && std::to_string(n) == digits ? n : 0;
}

}  // namespace tetwright
