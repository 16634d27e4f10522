// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/febio.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

/// Writes numbers of nodes or elements, from 1, separated by commas.
class NumberList {
 public:
  explicit NumberList(TextWriter& out) : out_(out) {}
  void add(std::size_t zero_based) {
    if (!first_) out_ << ',';
    first_ = false;
    out_ << zero_based + 1;
  }

 private:
  TextWriter& out_;
  bool first_ = true;
};

/// Tets of a material or of a bin.
struct FebioDomain {
  std::string name;
  std::vector<Index> tets;
  std::string comment;            ///< empty: none
  std::optional<double> modulus;  ///< std::nullopt: the material is not written
};

/// \param divisions those of the tets into bins; the first one makes the domains
std::vector<FebioDomain> domains_of(const std::vector<BinDivision>& divisions, MeshParts& parts) {
  std::vector<FebioDomain> domains;
  if (divisions.empty())
    for (MeshParts::Material& m : parts.materials)
      domains.push_back({std::move(m.name), std::move(m.tets), {}, {}});
  else
    for (const BinPart& part : divisions.front().parts)
      domains.push_back({part.name, part.tets, comment_on_bin(*part.bin, divisions.front().bins->field),
                         part.bin->modulus});
  return domains;
}

void write_materials(TextWriter& out, const std::vector<FebioDomain>& domains, double poisson) {
  out << "<Material>\n";
  for (std::size_t i = 0; i < domains.size(); ++i)
    out << "<material id=\"" << i + 1 << "\" name=\"" << xml_text(domains[i].name)
        << "\" type=\"isotropic elastic\"><E>" << domains[i].modulus.value_or(0) << "</E><v>" << poisson
        << "</v></material>\n";
  out << "</Material>\n";
}

/// Text of a comment, which may not contain two hyphens in succession.
std::string comment_text(std::string text) {
  for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;) text.replace(at, 2, "- -");
  return text;
}

void write_elements_of(TextWriter& out, const MeshToWrite& written, const FebioDomain& material) {
  const TetMesh& mesh = written.mesh;
  if (!material.comment.empty()) out << "<!-- " << comment_text(material.comment) << " -->\n";
  out << "<Elements type=\"" << (written.midside ? "tet10" : "tet4") << "\" name=\""
      << xml_text(material.name) << "\">\n";
  for (const Index t : material.tets) {
    out << "<elem id=\"" << std::uint64_t{t} + 1 << "\">";
    NumberList nodes(out);
    for (const Index v : mesh.tets[t]) nodes.add(v);
    if (written.midside)
      for (const Index m : written.midside->of_tets[t]) nodes.add(mesh.points.size() + m);
    out << "</elem>\n";
  }
  out << "</Elements>\n";
}

/// Writes a bin of tets that belong to the domains of another division.
void write_element_set(TextWriter& out, const BinPart& part, const std::string& field) {
  out << "<!-- " << comment_text(comment_on_bin(*part.bin, field)) << " -->\n<ElementSet name=\""
      << xml_text(part.name) << "\">";
  NumberList tets(out);
  for (const Index t : part.tets) tets.add(t);
  out << "</ElementSet>\n";
}

void write_surface(TextWriter& out, const MeshToWrite& written, const MeshParts::Surface& surface) {
  const TetMesh& mesh = written.mesh;
  const char* type = written.midside ? "tri6" : "tri3";
  out << "<Surface name=\"" << xml_text(surface.name) << "\">\n";
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    const std::size_t f = surface.faces[i];
    out << '<' << type << " id=\"" << i + 1 << "\">";
    NumberList nodes(out);
    for (const Index v : mesh.interfaces[f].ids) nodes.add(v);
    if (written.midside)
      for (const Index m : written.midside->of_faces[f]) nodes.add(mesh.points.size() + m);
    out << "</" << type << ">\n";
  }
  out << "</Surface>\n<NodeSet name=\"" << xml_text(surface.name) << "\">";
  NumberList nodes(out);
  for (const Index node :
       nodes_of_faces(mesh, surface.faces, written.midside ? &written.midside->of_faces : nullptr))
    nodes.add(node);
  out << "</NodeSet>\n";
}

}  // namespace

NameRules febio_names() { return {.form = name_for_febio, .surface_numbers = false}; }

void write_febio(const MeshToWrite& written, const ByteSink& sink) {
  MeshParts parts = mesh_parts(written.mesh, febio_names());
  const std::vector<BinDivision> divisions = parts_of_bins(written.bins, parts.materials, febio_names());
  const std::vector<FebioDomain> domains = domains_of(divisions, parts);
  const bool moduli = !divisions.empty() && divisions.front().bins->poisson;
  TextWriter out(sink);
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<febio_spec version=\"4.0\">\n"
      << (moduli ? "<!-- Written by tetwright -->\n"
                 : "<!-- Written by tetwright: materials of the names of the domains are to be added -->\n");
  if (moduli) write_materials(out, domains, *divisions.front().bins->poisson);
  out << "<Mesh>\n<Nodes>\n";  // no name: it would define a node set, whose name might be taken
  for (std::size_t i = 0; i < written.nodes(); ++i) {
    const Vec3& p = written.node(i);
    out << "<node id=\"" << i + 1 << "\">" << p.x() << ',' << p.y() << ',' << p.z() << "</node>\n";
  }
  out << "</Nodes>\n";
  for (const FebioDomain& domain : domains) write_elements_of(out, written, domain);
  for (std::size_t d = 1; d < divisions.size(); ++d)
    for (const BinPart& part : divisions[d].parts) write_element_set(out, part, divisions[d].bins->field);
  for (const MeshParts::Surface& s : parts.surfaces) write_surface(out, written, s);
  out << "</Mesh>\n<MeshDomains>\n";
  for (const FebioDomain& domain : domains)
    out << "<SolidDomain name=\"" << xml_text(domain.name) << "\" mat=\"" << xml_text(domain.name)
        << "\"/>\n";
  out << "</MeshDomains>\n</febio_spec>\n";
  out.flush();
}

}  // namespace tetwright
