// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/vtk_sections.h"

#include <algorithm>
#include <map>

#include "common/io/encodings/vtk_numbers.h"
#include "common/io/names/mesh_fields.h"
#include "common/lower_case.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::int64_t max_vtk_components = 1 << 16;

/// Decodes a name, in which VTK encodes spaces and some other characters as %20 and so on.
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

}  // namespace

void VtkSections::read_sections(std::vector<Dropped>& dropped) {
  read_head();
  for (std::string_view word; !(word = in_.word()).empty();) read_part(lower_case(word), word);
  if (!has_points_) in_.fail("there are no POINTS in it; the file is truncated");
  append_dropped_names(dropped, "arrays of the whole dataset", dataset_arrays_);
  append_dropped_names(dropped, "arrays of text", text_arrays_);
  append_dropped_names(dropped, "arrays of colours", colours_);
  rounded_.append_to(dropped);
}

void VtkSections::read_head() {
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
    throw InputError(in_.name(), 1, "version " + in_quotes(version) + " of the format; 1 to 5 are supported");
  title_ = in_.rest_of_line();
  const std::string_view kind = in_.word();
  binary_ = lower_case(kind) == "binary";
  if (!binary_ && lower_case(kind) != "ascii") in_.fail("expected ASCII or BINARY, found " + in_quotes(kind));
  const std::string_view dataset = in_.word();
  if (lower_case(dataset) != "dataset") in_.fail("expected DATASET, found " + in_quotes(dataset));
  check_dataset(in_.word());
}

void VtkSections::read_part(const std::string& part, std::string_view word) {
  if (part == "points")
    read_points();
  else if (part == "point_data")
    begin_data(Data::points);
  else if (part == "cell_data")
    begin_data(Data::cells);
  else if (part == "metadata")
    skip_metadata();
  else if (part == "field")
    read_field();
  else if (!read_section(part) && (data_ == Data::none || !read_attribute(part)))
    in_.fail("expected a section such as POINTS or CELL_DATA, found " + in_quotes(word));
}

std::string VtkSections::type_word() {
  const std::string_view word = in_.word();
  if (word.empty()) in_.fail_cut_short("type of numbers");
  return lower_case(word);
}

void VtkSections::read_points() {
  if (has_points_) in_.fail("a second section POINTS");
  has_points_ = true;
  const std::size_t n = in_.count("number of points", 3);
  if (n >= no_index) in_.fail("more than " + std::to_string(no_index - 1) + " points; split the mesh");
  const std::string type = type_word();
  std::vector<Vec3>& points = points_;
  if (!binary_) {
    if (n > (in_.left() + 1) / 6)
      in_.fail("the header gives " + std::to_string(n) + " points, but only " + std::to_string(in_.left()) +
               " bytes follow; the file is truncated or its header is wrong");
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
      in_.fail("a coordinate of point " + std::to_string(i) +
               " (counted from 0) is not finite: " + std::to_string(points[i].x()) + " " +
               std::to_string(points[i].y()) + " " + std::to_string(points[i].z()) + "; remove or repair it");
  }
}

VtkSections::Cells VtkSections::read_cells(const std::string& keyword, TextScanner& begin) {
  Cells cells;
  const std::size_t n = in_.count("number of cells", 1);
  const std::size_t size = in_.count("size of the cells", 1);
  TextScanner ahead = in_;
  if (lower_case(ahead.word()) == "offsets") {
    in_ = ahead;
    const std::string offsets_type = type_word();
    cells.offsets_ = read_vtk_numbers<std::int64_t>(in_, binary_, offsets_type, n, "offsets");
    expect_word("connectivity");
    const std::string type = type_word();
    begin = in_;
    cells.points_ = read_vtk_numbers<std::int64_t>(in_, binary_, type, size, "connectivity");
    std::int64_t last = 0;
    for (std::int64_t offset : cells.offsets_) {
      if (offset < last || offset > std::ssize(cells.points_))
        in_.fail("cell offset " + std::to_string(offset) + " follows " + std::to_string(last) + ", with " +
                 std::to_string(cells.points_.size()) + " indices in all; the file is damaged");
      last = offset;
    }
    if (!cells.offsets_.empty() && cells.offsets_[0] != 0)
      in_.fail("the first offset is " + std::to_string(cells.offsets_[0]) + ", not 0; the file is damaged");
    return cells;
  }
  // Each cell is its number of points followed by the points, so cells must be traversed in order.
  begin = in_;
  cells.before_each_ = 1;
  cells.points_ = read_vtk_numbers<std::int64_t>(in_, binary_, "int", size, "points of cells");
  cells.offsets_.reserve(std::min(n, size) + 1);
  std::size_t at = 0;
  for (std::size_t c = 0; c < n; ++c) {
    if (at >= size || cells.points_[at] < 0 || static_cast<std::uint64_t>(cells.points_[at]) >= size - at)
      fail_at(begin, at,
              "cell " + std::to_string(c) + " (counted from 0) extends beyond the " + std::to_string(size) +
                  " numbers of " + keyword + "; the file is damaged");
    cells.offsets_.push_back(static_cast<std::int64_t>(at + 1));
    at += 1 + static_cast<std::size_t>(cells.points_[at]);
  }
  if (at != size)
    in_.fail("the cells use " + std::to_string(at) + " numbers, but " + keyword + " gives " +
             std::to_string(size) + "; the file is damaged");
  cells.offsets_.push_back(static_cast<std::int64_t>(at + 1));
  return cells;
}

