#pragma once

#include "common/formats/3mf.h"
#include "tests/common/formats/zip_of.h"

namespace tetwright {

/// Reads the bytes as the model in a .3mf: archives that are damaged end at their checksums.
inline TriangleMesh read_3mf_model(std::string_view bytes, const std::string& name,
                                   std::vector<Dropped>* dropped = nullptr) {
  return read_3mf(zip_of({{"_rels/.rels", relationships_of_3mf}, {"3D/a.model", std::string(bytes)}}), name,
                  dropped);
}

}  // namespace tetwright
