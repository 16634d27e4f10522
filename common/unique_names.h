// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>

namespace tetwright {

/// Makes names unique: converts each to a form that the format can hold, and appends "_2", "_3" and so on if
/// the result is taken.
class UniqueNames {
 public:
  /// \param form converts a name to one that the format can hold
  /// \param ignore_case names that differ only in the case of ASCII letters are equal
  explicit UniqueNames(std::function<std::string(const std::string&)> form, bool ignore_case = false)
      : form_(std::move(form)), ignore_case_(ignore_case) {}

  std::string add(const std::string& name);

  /// \return whether this name was added
  bool has(const std::string& name) const { return used_.contains(key(form_(name))); }

  /// Adds the name of a pair of materials, with the largest suffix among equal names, so that readers can
  /// distinguish it from names of the input.
  /// \pre all names of the input have been added
  std::string add_pair(const std::string& name);

 private:
  std::string key(const std::string& name) const;

  std::function<std::string(const std::string&)> form_;
  bool ignore_case_;
  std::set<std::string> used_;
  std::map<std::string, std::size_t> next_;  ///< the next suffix to try
  /// Largest suffix among names of pairs and those names of the input that resemble them.
  std::map<std::string, std::int64_t> last_of_pairs_;
};

/// Suffix that turns `base` into `name`: 1 if they are equal, n for "base_n" with n from 2 to 2^31 - 1,
/// otherwise 0.
std::int64_t name_suffix(const std::string& base, const std::string& name);

}  // namespace tetwright
