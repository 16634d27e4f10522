// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/vtkhdf.h"

#include <array>
#include <span>
#include <utility>

#include "common/io/elements/element_types.h"
#include "common/io/elements/vtk_cells.h"
#include "common/io/elements/vtk_pieces.h"
#include "common/io/encodings/hdf5_file.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/surfaces/declared_space.h"
#include "common/io/tets/vtu.h"
#include "common/mesh/boundary_groups.h"
#include "common/utf8.h"
#include "tetwright/io.h"

namespace tetwright {

namespace {

std::vector<std::uint8_t> bytes_of_names(const std::vector<std::pair<std::int64_t, std::string>>& names) {
  std::vector<std::uint8_t> bytes;
  for (const auto& [number, name] : names)
    for (const char c : std::to_string(number) + '\t' + printable_name(name) + '\n')
      bytes.push_back(static_cast<std::uint8_t>(c));
  return bytes;
}

template <class Number>
void add_list(Hdf5Writer& file, const std::string& name, const std::vector<Number>& values,
              std::size_t columns = 0) {
  file.add(name, std::span<const Number>(values), columns);
}

void add_vtkhdf_fields(Hdf5Writer& file, const std::string& group, const std::vector<MeshField>& fields,
                       const std::vector<FieldType>& types, const std::vector<std::string>& own) {
  const std::vector<std::string> names = field_names_to_write(fields, own, vtkhdf_name);
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const std::size_t columns =
        fields[f].components == 1 ? 0 : static_cast<std::size_t>(fields[f].components);
    const std::vector<double>& values = fields[f].values;
    const std::string name = group + names[f];
    if (types[f] == FieldType::real)
      add_list(file, name, values, columns);
    else if (types[f] == FieldType::int32)
      add_list(file, name, std::vector<std::int32_t>(values.begin(), values.end()), columns);
    else
      add_list(file, name, std::vector<std::int64_t>(values.begin(), values.end()), columns);
  }
}

}  // namespace

std::string vtkhdf_name(const std::string& name) {
  std::string out = name;
  for (char& c : out)
    if (c == '/') c = '_';
  return out == "." ? "_" : out;
}

/// Arrays of all pieces, one after the other.
struct VtkHdfWriter::Arrays {
  std::vector<std::int64_t> points_of_pieces, cells_of_pieces, ids_of_pieces, offsets, connectivity;
  std::vector<std::int64_t> node_numbers, cell_numbers;
  std::vector<double> points;
  std::vector<std::uint8_t> types, node_ghosts, cell_ghosts;
  std::vector<std::int32_t> materials, face_groups;
  std::vector<MeshField> point_fields, cell_fields;
};

VtkHdfWriter::VtkHdfWriter(const DividedMesh& whole) : whole_(whole), arrays_(std::make_unique<Arrays>()) {
  arrays_->point_fields = whole.names.point_fields;
  arrays_->cell_fields = whole.names.cell_fields;
}
VtkHdfWriter::~VtkHdfWriter() = default;

void VtkHdfWriter::add(const MeshPiece& piece) {
  Arrays& a = *arrays_;
  const MeshToWrite written(piece.mesh, piece.midside ? &*piece.midside : nullptr);
  const std::size_t tets = piece.mesh.tets.size(), nodes = piece.midside ? 10 : 4;
  a.points_of_pieces.push_back(static_cast<std::int64_t>(written.nodes()));
  a.cells_of_pieces.push_back(static_cast<std::int64_t>(tets));
  a.ids_of_pieces.push_back(static_cast<std::int64_t>(nodes * tets));
  for (std::size_t i = 0; i < written.nodes(); ++i)
    for (const double x : written.node(i)) a.points.push_back(x);
  a.offsets.push_back(0);
  const auto first_midside = static_cast<std::int64_t>(piece.mesh.points.size());
  for (std::size_t t = 0; t < tets; ++t) {
    for (const Index p : piece.mesh.tets[t]) a.connectivity.push_back(p);
    if (piece.midside)
      for (const Index m : piece.midside->of_tets[t]) a.connectivity.push_back(first_midside + m);
    a.offsets.push_back(static_cast<std::int64_t>(nodes * (t + 1)));
    a.types.push_back(static_cast<std::uint8_t>((piece.midside ? element::quadratic_tet : element::tet).vtk));
    a.materials.push_back(piece.mesh.materials[t]);
  }
  for (const std::uint64_t n : piece.node_numbers) a.node_numbers.push_back(static_cast<std::int64_t>(n));
  for (const std::uint64_t n : piece.tet_numbers) a.cell_numbers.push_back(static_cast<std::int64_t>(n));
  const auto add_ghosts = [&](const std::vector<PartNumber>& owners, std::vector<std::uint8_t>& to) {
    for (const PartNumber owner : owners) to.push_back(owner == piece.part ? 0 : vtk_duplicate);
  };
  add_ghosts(piece.node_owners, a.node_ghosts);
  add_ghosts(piece.tet_owners, a.cell_ghosts);
  if (!whole_.names.interfaces.empty()) {
    const std::size_t first = a.face_groups.size();
    a.face_groups.resize(first + 4 * tets, 0);
    const BoundaryGroups groups(whole_.names);
    for (const InterfaceSide& side : piece.sides)
      a.face_groups[first + 4 * side.tet + side.face] =
          static_cast<std::int32_t>(groups.number_of(piece.mesh.interfaces[side.interface]));
  }
  const auto append = [](std::vector<MeshField>& all, const std::vector<MeshField>& fields) {
    for (std::size_t f = 0; f < fields.size(); ++f)
      all[f].values.insert(all[f].values.end(), fields[f].values.begin(), fields[f].values.end());
  };
  append(a.point_fields, written.node_fields());
  append(a.cell_fields, piece.mesh.cell_fields);
}

