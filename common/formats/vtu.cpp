#include "common/formats/vtu.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/formats/mesh_fields.h"
#include "common/formats/midside_nodes_read.h"
#include "common/formats/text_scanner.h"
#include "common/formats/vtk_cells.h"
#include "common/formats/vtu_arrays.h"
#include "common/formats/vtu_data.h"
#include "common/formats/xml_text.h"

namespace tetwright {

namespace {

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
    std::vector<Triangle> no_triangles;
    midside_.remove_from(result_, no_triangles);
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
    const auto tets = static_cast<std::size_t>(
        std::count_if(types.begin(), types.end(), [](auto t) { return is_vtk_tet(t); }));
    result_.mesh.tets.reserve(tets);
    if (tets < cells_) tet_to_cell_.reserve(tets);
    std::size_t begin = 0;
    OtherVtkCells other_cells;
    for (std::size_t c = 0; c < cells_; ++c) {
      const std::size_t end = offsets[c];
      if (end < begin || end > connectivity.size())
        data_.fail(offsets_node, "cell " + std::to_string(c) + " ends at " + std::to_string(end) + " of " +
                                     std::to_string(connectivity.size()) + "; the file is damaged");
      if (is_vtk_tet(types[c])) {
        const std::size_t nodes = vtk_nodes_of(types[c]);
        if (end - begin != nodes)
          data_.fail(offsets_node, "cell " + std::to_string(c) + " is a tet of " +
                                       std::to_string(end - begin) + " points; the file is damaged");
        for (std::size_t k = begin; k < end; ++k)
          if (connectivity[k] >= points_)
            data_.fail(connectivity_node, "cell " + std::to_string(c) + " names point " +
                                              std::to_string(connectivity[k]) + " of " +
                                              std::to_string(points_) + "; export the file again");
        result_.mesh.tets.push_back(
            {connectivity[begin], connectivity[begin + 1], connectivity[begin + 2], connectivity[begin + 3]});
        if (nodes > 4) midside_.add_tet(std::span(connectivity).subspan(begin + 4, nodes - 4));
        if (tets < cells_) tet_to_cell_.push_back(c);
      } else {
        other_cells.add(types[c], c);
      }
      begin = end;
    }
    if (other_cells.has_volumes()) data_.fail(types_node, other_cells.refusal());
    other_cells.append_flat_to(result_.dropped);
    if (tets == 0)
      data_.fail(cells, "there are no tets (type 10 or 24) among its " + std::to_string(cells_) +
                            " cells; a tet mesh is needed");
  }

  void read_names(pugi::xml_node grid) {
    const pugi::xml_node node =
        grid.child("FieldData").find_child_by_attribute("DataArray", "Name", vtk_material_names);
    if (!node) return;
    std::string text;
    // Compressed data may be longer than the file, but names hardly are.
    for (std::int64_t c : data_.integers(node, file_size_)) text += static_cast<char>(c);
    for (auto& [tag, name] : parse_vtk_names(text, vtk_material_names, name_))
      result_.mesh.material_names[checked_material(tag, name_, 0)] = name;
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
        if (is_array(node) && !(parent == grid && name_of(node) == vtk_material_names))
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
  MidsideNodesRead midside_;
  ReadTetMesh result_;
};

void write_field(const ByteSink& sink, const MeshField& field, const std::string& name) {
  const auto write = [&]<class Number>(Number, const char* type) {
    write_vtu_numbers(sink, type, xml_text(name),
                      "NumberOfComponents=\"" + std::to_string(field.components) + "\" ", field.values.size(),
                      [&](std::size_t i) { return static_cast<Number>(field.values[i]); });
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

std::string write_vtu(const MeshToWrite& written) {
  std::string out;
  write_vtu(written, [&](std::string_view bytes) { out += bytes; });
  return out;
}

void write_vtu(const MeshToWrite& written, const ByteSink& sink) {
  const TetMesh& mesh = written.mesh;
  const MidsideNodes* midside = written.midside;
  sink(vtu_head("UnstructuredGrid"));
  if (!mesh.material_names.empty()) {
    std::vector<std::pair<std::int64_t, std::string>> names(mesh.material_names.begin(),
                                                            mesh.material_names.end());
    sink("<FieldData>\n");
    write_vtu_names(sink, vtk_material_names, names);
    sink("</FieldData>\n");
  }
  sink("<Piece NumberOfPoints=\"" + std::to_string(written.nodes()) + "\" NumberOfCells=\"" +
       std::to_string(mesh.tets.size()) + "\">\n<Points>\n");
  write_vtu_numbers(sink, "Float64", "Points", "NumberOfComponents=\"3\" ", 3 * written.nodes(),
                    [&](std::size_t i) { return written.node(i / 3)[static_cast<Eigen::Index>(i % 3)]; });
  sink("</Points>\n<Cells>\n");
  const std::size_t of_tet = midside ? 10 : 4;
  write_vtu_numbers(sink, "Int64", "connectivity", "", of_tet * mesh.tets.size(), [&](std::size_t i) {
    const std::size_t t = i / of_tet, k = i % of_tet;
    return k < 4 ? std::int64_t{mesh.tets[t][k]}
                 : static_cast<std::int64_t>(mesh.points.size() + midside->of_tets[t][k - 4]);
  });
  write_vtu_numbers(sink, "Int64", "offsets", "", mesh.tets.size(),
                    [&](std::size_t i) { return static_cast<std::int64_t>(of_tet * (i + 1)); });
  write_vtu_numbers(sink, "UInt8", "types", "", mesh.tets.size(), [&](std::size_t) {
    return static_cast<std::uint8_t>(midside ? vtk_quadratic_tet_type : vtk_tet_type);
  });
  sink("</Cells>\n");
  if (!mesh.point_fields.empty()) {
    sink("<PointData>\n");
    const std::vector<MeshField> fields = written.node_fields();
    const std::vector<std::string> names = field_names_to_write(fields, {});
    for (std::size_t f = 0; f < names.size(); ++f) write_field(sink, fields[f], names[f]);
    sink("</PointData>\n");
  }
  sink("<CellData Scalars=\"material\">\n");
  write_vtu_numbers(sink, "Int32", "material", "", mesh.tets.size(),
                    [&](std::size_t i) { return std::int32_t{mesh.materials[i]}; });
  const std::vector<std::string> names = field_names_to_write(mesh.cell_fields, {"material"});
  for (std::size_t f = 0; f < names.size(); ++f) write_field(sink, mesh.cell_fields[f], names[f]);
  sink("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
}

}  // namespace tetwright
