// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/medit.h"

#include <array>
#include <cmath>
#include <utility>

#include "common/io/names/mesh_fields.h"
#include "common/io/text/text_scanner.h"
#include "common/mesh/boundary_groups.h"
#include "common/number_text.h"
#include "common/utf8.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

constexpr std::string_view reference_comment = "# reference ";

/// Reads a reference. Some programs write it as a floating-point number.
std::int64_t reference(TextScanner& in) {
  const std::string_view word = in.word();
  if (word.empty()) in.fail_cut_short("reference");
  std::int64_t value = 0;
  if (parse_number(word, value)) return value;
  double number = 0;
  if (!parse_number(word, number) || number != std::floor(number) || std::fabs(number) > 0x1p53)
    in.fail("expected a whole number (reference), found " + in_quotes(word));
  return static_cast<std::int64_t>(number);
}

/// Sections of volume cells other than linear tets, with the kinds of cells. Old files use the second
/// spelling of hexahedra.
constexpr std::array<std::pair<std::string_view, const char*>, 12> volume_sections{
    {{"Hexahedra", "hexahedra"},
     {"Hexaedra", "hexahedra"},
     {"Prisms", "prisms"},
     {"Pentahedra", "prisms"},
     {"Pyramids", "pyramids"},
     {"TetrahedraP2", "quadratic tets"},
     {"TetrahedraP3", "tets of higher order"},
     {"TetrahedraP4", "tets of higher order"},
     {"HexahedraQ2", "quadratic hexahedra"},
     {"PrismsP2", "quadratic prisms"},
     {"PyramidsP2", "quadratic pyramids"},
     {"Polyhedra", "polyhedra"}}};

/// Skipped sections and their contents. Other sections are reported by their keyword.
constexpr std::array<std::pair<std::string_view, const char*>, 10> other_sections{
    {{"Quadrilaterals", "quads"},
     {"Edges", "edges"},
     {"Corners", "corners"},
     {"Ridges", "ridges"},
     {"RequiredVertices", "required vertices"},
     {"RequiredEdges", "required edges"},
     {"RequiredTriangles", "required triangles"},
     {"RequiredTetrahedra", "required tets"},
     {"Normals", "normals"},
     {"Tangents", "tangents"}}};

template <class Sections>
const char* find_section(const Sections& sections, std::string_view keyword) {
  for (const auto& [name, kind] : sections)
    if (name == keyword) return kind;
  return nullptr;
}

/// Converts a name to one word without quotes, to be written in quotes.
std::string medit_name(const std::string& name) {
  std::string out;
  for (const char c : valid_utf8(name)) out += static_cast<unsigned char>(c) <= ' ' || c == '"' ? '_' : c;
  return out;
}

class TextReader {
 public:
  TextReader(std::string_view bytes, const std::string& name) : bytes_(bytes), in_(bytes, name, '#') {}

  ReadTetMesh read() {
    read_sections();
    read_comments();
    check_indices();
    return std::move(result_);
  }

  TriangleMesh read_surface(std::vector<Dropped>* dropped) {
    surface_ = true;
    read_sections();
    if (!result_.mesh.tets.empty()) throw InputError(in_.name() + surface_expected(result_.mesh.tets.size()));
    check_has_vertices();
    if (largest_ > std::ssize(result_.mesh.points)) fail_face(largest_, largest_line_);
    if (dropped) note_others(*dropped);
    return surface_of(triangles_, std::move(result_.mesh.points), in_.name());
  }

  /// \pre the materials are known
  void finish(ReadTetMesh& read) {
    triangles_.name_form = medit_name;
    take_triangles(triangles_, "reference", in_.name(), read);
    note_others(read.dropped);
  }

 private:
  void note_others(std::vector<Dropped>& dropped) const {
    others_.append_to(dropped);
    if (point_references_ > 0) dropped.push_back({"points with a reference other than 0", point_references_});
  }

  void check_has_vertices() const {
    if (!has_vertices_) in_.fail("there is no section \"Vertices\" in it; the file is truncated");
  }

