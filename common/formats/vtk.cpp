#include "common/formats/vtk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "common/error.h"
#include "common/formats/file_triangles.h"
#include "common/formats/mesh_fields.h"
#include "common/formats/midside_nodes_read.h"
#include "common/formats/text_scanner.h"
#include "common/formats/vtk_cells.h"
#include "common/formats/vtk_numbers.h"

namespace tetwright {

namespace {

constexpr std::int64_t max_vtk_components = 1 << 16;

/// Decodes a name, in which VTK writes spaces and some other characters as %20 and so on.
std::string decoded(std::string_view name) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == '%' && i + 2 < name.size() && digit(name[i + 1]) >= 0 && digit(name[i + 2]) >= 0) {
      out += static_cast<char>(digit(name[i + 1]) * 16 + digit(name[i + 2]));
      i += 2;
    } else {
      out += name[i];
    }
  }
  return field_name(out);
}

class VtkReader {
 public:
  VtkReader(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options)
      : in_(bytes, name), options_(options), cells_begin_(in_), types_begin_(in_) {}

  ReadTetMesh read() {
    read_head();
    for (std::string_view word; !(word = in_.word()).empty();) read_part(lower_case(word), word);
    if (!has_points_) in_.fail("there are no POINTS in it; the file is cut short");
    choose_tets();
    if (result_.mesh.tets.empty())
      in_.fail("there are no tets (type 10 or 24) among its " + std::to_string(types_.size()) +
               " cells; a tet mesh is needed");
    midside_.remove_from(result_, triangles_.triangles);
    take_material(result_, options_, in_.name());
    take_triangles(triangles_, "surface", in_.name(), result_);
    other_cells_.append_flat_to(result_.dropped);
    append_dropped_names(result_.dropped, "arrays of the whole dataset", dataset_arrays_);
    append_dropped_names(result_.dropped, "arrays of text", text_arrays_);
    append_dropped_names(result_.dropped, "arrays of colours", colours_);
    return std::move(result_);
  }

 private:
  enum class Data { none, points, cells };

  void read_head() {
    if (in_.left() == 0) in_.fail("the file is empty");
    const std::string_view first = in_.rest_of_line();
    constexpr std::string_view magic = "# vtk datafile version ";
    const std::string lower = lower_case(first.substr(0, magic.size()));
    const std::string_view version = first.substr(std::min(first.size(), magic.size()));
    if (lower != magic || version.empty())
      throw InputError(in_.name(), 1,
                       "expected \"# vtk DataFile Version\" at the beginning, found " + in_quotes(first) +
                           "; is this a legacy VTK file?");
    if (version[0] < '1' || version[0] > '5' || (version.size() > 1 && version[1] != '.'))
      throw InputError(in_.name(), 1, "version " + in_quotes(version) + " of the format; 1 to 5 are known");
    in_.skip_line();  // the title
    const std::string_view kind = in_.word();
    binary_ = lower_case(kind) == "binary";
    if (!binary_ && lower_case(kind) != "ascii")
      in_.fail("expected ASCII or BINARY, found " + in_quotes(kind));
    const std::string_view dataset = in_.word();
    if (lower_case(dataset) != "dataset") in_.fail("expected DATASET, found " + in_quotes(dataset));
    if (const std::string_view grid = in_.word(); lower_case(grid) != "unstructured_grid")
      in_.fail("a dataset UNSTRUCTURED_GRID is needed, this one is " + in_quotes(grid));
  }

  void read_part(const std::string& part, std::string_view word) {
    if (part == "points")
      read_points();
    else if (part == "cells")
      read_cells();
    else if (part == "cell_types")
      read_types();
    else if (part == "point_data")
      begin_data(Data::points);
    else if (part == "cell_data")
      begin_data(Data::cells);
    else if (part == "metadata")
      skip_metadata();
    else if (part == "field")
      read_field();
    else if (data_ == Data::none || !read_attribute(part))
      in_.fail("expected a section such as POINTS or CELL_DATA, found " + in_quotes(word));
  }

  std::string type_word() {
    const std::string_view word = in_.word();
    if (word.empty()) in_.fail_cut_short("type of numbers");
    return lower_case(word);
  }

