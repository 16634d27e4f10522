// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/vtk.h"

#include <span>
#include <vector>

#include "common/io/elements/midside_nodes_read.h"
#include "common/io/elements/vtk_cells.h"
#include "common/io/encodings/vtk_numbers.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/surfaces/declared_space.h"
#include "common/io/tets/vtk_sections.h"
#include "common/io/text/text_scanner.h"
#include "common/lower_case.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/parted_interfaces.h"

namespace tetwright {

namespace {

class VtkReader final : private VtkSections {
 public:
  VtkReader(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options)
      : VtkSections(bytes, name), options_(options), cells_begin_(in_), types_begin_(in_) {}

  ReadTetMesh read() {
    std::vector<Dropped> dropped;
    read_sections(dropped);
    choose_tets();
    if (result_.mesh.tets.empty())
      in_.fail("there are no tets (type 10 or 24) among its " + std::to_string(types_.size()) +
               " cells; a tet mesh is needed");
    result_.mesh.points = std::move(points_);
    result_.mesh.space = declared_space(title_);
    midside_.remove_from(result_, triangles_.triangles);
    take_material(result_, options_, in_.name());
    take_triangles(triangles_, "surface", in_.name(), result_);
    other_cells_.append_flat_to(result_.dropped);
    result_.dropped.insert(result_.dropped.end(), dropped.begin(), dropped.end());
    return std::move(result_);
  }

 private:
  void check_dataset(std::string_view word) override {
    if (lower_case(word) == "unstructured_grid") return;
    in_.fail("a dataset UNSTRUCTURED_GRID is needed, this one is " + in_quotes(word) +
             (lower_case(word) == "polydata"
                  ? "; it is a surface, which 'tetwright prepare' and 'tetwright mesh' read"
                  : ""));
  }

  bool read_section(const std::string& part) override {
    if (part == "cells") {
      if (has_cells_) in_.fail("a second section CELLS");
      has_cells_ = true;
      cells_ = read_cells("CELLS", cells_begin_);
    } else if (part == "cell_types") {
      if (has_types_) in_.fail("a second section CELL_TYPES");
      has_types_ = true;
      types_ = read_whole_numbers("number of cell types", "types of cells", types_begin_);
    } else {
      return false;
    }
    return true;
  }

  std::size_t cell_count() override {
    choose_tets();
    return types_.size();
  }

  /// Selects the tets at the first cell data or at the end of the file. Further calls have no effect.
  void choose_tets() {
    if (chosen_) return;
    chosen_ = true;
    if (!has_cells_ || !has_types_) in_.fail("there are no CELLS or no CELL_TYPES in it; it is truncated");
    if (types_.size() != cells_.count())
      in_.fail("CELL_TYPES has " + std::to_string(types_.size()) + " types for " +
               std::to_string(cells_.count()) + " cells; the file is damaged");
    for (std::size_t c = 0; c < types_.size(); ++c) {
      if (!is_vtk_tet(types_[c])) {
        if (types_[c] == element::wedge.vtk && take_wedge(c)) continue;
        if (is_vtk_triangle(types_[c])) triangle_to_cell_.push_back(c);
        other_cells_.add(types_[c], c);
        continue;
      }
      const std::vector<Index> nodes = nodes_of(c);
      result_.mesh.tets.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
      tet_to_cell_.push_back(c);
      if (nodes.size() > 4) midside_.add_tet(std::span(nodes).subspan(4));
    }
    if (other_cells_.has_volumes())
      fail_at(types_begin_, other_cells_.first_volume(), other_cells_.refusal());
    if (triangle_to_cell_.empty()) cells_.free_points();
  }

  /// Takes a wedge if it is a cohesive element.
  bool take_wedge(std::size_t c) {
    const std::vector<Index> nodes = nodes_of(c);
    Wedge wedge;
    for (std::size_t k = 0; k < wedge.size(); ++k) wedge[k] = nodes[vtk_wedge_order[k]];
    if (!is_cohesive(wedge, points_)) return false;
    result_.mesh.wedges.push_back(wedge);
    return true;
  }

  /// Nodes of a tet, triangle or wedge.
  std::vector<Index> nodes_of(std::size_t c) const {
    const std::size_t begin = cells_.begin(c), size = cells_.size(c);
    if (size != vtk_element_type(types_[c])->nodes)
      fail_at(cells_begin_, begin,
              "cell " + std::to_string(c) + " (counted from 0) is a " +
                  (is_vtk_tet(types_[c])        ? "tet"
                   : is_vtk_triangle(types_[c]) ? "triangle"
                                                : "wedge") +
                  " of " + std::to_string(size) + " points; the file is damaged");
    std::vector<Index> nodes;
    for (std::size_t k = begin; k < begin + size; ++k)
      nodes.push_back(checked_point(cells_, c, k, cells_begin_));
    return nodes;
  }

  /// Reads the triangles of files that this program wrote, by the field that gives the numbers of their
  /// surfaces; it is 0 for tets.
  void take_surfaces(const std::vector<double>& numbers) {
    for (const std::size_t c : triangle_to_cell_) {
      const std::vector<Index> nodes = nodes_of(c);
      triangles_.add({nodes[0], nodes[1], nodes[2]}, static_cast<std::int64_t>(numbers[c]));
      if (nodes.size() > 3) midside_.add_triangle(std::span(nodes).subspan(3));
      other_cells_.remove(types_[c]);
    }
    triangle_to_cell_.clear();
    cells_.free_points();
  }

  void take_field(Data data, MeshField field) override {
    if (data == Data::points) {
      result_.mesh.point_fields.push_back(std::move(field));
      return;
    }
    if (field.name == vtk_surface_field && !triangle_to_cell_.empty() && field.components == 1 &&
        field.integer) {
      take_surfaces(field.values);
      return;
    }
    if (tet_to_cell_.size() < types_.size()) {
      const auto components = static_cast<std::size_t>(field.components);
      for (std::size_t t = 0; t < tet_to_cell_.size(); ++t)
        for (std::size_t k = 0; k < components; ++k)
          field.values[t * components + k] = field.values[tet_to_cell_[t] * components + k];
      field.values.resize(tet_to_cell_.size() * components);
    }
    result_.mesh.cell_fields.push_back(std::move(field));
  }

  bool take_dataset_array(const std::string& name, const std::vector<double>& values) override {
    if (name != vtk_material_names && name != vtk_surface_names) return false;
    read_names(values, name);
    return true;
  }

  /// Reads the names written by write_vtk().
  void read_names(const std::vector<double>& bytes, const std::string& array) {
    for (auto& [number, name] : parse_vtk_names(vtk_text(bytes), array, in_.name())) {
      if (array == vtk_surface_names)
        triangles_.names[number] = name;
      else
        result_.mesh.material_names[checked_material(number, in_.name(), in_.line())] = name;
    }
  }

  const ReadTetMeshOptions& options_;
  ReadTetMesh result_;
  bool has_cells_ = false, has_types_ = false, chosen_ = false;
  Cells cells_;
  std::vector<std::int64_t> types_;
  TextScanner cells_begin_, types_begin_;
  std::vector<std::size_t> tet_to_cell_, triangle_to_cell_;
  FileTriangles triangles_;
  OtherVtkCells other_cells_;
  MidsideNodesRead midside_;
};

}  // namespace

ReadTetMesh read_vtk(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  return VtkReader(bytes, name, options).read();
}

}  // namespace tetwright
