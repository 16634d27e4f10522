// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/io/elements/element_types.h"
#include "common/io/elements/vtk_cells.h"
#include "common/io/encodings/vtu_arrays.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/surfaces/declared_space.h"
#include "common/io/surfaces/vtu_space.h"
#include "common/io/tets/vtu.h"
#include "common/io/tets/vtu_fields.h"
#include "common/mesh/boundary_groups.h"
#include "common/unique_names.h"
#include "tetwright/parted_interfaces.h"

namespace tetwright {

namespace {

/// Faces of sheets and of both sides of parted interfaces, as indices into TetMesh::interfaces.
std::vector<std::size_t> inner_faces(const TetMesh& mesh) {
  std::vector<std::size_t> faces = parted_faces(mesh);
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i)
    if (mesh.interfaces[i].is_sheet()) faces.push_back(i);
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// These faces of the mesh, without tets.
TetMesh only_faces(const TetMesh& mesh, const std::vector<std::size_t>& faces) {
  TetMesh only;
  for (const std::size_t face : faces) {
    const InterfaceTriangle& t = mesh.interfaces[face];
    only.interfaces.push_back(t);
    if (only.materials.empty() || only.materials.back() != t.material) only.materials.push_back(t.material);
  }
  only.material_names = mesh.material_names;
  only.patch_groups = mesh.patch_groups;
  return only;
}

/// The faces of sheets and parted interfaces, which are written as cells after the tets.
struct FaceCells {
  explicit FaceCells(const TetMesh& mesh) : faces(inner_faces(mesh)) {
    if (faces.empty()) return;
    const BoundaryGroups groups(only_faces(mesh, faces));
    for (const std::size_t face : faces) numbers.push_back(groups.number_of(mesh.interfaces[face]));
  }
  std::vector<std::size_t> faces;     ///< indices into TetMesh::interfaces
  std::vector<std::int64_t> numbers;  ///< of their surfaces
};

/// Cohesive elements, with numbers that no material has.
std::vector<CohesivePart> vtu_cohesive(const TetMesh& mesh) {
  if (mesh.wedges.empty()) return {};
  std::vector<MeshParts::Material> materials = vtu_materials(mesh);
  for (const std::int64_t tag : tags_of(mesh.materials))
    materials.push_back({static_cast<MaterialTag>(tag), tag, "material_" + std::to_string(tag), {}});
  return cohesive_parts(mesh, materials, printable_names());
}

}  // namespace

std::string write_vtu(const MeshToWrite& written) {
  std::string out;
  write_vtu(written, [&](std::string_view bytes) { out += bytes; });
  return out;
}

std::vector<MeshParts::Material> vtu_materials(const TetMesh& mesh) {
  std::vector<MeshParts::Material> materials;
  UniqueNames names(printable_name);
  std::map<std::string, std::string> written;  // names stay equal if they are equal in the mesh
  for (const auto& [tag, name] : mesh.material_names) {
    const auto [known, added] = written.try_emplace(name);
    if (added) known->second = names.add(name);
    materials.push_back({tag, tag, known->second, {}});
  }
  return materials;
}

MeshParts vtu_parts(const TetMesh& mesh) {
  return {vtu_materials(mesh),
          names_of_parts(only_faces(mesh, inner_faces(mesh)), printable_names()).surfaces};
}

void write_vtu(const MeshToWrite& written, const ByteSink& sink) {
  const TetMesh& mesh = written.mesh;
  const MidsideNodes* midside = written.midside;
  sink(vtu_head("UnstructuredGrid"));
  const FaceCells sheets(mesh);
  const std::vector<CohesivePart> cohesive = vtu_cohesive(mesh);
  std::vector<std::size_t> wedges;  // in the order in which they are written
  std::vector<std::int32_t> of_wedges;
  for (const CohesivePart& part : cohesive) {
    wedges.insert(wedges.end(), part.wedges.begin(), part.wedges.end());
    of_wedges.insert(of_wedges.end(), part.wedges.size(), static_cast<std::int32_t>(part.number));
  }
  if (!mesh.material_names.empty() || !sheets.faces.empty() || !cohesive.empty() ||
      !short_name_of_space(mesh.space).empty()) {
    const MeshParts parts = vtu_parts(mesh);
    std::vector<std::pair<std::int64_t, std::string>> names;
    sink("<FieldData>\n");
    for (const MeshParts::Material& m : parts.materials) names.emplace_back(m.tag, m.name);
    for (const CohesivePart& part : cohesive) names.emplace_back(part.number, part.name);
    if (!names.empty()) write_vtu_names(sink, vtk_material_names, names);
    names.clear();
    for (const MeshParts::Surface& s : parts.surfaces) names.emplace_back(s.number, s.name);
    if (!names.empty()) write_vtu_names(sink, vtk_surface_names, names);
    write_vtu_space(sink, mesh.space);
    sink("</FieldData>\n");
  }
  const std::size_t tets = mesh.tets.size(), faces = sheets.faces.size(),
                    cells = tets + faces + wedges.size();
  sink("<Piece NumberOfPoints=\"" + std::to_string(written.nodes()) + "\" NumberOfCells=\"" +
       std::to_string(cells) + "\">\n<Points>\n");
  write_vtu_numbers(sink, "Float64", "Points", "NumberOfComponents=\"3\" ", 3 * written.nodes(),
                    [&](std::size_t i) { return written.node(i / 3)[static_cast<Eigen::Index>(i % 3)]; });
  sink("</Points>\n<Cells>\n");
  const std::size_t of_tet = midside ? 10 : 4, of_triangle = midside ? 6 : 3, of_wedge = 6;
  const auto midside_node = [&](Index m) { return static_cast<std::int64_t>(mesh.points.size() + m); };
  write_vtu_numbers(sink, "Int64", "connectivity", "",
                    of_tet * tets + of_triangle * faces + of_wedge * wedges.size(), [&](std::size_t i) {
                      if (i < of_tet * tets) {
                        const std::size_t t = i / of_tet, k = i % of_tet;
                        return k < 4 ? std::int64_t{mesh.tets[t][k]}
                                     : midside_node(midside->of_tets[t][k - 4]);
                      }
                      if (i >= of_tet * tets + of_triangle * faces) {
                        const std::size_t w = i - of_tet * tets - of_triangle * faces;
                        return std::int64_t{mesh.wedges[wedges[w / of_wedge]][vtk_wedge_order[w % of_wedge]]};
                      }
                      const std::size_t face = sheets.faces[(i - of_tet * tets) / of_triangle],
                                        k = (i - of_tet * tets) % of_triangle;
                      return k < 3 ? std::int64_t{mesh.interfaces[face].ids[k]}
                                   : midside_node(midside->of_faces[face][k - 3]);
                    });
  write_vtu_numbers(sink, "Int64", "offsets", "", cells, [&](std::size_t i) {
    return static_cast<std::int64_t>(i < tets           ? of_tet * (i + 1)
                                     : i < tets + faces ? of_tet * tets + of_triangle * (i + 1 - tets)
                                                        : of_tet * tets + of_triangle * faces +
                                                              of_wedge * (i + 1 - tets - faces));
  });
  write_vtu_numbers(sink, "UInt8", "types", "", cells, [&](std::size_t i) {
    return static_cast<std::uint8_t>(i < tets ? (midside ? element::quadratic_tet.vtk : element::tet.vtk)
                                     : i < tets + faces
                                         ? (midside ? element::quadratic_triangle.vtk : element::triangle.vtk)
                                         : element::wedge.vtk);
  });
  sink("</Cells>\n");
  if (!mesh.point_fields.empty()) {
    sink("<PointData>\n");
    const std::vector<MeshField> fields = written.node_fields();
    const std::vector<std::string> names = field_names_to_write(fields, {});
    for (std::size_t f = 0; f < names.size(); ++f)
      write_vtu_field(sink, fields[f], names[f], field_type(fields[f]));
    sink("</PointData>\n");
  }
  sink("<CellData Scalars=\"material\">\n");
  write_vtu_numbers(sink, "Int32", "material", "", cells, [&](std::size_t i) {
    return std::int32_t{i < tets           ? mesh.materials[i]
                        : i < tets + faces ? mesh.interfaces[sheets.faces[i - tets]].material
                                           : of_wedges[i - tets - faces]};
  });
  std::vector<std::string> taken{"material"};
  if (!sheets.faces.empty()) {
    taken.emplace_back(vtk_surface_field);
    write_vtu_numbers(sink, "Int32", vtk_surface_field, "", cells, [&](std::size_t i) {
      return static_cast<std::int32_t>(i < tets || i >= tets + faces ? 0 : sheets.numbers[i - tets]);
    });
  }
  const std::vector<std::string> names = field_names_to_write(mesh.cell_fields, taken);
  for (std::size_t f = 0; f < names.size(); ++f)
    if (cells == tets) {
      write_vtu_field(sink, mesh.cell_fields[f], names[f], field_type(mesh.cell_fields[f]));
    } else {
      const MeshField extended = with_triangles(mesh.cell_fields[f], cells - tets);
      write_vtu_field(sink, extended, names[f], field_type(extended));
    }
  sink("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
}

}  // namespace tetwright
