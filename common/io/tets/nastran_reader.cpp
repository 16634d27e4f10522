// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/io/elements/file_numbers.h"
#include "common/io/elements/midside_nodes_read.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/tets/nastran.h"
#include "common/io/text/text_scanner.h"
#include "common/utf8.h"
#include "tetwright/error.h"
#include "tetwright/io.h"

namespace tetwright {

namespace {

std::string without_blanks(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (c != ' ' && c != '\t' && c != '\r')
      out += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return out;
}

/// A bulk data entry with all its continuations.
struct Entry {
  std::string name;  ///< upper case, without the asterisk of the large format
  std::vector<std::string> fields;
  std::size_t line = 0;

  /// Field i; empty if it is missing.
  const std::string& field(std::size_t i) const {
    static const std::string none;
    return i < fields.size() ? fields[i] : none;
  }
};

/// Three-dimensional elements other than tets, with their kinds.
const std::map<std::string, const char*> volume_entries{
    {"CHEXA", "hexahedra"},  {"CPENTA", "prisms"},     {"CPYRAM", "pyramids"},  {"CPYRA", "pyramids"},
    {"CHEXA8", "hexahedra"}, {"CHEXA20", "hexahedra"}, {"CPENTA6", "prisms"},   {"CPENTA15", "prisms"},
    {"CHEXCZ", "hexahedra"}, {"CPENTCZ", "prisms"},    {"CIHEX1", "hexahedra"}, {"CIHEX2", "hexahedra"}};

class NastranReader {
 public:
  NastranReader(std::string_view bytes, const std::string& name) : in_(bytes, name) {}

  ReadTetMesh read(const ReadTetMeshOptions& options) {
    if (in_.at_end()) in_.fail("the file is empty");
    read_entries();
    if (!volumes_.empty())
      throw InputError(in_.name(), volumes_line_, unsupported_cells(volumes_, "in this line"));
    if (tets_.empty()) in_.fail("there is no CTETRA in it; a tet mesh is needed");
    make_tets();
    midside_.remove_from(result_, triangles_.triangles);
    take_material(result_, options, in_.name());
    take_triangles(triangles_, "BSURFS", in_.name(), result_);
    others_.append_to(result_.dropped);
    return std::move(result_);
  }

 private:
  /// A tet or a face, with numbers as in the file.
  struct Numbered {
    std::int64_t number = 0, group = 0;  ///< element and property, or element and surface
    std::vector<std::int64_t> nodes;
    std::size_t line = 0;
  };

  [[noreturn]] void fail(std::size_t line, const std::string& message) const {
    throw InputError(in_.name(), line, message);
  }

