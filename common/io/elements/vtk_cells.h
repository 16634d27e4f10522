// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/io/contents/dropped.h"

namespace tetwright {

/// VTK's number of a linear tet, in legacy and in XML files.
inline constexpr std::int64_t vtk_tet_type = 10;
inline constexpr std::int64_t vtk_triangle_type = 5;
/// Of ten and six nodes.
inline constexpr std::int64_t vtk_quadratic_tet_type = 24;
inline constexpr std::int64_t vtk_quadratic_triangle_type = 22;

inline constexpr bool is_vtk_tet(std::int64_t type) {
  return type == vtk_tet_type || type == vtk_quadratic_tet_type;
}

inline constexpr bool is_vtk_triangle(std::int64_t type) {
  return type == vtk_triangle_type || type == vtk_quadratic_triangle_type;
}

/// The number of nodes of tets and triangles, linear and quadratic ones; of other cells 0.
inline constexpr std::size_t vtk_nodes_of(std::int64_t type) {
  return type == vtk_tet_type                  ? 4
         : type == vtk_quadratic_tet_type      ? 10
         : type == vtk_triangle_type           ? 3
         : type == vtk_quadratic_triangle_type ? 6
                                               : 0;
}

/// What our own files call the cell field with the numbers of surfaces, and the field data with the names of
/// these and of the materials: lines "NUMBER<tab>NAME" as bytes.
inline constexpr const char* vtk_surface_field = "surface";
inline constexpr const char* vtk_surface_names = "surface_names";
inline constexpr const char* vtk_material_names = "material_names";

/// The text whose bytes an array of numbers gives; ? for what is no byte.
std::string vtk_text(const std::vector<double>& bytes);

/// The numbers and names of such field data. Throws InputError for a line of another form.
std::vector<std::pair<std::int64_t, std::string>> parse_vtk_names(const std::string& text,
                                                                  const std::string& array,
                                                                  const std::string& file);

/// The cells of a file that are not linear tets, by kind.
class OtherVtkCells {
 public:
  /// `type` is VTK's number of the kind, `cell` the index of the cell.
  void add(std::int64_t type, std::size_t cell);
  /// Takes one that is no volume away again.
  void remove(std::int64_t type) {
    if (--counts_[type] == 0) counts_.erase(type);
  }
  /// There are cells of three dimensions, or of unknown types, which might be such.
  bool has_volumes() const { return has_volumes_; }
  /// Of the first of these.
  std::size_t first_volume() const { return first_volume_; }
  /// The message that refuses the file for them.
  std::string refusal() const;
  /// Appends the kinds that are skipped: lines, faces, vertices.
  void append_flat_to(std::vector<Dropped>& dropped) const;

 private:
  std::map<std::int64_t, std::size_t> counts_;  ///< by type
  bool has_volumes_ = false;
  std::size_t first_volume_ = 0;
  std::int64_t first_volume_type_ = 0;
};

}  // namespace tetwright
