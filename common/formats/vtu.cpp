#include "common/formats/vtu.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "common/error.h"
#include "common/formats/byte_order.h"
#include "common/formats/mesh_fields.h"
#include "common/formats/text_scanner.h"
#include "common/formats/vtk_cells.h"
#include "common/formats/vtu_data.h"
#include "common/number_text.h"
#include "common/utf8.h"

namespace tetwright {

namespace {

constexpr const char* names_field = "material_names";

class VtuReader {
 public:
  VtuReader(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options)
      : data_(bytes, name), name_(name), options_(options), file_size_(bytes.size()) {}

  ReadTetMesh read() {
    const pugi::xml_node piece = data_.piece("UnstructuredGrid"), grid = piece.parent();
    points_ = data_.count(piece, "NumberOfPoints");
    cells_ = data_.count(piece, "NumberOfCells");
    result_.mesh.points = data_.points(piece, points_);
    read_cells(piece);
    result_.mesh.point_fields = data_.fields(piece.child("PointData"), points_);
    result_.mesh.cell_fields =
        data_.fields(piece.child("CellData"), cells_, tet_to_cell_.empty() ? nullptr : &tet_to_cell_);
    read_names(grid);
    take_material(result_, options_, name_);
    note_dropped_arrays(grid, piece);
    return std::move(result_);
  }

 private:
  void read_cells(pugi::xml_node piece) {
    const pugi::xml_node cells = piece.child("Cells");
    if (!cells) data_.fail(piece, "there are no Cells in it");
    const pugi::xml_node types_node = data_.array(cells, "types"),
                         offsets_node = data_.array(cells, "offsets"),
                         connectivity_node = data_.array(cells, "connectivity");
    const std::vector<std::uint32_t> types = data_.counts(types_node, cells_);
    data_.expect_size(types_node, types.size(), cells_);
    const std::vector<std::uint32_t> offsets = data_.counts(offsets_node, cells_);
    data_.expect_size(offsets_node, offsets.size(), cells_);
    const std::vector<std::uint32_t> connectivity =
        data_.counts(connectivity_node, offsets.empty() ? 0 : offsets.back());
    const auto tets = static_cast<std::size_t>(std::count(types.begin(), types.end(), vtk_tet_type));
    result_.mesh.tets.reserve(tets);
    if (tets < cells_) tet_to_cell_.reserve(tets);
    std::size_t begin = 0;
    OtherVtkCells other_cells;
    for (std::size_t c = 0; c < cells_; ++c) {
      const std::size_t end = offsets[c];
      if (end < begin || end > connectivity.size())
        data_.fail(offsets_node, "cell " + std::to_string(c) + " ends at " + std::to_string(end) + " of " +
                                     std::to_string(connectivity.size()) + "; the file is damaged");
      if (types[c] == vtk_tet_type) {
        if (end - begin != 4)
          data_.fail(offsets_node, "cell " + std::to_string(c) + " is a tet of " +
                                       std::to_string(end - begin) + " points; the file is damaged");
        Tet tet;
        for (std::size_t k = 0; k < 4; ++k) {
          tet[k] = connectivity[begin + k];
          if (tet[k] >= points_)
            data_.fail(connectivity_node, "cell " + std::to_string(c) + " names point " +
                                              std::to_string(tet[k]) + " of " + std::to_string(points_) +
                                              "; export the file again");
        }
        result_.mesh.tets.push_back(tet);
        if (tets < cells_) tet_to_cell_.push_back(c);
      } else {
        other_cells.add(types[c], c);
      }
      begin = end;
    }
    if (other_cells.has_volumes()) data_.fail(types_node, other_cells.refusal());
    other_cells.append_flat_to(result_.dropped);
    if (tets == 0)
      data_.fail(cells, "there are no linear tets (type 10) among its " + std::to_string(cells_) +
                            " cells; a tet mesh is needed");
  }

  void read_names(pugi::xml_node grid) {
    const pugi::xml_node node =
        grid.child("FieldData").find_child_by_attribute("DataArray", "Name", names_field);
    if (!node) return;
    std::string text;
    // Compressed data may be longer than the file, but names hardly are.
    for (std::int64_t c : data_.integers(node, file_size_)) text += static_cast<char>(c);
    TextScanner lines(text, name_);
    while (lines.left() > 0) {
      const std::string_view line = lines.rest_of_line();
      const std::size_t tab = line.find('\t');
      std::int64_t tag = 0;
      if (tab == std::string_view::npos || !parse_number(line.substr(0, tab), tag))
        data_.fail(node, "expected a tag, a tab and a name, found " + in_quotes(line));
      result_.mesh.material_names[checked_material(tag, name_, 0)] = std::string(line.substr(tab + 1));
    }
  }

  /// Arrays of the whole dataset, and arrays of text.
  void note_dropped_arrays(pugi::xml_node grid, pugi::xml_node piece) {
    const auto is_array = [](pugi::xml_node node) {
      return std::string_view(node.name()) == "DataArray" || std::string_view(node.name()) == "Array";
    };
    const auto name_of = [](pugi::xml_node node) { return field_name(node.attribute("Name").as_string()); };
    std::vector<std::string> of_dataset, text;
    // Some programs put FieldData beside the grid or into the piece.
    for (const pugi::xml_node parent : {data_.root(), grid, piece})
      for (const pugi::xml_node node : parent.child("FieldData").children())
        if (is_array(node) && !(parent == grid && name_of(node) == names_field))
          of_dataset.push_back(name_of(node));
    for (const char* part : {"PointData", "CellData"})
      for (const pugi::xml_node node : piece.child(part).children())
        if (is_array(node) && !holds_numbers(node)) text.push_back(name_of(node));
    append_dropped_names(result_.dropped, "arrays of the whole dataset", of_dataset);
    append_dropped_names(result_.dropped, "arrays of text", text);
  }

