// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/vtu_space.h"

#include <cstdint>
#include <string_view>

#include "common/io/elements/vtk_cells.h"
#include "common/io/encodings/vtu_arrays.h"
#include "common/io/surfaces/declared_space.h"
#include "tetwright/error.h"

namespace tetwright {

std::string space_of_vtu_array(const VtuData& data, pugi::xml_node array) {
  if (std::string_view(array.attribute("Name").as_string()) != vtk_space) return {};
  const std::string_view type = array.attribute("type").as_string();
  const int tuples = array.attribute("NumberOfTuples").as_int();
  constexpr int length = 3;  // of LPS and RAS
  std::string text;
  try {
    if (type == "String" && tuples == 1)
      data.texts(array, 1, [&](std::string_view name) { text = name; });
    else if (type == "UInt8" && tuples == length)
      for (const std::int64_t c : data.integers(array, length)) text += static_cast<char>(c);
  } catch (const InputError&) {
    return {};  // another program's array of this name, with something else in it
  }
  return space_called(text);
}

std::string read_vtu_space(const VtuData& data, pugi::xml_node grid) {
  for (const pugi::xml_node array : grid.child("FieldData").children())
    if (std::string space = space_of_vtu_array(data, array); !space.empty()) return space;
  return {};
}

void write_vtu_space(const ByteSink& sink, const std::string& space) {
  const std::string name = short_name_of_space(space);
  if (name.empty()) return;
  write_vtu_numbers(sink, "UInt8", vtk_space, "NumberOfTuples=\"" + std::to_string(name.size()) + "\" ",
                    name.size(), [&](std::size_t i) { return name[i]; });
}

}  // namespace tetwright
