// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/febio.h"

#include <algorithm>

#include "common/io/names/mesh_parts.h"
#include "common/io/text/text_writer.h"
#include "common/io/text/xml_text.h"
#include "common/utf8.h"

namespace tetwright {

namespace {

/// Replaces quotes, since FEBio decodes &quot; before it looks for the closing quote of an attribute.
std::string name_for_febio(const std::string& name) {
  std::string text = printable_name(name);
  std::replace(text.begin(), text.end(), '"', '\'');
  return text;
}

/// Writes node numbers, from 1, separated by commas.
class NodeList {
 public:
  explicit NodeList(TextWriter& out) : out_(out) {}
  void add(std::size_t zero_based) {
    if (!first_) out_ << ',';
    first_ = false;
    out_ << zero_based + 1;
  }

 private:
  TextWriter& out_;
  bool first_ = true;
};

void write_elements_of(TextWriter& out, const MeshToWrite& written, const MeshParts::Material& material) {
  const TetMesh& mesh = written.mesh;
  out << "<Elements type=\"" << (written.midside ? "tet10" : "tet4") << "\" name=\""
      << xml_text(material.name) << "\">\n";
  for (const Index t : material.tets) {
    out << "<elem id=\"" << std::uint64_t{t} + 1 << "\">";
    NodeList nodes(out);
    for (const Index v : mesh.tets[t]) nodes.add(v);
    if (written.midside)
      for (const Index m : written.midside->of_tets[t]) nodes.add(mesh.points.size() + m);
    out << "</elem>\n";
  }
  out << "</Elements>\n";
}

void write_surface(TextWriter& out, const MeshToWrite& written, const MeshParts::Surface& surface) {
  const TetMesh& mesh = written.mesh;
  const char* type = written.midside ? "tri6" : "tri3";
  out << "<Surface name=\"" << xml_text(surface.name) << "\">\n";
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    const std::size_t f = surface.faces[i];
    out << '<' << type << " id=\"" << i + 1 << "\">";
    NodeList nodes(out);
    for (const Index v : mesh.interfaces[f].ids) nodes.add(v);
    if (written.midside)
      for (const Index m : written.midside->of_faces[f]) nodes.add(mesh.points.size() + m);
    out << "</" << type << ">\n";
  }
  out << "</Surface>\n<NodeSet name=\"" << xml_text(surface.name) << "\">";
  NodeList nodes(out);
  for (const Index node :
       nodes_of_faces(mesh, surface.faces, written.midside ? &written.midside->of_faces : nullptr))
    nodes.add(node);
  out << "</NodeSet>\n";
}

}  // namespace

NameRules febio_names() { return {.form = name_for_febio, .surface_numbers = false}; }

void write_febio(const MeshToWrite& written, const ByteSink& sink) {
  const MeshParts parts = mesh_parts(written.mesh, febio_names());
  TextWriter out(sink);
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<febio_spec version=\"4.0\">\n"
         "<!-- Written by tetwright: materials of the names of the domains are to be added -->\n<Mesh>\n"
         "<Nodes>\n";  // no name: it would define a node set, whose name might be taken
  for (std::size_t i = 0; i < written.nodes(); ++i) {
    const Vec3& p = written.node(i);
    out << "<node id=\"" << i + 1 << "\">" << p.x() << ',' << p.y() << ',' << p.z() << "</node>\n";
  }
  out << "</Nodes>\n";
  for (const MeshParts::Material& m : parts.materials) write_elements_of(out, written, m);
  for (const MeshParts::Surface& s : parts.surfaces) write_surface(out, written, s);
  out << "</Mesh>\n<MeshDomains>\n";
  for (const MeshParts::Material& m : parts.materials)
    out << "<SolidDomain name=\"" << xml_text(m.name) << "\" mat=\"" << xml_text(m.name) << "\"/>\n";
  out << "</MeshDomains>\n</febio_spec>\n";
  out.flush();
}

}  // namespace tetwright