  VtuData data_;
  std::string name_;
  const ReadTetMeshOptions& options_;
  std::size_t file_size_;
  std::size_t points_ = 0, cells_ = 0;
  std::vector<std::size_t> tet_to_cell_;  ///< where some cells are no tets
  ReadTetMesh result_;
};

/// Writes a data array of `size` numbers, the i-th of which is `number(i)`.
template <class NumberAt>
void write_array(const ByteSink& sink, const char* type, const std::string& name, const std::string& more,
                 std::size_t size, NumberAt&& number) {
  using Number = decltype(number(std::size_t{}));
  sink(std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" " + more +
       "format=\"binary\">\n");
  write_vtu_array(
      size * sizeof(Number),
      [&](std::size_t begin, std::span<char> bytes) {
        for (std::size_t at = 0; at < bytes.size(); at += sizeof(Number)) {
          auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(number((begin + at) / sizeof(Number)));
          if (!little_endian_machine) std::reverse(raw.begin(), raw.end());
          std::copy(raw.begin(), raw.end(), bytes.data() + at);
        }
      },
      sink);
  sink("\n</DataArray>\n");
}

/// A name without control characters in the form that an XML attribute needs.
std::string escaped(const std::string& name) {
  std::string out;
  for (char c : name) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

void write_field(const ByteSink& sink, const MeshField& field, const std::string& name) {
  const auto write = [&]<class Number>(Number, const char* type) {
    write_array(sink, type, escaped(name), "NumberOfComponents=\"" + std::to_string(field.components) + "\" ",
                field.values.size(), [&](std::size_t i) { return static_cast<Number>(field.values[i]); });
  };
  const auto narrow = [](double value) { return value >= INT32_MIN && value <= INT32_MAX; };
  if (!field.integer || !all_whole(field))
    write(double{}, "Float64");
  else if (std::all_of(field.values.begin(), field.values.end(), narrow))
    write(std::int32_t{}, "Int32");
  else
    write(std::int64_t{}, "Int64");
}

}  // namespace

ReadTetMesh read_vtu(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  return VtuReader(bytes, name, options).read();
}

std::string write_vtu(const TetMesh& mesh) {
  std::string out;
  write_vtu(mesh, [&](std::string_view bytes) { out += bytes; });
  return out;
}

void write_vtu(const TetMesh& mesh, const ByteSink& sink) {
  sink(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" "
      "header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n");
  if (!mesh.material_names.empty()) {
    // As numbers, since other readers do not know VTK's arrays of strings.
    std::string text;
    for (const auto& [tag, name] : mesh.material_names) {
      append_number(text, tag);
      text += '\t';
      for (char c : valid_utf8(name)) text += static_cast<unsigned char>(c) < ' ' ? '_' : c;
      text += '\n';
    }
    sink("<FieldData>\n");
    write_array(sink, "UInt8", names_field, "NumberOfTuples=\"" + std::to_string(text.size()) + "\" ",
                text.size(), [&](std::size_t i) { return text[i]; });
    sink("</FieldData>\n");
  }
  sink("<Piece NumberOfPoints=\"" + std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" +
       std::to_string(mesh.tets.size()) + "\">\n<Points>\n");
  write_array(sink, "Float64", "Points", "NumberOfComponents=\"3\" ", 3 * mesh.points.size(),
              [&](std::size_t i) { return mesh.points[i / 3][static_cast<Eigen::Index>(i % 3)]; });
  sink("</Points>\n<Cells>\n");
  write_array(sink, "Int64", "connectivity", "", 4 * mesh.tets.size(),
              [&](std::size_t i) { return std::int64_t{mesh.tets[i / 4][i % 4]}; });
  write_array(sink, "Int64", "offsets", "", mesh.tets.size(),
              [](std::size_t i) { return static_cast<std::int64_t>(4 * (i + 1)); });
  write_array(sink, "UInt8", "types", "", mesh.tets.size(),
              [](std::size_t) { return static_cast<std::uint8_t>(vtk_tet_type); });
  sink("</Cells>\n");
  if (!mesh.point_fields.empty()) {
    sink("<PointData>\n");
    const std::vector<std::string> names = field_names_to_write(mesh.point_fields, {});
    for (std::size_t f = 0; f < names.size(); ++f) write_field(sink, mesh.point_fields[f], names[f]);
    sink("</PointData>\n");
  }
  sink("<CellData Scalars=\"material\">\n");
  write_array(sink, "Int32", "material", "", mesh.tets.size(),
              [&](std::size_t i) { return std::int32_t{mesh.materials[i]}; });
  const std::vector<std::string> names = field_names_to_write(mesh.cell_fields, {"material"});
  for (std::size_t f = 0; f < names.size(); ++f) write_field(sink, mesh.cell_fields[f], names[f]);
  sink("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
}

}  // namespace tetwright
