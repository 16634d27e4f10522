// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tetwright/files.h"

namespace tetwright {

/// Whether this build has the netCDF library.
bool has_netcdf();

/// Classic formats of netCDF files.
enum class NetcdfForm : std::uint8_t {
  offset64,  ///< CDF-2: less than 4 GiB for each variable, no integers of 64 bits
  data64     ///< CDF-5: neither limit, but fewer programs read it
};

enum class NetcdfType : std::uint8_t { text, int32, int64, real };

/// Writes a netCDF file in memory with the netCDF library: first dimensions, attributes and variables are
/// defined, then values are put. Objects of this class may be used concurrently; each waits until the others
/// are gone, since the library is not safe for concurrent use.
class NetcdfWriter {
 public:
  /// \param min_bytes for which memory is reserved. The file gets this size at least, so it must
  ///   not exceed what the variables take
  /// \throws OutputError without has_netcdf(), or without the memory
  NetcdfWriter(NetcdfForm form, std::size_t min_bytes);
  ~NetcdfWriter();
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;

  /// \return the dimension, for variable()
  int dimension(const std::string& name, std::size_t size);
  /// A dimension that grows as values are put.
  int record_dimension(const std::string& name);
  /// \return the variable, for the functions below
  int variable(const std::string& name, NetcdfType type, const std::vector<int>& dimensions);
  /// Add an attribute to a variable, or to the file if `variable` is `whole_file`.
  void attribute(int variable, const std::string& name, const std::string& text);
  void attribute(int variable, const std::string& name, std::int32_t value);
  void attribute(int variable, const std::string& name, float value);
  static constexpr int whole_file = -1;
  void end_definitions();

  /// Put all values of a variable, or its first record. Integers are converted to the variable's type.
  void put(int variable, std::span<const double> values);
  void put(int variable, std::span<const std::int64_t> values);
  /// Puts texts of equal length, the rest of each filled with zeros.
  /// \pre no text is longer than the last dimension of the variable less one
  void put(int variable, const std::vector<std::string>& texts);

  /// Passes the file to a sink, after which nothing more can be put.
  void write_to(const ByteSink& sink);

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace tetwright
