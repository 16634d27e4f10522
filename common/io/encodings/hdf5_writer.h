// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>

namespace tetwright {

/// Numbers of a dataset, row by row.
using Hdf5Numbers = std::variant<std::span<const double>, std::span<const std::int64_t>,
                                 std::span<const std::int32_t>, std::span<const std::uint8_t>>;

/// Writes an HDF5 file. Not safe for concurrent use, since the HDF5 library is not.
class Hdf5Writer {
 public:
  virtual ~Hdf5Writer() = default;

  /// Adds a group with this name, for names such as "group/dataset".
  virtual void add_group(const std::string& name) = 0;
  /// Add attributes to a group: a text, and a list of numbers.
  virtual void add_attribute(const std::string& group, const std::string& name, const std::string& text) = 0;
  virtual void add_attribute(const std::string& group, const std::string& name,
                             std::span<const std::int64_t> values) = 0;
  /// Adds a dataset with `columns` numbers in each row.
  /// \param name path of a group that was added, and a name without slashes; or only the latter
  /// \param columns 0: a list, with one dimension
  virtual void add(const std::string& name, const Hdf5Numbers& values, std::size_t columns) = 0;
};

}  // namespace tetwright
