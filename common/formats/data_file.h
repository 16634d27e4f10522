#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/formats/header_fields.h"

namespace tetwright {

/// All bytes of a file: read_whole_file(), unless there are to be no files.
using FileReader = std::function<std::string(const std::string& path)>;

/// Where a header's voxels are, if not behind it.
struct DataFile {
  std::string path;
  std::string bytes;
};

/// Reads the file that `field` of the header names, relative to the header. Throws InputError with the
/// header's line if it can't be read.
DataFile read_data_file(const HeaderFields& header, const std::string& field, const FileReader& read);

}  // namespace tetwright
