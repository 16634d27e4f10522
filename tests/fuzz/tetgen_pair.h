#pragma once

#include "common/formats/tetgen.h"

namespace tetwright {

/// Reads both files of a pair from one text, in which a line of equal signs separates them.
inline ReadTetMesh read_tetgen(std::string_view bytes, const std::string& name) {
  constexpr std::string_view between = "=====\n";
  const std::size_t at = bytes.find(between);
  const std::string_view ele = at == std::string_view::npos ? "" : bytes.substr(at + between.size());
  return read_tetgen(bytes.substr(0, at), name, ele, name);
}

}  // namespace tetwright
