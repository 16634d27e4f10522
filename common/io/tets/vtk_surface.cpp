// SPDX-License-Identifier: Apache-2.0

// Surfaces of legacy VTK files.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/io/elements/vtk_cells.h"
#include "common/io/encodings/vtk_numbers.h"
#include "common/io/names/label_groups.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/surfaces/declared_space.h"
#include "common/io/surfaces/surface_builder.h"
#include "common/io/tets/vtk.h"
#include "common/io/tets/vtk_sections.h"
#include "common/lower_case.h"
#include "tetwright/error.h"
#include "tetwright/io.h"

namespace tetwright {

namespace {

// VTK's numbers of the flat cells that become triangles.
constexpr std::int64_t strip_type = 6, polygon_type = 7, pixel_type = 8;

/// Reads POLYDATA, or the faces of an UNSTRUCTURED_GRID without volume cells.
class VtkSurfaceReader final : private VtkSections {
 public:
  VtkSurfaceReader(std::string_view bytes, const std::string& name)
      : VtkSections(bytes, name), begin_(in_), types_begin_(in_), surface_(name) {}

  /// \return std::nullopt for a file with tets
  std::optional<SurfaceWithFields> read(std::vector<Dropped>* dropped) {
    std::vector<Dropped> arrays;
    read_sections(arrays);
    const std::size_t cells = cell_count();
    tets_ = static_cast<std::size_t>(std::count_if(types_.begin(), types_.end(), is_vtk_tet));
    if (tets_ > 0) return {};
    surface_.reserve(points_.size(), 0);
    for (const Vec3& p : points_) surface_.add_point(p, [] { return std::string("POINTS"); });
    std::size_t first = 0;
    for (const List& list : lists_) {
      add_cells(list, first, cells);
      first += list.cells.count();
    }
    if (other_.has_volumes()) in_.fail(other_.refusal());
    SurfaceWithFields result;
    std::vector<SurfaceRegion> groups = groups_.groups();
    if (label_name_ == vtk_surface_field)
      for (SurfaceRegion& group : groups)
        if (const auto name = names_.find(group.number); name != names_.end()) group.name = name->second;
    result.surface = surface_.finish(dropped, groups);
    result.surface.space = declared_space(title_);
    result.point_fields = std::move(point_fields_);
    if (!dropped) return result;
    other_.append_flat_to(*dropped);
    std::vector<std::string> of_points;
    for (const MeshField& field : result.point_fields) of_points.push_back(field.name);
    append_dropped_names(*dropped, "fields of points", of_points);
    append_dropped_names(*dropped, "fields of cells", cell_fields_);
    dropped->insert(dropped->end(), arrays.begin(), arrays.end());
    return result;
  }

  std::size_t tets() const { return tets_; }

 private:
  /// Cells after one keyword. `type` is VTK's number, or 0 if each cell has its own type.
  struct List {
    Cells cells;
    TextScanner begin;
    std::int64_t type;
    std::size_t order;  ///< position among the lists of POLYDATA
  };

  void check_dataset(std::string_view word) override {
    grid_ = lower_case(word) == "unstructured_grid";
    if (grid_ || lower_case(word) == "polydata") return;
    in_.fail("a dataset POLYDATA is needed, this one is " + in_quotes(word));
  }

  bool read_section(const std::string& part) override {
    constexpr std::int64_t vertices_type = 2, line_type = 4;
    static const std::vector<std::pair<const char*, std::int64_t>> of_polydata{
        {"vertices", vertices_type},
        {"lines", line_type},
        {"polygons", polygon_type},
        {"triangle_strips", strip_type}};
    if (grid_ && part == "cell_types") {
      if (!types_.empty()) in_.fail("a second section CELL_TYPES");
      types_ = read_whole_numbers("number of cell types", "types of cells", types_begin_);
      return true;
    }
    if (grid_ && part == "cells") {
      if (!lists_.empty()) in_.fail("a second section CELLS");
      Cells cells = read_cells("CELLS", begin_);
      lists_.push_back({std::move(cells), begin_, 0, 0});
      return true;
    }
    for (std::size_t k = 0; k < of_polydata.size(); ++k) {
      const auto& [keyword, type] = of_polydata[k];
      if (grid_ || part != keyword) continue;
      // Cell data list the cells in the order of this table, not of the file.
      const auto place =
          std::find_if(lists_.begin(), lists_.end(), [&](const List& l) { return l.order >= k; });
      if (place != lists_.end() && place->order == k) in_.fail("a second section " + std::string(keyword));
      Cells cells = read_cells(keyword, begin_);
      lists_.insert(place, {std::move(cells), begin_, type, k});
      return true;
    }
    return false;
  }

