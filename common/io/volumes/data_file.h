// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Reads the file named by `field` of the header, relative to the header's folder.
/// \throws InputError with the line of the header if the file cannot be read
DataFile read_data_file(const HeaderFields& header, const std::string& field, const FileReader& read);

}  // namespace tetwright
