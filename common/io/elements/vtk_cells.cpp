// SPDX-License-Identifier: Apache-2.0
#include "common/io/elements/vtk_cells.h"

#include "common/error.h"
#include "common/io/text/text_scanner.h"

namespace tetwright {

namespace {

struct CellKind {
  std::string name;  ///< plural
  bool volume;       ///< of three dimensions
};

/// Lines, faces and vertices of VTK's numbering (vtkCellType.h).
const std::map<std::int64_t, const char*> flat_cells{{0, "empty cells"},      {1, "vertex cells"},
                                                     {2, "vertex cells"},     {3, "lines"},
                                                     {4, "polylines"},        {5, "triangles"},
                                                     {6, "triangle strips"},  {7, "polygons"},
                                                     {8, "pixels"},           {9, "quads"},
                                                     {21, "quadratic lines"}, {22, "quadratic triangles"},
                                                     {23, "quadratic quads"}, {28, "quadratic quads"},
                                                     {30, "quadratic quads"}, {34, "quadratic triangles"},
                                                     {35, "cubic lines"},     {36, "quadratic polygons"}};

const std::map<std::int64_t, const char*> volume_cells{{11, "voxels"},
                                                       {12, "hexahedra"},
                                                       {13, "wedges"},
                                                       {14, "pyramids"},
                                                       {15, "pentagonal prisms"},
                                                       {16, "hexagonal prisms"},
                                                       {24, "quadratic tets"},
                                                       {25, "quadratic hexahedra"},
                                                       {26, "quadratic wedges"},
                                                       {27, "quadratic pyramids"},
                                                       {29, "quadratic hexahedra"},
                                                       {31, "quadratic wedges"},
                                                       {32, "quadratic wedges"},
                                                       {33, "quadratic hexahedra"},
                                                       {37, "quadratic pyramids"},
                                                       {42, "polyhedra"},
                                                       {64, "tets of higher order"},
                                                       {65, "wedges of higher order"},
                                                       {66, "pyramids of higher order"},
                                                       {67, "hexahedra of higher order"},
                                                       {71, "tets of higher order"},
                                                       {72, "hexahedra of higher order"},
                                                       {73, "wedges of higher order"},
                                                       {74, "pyramids of higher order"},
                                                       {78, "tets of higher order"},
                                                       {79, "hexahedra of higher order"},
                                                       {80, "wedges of higher order"},
                                                       {81, "pyramids of higher order"}};

bool is_flat_of_higher_order(std::int64_t type) {
  return (type >= 51 && type <= 54) || (type >= 60 && type <= 63) || (type >= 68 && type <= 70) ||
         (type >= 75 && type <= 77);
}

/// Unknown kinds count as volumes, so that they are rejected.
CellKind cell_kind(std::int64_t type) {
  if (const auto flat = flat_cells.find(type); flat != flat_cells.end()) return {flat->second, false};
  if (const auto volume = volume_cells.find(type); volume != volume_cells.end())
    return {volume->second, true};
  if (is_flat_of_higher_order(type)) return {"lines or faces of higher order", false};
  return {"cells of the unknown type " + std::to_string(type), true};
}

}  // namespace

std::string vtk_text(const std::vector<double>& bytes) {
  std::string text;
  for (const double byte : bytes)
    text += byte >= 0 && byte < 256 ? static_cast<char>(static_cast<unsigned char>(byte)) : '?';
  return text;
}

std::vector<std::pair<std::int64_t, std::string>> parse_vtk_names(const std::string& text,
                                                                  const std::string& array,
                                                                  const std::string& file) {
  std::vector<std::pair<std::int64_t, std::string>> names;
  TextScanner lines(text, file);
  while (lines.left() > 0) {
    const std::string_view line = lines.rest_of_line();
    const std::size_t tab = line.find('\t');
    std::int64_t number = 0;
    if (tab == std::string_view::npos || !parse_number(line.substr(0, tab), number))
      throw InputError(file + ": in " + in_quotes(array) +
                       " a number, a tab and a name were expected, found " + in_quotes(line));
    names.emplace_back(number, line.substr(tab + 1));
  }
  return names;
}

void OtherVtkCells::add(std::int64_t type, std::size_t cell) {
  if (++counts_[type] > 1 || has_volumes_ || !cell_kind(type).volume) return;
  has_volumes_ = true;
  first_volume_ = cell;
  first_volume_type_ = type;
}

std::string OtherVtkCells::refusal() const {
  KindCounts volumes;
  for (const auto& [type, count] : counts_)
    if (const CellKind kind = cell_kind(type); kind.volume) volumes.add(kind.name, count);
  return unsupported_cells(volumes, "cell " + std::to_string(first_volume_) + " (counted from 0, type " +
                                        std::to_string(first_volume_type_) + ")");
}

void OtherVtkCells::append_flat_to(std::vector<Dropped>& dropped) const {
  KindCounts flat;
  for (const auto& [type, count] : counts_)
    if (const CellKind kind = cell_kind(type); !kind.volume) flat.add(kind.name, count);
  flat.append_to(dropped);
}

}  // namespace tetwright
