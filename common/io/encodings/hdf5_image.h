// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tetwright {

/// An HDF5 file in memory, on the HDF5 library. Not safe for concurrent use: the library is not.
class Hdf5Writer {
 public:
  Hdf5Writer();
  ~Hdf5Writer();

  /// Adds a dataset of `columns` numbers in each row, compressed by zlib; `name` has no slashes.
  void add(const std::string& name, std::span<const double> values, std::size_t columns);
  void add(const std::string& name, std::span<const std::int64_t> values, std::size_t columns);
  void add(const std::string& name, std::span<const std::int32_t> values, std::size_t columns);
  /// The bytes of the file, the same for the same datasets.
  std::string bytes();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// Reads datasets of an HDF5 file in memory.
class Hdf5Reader {
 public:
  /// Throws InputError if the bytes are no HDF5 file.
  Hdf5Reader(std::string bytes, std::string name);
  ~Hdf5Reader();

  /// All numbers of a dataset ("/Mesh/geometry"), row by row; integers beyond 2^53 lose digits. Throws
  /// InputError if there is none, if it does not hold numbers, or if they are more than `max_count`.
  std::vector<double> numbers(const std::string& dataset, std::size_t max_count) const;

 private:
  struct File;
  std::unique_ptr<File> file_;
  std::string name_;
};

}  // namespace tetwright
