// SPDX-License-Identifier: Apache-2.0
#include "common/io/names/mesh_parts.h"
#include "common/io/tets/tetgen.h"
#include "common/io/text/text_writer.h"

namespace tetwright {

void write_tetgen_node(const MeshToWrite& written, const ByteSink& sink) {
  TextWriter out(sink);
  const TetMesh& mesh = written.mesh;
  out << mesh.points.size() << " 3 0 0\n";
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    out << i + 1 << ' ' << mesh.points[i].x() << ' ' << mesh.points[i].y() << ' ' << mesh.points[i].z()
        << '\n';
  out.flush();
}

void write_tetgen_ele(const MeshToWrite& written, const ByteSink& sink) {
  TextWriter out(sink);
  const TetMesh& mesh = written.mesh;
  for (const MeshParts::Material& m : mesh_parts(mesh, printable_names()).materials)
    out << "# material " << m.tag << ": " << m.name << '\n';
  out << mesh.tets.size() << " 4 1\n";
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    out << t + 1;
    for (const Index v : mesh.tets[t]) out << ' ' << std::uint64_t{v} + 1;
    out << ' ' << mesh.materials[t] << '\n';
  }
  out.flush();
}

void write_tetgen_face(const MeshToWrite& written, const ByteSink& sink) {
  TextWriter out(sink);
  const TetMesh& mesh = written.mesh;
  const MeshParts parts = mesh_parts(mesh, printable_names());
  std::vector<std::int64_t> marker(mesh.interfaces.size());
  for (const MeshParts::Surface& s : parts.surfaces) {
    out << "# marker " << s.number << ": " << s.name << '\n';
    for (const std::size_t f : s.faces) marker[f] = s.number;
  }
  out << mesh.interfaces.size() << " 1\n";
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    out << i + 1;
    for (const Index v : mesh.interfaces[i].ids) out << ' ' << std::uint64_t{v} + 1;
    out << ' ' << marker[i] << '\n';
  }
  out.flush();
}

}  // namespace tetwright