void VtkSections::expect_word(const char* expected) {
  const std::string_view word = in_.word();
  if (word.empty()) in_.fail_cut_short(expected);
  if (lower_case(word) != expected)
    in_.fail("expected " + std::string(expected) + " of the cells, found " + in_quotes(word));
}

std::vector<std::int64_t> VtkSections::read_whole_numbers(const char* count_of, const char* what,
                                                          TextScanner& begin) {
  const std::size_t n = in_.count(count_of, 1);
  begin = in_;
  return read_vtk_numbers<std::int64_t>(in_, binary_, "int", n, what);
}

Index VtkSections::checked_point(const Cells& cells, std::size_t cell, std::size_t place,
                                 const TextScanner& begin) const {
  const std::int64_t point = cells.point(place);
  if (point < 0 || static_cast<std::uint64_t>(point) >= points_.size())
    fail_at(begin, place,
            "cell " + std::to_string(cell) + " (counted from 0) refers to point " + std::to_string(point) +
                " of " + std::to_string(points_.size()) + "; export the file again");
  return static_cast<Index>(point);
}

void VtkSections::fail_at(TextScanner begin, std::size_t k, const std::string& message) const {
  if (binary_) in_.fail(message);
  for (std::size_t i = 0; i <= k; ++i) (void)begin.word();
  begin.fail(message);
}

void VtkSections::begin_data(Data data) {
  const std::int64_t n = in_.integer(data == Data::points ? "number of points" : "number of cells");
  if (data == Data::points && !has_points_) in_.fail("POINT_DATA comes before the points");
  items_ = data == Data::points ? points_.size() : cell_count();
  if (n != static_cast<std::int64_t>(items_))
    in_.fail("data of " + std::to_string(n) + (data == Data::points ? " points" : " cells") +
             ", but there are " + std::to_string(items_) + "; the file is damaged");
  data_ = data;
}

void VtkSections::add_field(const std::string& name, std::size_t components, const std::string& type) {
  MeshField field{name, static_cast<int>(components), false, {}};
  field.values =
      read_vtk_numbers<double>(in_, binary_, type, components * items_, "values of " + in_quotes(name));
  if (is_integer_type(type)) take_integers(field, rounded_);
  take_field(data_, std::move(field));
}

std::string VtkSections::name_word() {
  const std::string_view word = in_.word();
  if (word.empty()) in_.fail_cut_short("name");
  return decoded(word);
}

std::size_t VtkSections::checked_components(std::int64_t n) const {
  if (n < 1 || n > max_vtk_components)
    in_.fail(std::to_string(n) + " components; 1 to " + std::to_string(max_vtk_components) + " are possible");
  return static_cast<std::size_t>(n);
}

bool VtkSections::read_attribute(const std::string& part) {
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

/// Reads the optional number of components on this line, and the optional line LOOKUP_TABLE.
void VtkSections::read_scalars_head(std::size_t& components) {
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

void VtkSections::skip_colours(std::size_t n, std::size_t components) {
  (void)read_vtk_numbers<double>(in_, binary_, "unsigned_char", n * components, "colours");
}

/// Reads the arrays of FIELD: of points, of cells or, before both, of the whole dataset; the latter are
/// dropped.
void VtkSections::read_field() {
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
      if (!take_dataset_array(name, values)) dataset_arrays_.push_back(name);
      continue;
    }
    if (tuples != items_)
      in_.fail("array " + in_quotes(name) + " has " + std::to_string(tuples) + " values, but there are " +
               std::to_string(items_) + (data_ == Data::points ? " points" : " cells"));
    add_field(name, checked_components(static_cast<std::int64_t>(components)), type);
  }
}

/// Skips everything up to the next empty line.
void VtkSections::skip_metadata() {
  in_.skip_line();
  while (in_.left() > 0)
    if (in_.rest_of_line().find_first_not_of(" \t\r") == std::string_view::npos) return;
}

}  // namespace tetwright