  void read_points() {
    if (has_points_) in_.fail("a second section POINTS");
    has_points_ = true;
    const std::size_t n = in_.count("number of points", 3);
    if (n >= no_index) in_.fail("more than " + std::to_string(no_index - 1) + " points; split the mesh");
    const std::string type = type_word();
    std::vector<Vec3>& points = result_.mesh.points;
    if (!binary_) {
      if (n > (in_.left() + 1) / 6)
        in_.fail(std::to_string(n) + " points are promised, but only " + std::to_string(in_.left()) +
                 " bytes follow; the file is cut short or its header is wrong");
      points.resize(n);
      for (Vec3& p : points)
        for (int k = 0; k < 3; ++k) p[k] = in_.coordinate();
      return;
    }
    const std::vector<double> numbers = read_vtk_numbers<double>(in_, true, type, 3 * n, "coordinates");
    points.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      points[i] = Vec3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
      if (!points[i].allFinite())
        in_.fail("a coordinate of point " + std::to_string(i) + " (counted from 0) is not finite: " +
                 std::to_string(points[i].x()) + " " + std::to_string(points[i].y()) + " " +
                 std::to_string(points[i].z()) + "; remove or repair it");
    }
  }

  void read_cells() {
    if (has_cells_) in_.fail("a second section CELLS");
    has_cells_ = true;
    const std::size_t n = in_.count("number of cells", 1);
    const std::size_t size = in_.count("size of the cells", 1);
    TextScanner ahead = in_;
    if (lower_case(ahead.word()) == "offsets") {
      new_cells_ = true;
      in_ = ahead;
      const std::string offsets_type = type_word();
      offsets_ = read_vtk_numbers<std::int64_t>(in_, binary_, offsets_type, n, "offsets");
      expect_word("connectivity");
      const std::string type = type_word();
      cells_begin_ = in_;
      connectivity_ = read_vtk_numbers<std::int64_t>(in_, binary_, type, size, "connectivity");
      std::int64_t last = 0;
      for (std::int64_t offset : offsets_) {
        if (offset < last || offset > std::ssize(connectivity_))
          in_.fail("an offset of the cells is " + std::to_string(offset) + " after " + std::to_string(last) +
                   ", of " + std::to_string(connectivity_.size()) + "; the file is damaged");
        last = offset;
      }
      if (!offsets_.empty() && offsets_[0] != 0)
        in_.fail("the first offset is " + std::to_string(offsets_[0]) + ", not 0; the file is damaged");
      return;
    }
    // Each cell is its number of points followed by these points, so that the cells must be walked one by
    // one.
    cells_begin_ = in_;
    connectivity_ = read_vtk_numbers<std::int64_t>(in_, binary_, "int", size, "points of cells");
    offsets_.reserve(std::min(n, size) + 1);
    std::size_t at = 0;
    for (std::size_t c = 0; c < n; ++c) {
      if (at >= size || connectivity_[at] < 0 || static_cast<std::uint64_t>(connectivity_[at]) >= size - at)
        fail_at(cells_begin_, at,
                "cell " + std::to_string(c) + " (counted from 0) goes beyond the " + std::to_string(size) +
                    " numbers of CELLS; the file is damaged");
      offsets_.push_back(static_cast<std::int64_t>(at + 1));
      at += 1 + static_cast<std::size_t>(connectivity_[at]);
    }
    if (at != size)
      in_.fail("the cells take " + std::to_string(at) + " numbers, but CELLS promises " +
               std::to_string(size) + "; the file is damaged");
    offsets_.push_back(static_cast<std::int64_t>(at + 1));
  }

  void expect_word(const char* expected) {
    const std::string_view word = in_.word();
    if (word.empty()) in_.fail_cut_short(expected);
    if (lower_case(word) != expected)
      in_.fail("expected " + std::string(expected) + " of the cells, found " + in_quotes(word));
  }

  std::size_t cell_count() const { return offsets_.empty() ? 0 : offsets_.size() - 1; }

  /// The number of points of a cell. In old files the number of points of the next cell lies between two
  /// cells.
  std::size_t cell_size(std::size_t cell) const {
    return static_cast<std::size_t>(offsets_[cell + 1] - offsets_[cell]) - (new_cells_ ? 0 : 1);
  }

  void read_types() {
    if (has_types_) in_.fail("a second section CELL_TYPES");
    has_types_ = true;
    const std::size_t n = in_.count("number of cell types", 1);
    types_begin_ = in_;
    types_ = read_vtk_numbers<std::int64_t>(in_, binary_, "int", n, "types of cells");
  }

  /// Throws InputError with the line of the k-th number of a list that begins at `begin`.
  [[noreturn]] void fail_at(TextScanner begin, std::size_t k, const std::string& message) const {
    if (binary_) in_.fail(message);
    for (std::size_t i = 0; i <= k; ++i) (void)begin.word();
    begin.fail(message);
  }

  /// Called at the first data of cells or at the end of the file; does its work once.
  void choose_tets() {
    if (chosen_) return;
    chosen_ = true;
    if (!has_cells_ || !has_types_) in_.fail("there are no CELLS or no CELL_TYPES in it; it is cut short");
    if (types_.size() != cell_count())
      in_.fail("CELL_TYPES has " + std::to_string(types_.size()) + " types for " +
               std::to_string(cell_count()) + " cells; the file is damaged");
    for (std::size_t c = 0; c < types_.size(); ++c) {
      if (!is_vtk_tet(types_[c])) {
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
    if (triangle_to_cell_.empty()) connectivity_ = {};
  }

  /// Of a tet or triangle.
  std::vector<Index> nodes_of(std::size_t c) const {
    const std::size_t points = result_.mesh.points.size();
    const auto cell = [c] { return "cell " + std::to_string(c) + " (counted from 0)"; };
    const auto begin = static_cast<std::size_t>(offsets_[c]);
    if (cell_size(c) != vtk_nodes_of(types_[c]))
      fail_at(cells_begin_, begin,
              cell() + " is a " + (is_vtk_tet(types_[c]) ? "tet" : "triangle") + " of " +
                  std::to_string(cell_size(c)) + " points; the file is damaged");
    std::vector<Index> nodes;
    for (std::size_t k = begin; k < begin + cell_size(c); ++k) {
      if (connectivity_[k] < 0 || static_cast<std::uint64_t>(connectivity_[k]) >= points)
        fail_at(cells_begin_, k,
                cell() + " names point " + std::to_string(connectivity_[k]) + " of " +
                    std::to_string(points) + "; export the file again");
      nodes.push_back(static_cast<Index>(connectivity_[k]));
    }
    return nodes;
  }

  /// The triangles of our own files, by the field that numbers their surfaces; those of tets are 0.
  void take_surfaces(const std::vector<double>& numbers) {
    for (const std::size_t c : triangle_to_cell_) {
      const std::vector<Index> nodes = nodes_of(c);
      triangles_.add({nodes[0], nodes[1], nodes[2]}, static_cast<std::int64_t>(numbers[c]));
      if (nodes.size() > 3) midside_.add_triangle(std::span(nodes).subspan(3));
      other_cells_.remove(types_[c]);
    }
    triangle_to_cell_.clear();
    connectivity_ = {};
  }

  void begin_data(Data data) {
    const std::int64_t n = in_.integer(data == Data::points ? "number of points" : "number of cells");
    if (data == Data::points && !has_points_) in_.fail("POINT_DATA comes before the points");
    if (data == Data::cells) choose_tets();
    items_ = data == Data::points ? result_.mesh.points.size() : types_.size();
    if (n != static_cast<std::int64_t>(items_))
      in_.fail("data of " + std::to_string(n) + (data == Data::points ? " points" : " cells") +
               ", but there are " + std::to_string(items_) + "; the file is damaged");
    data_ = data;
  }

  void add_field(const std::string& name, std::size_t components, const std::string& type) {
    MeshField field{name, static_cast<int>(components), false, {}};
    field.values =
        read_vtk_numbers<double>(in_, binary_, type, components * items_, "values of " + in_quotes(name));
    if (data_ == Data::cells && name == vtk_surface_field && !triangle_to_cell_.empty() && components == 1 &&
        is_integer_type(type) && all_whole(field)) {
      take_surfaces(field.values);
      return;
    }
    if (data_ == Data::cells && tet_to_cell_.size() < items_) {
      for (std::size_t t = 0; t < tet_to_cell_.size(); ++t)
        for (std::size_t k = 0; k < components; ++k)
          field.values[t * components + k] = field.values[tet_to_cell_[t] * components + k];
      field.values.resize(tet_to_cell_.size() * components);
    }
    field.integer = is_integer_type(type) && all_whole(field);
    (data_ == Data::cells ? result_.mesh.cell_fields : result_.mesh.point_fields).push_back(std::move(field));
  }

  std::string name_word() {
    const std::string_view word = in_.word();
    if (word.empty()) in_.fail_cut_short("name");
    return decoded(word);
  }

  std::size_t checked_components(std::int64_t n) const {
    if (n < 1 || n > max_vtk_components)
      in_.fail(std::to_string(n) + " components; 1 to " + std::to_string(max_vtk_components) +
               " are possible");
    return static_cast<std::size_t>(n);
  }

  /// Reads an attribute that has a keyword of its own; false if `part` is not such a keyword.
  bool read_attribute(const std::string& part) {
    if (part == "lookup_table") {
      colours_.push_back(name_word());
      const std::size_t n = in_.count("size of the lookup table", 1);
      skip_colours(n, 4);
      return true;
    }
    if (part == "color_scalars") {
      colours_.push_back(name_word());
      skip_colours(items_, checked_components(in_.integer("number of components")));
      return true;
    }
    static const std::map<std::string, std::size_t> components_of{
        {"scalars", 1},      {"vectors", 3},    {"normals", 3},
        {"tensors", 9},      {"tensors6", 6},   {"global_ids", 1},
        {"pedigree_ids", 1}, {"edge_flags", 1}, {"texture_coordinates", 0}};
    const auto known = components_of.find(part);
    if (known == components_of.end()) return false;
    const std::string name = name_word();
    std::size_t components = known->second;
    if (components == 0) components = checked_components(in_.integer("number of components"));
    const std::string type = type_word();
    if (part == "scalars") read_scalars_head(components);
    add_field(name, components, type);
    return true;
  }

  /// Reads the optional number of components on the line and the optional line LOOKUP_TABLE.
  void read_scalars_head(std::size_t& components) {
    if (const std::string_view word = in_.word_on_line(); !word.empty()) {
      std::int64_t n = 0;
      if (!parse_number(word, n)) in_.fail("expected a number of components, found " + in_quotes(word));
      components = checked_components(n);
    }
    const TextScanner before = in_;
    if (lower_case(in_.word()) == "lookup_table")
      (void)name_word();
    else
      in_ = before;
  }

  void skip_colours(std::size_t n, std::size_t components) {
    (void)read_vtk_numbers<double>(in_, binary_, "unsigned_char", n * components, "colours");
  }

  /// Reads the arrays of FIELD: of points or cells, or, before both, of the whole dataset, which are dropped.
  void read_field() {
    (void)name_word();
    const std::size_t arrays = in_.count("number of arrays", 1);
    for (std::size_t a = 0; a < arrays; ++a) {
      const std::string_view word = in_.word();
      if (word.empty()) in_.fail_cut_short("name of an array");
      if (lower_case(word) == "metadata") {
        skip_metadata();
        --a;
        continue;
      }
      const std::string name = decoded(word);
      if (name == "NULL_ARRAY") continue;
      const std::size_t components = in_.count("number of components", 1);
      const std::size_t tuples = in_.count("number of tuples", 1);
      const std::string type = type_word();
      if (type == "string") {
        if (tuples > 0 && components > in_.left() / tuples) in_.fail_cut_short("text");
        skip_vtk_strings(in_, binary_, components * tuples);
        text_arrays_.push_back(name);
        continue;
      }
      if (data_ == Data::none) {
        if (tuples > 0 && components > SIZE_MAX / tuples) in_.fail_cut_short("value");
        const std::vector<double> values =
            read_vtk_numbers<double>(in_, binary_, type, components * tuples, "values of " + in_quotes(name));
        if (name == vtk_material_names || name == vtk_surface_names)
          read_names(values, name);
        else
          dataset_arrays_.push_back(name);
        continue;
      }
      if (tuples != items_)
        in_.fail("array " + in_quotes(name) + " has " + std::to_string(tuples) + " values, but there are " +
                 std::to_string(items_) + (data_ == Data::points ? " points" : " cells"));
      add_field(name, checked_components(static_cast<std::int64_t>(components)), type);
    }
  }

  /// Those that write_vtk() writes.
  void read_names(const std::vector<double>& bytes, const std::string& array) {
    std::string text;
    for (const double byte : bytes)
      text += byte >= 0 && byte < 256 ? static_cast<char>(static_cast<unsigned char>(byte)) : '?';
    for (auto& [number, name] : parse_vtk_names(text, array, in_.name())) {
      if (array == vtk_surface_names)
        triangles_.names[number] = name;
      else
        result_.mesh.material_names[checked_material(number, in_.name(), in_.line())] = name;
    }
  }

  /// Skips everything up to the next empty line.
  void skip_metadata() {
    in_.skip_line();
    while (in_.left() > 0)
      if (in_.rest_of_line().find_first_not_of(" \t\r") == std::string_view::npos) return;
  }

  TextScanner in_;
  const ReadTetMeshOptions& options_;
  ReadTetMesh result_;
  bool binary_ = false;
  bool new_cells_ = false;  ///< since version 5: offsets and connectivity
  bool has_points_ = false, has_cells_ = false, has_types_ = false, chosen_ = false;
  std::vector<std::int64_t> offsets_, connectivity_, types_;
  TextScanner cells_begin_, types_begin_;
  std::vector<std::size_t> tet_to_cell_, triangle_to_cell_;
  FileTriangles triangles_;
  OtherVtkCells other_cells_;
  MidsideNodesRead midside_;
  std::vector<std::string> dataset_arrays_, text_arrays_, colours_;  ///< names of what is not taken
  Data data_ = Data::none;
  std::size_t items_ = 0;  ///< points or cells that data is for
};

}  // namespace

ReadTetMesh read_vtk(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  return VtkReader(bytes, name, options).read();
}

}  // namespace tetwright