void VtkHdfWriter::write(Hdf5Writer& file) const {
  const Arrays& a = *arrays_;
  file.add_group("VTKHDF");
  file.add_attribute("VTKHDF", "Version", std::array<std::int64_t, 2>{1, 0});
  file.add_attribute("VTKHDF", "Type", "UnstructuredGrid");
  add_list(file, "VTKHDF/NumberOfPoints", a.points_of_pieces);
  add_list(file, "VTKHDF/NumberOfCells", a.cells_of_pieces);
  add_list(file, "VTKHDF/NumberOfConnectivityIds", a.ids_of_pieces);
  add_list(file, "VTKHDF/Points", a.points, 3);
  add_list(file, "VTKHDF/Offsets", a.offsets);
  add_list(file, "VTKHDF/Connectivity", a.connectivity);
  add_list(file, "VTKHDF/Types", a.types);

  const std::string points = "VTKHDF/PointData", cells = "VTKHDF/CellData", field_data = "VTKHDF/FieldData";
  for (const std::string& group : {points, cells, field_data}) file.add_group(group);
  file.add_attribute(points, "GlobalIds", vtk_node_numbers);
  file.add_attribute(cells, "GlobalIds", vtk_cell_numbers);
  add_vtkhdf_fields(file, points + "/", a.point_fields, whole_.point_types, {vtk_node_numbers, vtk_ghosts});
  add_list(file, points + "/" + vtk_node_numbers, a.node_numbers);
  add_list(file, points + "/" + vtk_ghosts, a.node_ghosts);
  add_list(file, cells + "/material", a.materials);
  if (!a.face_groups.empty()) add_list(file, cells + "/" + vtk_face_groups, a.face_groups, 4);
  add_vtkhdf_fields(file, cells + "/", a.cell_fields, whole_.cell_types,
                    {"material", vtk_face_groups, vtk_cell_numbers, vtk_ghosts});
  add_list(file, cells + "/" + vtk_cell_numbers, a.cell_numbers);
  add_list(file, cells + "/" + vtk_ghosts, a.cell_ghosts);

  std::vector<std::pair<std::int64_t, std::string>> names;
  for (const MeshParts::Material& m : vtu_materials(whole_.names)) names.emplace_back(m.tag, m.name);
  if (!names.empty()) add_list(file, field_data + "/" + vtk_material_names, bytes_of_names(names));
  names.clear();
  for (const MeshParts::Surface& s : names_of_parts(whole_.names, printable_names()).surfaces)
    names.emplace_back(s.number, s.name);
  if (!names.empty()) add_list(file, field_data + "/" + vtk_face_group_names, bytes_of_names(names));
  if (const std::string space = short_name_of_space(whole_.names.space); !space.empty())
    add_list(file, field_data + "/" + vtk_space, std::vector<std::uint8_t>(space.begin(), space.end()));
  add_list(file, field_data + "/" + vtk_whole_mesh,
           std::vector<std::int64_t>{whole_.parts, static_cast<std::int64_t>(whole_.tets),
                                     static_cast<std::int64_t>(whole_.nodes)});
}

void write_vtkhdf(const MeshPieces& pieces, const std::string& path, OutputFiles& files,
                  const FileSharing* share) {
  VtkHdfWriter writer(pieces.whole());
  for (PartNumber part = 0; part < pieces.whole().parts; ++part) writer.add(pieces.piece(part));
  write_hdf5_file(
      path, files, [&](Hdf5Writer& file) { writer.write(file); }, share);
}

}  // namespace tetwright
