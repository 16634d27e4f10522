#pragma once

#include "common/error.h"
#include "common/formats/xdmf.h"

namespace tetwright {

/// Reads a file with its numbers in the text: no other file is there.
inline ReadTetMesh read_xdmf(std::string_view bytes, const std::string& name) {
  return read_xdmf(bytes, name,
                   [](const std::string& path) -> std::string { throw InputError(path + ": is not there"); });
}

}  // namespace tetwright
