// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/size_field_file.h"

#include "common/files/file_names.h"
#include "common/io/size_files.h"
#include "mesher/level_sets/vdb_sizes.h"

namespace tetwright {

void check_size_field_path(const std::string& file) {
  if (extension_of(file) != ".vdb") check_mesh_sizes_path(file, ".vdb");
}

std::unique_ptr<const SizeSource> read_size_field(const std::string& file) {
  check_size_field_path(file);
  return extension_of(file) == ".vdb" ? read_vdb_sizes(file) : read_mesh_sizes(file);
}

}  // namespace tetwright
