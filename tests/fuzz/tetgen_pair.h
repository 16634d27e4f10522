#pragma once

#include "common/formats/tetgen.h"

namespace tetwright {

/// Reads the files of points, tets and faces from one text, in which lines of equal signs separate them;
/// faces may be left out.
inline ReadTetMesh read_tetgen(std::string_view bytes, const std::string& name) {
  constexpr std::string_view between = "=====\n";
  const auto next = [&] {
    const std::size_t at = bytes.find(between);
    const std::string_view part = bytes.substr(0, at);
    bytes = at == std::string_view::npos ? "" : bytes.substr(at + between.size());
    return part;
  };
  const std::string_view node = next(), ele = next();
  const std::optional<NamedBytes> face =
      bytes.empty() ? std::nullopt : std::optional(NamedBytes{bytes, name});
  return read_tetgen({node, name}, {ele, name}, face);
}

}  // namespace tetwright
