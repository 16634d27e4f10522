// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/io/encodings/vtu_arrays.h"
#include "common/io/text/xml_text.h"
#include "common/mesh/mesh_pieces.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// VTK's name of the type in which a field is stored.
inline const char* vtu_type(FieldType type) {
  return type == FieldType::real ? "Float64" : type == FieldType::int32 ? "Int32" : "Int64";
}

/// Writes a field as a data array.
inline void write_vtu_field(const ByteSink& sink, const MeshField& field, const std::string& name,
                            FieldType type) {
  const auto write = [&]<class Number>(Number) {
    write_vtu_numbers(sink, vtu_type(type), xml_text(name),
                      "NumberOfComponents=\"" + std::to_string(field.components) + "\" ", field.values.size(),
                      [&](std::size_t i) { return static_cast<Number>(field.values[i]); });
  };
  if (type == FieldType::real)
    write(double{});
  else if (type == FieldType::int32)
    write(std::int32_t{});
  else
    write(std::int64_t{});
}

}  // namespace tetwright
