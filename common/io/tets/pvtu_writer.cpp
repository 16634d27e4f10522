// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "common/files/file_names.h"
#include "common/io/elements/element_types.h"
#include "common/io/elements/vtk_cells.h"
#include "common/io/elements/vtk_pieces.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/surfaces/vtu_space.h"
#include "common/io/tets/pvtu.h"
#include "common/io/tets/vtu.h"
#include "common/io/tets/vtu_fields.h"
#include "common/mesh/boundary_groups.h"

namespace tetwright {

namespace {

const std::vector<std::string>& own_point_arrays() {
  static const std::vector<std::string> names{vtk_node_numbers, vtk_ghosts};
  return names;
}
const std::vector<std::string>& own_cell_arrays() {
  static const std::vector<std::string> names{"material", vtk_face_groups, vtk_cell_numbers, vtk_ghosts};
  return names;
}

std::string name_of_piece(const std::string& stem, PartNumber part) {
  return stem + "_" + std::to_string(part) + ".vtu";
}

void write_field_data(const DividedMesh& whole, const ByteSink& sink) {
  sink("<FieldData>\n");
  std::vector<std::pair<std::int64_t, std::string>> names;
  for (const MeshParts::Material& m : vtu_materials(whole.names)) names.emplace_back(m.tag, m.name);
  if (!names.empty()) write_vtu_names(sink, vtk_material_names, names);
  names.clear();
  for (const MeshParts::Surface& s : names_of_parts(whole.names, printable_names()).surfaces)
    names.emplace_back(s.number, s.name);
  if (!names.empty()) write_vtu_names(sink, vtk_face_group_names, names);
  write_vtu_space(sink, whole.names.space);
  const std::array<std::int64_t, 3> sizes{whole.parts, static_cast<std::int64_t>(whole.tets),
                                          static_cast<std::int64_t>(whole.nodes)};
  write_vtu_numbers(sink, "Int64", vtk_whole_mesh, "NumberOfTuples=\"3\" ", sizes.size(),
                    [&](std::size_t i) { return sizes[i]; });
  sink("</FieldData>\n");
}

void write_global_numbers(const char* name, const std::vector<std::uint64_t>& numbers, const ByteSink& sink) {
  // VTK takes only its own type of indices for global numbers.
  write_vtu_numbers(sink, "Int64", name, "IdType=\"1\" ", numbers.size(),
                    [&](std::size_t i) { return static_cast<std::int64_t>(numbers[i]); });
}

void write_ghosts(const std::vector<PartNumber>& owners, PartNumber part, const ByteSink& sink) {
  write_vtu_numbers(sink, "UInt8", vtk_ghosts, "", owners.size(), [&](std::size_t i) {
    return static_cast<std::uint8_t>(owners[i] == part ? 0 : vtk_duplicate);
  });
}

/// Numbers of the groups of the faces of all tets, four for each tet.
std::vector<std::int32_t> groups_of_faces(const MeshPiece& piece, const DividedMesh& whole) {
  std::vector<std::int32_t> numbers(4 * piece.mesh.tets.size(), 0);
  const BoundaryGroups groups(whole.names);
  for (const InterfaceSide& side : piece.sides)
    numbers[4 * side.tet + side.face] =
        static_cast<std::int32_t>(groups.number_of(piece.mesh.interfaces[side.interface]));
  return numbers;
}

void write_cells(const MeshPiece& piece, const ByteSink& sink) {
  const std::size_t tets = piece.mesh.tets.size(), nodes = piece.midside ? 10 : 4;
  const auto midside_node = [&](Index m) { return static_cast<std::int64_t>(piece.mesh.points.size() + m); };
  sink("<Cells>\n");
  write_vtu_numbers(sink, "Int64", "connectivity", "", nodes * tets, [&](std::size_t i) {
    const std::size_t t = i / nodes, k = i % nodes;
    return k < 4 ? std::int64_t{piece.mesh.tets[t][k]} : midside_node(piece.midside->of_tets[t][k - 4]);
  });
  write_vtu_numbers(sink, "Int64", "offsets", "", tets,
                    [&](std::size_t i) { return static_cast<std::int64_t>(nodes * (i + 1)); });
  write_vtu_numbers(sink, "UInt8", "types", "", tets, [&](std::size_t) {
    return static_cast<std::uint8_t>((piece.midside ? element::quadratic_tet : element::tet).vtk);
  });
  sink("</Cells>\n");
}

}  // namespace

void write_vtu_piece(const MeshPiece& piece, const DividedMesh& whole, const ByteSink& sink) {
  const TetMesh& mesh = piece.mesh;
  const MeshToWrite written(mesh, piece.midside ? &*piece.midside : nullptr);
  sink(vtu_head("UnstructuredGrid"));
  write_field_data(whole, sink);
  sink("<Piece NumberOfPoints=\"" + std::to_string(written.nodes()) + "\" NumberOfCells=\"" +
       std::to_string(mesh.tets.size()) + "\">\n<Points>\n");
  write_vtu_numbers(sink, "Float64", "Points", "NumberOfComponents=\"3\" ", 3 * written.nodes(),
                    [&](std::size_t i) { return written.node(i / 3)[static_cast<Eigen::Index>(i % 3)]; });
  sink("</Points>\n");
  write_cells(piece, sink);

  sink(std::string("<PointData GlobalIds=\"") + vtk_node_numbers + "\">\n");
  const std::vector<MeshField> fields = written.node_fields();
  const std::vector<std::string> point_names = field_names_to_write(fields, own_point_arrays());
  for (std::size_t f = 0; f < fields.size(); ++f)
    write_vtu_field(sink, fields[f], point_names[f], whole.point_types[f]);
  write_global_numbers(vtk_node_numbers, piece.node_numbers, sink);
  write_ghosts(piece.node_owners, piece.part, sink);
  sink("</PointData>\n");

  sink(std::string("<CellData Scalars=\"material\" GlobalIds=\"") + vtk_cell_numbers + "\">\n");
  write_vtu_numbers(sink, "Int32", "material", "", mesh.tets.size(),
                    [&](std::size_t i) { return std::int32_t{mesh.materials[i]}; });
  if (!whole.names.interfaces.empty()) {
    const std::vector<std::int32_t> groups = groups_of_faces(piece, whole);
    write_vtu_numbers(sink, "Int32", vtk_face_groups, "NumberOfComponents=\"4\" ", groups.size(),
                      [&](std::size_t i) { return groups[i]; });
  }
  const std::vector<std::string> cell_names = field_names_to_write(mesh.cell_fields, own_cell_arrays());
  for (std::size_t f = 0; f < mesh.cell_fields.size(); ++f)
    write_vtu_field(sink, mesh.cell_fields[f], cell_names[f], whole.cell_types[f]);
  write_global_numbers(vtk_cell_numbers, piece.tet_numbers, sink);
  write_ghosts(piece.tet_owners, piece.part, sink);
  sink("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
}

void write_pvtu_index(const DividedMesh& whole, const std::string& stem, const ByteSink& sink) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\">\n"
      "<PUnstructuredGrid GhostLevel=\"1\">\n";
  const auto array = [&](const char* type, const std::string& name, int components, const char* more = "") {
    text += std::string("<PDataArray type=\"") + type + "\" Name=\"" + xml_text(name) + "\" " + more +
            "NumberOfComponents=\"" + std::to_string(components) + "\"/>\n";
  };
  const auto fields = [&](const std::vector<MeshField>& all, const std::vector<FieldType>& types,
                          const std::vector<std::string>& own) {
    const std::vector<std::string> names = field_names_to_write(all, own);
    for (std::size_t f = 0; f < all.size(); ++f) array(vtu_type(types[f]), names[f], all[f].components);
  };
  text += "<PPoints>\n";
  array("Float64", "Points", 3);
  text += std::string("</PPoints>\n<PPointData GlobalIds=\"") + vtk_node_numbers + "\">\n";
  fields(whole.names.point_fields, whole.point_types, own_point_arrays());
  array("Int64", vtk_node_numbers, 1, "IdType=\"1\" ");
  array("UInt8", vtk_ghosts, 1);
  text +=
      std::string("</PPointData>\n<PCellData Scalars=\"material\" GlobalIds=\"") + vtk_cell_numbers + "\">\n";
  array("Int32", "material", 1);
  if (!whole.names.interfaces.empty()) array("Int32", vtk_face_groups, 4);
  fields(whole.names.cell_fields, whole.cell_types, own_cell_arrays());
  array("Int64", vtk_cell_numbers, 1, "IdType=\"1\" ");
  array("UInt8", vtk_ghosts, 1);
  text += "</PCellData>\n";
  for (PartNumber part = 0; part < whole.parts; ++part)
    text += "<Piece Source=\"" + xml_text(name_of_piece(stem, part)) + "\"/>\n";
  sink(text + "</PUnstructuredGrid>\n</VTKFile>\n");
}

std::vector<std::string> files_of_pvtu(const std::string& path, PartNumber parts) {
  const std::string index = extension_of(path) == ".pvtu" ? path : path + ".pvtu";
  std::vector<std::string> files;
  const std::string stem = index.substr(0, index.size() - std::string_view(".pvtu").size());
  for (PartNumber part = 0; part < parts; ++part) files.push_back(name_of_piece(stem, part));
  files.push_back(index);
  return files;
}

}  // namespace tetwright