  /// Reads the bulk data: the part after the line BEGIN BULK, or else the whole file.
  void read_entries() {
    Entry entry;
    bool bulk = !has_begin_bulk();
    while (in_.left() > 0) {
      const std::size_t line = in_.line();
      std::string_view text = in_.rest_of_line();
      if (text.starts_with('$')) {
        read_comment(text, line);
        continue;
      }
      if (text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
      const std::string words = without_blanks(text);
      if (!bulk) {
        bulk = words.starts_with("BEGINBULK");
        continue;
      }
      if (words.starts_with("BEGINBULK")) continue;
      if (words.starts_with("ENDDATA")) break;
      if (words.starts_with("INCLUDE"))
        fail(line, "INCLUDE is not supported; give the file that has the mesh");
      read_line(text, line, entry);
    }
    take(entry);
  }

  bool has_begin_bulk() const {
    TextScanner ahead = in_;
    while (ahead.left() > 0)
      if (without_blanks(ahead.rest_of_line()).starts_with("BEGINBULK")) return true;
    return false;
  }

  /// Reads comments of write_nastran(): "$ material NUMBER: NAME" and "$ surface NUMBER: NAME".
  void read_comment(std::string_view text, std::size_t line) {
    for (const std::string_view what : {nastran_material_comment, nastran_surface_comment}) {
      if (!text.starts_with(what)) continue;
      const std::string_view rest = text.substr(what.size());
      const std::size_t colon = rest.find(": ");
      std::int64_t number = 0;
      if (colon == std::string_view::npos || !parse_number(rest.substr(0, colon), number)) return;
      const std::string name = printable_name(std::string(rest.substr(colon + 2)));
      if (what == nastran_surface_comment)
        triangles_.names[number] = name;
      else
        result_.mesh.material_names[checked_material(number, in_.name(), line)] = name;
    }
  }

  /// Reads a line of fields: a new entry, or a continuation of the last one.
  void read_line(std::string_view text, std::size_t line, Entry& entry) {
    text = text.substr(0, text.find('$'));
    std::vector<std::string> fields;
    bool large = false;
    if (text.find(',') != std::string_view::npos) {
      for (std::size_t begin = 0;;) {
        const std::size_t comma = text.find(',', begin);
        fields.push_back(
            without_blanks(text.substr(begin, comma == std::string_view::npos ? comma : comma - begin)));
        if (comma == std::string_view::npos) break;
        begin = comma + 1;
      }
      large = fields[0].ends_with('*');
    } else {
      // A tab advances to the next multiple of eight columns.
      std::string wide;
      for (const char c : text) {
        if (c != '\t') wide += c;
        if (c == '\t') wide.resize((wide.size() / 8 + 1) * 8, ' ');
      }
      fields.push_back(without_blanks(wide.substr(0, 8)));
      large = fields[0].ends_with('*') || fields[0].starts_with('*');
      const std::size_t width = large ? 16 : 8;
      for (std::size_t begin = 8; begin < std::min<std::size_t>(wide.size(), 72); begin += width)
        fields.push_back(without_blanks(wide.substr(begin, width)));
    }
    const bool goes_on = fields[0].empty() || fields[0][0] == '+' || fields[0][0] == '*';
    // A line has eight fields, or four large ones, followed by the name of its continuation.
    const std::size_t on_line = large ? 4 : 8;
    if (goes_on && entry.name.empty()) fail(line, "a line continues an entry, but there is none before it");
    if (!goes_on) {
      take(entry);
      entry = {fields[0].substr(0, fields[0].find('*')), {}, line};
    } else {
      entry.fields.resize(entry.fields.size() + padding_);
    }
    fields.erase(fields.begin());
    if (fields.size() > on_line) fields.resize(on_line);
    entry.fields.insert(entry.fields.end(), fields.begin(), fields.end());
    padding_ = on_line - fields.size();
  }

  std::int64_t whole_number(const Entry& entry, std::size_t i, const char* what) const {
    std::int64_t value = 0;
    if (!parse_number(entry.field(i), value))
      fail(entry.line, entry.name + ": expected a whole number (" + std::string(what) + "), found " +
                           in_quotes(entry.field(i)));
    return value;
  }

  /// Reads a number in Nastran's notation: the letter before an exponent may be missing or be a D.
  double real(const Entry& entry, std::size_t i) const {
    std::string text = entry.field(i);
    if (text.empty()) return 0;
    for (char& c : text)
      if (c == 'D') c = 'E';
    const std::size_t sign = text.find_first_of("+-", 1);
    if (sign != std::string::npos && text.find('E') == std::string::npos) text.insert(sign, "E");
    if (text[0] == '+') text.erase(0, 1);
    double value = 0;
    if (!parse_number(text, value) || !std::isfinite(value))
      fail(entry.line, entry.name + ": " + in_quotes(entry.field(i)) + " is not a finite number");
    return value;
  }

  void take(const Entry& entry) {
    if (entry.name == "GRID")
      read_point(entry);
    else if (entry.name == "CTETRA" || entry.name == "CTETRA4" || entry.name == "CTETRA10")
      read_tet(entry);
    else if (entry.name == "BSURFS")
      read_surface(entry);
    else if (entry.name == "GRDSET" && !entry.field(1).empty() && entry.field(1) != "0")
      fail(entry.line, "GRDSET puts points into another coordinate system; export them in the basic one");
    else if (const auto volume = volume_entries.find(entry.name); volume != volume_entries.end()) {
      if (volumes_.empty()) volumes_line_ = entry.line;
      volumes_.add(volume->second);
    } else if (entry.name.starts_with("C") && entry.name != "CORD2R" && !entry.name.starts_with("CORD")) {
      others_.add("elements " + entry.name.substr(0, 8));
    }
  }

  void read_point(const Entry& entry) {
    if (!entry.field(1).empty() && entry.field(1) != "0")
      fail(entry.line, "GRID " + entry.field(0) + " is in the coordinate system " +
                           in_quotes(entry.field(1)) + "; export points in the basic one");
    nodes_.add(whole_number(entry, 0, "number of a point"));
    if (result_.mesh.points.size() >= no_index - 1)
      fail(entry.line, "more than " + std::to_string(no_index - 1) + " points; split the mesh");
    result_.mesh.points.push_back({real(entry, 2), real(entry, 3), real(entry, 4)});
  }

  void read_tet(const Entry& entry) {
    Numbered tet{
        whole_number(entry, 0, "number of an element"), whole_number(entry, 1, "property"), {}, entry.line};
    std::size_t given = 0;
    for (std::size_t i = 2; i < 12; ++i) given += !entry.field(i).empty();
    const std::size_t nodes = given > 4 ? 10 : 4;
    // Some of the midside points may be missing.
    for (std::size_t i = 2; i < 2 + nodes; ++i)
      tet.nodes.push_back(i >= 6 && entry.field(i).empty() ? 0 : whole_number(entry, i, "point of a tet"));
    tets_.push_back(std::move(tet));
  }

  /// Reads a surface of element faces. Each face, from the fifth field on, is given by its element and three
  /// points.
  void read_surface(const Entry& entry) {
    const std::int64_t number = whole_number(entry, 0, "number of a surface");
    for (std::size_t i = 4; i + 3 < entry.fields.size(); i += 4) {
      if (entry.field(i).empty()) break;
      Numbered face{whole_number(entry, i, "number of an element"), number, {}, entry.line};
      for (std::size_t k = 1; k <= 3; ++k)
        face.nodes.push_back(whole_number(entry, i + k, "point of a face"));
      faces_.push_back(std::move(face));
    }
  }

  Index node(const Numbered& of, std::int64_t number) const {
    const Index index = nodes_.find(number);
    if (index == no_index)
      fail(of.line, "element " + std::to_string(of.number) + " refers to point " + std::to_string(number) +
                        ", which no GRID defines; export the file again");
    return index;
  }

  void make_tets() {
    if (const std::optional<std::int64_t> twice = nodes_.sort())
      in_.fail("GRID " + std::to_string(*twice) + " appears twice");
    std::set<std::int64_t> numbers;
    TetMesh& mesh = result_.mesh;
    for (const Numbered& tet : tets_) {
      if (!numbers.insert(tet.number).second)
        fail(tet.line, "element " + std::to_string(tet.number) + " appears twice");
      Tet ids;
      for (std::size_t k = 0; k < 4; ++k) ids[k] = node(tet, tet.nodes[k]);
      mesh.tets.push_back(ids);
      mesh.materials.push_back(checked_material(tet.group, in_.name(), tet.line));
      std::vector<Index> midside;
      for (std::size_t k = 4; k < tet.nodes.size(); ++k)
        if (tet.nodes[k] != 0) midside.push_back(node(tet, tet.nodes[k]));
      if (!midside.empty()) midside_.add_tet(midside);
    }
    for (const Numbered& face : faces_) {
      if (!numbers.contains(face.number)) {
        others_.add("faces of other elements in BSURFS");
        continue;
      }
      Triangle ids;
      for (std::size_t k = 0; k < 3; ++k) ids[k] = node(face, face.nodes[k]);
      triangles_.add(ids, face.group);
    }
    result_.material_field = "PID";
  }

  TextScanner in_;
  ReadTetMesh result_;
  FileNumbers nodes_;
  std::vector<Numbered> tets_, faces_;
  FileTriangles triangles_;
  MidsideNodesRead midside_;
  KindCounts volumes_, others_;
  std::size_t volumes_line_ = 0;
  std::size_t padding_ = 0;  ///< missing fields on the last line of the entry
};

}  // namespace

ReadTetMesh read_nastran(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  return NastranReader(bytes, name).read(options);
}

}  // namespace tetwright