  void read_sections() {
    if (in_.at_end()) in_.fail("the file is empty");
    if (const std::string_view word = in_.word(); word != "MeshVersionFormatted")
      in_.fail("expected \"MeshVersionFormatted\" at the beginning, found " + in_quotes(word) +
               "; only ASCII Medit meshes are supported");
    (void)in_.integer("version");
    bool ended = false;
    for (std::string_view word; !ended && !(word = in_.word()).empty();) {
      if (word == "Dimension") {
        if (const std::int64_t dimension = in_.integer("dimension"); dimension != 3)
          in_.fail("dimension " + std::to_string(dimension) + "; a mesh of tets has 3");
      } else if (word == "Vertices") {
        read_vertices();
      } else if (word == "Tetrahedra") {
        read_tets();
      } else if (word == "Triangles") {
        read_triangles();
      } else if (word == "Quadrilaterals" && surface_) {
        read_quads();
      } else if (word == "End") {
        ended = true;
      } else {
        // Keyword of a skipped section, or one of its numbers.
        note_section(word);
      }
    }
    if (!volume_cells_.empty())
      throw InputError(in_.name(), volume_cells_line_,
                       unsupported_cells(volume_cells_, "in the section that begins here"));
  }

  void read_vertices() {
    TetMesh& mesh = result_.mesh;
    if (has_vertices_) in_.fail("a second section \"Vertices\"");
    has_vertices_ = true;
    const std::size_t n = in_.count("number of points", 8);
    if (n >= no_index) in_.fail("more than " + std::to_string(no_index - 1) + " points; split the mesh");
    mesh.points.resize(n);
    for (Vec3& p : mesh.points) {
      for (int k = 0; k < 3; ++k) p[k] = in_.coordinate();
      point_references_ += reference(in_) != 0;
    }
  }

  void read_triangles() {
    const std::size_t n = in_.count("number of triangles", 8);
    for (std::size_t i = 0; i < n; ++i) {
      Triangle ids;
      for (Index& vertex : ids) vertex = read_point_of_face();
      triangles_.add(ids, reference(in_));
    }
  }

  /// Reads the quads of a surface; in a file with tets they are not faces.
  void read_quads() {
    const std::size_t n = in_.count("number of quads", 10);
    for (std::size_t i = 0; i < n; ++i) {
      std::array<Index, 4> ids;
      for (Index& vertex : ids) vertex = read_point_of_face();
      triangles_.add_quad(ids, reference(in_));
    }
  }

  /// Reads the index of a point, which may follow the face in the file. An impossible index becomes no_index,
  /// and is an error in a surface.
  Index read_point_of_face() {
    const std::int64_t index = in_.integer("index of a point");
    const bool possible = index >= 1 && index < no_index;
    if (surface_ && !possible) fail_face(index, in_.line());
    if (index > largest_) {
      largest_ = index;
      largest_line_ = in_.line();
    }
    return possible ? static_cast<Index>(index - 1) : no_index;
  }

  [[noreturn]] void fail_face(std::int64_t index, std::size_t line) const {
    throw InputError(in_.name(), line,
                     "a face refers to point " + std::to_string(index) +
                         (has_vertices_ ? " of " + std::to_string(result_.mesh.points.size()) : "") +
                         " (counted from 1); export the file again");
  }

  /// Reads the comments of write_medit() about references.
  void read_comments() {
    for (std::size_t at = 0; (at = bytes_.find(reference_comment, at)) != std::string_view::npos;) {
      const bool begins_line = at == 0 || bytes_[at - 1] == '\n' || bytes_[at - 1] == '\r';
      at += reference_comment.size();
      if (!begins_line) continue;
      const std::string_view line = bytes_.substr(at, bytes_.substr(at).find_first_of("\r\n"));
      const std::size_t colon = line.find(": ");
      std::int64_t number = 0;
      if (colon == std::string_view::npos || !parse_number(line.substr(0, colon), number)) continue;
      const std::string_view said = line.substr(colon + 2);
      triangles_.comments.emplace(number, said);
      if (said.size() > 2 && said.starts_with('"') && said.ends_with('"'))
        triangles_.names.emplace(number, said.substr(1, said.size() - 2));
    }
  }

  /// Counts the items of a section if `word` is a section keyword: it starts with an upper-case letter, and
  /// the number of items follows.
  void note_section(std::string_view word) {
    if (word[0] < 'A' || word[0] > 'Z') return;
    const std::size_t line = in_.line();
    TextScanner ahead = in_;
    std::int64_t n = 0;
    if (!parse_number(ahead.word(), n) || n <= 0) return;
    const auto count = static_cast<std::size_t>(n);
    if (const char* kind = find_section(volume_sections, word)) {
      if (volume_cells_.empty()) volume_cells_line_ = line;
      volume_cells_.add(kind, count);
    } else if (const char* other = find_section(other_sections, word)) {
      others_.add(other, count);
    } else {
      others_.add("items of section " + in_quotes(word), count);
    }
  }

