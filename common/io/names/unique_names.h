// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>

namespace tetwright {

/// Gives each name that it is asked for once: in the form that a format can hold, or where that is taken with
/// the suffix "_2", "_3" and so on.
class UniqueNames {
 public:
  /// `form` makes a name one that the format can hold. With `ignore_case`, names that differ in their ASCII
  /// letters' case alone are the same.
  explicit UniqueNames(std::function<std::string(const std::string&)> form, bool ignore_case = false)
      : form_(std::move(form)), ignore_case_(ignore_case) {}

  std::string add(const std::string& name);

  /// The same for the name of a pair of materials, which has the largest suffix of those with its name: so
  /// readers tell it from the user's. Those of the user must be there.
  std::string add_pair(const std::string& name);

 private:
  std::string key(const std::string& name) const;

  std::function<std::string(const std::string&)> form_;
  bool ignore_case_;
  std::set<std::string> used_;
  std::map<std::string, std::size_t> next_;  ///< the next suffix to try
  /// The largest suffix of names of pairs, and of what the user calls like them.
  std::map<std::string, std::int64_t> last_of_pairs_;
};

/// Which suffix makes `name` of `base`: 1 if they are equal, n for "base_n" with n from 2 to 2^31 - 1, else
/// 0.
std::int64_t name_suffix(const std::string& base, const std::string& name);

}  // namespace tetwright
