// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/vtp.h"

#include <algorithm>
#include <span>

#include "common/io/elements/vtk_cells.h"
#include "common/io/encodings/vtu_arrays.h"
#include "common/io/encodings/vtu_data.h"
#include "common/io/names/group_text.h"
#include "common/io/names/label_groups.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/surfaces/declared_space.h"
#include "common/io/surfaces/surface_builder.h"
#include "common/io/surfaces/vtu_space.h"

namespace tetwright {

namespace {

bool holds_texts(pugi::xml_node array) {
  return std::string_view(array.attribute("type").as_string()) == "String";
}

/// Whether an array of CellData gives the group of each cell, by name or by number.
bool is_label_array(pugi::xml_node array) {
  if (array.attribute("NumberOfComponents").as_int(1) != 1) return false;
  if (holds_texts(array)) return true;
  return holds_numbers(array) && is_face_label(array.attribute("Name").as_string()) &&
         !std::string_view(array.attribute("type").as_string()).starts_with("Float");
}

/// The array of labels, or an empty node.
pugi::xml_node find_labels(pugi::xml_node cell_data) {
  return cell_data.find_child([](pugi::xml_node node) { return is_label_array(node); });
}

/// Group of each cell, as an index into `groups`.
std::vector<std::uint32_t> read_labels(const VtuData& data, pugi::xml_node array, std::size_t cells,
                                       LabelGroups& groups) {
  std::vector<std::uint32_t> of_cells;
  if (holds_texts(array)) {
    data.texts(array, cells, [&](std::string_view name) { of_cells.push_back(groups.index_of_name(name)); });
    return of_cells;
  }
  const std::vector<std::int64_t> labels = data.integers(array, cells);
  data.expect_size(array, labels.size(), cells);
  of_cells.reserve(cells);
  for (const std::int64_t label : labels) of_cells.push_back(groups.index_of(label));
  return of_cells;
}

void note_arrays(pugi::xml_node parent, const std::string& what, pugi::xml_node taken,
                 std::vector<Dropped>& dropped) {
  std::vector<std::string> names;
  for (const pugi::xml_node node : parent.children())
    if (node.type() == pugi::node_element && node != taken)
      names.push_back(field_name(node.attribute("Name").as_string()));
  append_dropped_names(dropped, what, names);
}

/// Reads the group names written by write_vtp().
void read_names(const VtuData& data, pugi::xml_node piece, std::vector<SurfaceRegion>& groups,
                std::size_t max_size) {
  const pugi::xml_node node =
      piece.parent().child("FieldData").find_child_by_attribute("DataArray", "Name", vtk_surface_names);
  if (!node) return;
  std::string text;
  for (const std::int64_t c : data.integers(node, max_size)) text += static_cast<char>(c);
  for (const auto& [number, name] : parse_vtk_names(text, vtk_surface_names, data.name()))
    for (SurfaceRegion& group : groups)
      if (group.number == number) group.name = name;
}

/// \param point_fields receives the fields; may be null
TriangleMesh read_poly_data(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped,
                            std::vector<MeshField>* point_fields) {
  const VtuData data(bytes, name);
  const pugi::xml_node piece = data.only_piece("PolyData");
  const auto count = [&](const char* attribute) {
    return piece.attribute(attribute) ? data.count(piece, attribute) : 0;
  };
  const std::size_t polygons = count("NumberOfPolys"), verts = count("NumberOfVerts"),
                    lines = count("NumberOfLines"), strips = count("NumberOfStrips");
  if (strips > 0) data.fail(piece, "triangle strips are not supported; export the surface as triangles");
  SurfaceBuilder surface(name);
  const std::vector<Vec3> points = data.points(piece, data.count(piece, "NumberOfPoints"));
  surface.reserve(points.size(), 0);
  for (const Vec3& p : points) surface.add_point(p, [] { return std::string("Points"); });
  if (verts > 0) surface.drop("vertices", verts);
  if (lines > 0) surface.drop("lines", lines);

  const pugi::xml_node label_array = find_labels(piece.child("CellData"));
  LabelGroups groups;
  if (polygons > 0) {
    const pugi::xml_node cells = piece.child("Polys");
    const pugi::xml_node offsets_node = data.array(cells, "offsets");
    const std::vector<std::uint32_t> offsets = data.counts(offsets_node, polygons);
    data.expect_size(offsets_node, offsets.size(), polygons);
    const std::vector<std::uint32_t> connectivity =
        data.counts(data.array(cells, "connectivity"), offsets.empty() ? 0 : offsets.back());
    // Cells are numbered in the order vertices, lines, polygons.
    std::vector<std::uint32_t> labels;
    if (label_array) labels = read_labels(data, label_array, verts + lines + polygons, groups);
    std::vector<std::int64_t> polygon;
    std::size_t begin = 0;
    for (std::size_t c = 0; c < polygons; ++c) {
      const std::size_t end = offsets[c];
      if (end < begin || end > connectivity.size())
        data.fail(offsets_node, "polygon " + std::to_string(c) + " ends at index " + std::to_string(end) +
                                    " of " + std::to_string(connectivity.size()) + "; the file is damaged");
      polygon.assign(connectivity.begin() + static_cast<std::ptrdiff_t>(begin),
                     connectivity.begin() + static_cast<std::ptrdiff_t>(end));
      if (!labels.empty()) surface.begin_group(labels[verts + lines + c]);
      surface.add_polygon(polygon, [&] { return "polygon " + std::to_string(c) + " (counted from 0)"; });
      begin = end;
    }
  }
  if (point_fields) *point_fields = data.fields(piece.child("PointData"), points.size());
  std::vector<SurfaceRegion> named = groups.groups();
  if (!holds_texts(label_array) &&
      std::string_view(label_array.attribute("Name").as_string()) == vtk_surface_field)
    read_names(data, piece, named, bytes.size());
  TriangleMesh mesh = surface.finish(dropped, named);
  mesh.space = read_vtu_space(data, piece.parent());
  if (dropped) {
    note_arrays(piece.child("PointData"), "fields of points", {}, *dropped);
    note_arrays(piece.child("CellData"), "fields of cells", label_array, *dropped);
  }
  return mesh;
}

}  // namespace

TriangleMesh read_vtp(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  return read_poly_data(bytes, name, dropped, nullptr);
}

SurfaceWithFields read_vtp_with_fields(std::string_view bytes, const std::string& name) {
  SurfaceWithFields result;
  result.surface = read_poly_data(bytes, name, nullptr, &result.point_fields);
  return result;
}

void write_vtp(const TriangleMesh& mesh, const ByteSink& sink) {
  const std::size_t triangles = mesh.triangles.size();
  sink(vtu_head("PolyData"));
  const std::vector<std::int32_t> labels = labels_of(mesh.groups);
  if (!mesh.groups.empty() || !short_name_of_space(mesh.space).empty()) {
    std::vector<std::pair<std::int64_t, std::string>> names;
    for (std::size_t g = 0; g < mesh.groups.size(); ++g)
      names.emplace_back(labels[g], group_text(mesh.groups[g]));
    sink("<FieldData>\n");
    if (!names.empty()) write_vtu_names(sink, vtk_surface_names, names);
    write_vtu_space(sink, mesh.space);
    sink("</FieldData>\n");
  }
  sink("<Piece NumberOfPoints=\"" + std::to_string(mesh.points.size()) + "\" NumberOfPolys=\"" +
       std::to_string(triangles) + "\">\n<Points>\n");
  write_vtu_numbers(sink, "Float64", "Points", "NumberOfComponents=\"3\" ", 3 * mesh.points.size(),
                    [&](std::size_t i) { return mesh.points[i / 3][static_cast<Eigen::Index>(i % 3)]; });
  sink("</Points>\n<Polys>\n");
  write_vtu_numbers(sink, "Int64", "connectivity", "", 3 * triangles,
                    [&](std::size_t i) { return std::int64_t{mesh.triangles[i / 3][i % 3]}; });
  write_vtu_numbers(sink, "Int64", "offsets", "", triangles,
                    [](std::size_t i) { return static_cast<std::int64_t>(3 * (i + 1)); });
  sink("</Polys>\n");
  if (!mesh.groups.empty()) {
    sink("<CellData>\n");
    write_vtu_numbers(sink, "Int32", vtk_surface_field, "", triangles,
                      [&](std::size_t i) { return labels[mesh.triangle_groups[i]]; });
    sink("</CellData>\n");
  }
  sink("</Piece>\n</PolyData>\n</VTKFile>\n");
}

}  // namespace tetwright