  void read_tets() {
    TetMesh& mesh = result_.mesh;
    if (!mesh.tets.empty()) in_.fail("a second section \"Tetrahedra\"");
    const std::size_t n = in_.count("number of tets", 10);
    mesh.tets.resize(n);
    mesh.materials.resize(n);
    for (std::size_t t = 0; t < n; ++t) {
      for (Index& vertex : mesh.tets[t]) {
        const std::int64_t index = in_.integer("index of a point");
        if (index < 1 || index >= no_index || (has_vertices_ && index > std::ssize(mesh.points)))
          in_.fail("tet " + std::to_string(t + 1) + " refers to point " + std::to_string(index) + " of " +
                   std::to_string(mesh.points.size()) + " (counted from 1); export the file again");
        vertex = static_cast<Index>(index - 1);
      }
      mesh.materials[t] = checked_material(reference(in_), in_.name(), in_.line());
    }
    result_.material_field = "medit:ref";
  }

  /// Checks the indices at the end, since tets may precede the points.
  void check_indices() const {
    const TetMesh& mesh = result_.mesh;
    check_has_vertices();
    if (mesh.tets.empty()) in_.fail("there are no tets in it; a tet mesh is needed, not a surface");
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (Index vertex : mesh.tets[t])
        if (vertex >= mesh.points.size())
          in_.fail("tet " + std::to_string(t + 1) + " refers to point " +
                   std::to_string(std::uint64_t{vertex} + 1) + " of " + std::to_string(mesh.points.size()) +
                   " (counted from 1); export the file again");
  }

  std::string_view bytes_;
  TextScanner in_;
  ReadTetMesh result_;
  FileTriangles triangles_;
  KindCounts volume_cells_, others_;
  std::size_t volume_cells_line_ = 0;  ///< line of the first section with volume cells
  std::size_t point_references_ = 0;
  std::int64_t largest_ = 0;  ///< largest point number in the faces, from 1
  std::size_t largest_line_ = 0;
  bool has_vertices_ = false;
  bool surface_ = false;  ///< true: a surface is read, not tets
};

void append_triangles(std::string& out, const TetMesh& mesh) {
  const std::vector<InterfaceTriangle>& triangles = mesh.interfaces;
  const BoundaryGroups groups(mesh);
  out += '\n';
  // Some readers do not support comments and could take a name for a keyword. So write material tags, and a
  // single word in quotes for a region of the input.
  for (const BoundaryGroups::Group& g : groups.all()) {
    out += reference_comment;
    append_number(out, g.number);
    out += ": ";
    if (g.pair)
      out += pair_name(*g.pair);
    else
      out += g.surface_region.name.empty() ? std::to_string(g.surface_region.number)
                                           : '"' + medit_name(g.surface_region.name) + '"';
    out += '\n';
  }
  out += "Triangles\n";
  append_number(out, triangles.size());
  out += '\n';
  for (const InterfaceTriangle& t : triangles) {
    for (Index vertex : t.ids) {
      append_number(out, std::uint64_t{vertex} + 1);
      out += ' ';
    }
    append_number(out, groups.number_of(t));
    out += '\n';
  }
}

}  // namespace

ReadTetMesh read_medit(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  TextReader reader(bytes, name);
  ReadTetMesh read = reader.read();
  take_material(read, options, name);
  reader.finish(read);
  return read;
}

TriangleMesh read_medit_surface(std::string_view bytes, const std::string& name,
                                std::vector<Dropped>* dropped) {
  return TextReader(bytes, name).read_surface(dropped);
}

MeshParts medit_parts(const TetMesh& mesh) {
  MeshParts parts;
  for (const std::int64_t tag : tags_of(mesh.materials))
    parts.materials.push_back({static_cast<MaterialTag>(tag), tag, {}, {}});
  const BoundaryGroups groups(mesh);
  for (const BoundaryGroups::Group& g : groups.all())
    parts.surfaces.push_back({g.surface_region, g.number, medit_name(g.surface_region.name), {}});
  return parts;
}

std::string write_medit(const MeshToWrite& written) {
  const TetMesh& mesh = written.mesh;
  // Version 2: coordinates in double precision.
  std::string out = "MeshVersionFormatted 2\n\nDimension 3\n\nVertices\n";
  append_number(out, mesh.points.size());
  out += '\n';
  for (const Vec3& p : mesh.points) {
    append_point(out, p);
    out += " 0\n";
  }
  out += "\nTetrahedra\n";
  append_number(out, mesh.tets.size());
  out += '\n';
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (Index vertex : mesh.tets[t]) {
      append_number(out, std::uint64_t{vertex} + 1);
      out += ' ';
    }
    append_number(out, mesh.materials[t]);
    out += '\n';
  }
  if (!mesh.interfaces.empty()) append_triangles(out, mesh);
  return out + "\nEnd\n";
}

}  // namespace tetwright
