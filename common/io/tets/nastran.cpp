// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/nastran.h"

#include <algorithm>
#include <vector>

#include "common/io/names/mesh_parts.h"
#include "common/io/text/fixed_width_number.h"
#include "common/io/text/text_writer.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::size_t small_field = 8, large_field = 16;
constexpr std::size_t fields_on_line = 8;
constexpr std::int64_t max_number = 99'999'999;  // eight digits

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

/// Writes an entry of integers in the small field format, on as many lines as it needs. A field with 0 is
/// left blank.
void write_entry(TextWriter& out, const char* name, const std::vector<std::size_t>& fields) {
  std::string line = padded(name, small_field);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0 && i % fields_on_line == 0) {
      out << line << "\n";
      line = padded("+", small_field);
    }
    line += padded(fields[i] == 0 ? "" : std::to_string(fields[i]), small_field);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  out << line << '\n';
}

void write_points(TextWriter& out, const MeshToWrite& written) {
  for (std::size_t i = 0; i < written.nodes(); ++i) {
    const Vec3& p = written.node(i);
    const auto field = [&](double x) {
      return padded(fixed_width_number(x, large_field, true), large_field);
    };
    out << padded("GRID*", small_field) << padded(std::to_string(i + 1), large_field)
        << padded("", large_field) << field(p.x()) << field(p.y()) << "*\n"
        << padded("*", small_field) << field(p.z()) << '\n';
  }
}

void write_tets_of(TextWriter& out, const MeshToWrite& written, std::int64_t number, const std::string& name,
                   const std::vector<Index>& tets) {
  const TetMesh& mesh = written.mesh;
  const auto property = static_cast<std::size_t>(number);
  out << nastran_material_comment << property << ": " << name << '\n';
  write_entry(out, "PSOLID", {property, property});
  for (const Index t : tets) {
    std::vector<std::size_t> fields = {std::size_t{t} + 1, property};
    for (const Index v : mesh.tets[t]) fields.push_back(std::size_t{v} + 1);
    if (written.midside)
      for (const Index node : written.midside->of_tets[t]) fields.push_back(mesh.points.size() + node + 1);
    write_entry(out, "CTETRA", fields);
  }
}

/// Writes bins of tets that belong to other properties as sets.
/// \param first number of the first set
void write_sets_of_bins(TextWriter& out, const BinDivision& division, std::size_t first) {
  for (const BinPart& part : division.parts) {
    out << "$ set " << first << ": " << part.name << ", tets with the "
        << comment_on_bin(*part.bin, division.bins->field) << '\n';
    std::vector<std::size_t> fields = {first++};
    for (const Index t : part.tets) fields.push_back(std::size_t{t} + 1);
    write_entry(out, "SET1", fields);
  }
}

void write_tets(TextWriter& out, const MeshToWrite& written, const MeshParts& parts) {
  const std::vector<BinDivision> divisions = parts_of_bins(written.bins, parts.materials, nastran_names());
  if (divisions.empty()) {
    for (const MeshParts::Material& m : parts.materials)
      write_tets_of(out, written, m.number, m.name, m.tets);
    return;
  }
  const TetBins& bins = *divisions.front().bins;
  for (const BinPart& part : divisions.front().parts) {
    out << "$ " << part.name << ": " << comment_on_bin(*part.bin, bins.field) << '\n';
    write_tets_of(out, written, part.number, part.name, part.tets);
    if (!bins.poisson) continue;
    const auto field = [&](double x) {
      return padded(fixed_width_number(x, large_field, true), large_field);
    };
    // The shear modulus, which is left blank, follows from the other two.
    out << padded("MAT1*", small_field) << padded(std::to_string(part.number), large_field)
        << field(part.bin->modulus.value_or(0)) << padded("", large_field) << field(*bins.poisson)
        << "*\n*\n";
  }
  std::int64_t last = 0;  // sets of nodes have the numbers of surfaces
  for (const MeshParts::Surface& s : parts.surfaces) last = std::max(last, s.number);
  auto number = static_cast<std::size_t>(last) + 1;
  for (std::size_t d = 1; d < divisions.size(); ++d) {
    write_sets_of_bins(out, divisions[d], number);
    number += divisions[d].parts.size();
  }
}

void write_surfaces(TextWriter& out, const MeshToWrite& written, const MeshParts& parts) {
  const TetMesh& mesh = written.mesh;
  const std::vector<TetFace> faces = faces_of_tets(mesh);
  for (const MeshParts::Surface& s : parts.surfaces) {
    const auto number = static_cast<std::size_t>(s.number);
    out << nastran_surface_comment << number << ": " << s.name << '\n';
    std::vector<std::size_t> fields = {number, 0, 0, 0};
    for (const std::size_t f : s.faces) {
      fields.push_back(std::size_t{faces[f].tet} + 1);
      for (const Index v : mesh.interfaces[f].ids) fields.push_back(std::size_t{v} + 1);
    }
    write_entry(out, "BSURFS", fields);
    fields = {number};
    for (const Index node :
         nodes_of_faces(mesh, s.faces, written.midside ? &written.midside->of_faces : nullptr))
      fields.push_back(std::size_t{node} + 1);
    write_entry(out, "SET1", fields);
  }
}

}  // namespace

NameRules nastran_names() {
  // Names are written in comments, which end with the line.
  return {.form = printable_name, .max_number = max_number};
}

void write_nastran(const MeshToWrite& written, const ByteSink& sink) {
  if (static_cast<std::int64_t>(std::max(written.nodes(), written.mesh.tets.size())) > max_number)
    throw OutputError("a Nastran file cannot hold numbers of more than eight digits, but there are " +
                      std::to_string(std::max(written.nodes(), written.mesh.tets.size())) +
                      " nodes or tets; write another format");
  const MeshParts parts = mesh_parts(written.mesh, nastran_names());
  TextWriter out(sink);
  const bool moduli = !written.bins.empty() && written.bins[leading_division(written.bins)].poisson;
  out << (moduli ? "$ Written by tetwright\n"
                 : "$ Written by tetwright: a MAT1 with the number of each PSOLID is to be added\n")
      << "BEGIN BULK\n";
  write_points(out, written);
  write_tets(out, written, parts);
  write_surfaces(out, written, parts);
  out << "ENDDATA\n";
  out.flush();
}

}  // namespace tetwright
