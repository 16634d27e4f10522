// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tetwright {

/// Writes an HDF5 file in memory with the HDF5 library. Not safe for concurrent use, since the library is
/// not.
class Hdf5Writer {
 public:
  Hdf5Writer();
  ~Hdf5Writer();

  /// Adds a group with this name, for names such as "group/dataset".
  void add_group(const std::string& name);
  /// Add attributes to a group: a text, and a list of numbers.
  void add_attribute(const std::string& group, const std::string& name, const std::string& text);
  void add_attribute(const std::string& group, const std::string& name, std::span<const std::int64_t> values);
  /// Adds a dataset with `columns` numbers in each row, compressed by zlib.
  /// \param name path of a group that was added, and a name without slashes; or only the latter
  /// \param columns 0: a list, with one dimension
  void add(const std::string& name, std::span<const double> values, std::size_t columns);
  void add(const std::string& name, std::span<const std::int64_t> values, std::size_t columns);
  void add(const std::string& name, std::span<const std::int32_t> values, std::size_t columns);
  void add(const std::string& name, std::span<const std::uint8_t> values, std::size_t columns);
  /// Bytes of the file; equal datasets give equal bytes.
  std::string bytes();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// Reads datasets of an HDF5 file in memory.
class Hdf5Reader {
 public:
  /// \throws InputError if the bytes are not an HDF5 file
  Hdf5Reader(std::string bytes, std::string name);
  ~Hdf5Reader();

  /// Reads all numbers of a dataset (such as "/Mesh/geometry"), row by row; integers beyond 2^53 are rounded.
  /// \throws InputError if the dataset is missing, not numeric, or has more than `max_count` numbers
  std::vector<double> numbers(const std::string& dataset, std::size_t max_count) const;

 private:
  struct File;
  std::unique_ptr<File> file_;
  std::string name_;
};

}  // namespace tetwright
