// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/io/elements/element_types.h"
#include "tetwright/io.h"

namespace tetwright {

inline constexpr bool is_vtk_tet(std::int64_t type) {
  return type == element::tet.vtk || type == element::quadratic_tet.vtk;
}

inline constexpr bool is_vtk_triangle(std::int64_t type) {
  return type == element::triangle.vtk || type == element::quadratic_triangle.vtk;
}

/// Names of arrays in this program's files: the cell field with the numbers of surfaces, and the field data
/// with the names of surfaces and materials, as the bytes of lines "NUMBER<tab>NAME".
inline constexpr const char* vtk_surface_field = "surface";
inline constexpr const char* vtk_surface_names = "surface_names";
inline constexpr const char* vtk_material_names = "material_names";
/// Name of the field data with the coordinate system, "LPS" or "RAS": a text in files of 3D Slicer, the bytes
/// of the text in those of this program, since other readers do not support VTK's text arrays.
inline constexpr const char* vtk_space = "SPACE";

/// Converts an array of bytes to text; ? for a number that is no byte.
std::string vtk_text(const std::vector<double>& bytes);

/// Parses such lines.
/// \throws InputError for a line of another form
std::vector<std::pair<std::int64_t, std::string>> parse_vtk_names(const std::string& text,
                                                                  const std::string& array,
                                                                  const std::string& file);

/// Cells of a file that are not linear tets, counted by type.
class OtherVtkCells {
 public:
  /// `type` is VTK's number, `cell` the index of the cell.
  void add(std::int64_t type, std::size_t cell);
  /// Removes a cell that is no volume.
  void remove(std::int64_t type) {
    if (--counts_[type] == 0) counts_.erase(type);
  }
  /// Whether there are cells of three dimensions, or of unknown types, which might be.
  bool has_volumes() const { return has_volumes_; }
  /// Index of the first of these.
  std::size_t first_volume() const { return first_volume_; }
  /// Message that rejects the file for them.
  std::string refusal() const;
  /// Appends the skipped cells: lines, faces, vertices.
  void append_flat_to(std::vector<Dropped>& dropped) const;

 private:
  std::map<std::int64_t, std::size_t> counts_;  ///< by type
  bool has_volumes_ = false;
  std::size_t first_volume_ = 0;
  std::int64_t first_volume_type_ = 0;
};

}  // namespace tetwright
