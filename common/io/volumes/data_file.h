// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "common/io/volumes/header_fields.h"

namespace tetwright {

/// Returns all bytes of a file. This is read_whole_file(), except in tests and fuzzers, which have no files.
using FileReader = std::function<std::string(const std::string& path)>;

/// Content of a file, with its name for messages.
struct NamedBytes {
  std::string_view bytes;
  std::string name;
};

/// File that holds the voxels of a separate header.
struct DataFile {
  std::string path;
  std::string bytes;
};

/// Path of the file named by `field` of the header, relative to the header's folder.
/// \throws InputError with the line of the header if the field does not name one file
std::string data_file_path(const HeaderFields& header, const std::string& field);

/// Size of the file named by `field` of the header, bytes.
/// \throws InputError with the line of the header if the file cannot be read
std::uint64_t data_file_size(const HeaderFields& header, const std::string& field);

/// Reads the file named by `field` of the header, relative to the header's folder.
/// \throws InputError with the line of the header if the file cannot be read
DataFile read_data_file(const HeaderFields& header, const std::string& field, const FileReader& read);

}  // namespace tetwright
