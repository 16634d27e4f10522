// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>

namespace tetwright {

/// Makes names unique: each in the form that a format can hold, with the suffix "_2", "_3" and so on if that
/// is taken.
class UniqueNames {
 public:
  /// \param form converts a name to one that the format can hold
  /// \param ignore_case names that differ only in the case of ASCII letters are equal
  explicit UniqueNames(std::function<std::string(const std::string&)> form, bool ignore_case = false)
      : form_(std::move(form)), ignore_case_(ignore_case) {}

  std::string add(const std::string& name);

  /// Adds the name of a pair of materials, with the largest suffix of those with its name, so that readers
  /// can distinguish it from the input's.
  /// \pre the names of the input are added already
  std::string add_pair(const std::string& name);

 private:
  std::string key(const std::string& name) const;

  std::function<std::string(const std::string&)> form_;
  bool ignore_case_;
  std::set<std::string> used_;
  std::map<std::string, std::size_t> next_;  ///< the next suffix to try
  /// Largest suffix of names of pairs, and of the input's names that resemble them.
  std::map<std::string, std::int64_t> last_of_pairs_;
};

/// Suffix that turns `base` into `name`: 1 if they are equal, n for "base_n" with n from 2 to 2^31 - 1,
/// otherwise 0.
std::int64_t name_suffix(const std::string& base, const std::string& name);

}  // namespace tetwright