  std::size_t cell_count() override {
    std::size_t count = 0;
    for (const List& list : lists_) count += list.cells.count();
    if (grid_ && types_.size() != count)
      in_.fail("CELL_TYPES has " + std::to_string(types_.size()) + " types for " + std::to_string(count) +
               " cells; the file is damaged");
    return count;
  }

  void take_field(Data data, MeshField field) override {
    if (data == Data::points) {
      point_fields_.push_back(std::move(field));
    } else if (labels_.empty() && field.integer && field.components == 1 && is_face_label(field.name)) {
      label_name_ = field.name;
      labels_ = std::move(field.values);
    } else {
      cell_fields_.push_back(field.name);
    }
  }

  bool take_dataset_array(const std::string& name, const std::vector<double>& values) override {
    if (name != vtk_surface_names) return false;
    for (auto& [number, text] : parse_vtk_names(vtk_text(values), name, in_.name())) names_[number] = text;
    return true;
  }

  /// \param first number of cells before the list
  /// \param count total number of cells
  void add_cells(const List& list, std::size_t first, std::size_t count) {
    for (std::size_t c = 0; c < list.cells.count(); ++c) {
      corners_.clear();
      for (std::size_t k = 0; k < list.cells.size(c); ++k)
        corners_.push_back(checked_point(list.cells, c, list.cells.begin(c) + k, list.begin));
      if (labels_.size() == count)
        surface_.begin_group(groups_.index_of(static_cast<std::int64_t>(labels_[first + c])));
      add_cell(list.type == 0 ? types_[c] : list.type, first + c);
    }
  }

  /// Adds the cell whose corners are in `corners_`.
  void add_cell(std::int64_t type, std::size_t number) {
    const auto place = [&] { return "cell " + std::to_string(number) + " (counted from 0)"; };
    if (type == strip_type) {
      // Each point forms a triangle with the two points before it; every second triangle is reversed.
      for (std::size_t k = 2; k < corners_.size(); ++k) {
        const std::size_t turned = k % 2;
        surface_.add_polygon(std::array{corners_[k - 2 + turned], corners_[k - 1 - turned], corners_[k]},
                             place);
      }
    } else if (type == pixel_type) {
      expect_corners(4, place());
      surface_.add_polygon(std::array{corners_[0], corners_[1], corners_[3], corners_[2]}, place);
    } else if (type == element::quadratic_triangle.vtk) {
      expect_corners(6, place());
      surface_.add_polygon(std::span(corners_).first(3), place);
    } else if (type == element::triangle.vtk || type == element::quad.vtk) {
      expect_corners(type == element::quad.vtk ? 4 : 3, place());
      surface_.add_polygon(corners_, place);
    } else if (type == polygon_type) {
      surface_.add_polygon(corners_, place);
    } else {
      other_.add(type, number);
    }
  }

  void expect_corners(std::size_t n, const std::string& place) const {
    if (corners_.size() != n)
      in_.fail(place + " has " + std::to_string(corners_.size()) + " points, not the " + std::to_string(n) +
               " of its type; the file is damaged");
  }

  bool grid_ = false;
  TextScanner begin_, types_begin_;
  std::vector<List> lists_;
  std::vector<std::int64_t> types_, corners_;
  std::size_t tets_ = 0;
  SurfaceBuilder surface_;
  OtherVtkCells other_;
  LabelGroups groups_;
  std::vector<double> labels_;
  std::string label_name_;
  std::map<std::int64_t, std::string> names_;
  std::vector<MeshField> point_fields_;
  std::vector<std::string> cell_fields_;
};

}  // namespace

TriangleMesh read_vtk_surface(std::string_view bytes, const std::string& name,
                              std::vector<Dropped>* dropped) {
  VtkSurfaceReader reader(bytes, name);
  std::optional<SurfaceWithFields> read = reader.read(dropped);
  if (!read) throw InputError(name + surface_expected(reader.tets()));
  return std::move(read->surface);
}

std::optional<SurfaceWithFields> read_vtk_surface_with_fields(std::string_view bytes,
                                                              const std::string& name) {
  return VtkSurfaceReader(bytes, name).read(nullptr);
}

}  // namespace tetwright
