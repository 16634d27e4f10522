// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/encodings/hdf5_writer.h"

namespace tetwright {

/// Writes an HDF5 file in memory with the HDF5 library. Equal contents give equal bytes.
class Hdf5Image final : public Hdf5Writer {
 public:
  Hdf5Image();
  ~Hdf5Image() override;

  void add_group(const std::string& name) override;
  void add_attribute(const std::string& group, const std::string& name, const std::string& text) override;
  void add_attribute(const std::string& group, const std::string& name,
                     std::span<const std::int64_t> values) override;
  void add(const std::string& name, const Hdf5Numbers& values, std::size_t columns) override;
  /// Bytes of the file.
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
