// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/abaqus.h"

#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/io/names/mesh_parts.h"
#include "common/io/text/fixed_width_number.h"
#include "common/io/text/text_writer.h"

namespace tetwright {

namespace {

/// Number of the face opposite each vertex: S1 has the nodes 1-2-3, S2 1-4-2, S3 2-4-3, S4 3-4-1.
constexpr std::array<int, 4> face_numbers{3, 4, 2, 1};

/// Limits of both programs: the width of a number, and how many numbers a line may have.
constexpr std::size_t number_width = 20;
constexpr std::size_t numbers_on_line = 16;

void write_numbers(TextWriter& out, std::span<const Index> zero_based) {
  for (std::size_t i = 0; i < zero_based.size(); ++i) {
    const bool ends_line = (i + 1) % numbers_on_line == 0 || i + 1 == zero_based.size();
    out << std::uint64_t{zero_based[i]} + 1 << (ends_line ? "\n" : ", ");
  }
}

void write_elements(TextWriter& out, const MeshToWrite& written, const MeshParts::Material& material) {
  const TetMesh& mesh = written.mesh;
  out << "*ELEMENT, TYPE=" << (written.midside ? "C3D10" : "C3D4") << ", ELSET=" << material.name << '\n';
  for (const Index t : material.tets) {
    out << std::uint64_t{t} + 1;
    for (const Index v : mesh.tets[t]) out << ", " << std::uint64_t{v} + 1;
    if (written.midside)
      for (const Index m : written.midside->of_tets[t]) out << ", " << mesh.points.size() + m + 1;
    out << '\n';
  }
}

/// Writes cohesive elements, whose first three nodes are on the first side.
void write_cohesive(TextWriter& out, const TetMesh& mesh, const std::vector<CohesivePart>& parts) {
  std::uint64_t number = mesh.tets.size();
  for (const CohesivePart& part : parts) {
    out << "*ELEMENT, TYPE=COH3D6, ELSET=" << part.name << '\n';
    for (const std::size_t w : part.wedges) {
      out << ++number;
      for (const Index node : mesh.wedges[w]) out << ", " << std::uint64_t{node} + 1;
      out << '\n';
    }
  }
}

/// Names that no other set of elements may have.
std::set<std::string> names_of_sets(const MeshParts& parts, const MeshToWrite& written) {
  std::set<std::string> names;
  for (const MeshParts::Material& m : parts.materials) names.insert(m.name);
  for (const BinDivision& division : parts_of_bins(written.bins, parts.materials, abaqus_names()))
    for (const BinPart& bin : division.parts) names.insert(bin.name);
  return names;
}

/// Writes the bins as element sets, and their moduli as sections.
void write_bins(TextWriter& out, std::span<const TetBins> bins,
                const std::vector<MeshParts::Material>& materials) {
  const std::vector<BinDivision> divisions = parts_of_bins(bins, materials, abaqus_names());
  for (const BinDivision& division : divisions)
    for (const BinPart& part : division.parts) {
      out << "** " << part.name << ": " << comment_on_bin(*part.bin, division.bins->field) << '\n';
      out << "*ELSET, ELSET=" << part.name << '\n';
      write_numbers(out, part.tets);
    }
  // An element has one section.
  if (divisions.empty() || !divisions.front().bins->poisson) return;
  for (const BinPart& part : divisions.front().parts)
    out << "*MATERIAL, NAME=" << part.name << "\n*ELASTIC\n"
        << fixed_width_number(part.bin->modulus.value_or(0), number_width) << ", "
        << fixed_width_number(*divisions.front().bins->poisson, number_width)
        << "\n*SOLID SECTION, ELSET=" << part.name << ", MATERIAL=" << part.name << '\n';
}

}  // namespace

NameRules abaqus_names() {
  return {.form = [](const std::string& name) { return plain_name(name); },
          .ignore_case = true,
          .surface_numbers = false};
}

void write_abaqus(const MeshToWrite& written, const ByteSink& sink) {
  const TetMesh& mesh = written.mesh;
  const MeshParts parts = mesh_parts(mesh, abaqus_names());
  TextWriter out(sink);
  out << "** Written by tetwright, to be taken in by *INCLUDE\n";
  for (const MeshParts::Material& m : parts.materials)
    out << abaqus_material_comment << m.tag << ": " << m.name << '\n';
  const auto write_name = [&](const char* comment, const std::string& written_name, const std::string& name) {
    if (!name.empty() && name != written_name)
      out << comment << written_name << ": " << printable_name(name) << '\n';
  };
  for (const MeshParts::Material& m : parts.materials)
    if (const auto known = mesh.material_names.find(m.tag); known != mesh.material_names.end())
      write_name(abaqus_material_name_comment, m.name, known->second);
  for (const MeshParts::Surface& s : parts.surfaces)
    write_name(abaqus_surface_name_comment, s.name, s.group.name);
  out << "*NODE\n";
  for (std::size_t i = 0; i < written.nodes(); ++i) {
    out << i + 1;
    for (const double x : written.node(i)) out << ", " << fixed_width_number(x, number_width);
    out << '\n';
  }
  for (const MeshParts::Material& m : parts.materials) write_elements(out, written, m);
  write_cohesive(out, mesh, cohesive_parts(mesh, names_of_sets(parts, written), {}, abaqus_names()));
  write_bins(out, written.bins, parts.materials);
  const std::vector<TetFace> faces = faces_of_tets(mesh);
  for (const MeshParts::Surface& s : parts.surfaces) {
    out << "*SURFACE, NAME=" << s.name << ", TYPE=ELEMENT\n";
    for (const std::size_t f : s.faces)
      out << std::uint64_t{faces[f].tet} + 1 << ", S" << face_numbers[faces[f].face] << '\n';
    out << "*NSET, NSET=" << s.name << '\n';
    write_numbers(out, nodes_of_faces(mesh, s.faces, written.midside ? &written.midside->of_faces : nullptr));
  }
  out.flush();
}

}  // namespace tetwright
