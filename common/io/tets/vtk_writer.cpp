// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/io/elements/vtk_cells.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/surfaces/declared_space.h"
#include "common/io/tets/vtk.h"
#include "common/io/text/text_writer.h"

namespace tetwright {

namespace {

/// Converts a name to one word in VTK's encoding.
std::string encoded(const std::string& name) {
  constexpr const char* digits = "0123456789ABCDEF";
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > ' ' && byte < 127 && c != '%' && c != '"')
      out += c;
    else
      out.append({'%', digits[byte / 16], digits[byte % 16]});
  }
  return out;
}

/// Writes names as an array of bytes with a line "NUMBER<tab>NAME" for each, since few readers support text
/// arrays.
template <class Parts, class NumberOf>
void write_names(TextWriter& out, const char* array, const Parts& parts, const NumberOf& number_of) {
  std::string text;
  for (const auto& part : parts) text += std::to_string(number_of(part)) + '\t' + part.name + '\n';
  out << array << " 1 " << text.size() << " unsigned_char\n";
  for (const char c : text) out << unsigned{static_cast<unsigned char>(c)} << '\n';
}

/// Writes the fields as arrays of FIELD.
void write_fields(TextWriter& out, const std::vector<MeshField>& fields, std::vector<std::string> taken,
                  std::size_t items) {
  if (fields.empty()) return;
  const std::vector<std::string> names = field_names_to_write(fields, std::move(taken));
  out << "FIELD FieldData " << fields.size() << '\n';
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const bool whole = fields[f].integer && all_whole(fields[f]);
    const bool small = std::all_of(fields[f].values.begin(), fields[f].values.end(), [](double value) {
      return std::fabs(value) <= std::numeric_limits<std::int32_t>::max();
    });
    const auto components = static_cast<std::size_t>(fields[f].components);
    out << encoded(names[f]) << ' ' << components << ' ' << items << ' '
        << (!whole  ? "double"
            : small ? "int"
                    : "long")
        << '\n';
    for (std::size_t i = 0; i < fields[f].values.size(); ++i) {
      const double value = fields[f].values[i];
      if (whole)
        out << static_cast<std::int64_t>(value);
      else if (std::isnan(value))
        out << "nan";  // without a sign, which a NaN may have
      else
        out << value;
      out << ((i + 1) % components == 0 ? '\n' : ' ');
    }
  }
}

}  // namespace

void write_vtk(const MeshToWrite& written, const ByteSink& sink) {
  const TetMesh& mesh = written.mesh;
  const MidsideNodes* midside = written.midside;
  const MeshParts parts = mesh_parts(mesh, printable_names());
  const std::vector<CohesivePart> cohesive = cohesive_parts(mesh, parts.materials, printable_names());
  const std::size_t tets = mesh.tets.size(), triangles = mesh.interfaces.size(),
                    cells = tets + triangles + mesh.wedges.size();
  TextWriter out(sink);
  out << "# vtk DataFile Version 3.0\nwritten by tetwright";
  if (const std::string space = short_name_of_space(mesh.space); !space.empty()) out << " SPACE=" << space;
  out << "\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  out << "POINTS " << written.nodes() << " double\n";
  for (std::size_t i = 0; i < written.nodes(); ++i) {
    const Vec3& p = written.node(i);
    out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  }
  const std::size_t of_tet = midside ? 10 : 4, of_triangle = midside ? 6 : 3;
  out << "CELLS " << cells << ' '
      << tets * (1 + of_tet) + triangles * (1 + of_triangle) + mesh.wedges.size() * 7 << '\n';
  for (std::size_t t = 0; t < tets; ++t) {
    out << of_tet;
    for (const Index v : mesh.tets[t]) out << ' ' << v;
    if (midside)
      for (const Index m : midside->of_tets[t]) out << ' ' << mesh.points.size() + m;
    out << '\n';
  }
  for (std::size_t i = 0; i < triangles; ++i) {
    out << of_triangle;
    for (const Index v : mesh.interfaces[i].ids) out << ' ' << v;
    if (midside)
      for (const Index m : midside->of_faces[i]) out << ' ' << mesh.points.size() + m;
    out << '\n';
  }
  for (const CohesivePart& part : cohesive)
    for (const std::size_t w : part.wedges) {
      out << 6;
      for (const std::size_t k : vtk_wedge_order) out << ' ' << mesh.wedges[w][k];
      out << '\n';
    }
  out << "CELL_TYPES " << cells << '\n';
  for (std::size_t t = 0; t < tets; ++t)
    out << (midside ? element::quadratic_tet.vtk : element::tet.vtk) << '\n';
  for (std::size_t i = 0; i < triangles; ++i)
    out << (midside ? element::quadratic_triangle.vtk : element::triangle.vtk) << '\n';
  for (std::size_t w = 0; w < mesh.wedges.size(); ++w) out << element::wedge.vtk << '\n';
  // Simple readers expect the points first.
  out << "FIELD FieldData " << (parts.surfaces.empty() ? 1 : 2) << '\n';
  std::vector<MeshParts::Material> solids = parts.materials;
  for (const CohesivePart& part : cohesive)
    solids.push_back({static_cast<MaterialTag>(part.number), part.number, part.name, {}});
  write_names(out, vtk_material_names, solids, [](const auto& m) { return m.tag; });
  if (!parts.surfaces.empty())
    write_names(out, vtk_surface_names, parts.surfaces, [](const auto& s) { return s.number; });
  out << "CELL_DATA " << cells << "\nSCALARS material int 1\nLOOKUP_TABLE default\n";
  for (const MaterialTag tag : mesh.materials) out << tag << '\n';
  for (const InterfaceTriangle& t : mesh.interfaces) out << t.material << '\n';
  for (const CohesivePart& part : cohesive)
    for (std::size_t i = 0; i < part.wedges.size(); ++i) out << part.number << '\n';
  if (triangles > 0) {
    std::vector<std::int64_t> surface_of(triangles);
    for (const MeshParts::Surface& s : parts.surfaces)
      for (const std::size_t f : s.faces) surface_of[f] = s.number;
    out << "SCALARS " << vtk_surface_field << " int 1\nLOOKUP_TABLE default\n";
    for (std::size_t t = 0; t < tets; ++t) out << "0\n";
    for (const std::int64_t number : surface_of) out << number << '\n';
    for (std::size_t w = 0; w < mesh.wedges.size(); ++w) out << "0\n";
  }
  std::vector<MeshField> fields = mesh.cell_fields;
  for (MeshField& field : fields) field = with_triangles(std::move(field), cells - tets);
  write_fields(out, fields, {"material", vtk_surface_field}, cells);
  if (!mesh.point_fields.empty()) {
    out << "POINT_DATA " << written.nodes() << '\n';
    write_fields(out, written.node_fields(), {}, written.nodes());
  }
  out.flush();
}

}  // namespace tetwright
