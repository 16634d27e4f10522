// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/io/elements/file_numbers.h"
#include "common/io/elements/midside_nodes_read.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/tets/abaqus.h"
#include "common/io/text/text_scanner.h"
#include "common/trimmed.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/parted_interfaces.h"

namespace tetwright {

namespace {

std::string in_capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

/// A keyword line, such as "*ELEMENT, TYPE=C3D4, ELSET=bone".
struct Keyword {
  std::string name;  ///< upper case, without blanks
  std::map<std::string, std::string> parameters;
  std::size_t line;

  const std::string* find(const std::string& parameter) const {
    const auto found = parameters.find(parameter);
    return found == parameters.end() ? nullptr : &found->second;
  }
};

/// Kind of an element, as determined by the beginning of its type.
enum class Kind { tet, quadratic_tet, cohesive, volume, flat };

Kind kind_of(const std::string& type) {
  // C3D is a continuum element; with a prefix, AC3D is an acoustic and DC3D a thermal one.
  if (type == "COH3D6") return Kind::cohesive;
  const std::size_t at = type.find("C3D");
  if (at > 1)  // or npos
    return type.starts_with("SC") || type.starts_with("CSS") ? Kind::volume : Kind::flat;
  std::string nodes;
  for (std::size_t i = at + 3; i < type.size() && type[i] >= '0' && type[i] <= '9'; ++i) nodes += type[i];
  return nodes == "4" ? Kind::tet : nodes == "10" ? Kind::quadratic_tet : Kind::volume;
}

class AbaqusReader {
 public:
  AbaqusReader(std::string_view bytes, const std::string& name) : in_(bytes, name) {}

  ReadTetMesh read(const ReadTetMeshOptions& options) {
    read_keywords();
    if (!volumes_.empty())
      throw InputError(in_.name(), volumes_line_,
                       unsupported_cells(volumes_, "in the block that begins here"));
    if (result_.mesh.tets.empty())
      in_.fail("there are no tets in it (*ELEMENT, TYPE=C3D4 or C3D10); a tet mesh is needed");
    set_materials();
    take_surfaces();
    midside_.remove_from(result_, triangles_.triangles);
    take_material(result_, options, in_.name());
    take_triangles(triangles_, "surface", in_.name(), result_);
    note_dropped();
    return std::move(result_);
  }

 private:
  /// Element numbers in a set, and the names of sets that it includes.
  struct Set {
    std::vector<std::int64_t> numbers;
    std::vector<std::string> sets;
  };
  struct Side {
    std::string what;  ///< an element number or the name of a set
    int side;
    std::size_t line;
  };

  void read_keywords() {
    if (in_.at_end()) in_.fail("the file is empty");
    bool began = false;
    while (next_line()) {
      if (!line_.starts_with('*')) {
        if (!began)
          in_.fail("expected a keyword with an asterisk, found " + in_quotes(line_) +
                   "; is this an input file of Abaqus or CalculiX?");
        continue;  // data of a skipped keyword
      }
      began = true;
      const Keyword keyword = parse_keyword();
      if (keyword.name == "NODE")
        read_nodes();
      else if (keyword.name == "ELEMENT")
        read_elements(keyword);
      else if (keyword.name == "ELSET")
        read_set(keyword, "ELSET");
      else if (keyword.name == "NSET")
        note_node_set(keyword);
      else if (keyword.name == "SURFACE")
        read_surface(keyword);
      else if (keyword.name == "SOLIDSECTION")
        note_section(keyword);
      else if (keyword.name == "INCLUDE")
        fail(keyword.line, "*INCLUDE is not supported; give the file that has the nodes and elements");
      else if (keyword.name == "PART" && ++parts_ > 1)
        fail(keyword.line, "a second *PART; save each as a file of its own, or the whole as one part");
      else if (keyword.name == "INSTANCE")
        check_instance(keyword);
    }
  }

  /// Reads the next line that is neither a comment nor empty into line_ and line_number_.
  /// \return false at the end
  bool next_line() {
    if (pushed_back_) {
      pushed_back_ = false;
      return true;
    }
    while (in_.left() > 0) {
      line_number_ = in_.line();
      const std::string_view text = trimmed(in_.rest_of_line());
      if (text.starts_with(abaqus_material_comment)) read_comment(text);
      read_name_comment(text, abaqus_material_name_comment, material_names_);
      read_name_comment(text, abaqus_surface_name_comment, surface_names_);
      if (text.empty() || text.starts_with("**")) continue;
      line_ = text;
      return true;
    }
    return false;
  }
  /// Reads the next data line.
  /// \return false before a keyword and at the end
  bool next_data() {
    if (!next_line()) return false;
    if (!line_.starts_with('*')) return true;
    pushed_back_ = true;
    return false;
  }

  [[noreturn]] void fail(std::size_t line, const std::string& message) const {
    throw InputError(in_.name(), line, message);
  }

  /// Reads a comment "** material TAG: NAME".
  void read_comment(std::string_view text) {
    text.remove_prefix(std::string_view(abaqus_material_comment).size());
    const std::size_t colon = text.find(": ");
    std::int64_t tag = 0;
    if (colon == std::string_view::npos || !parse_number(text.substr(0, colon), tag)) return;
    tags_[in_capitals(text.substr(colon + 2))] = checked_material(tag, in_.name(), line_number_);
  }

  /// Reads a comment that gives a name in the mesh.
  static void read_name_comment(std::string_view text, std::string_view comment,
                                std::map<std::string, std::string>& names) {
    if (!text.starts_with(comment)) return;
    text.remove_prefix(comment.size());
    if (const std::size_t colon = text.find(": "); colon != std::string_view::npos)
      names[in_capitals(text.substr(0, colon))] = text.substr(colon + 2);
  }

  /// Splits a line at commas.
  static std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t begin = 0;;) {
      const std::size_t comma = line.find(',', begin);
      fields.push_back(trimmed(line.substr(begin, comma == std::string_view::npos ? comma : comma - begin)));
      if (comma == std::string_view::npos) break;
      begin = comma + 1;
    }
    return fields;
  }

  Keyword parse_keyword() const {
    Keyword keyword{{}, {}, line_number_};
    const std::vector<std::string_view> fields = fields_of(line_);
    for (const char c : in_capitals(fields[0].substr(1)))
      if (c != ' ') keyword.name += c;
    for (std::size_t i = 1; i < fields.size(); ++i) {
      const std::size_t equals = fields[i].find('=');
      std::string_view value = equals == std::string_view::npos ? "" : trimmed(fields[i].substr(equals + 1));
      if (value.size() > 1 && value.front() == '"' && value.back() == '"')
        value = value.substr(1, value.size() - 2);
      keyword.parameters[in_capitals(trimmed(fields[i].substr(0, equals)))] = std::string(value);
    }
    return keyword;
  }

  std::int64_t whole_number(std::string_view text, const char* what) const {
    std::int64_t value = 0;
    if (!parse_number(text, value))
      fail(line_number_, "expected a whole number (" + std::string(what) + "), found " + in_quotes(text));
    return value;
  }

  void read_nodes() {
    std::vector<Vec3>& points = result_.mesh.points;
    while (next_data()) {
      const std::vector<std::string_view> fields = fields_of(line_);
      if (fields.size() < 4)
        fail(line_number_, "expected a number and three coordinates, found " + in_quotes(line_));
      nodes_.add(whole_number(fields[0], "number of a node"));
      Vec3 p;
      for (std::size_t k = 0; k < 3; ++k) {
        double& x = p[static_cast<Eigen::Index>(k)];
        if (!parse_number(fields[k + 1], x) || !std::isfinite(x))
          fail(line_number_, "coordinate " + in_quotes(fields[k + 1]) + " is not a finite number");
      }
      if (points.size() >= no_index - 1)
        fail(line_number_, "more than " + std::to_string(no_index - 1) + " points; split the mesh");
      points.push_back(p);
    }
  }

  void read_elements(const Keyword& keyword) {
    const std::string* type = keyword.find("TYPE");
    if (!type) fail(keyword.line, "*ELEMENT without TYPE=");
    const Kind kind = kind_of(in_capitals(*type));
    const std::string* set = keyword.find("ELSET");
    const std::size_t nodes = kind == Kind::tet ? 4 : kind == Kind::cohesive ? 6 : 10;
    if (kind == Kind::tet || kind == Kind::quadratic_tet || kind == Kind::cohesive) sort_nodes();
    std::vector<std::int64_t> numbers;  // of an element; all of its lines but the last end with a comma
    std::size_t count = 0;
    while (next_data()) {
      const bool goes_on = line_.ends_with(',');
      if (kind == Kind::volume || kind == Kind::flat) {
        count += goes_on ? 0 : 1;
        continue;
      }
      std::vector<std::string_view> fields = fields_of(line_);
      if (goes_on) fields.pop_back();
      for (const std::string_view field : fields) numbers.push_back(whole_number(field, "number"));
      if (numbers.size() < nodes + 1 && goes_on) continue;
      if (numbers.size() != nodes + 1)
        fail(line_number_, "element " + std::to_string(numbers[0]) + " of type " + *type + " has " +
                               std::to_string(numbers.size() - 1) + " nodes instead of " +
                               std::to_string(nodes));
      if (kind == Kind::cohesive) {
        add_wedge(numbers, *type, keyword.line);
        numbers.clear();
        continue;
      }
      add_tet(numbers, set ? in_capitals(*set) : "");
      if (set) set_names_.emplace(in_capitals(*set), *set);
      numbers.clear();
    }
    if (!numbers.empty()) fail(line_number_, "the file ends within an element; it is truncated");
    if (kind == Kind::volume) {
      if (volumes_.empty()) volumes_line_ = keyword.line;
      volumes_.add("elements of type " + *type, count);
    } else if (kind == Kind::flat && count > 0) {
      others_.add("elements of type " + *type, count);
    }
  }

  void sort_nodes() {
    if (sorted_) return;
    sorted_ = true;
    if (const std::optional<std::int64_t> twice = nodes_.sort())
      in_.fail("node " + std::to_string(*twice) + " appears twice");
  }

  Index node(std::int64_t element, std::int64_t number) const {
    const Index index = nodes_.find(number);
    if (index == no_index)
      fail(line_number_, "element " + std::to_string(element) + " refers to node " + std::to_string(number) +
                             ", which no earlier *NODE defines; export the file again");
    return index;
  }

  void add_tet(const std::vector<std::int64_t>& numbers, const std::string& set) {
    Tet tet;
    for (std::size_t k = 0; k < 4; ++k) tet[k] = node(numbers[0], numbers[k + 1]);
    result_.mesh.tets.push_back(tet);
    elements_.add(numbers[0]);
    block_set_.push_back(index_of_set(set));
    if (numbers.size() == 5) return;
    std::array<Index, 6> midside{};
    for (std::size_t k = 0; k < 6; ++k) midside[k] = node(numbers[0], numbers[k + 5]);
    midside_.add_tet(midside);
  }

  void add_wedge(const std::vector<std::int64_t>& numbers, const std::string& type, std::size_t line) {
    Wedge wedge;
    for (std::size_t k = 0; k < 6; ++k) wedge[k] = node(numbers[0], numbers[k + 1]);
    if (is_cohesive(wedge, result_.mesh.points)) {
      result_.mesh.wedges.push_back(wedge);
      return;
    }
    if (volumes_.empty()) volumes_line_ = line;
    volumes_.add("elements of type " + type + " whose nodes do not coincide in pairs", 1);
  }

  std::uint32_t index_of_set(const std::string& set) {
    const auto [known, added] = block_sets_.try_emplace(set, static_cast<std::uint32_t>(block_names_.size()));
    if (added) block_names_.push_back(set);
    return known->second;
  }

  void read_set(const Keyword& keyword, const char* parameter) {
    const std::string* name = keyword.find(parameter);
    if (!name || name->empty()) fail(keyword.line, "*" + keyword.name + " without a name");
    Set& set = sets_[in_capitals(*name)];
    set_names_.emplace(in_capitals(*name), *name);
    const bool generate = keyword.find("GENERATE") != nullptr;
    while (next_data())
      if (generate)
        generate_numbers(set);
      else
        for (const std::string_view field : fields_of(line_)) {
          if (field.empty()) continue;
          if (std::int64_t number = 0; parse_number(field, number))
            set.numbers.push_back(number);
          else
            set.sets.push_back(in_capitals(field));
        }
  }

  /// Reads a data line "first, last, step".
  void generate_numbers(Set& set) const {
    const std::vector<std::string_view> fields = fields_of(line_);
    if (fields.size() < 2)
      fail(line_number_, "expected the first and the last number, found " + in_quotes(line_));
    const std::int64_t first = whole_number(fields[0], "first number"),
                       last = whole_number(fields[1], "last number"),
                       step = fields.size() > 2 && !fields[2].empty() ? whole_number(fields[2], "step") : 1;
    if (step < 1) fail(line_number_, "a step of " + std::to_string(step) + "; it must be 1 or more");
    // Limit the numbers to as many as there are elements, whatever the file says.
    const auto max_steps = static_cast<std::int64_t>(std::max<std::size_t>(elements_.size(), 1));
    if (last < first || (last - first) / step >= max_steps)
      fail(line_number_, in_quotes(line_) + " are more elements than the " +
                             std::to_string(elements_.size()) + " tets before it");
    for (std::int64_t n = first; n <= last; n += step) set.numbers.push_back(n);
  }

  void note_node_set(const Keyword& keyword) {
    if (const std::string* name = keyword.find("NSET")) node_sets_.push_back(*name);
    while (next_data()) {
    }
  }

  void read_surface(const Keyword& keyword) {
    const std::string* name = keyword.find("NAME");
    const std::string* type = keyword.find("TYPE");
    if (!name || name->empty()) fail(keyword.line, "*SURFACE without NAME=");
    if (type && in_capitals(*type) != "ELEMENT") {
      other_surfaces_.push_back(*name);
      return;
    }
    std::vector<Side>& sides = surfaces_[*name];
    while (next_data()) {
      const std::vector<std::string_view> fields = fields_of(line_);
      const std::string side = fields.size() > 1 ? in_capitals(fields[1]) : "";
      if (side.size() != 2 || side[0] != 'S' || side[1] < '1' || side[1] > '4')
        fail(line_number_, "expected an element or set and its side S1 to S4, found " + in_quotes(line_));
      sides.push_back({in_capitals(fields[0]), side[1] - '0', line_number_});
    }
  }

  void note_section(const Keyword& keyword) {
    const std::string* set = keyword.find("ELSET");
    if (!set) fail(keyword.line, "*SOLID SECTION without ELSET=");
    sections_.emplace_back(in_capitals(*set), keyword.line);
  }

  void check_instance(const Keyword& keyword) {
    if (++instances_ > 1) fail(keyword.line, "a second *INSTANCE; save the assembly as one part");
    if (next_data())
      fail(line_number_, "the instance is translated or rotated; save the mesh without a transformation");
  }

  /// Collects the indices of the tets in a set and in the sets that it includes.
  void tets_of(const std::string& name, std::size_t line, std::set<std::string>& open,
               std::vector<Index>& tets) const {
    if (!open.insert(name).second) return;  // the set includes itself
    const auto block = block_sets_.find(name);
    const auto set = sets_.find(name);
    if (block == block_sets_.end() && set == sets_.end())
      fail(line, "there is no element set " + in_quotes(name));
    if (block != block_sets_.end())
      for (std::size_t t = 0; t < block_set_.size(); ++t)
        if (block_set_[t] == block->second) tets.push_back(static_cast<Index>(t));
    if (set == sets_.end()) return;
    for (const std::int64_t number : set->second.numbers)
      if (const Index t = elements_.find(number); t != no_index) tets.push_back(t);
    for (const std::string& other : set->second.sets) tets_of(other, line, open, tets);
  }

  /// Name of a material in the mesh that was written.
  const std::string& own_name(const std::string& in_upper_case, const std::string& written) const {
    const auto own = material_names_.find(in_upper_case);
    return own == material_names_.end() ? written : own->second;
  }

  void set_materials() {
    if (const std::optional<std::int64_t> twice = elements_.sort())
      in_.fail("element " + std::to_string(*twice) + " appears twice");
    TetMesh& mesh = result_.mesh;
    // Names of the sets in sections, or else in *ELEMENT lines, with their tets.
    std::vector<std::pair<std::string, std::vector<Index>>> materials;
    for (const auto& [set, line] : sections_) {
      std::set<std::string> open;
      std::vector<Index> tets;
      tets_of(set, line, open, tets);
      if (!tets.empty()) materials.emplace_back(set, std::move(tets));
    }
    if (materials.empty() && !(block_names_.size() == 1 && block_names_[0].empty())) {
      for (const std::string& name : block_names_) materials.emplace_back(name, std::vector<Index>{});
      for (std::size_t t = 0; t < block_set_.size(); ++t)
        materials[block_set_[t]].second.push_back(static_cast<Index>(t));
    }
    if (materials.empty()) return;
    std::set<MaterialTag> taken;
    for (const auto& [name, tets] : materials)
      if (const auto tag = tags_.find(name); tag != tags_.end()) taken.insert(tag->second);
    MaterialTag next = 1;
    const auto free_tag = [&] {
      while (taken.contains(next)) ++next;
      return next++;
    };
    constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();
    std::vector<std::int64_t> of_tets(mesh.tets.size(), none);
    for (const auto& [name, tets] : materials) {
      const auto known = tags_.find(name);
      const MaterialTag tag = known != tags_.end() ? known->second : free_tag();
      for (const Index t : tets) {
        if (of_tets[t] != none && of_tets[t] != tag) ++twice_;
        of_tets[t] = tag;
      }
      if (const auto text = set_names_.find(name); text != set_names_.end() && !text->second.empty())
        mesh.material_names[tag] = own_name(name, text->second);
    }
    const MaterialTag rest = free_tag();
    for (const std::int64_t tag : of_tets)
      mesh.materials.push_back(tag == none ? rest : static_cast<MaterialTag>(tag));
    result_.material_field = sections_.empty() ? "ELSET" : "SOLID SECTION";
  }

  void take_surfaces() {
    // Corners of each face.
    constexpr std::array<std::array<std::size_t, 3>, 4> corners{{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
    triangles_.name_form = [](const std::string& name) { return plain_name(name); };
    std::int64_t number = 0;
    for (const auto& [name, sides] : surfaces_) {
      const auto own = surface_names_.find(in_capitals(name));
      triangles_.names[++number] = own == surface_names_.end() ? name : own->second;
      for (const Side& side : sides) {
        std::vector<Index> tets;
        if (std::int64_t element = 0; parse_number(side.what, element)) {
          const Index t = elements_.find(element);
          if (t == no_index) {
            others_.add("faces of other elements in surfaces");
            continue;
          }
          tets.push_back(t);
        } else {
          std::set<std::string> open;
          tets_of(side.what, side.line, open, tets);
        }
        for (const Index t : tets) {
          const Tet& tet = result_.mesh.tets[t];
          const auto& c = corners[static_cast<std::size_t>(side.side - 1)];
          triangles_.add({tet[c[0]], tet[c[1]], tet[c[2]]}, number);
        }
      }
    }
  }

  void note_dropped() {
    std::vector<Dropped>& dropped = result_.dropped;
    others_.append_to(dropped);
    if (twice_ > 0) dropped.push_back({"tets in several sections; the last one is used", twice_});
    std::vector<std::string> sets;
    for (const std::string& name : node_sets_)
      if (!surfaces_.contains(name)) sets.push_back(name);
    append_dropped_names(dropped, "node sets", sets);
    append_dropped_names(dropped, "surfaces of nodes", other_surfaces_);
    if (sections_.empty()) {
      std::vector<std::string> names;
      for (const auto& [name, set] : sets_) names.push_back(set_names_.at(name));
      append_dropped_names(dropped, "element sets", names);
    }
  }

  TextScanner in_;
  std::string_view line_;
  std::size_t line_number_ = 0;
  bool pushed_back_ = false;  ///< true: line_ must be read again
  ReadTetMesh result_;
  FileNumbers nodes_, elements_;
  bool sorted_ = false;
  std::vector<std::uint32_t> block_set_;             ///< of each tet, as an index into block_names_
  std::map<std::string, std::uint32_t> block_sets_;  ///< by name in upper case
  std::vector<std::string> block_names_;             ///< in upper case; empty for *ELEMENT without ELSET
  std::map<std::string, Set> sets_;                  ///< by name in upper case
  std::map<std::string, std::string> set_names_;     ///< as spelled in the file, by name in upper case
  std::map<std::string, std::string> material_names_,
      surface_names_;                                          ///< from comments, by name in upper case
  std::map<std::string, MaterialTag> tags_;                    ///< from comments, by name in upper case
  std::vector<std::pair<std::string, std::size_t>> sections_;  ///< sets in upper case, with lines
  std::map<std::string, std::vector<Side>> surfaces_;
  std::vector<std::string> node_sets_, other_surfaces_;
  FileTriangles triangles_;
  MidsideNodesRead midside_;
  KindCounts volumes_, others_;
  std::size_t volumes_line_ = 0, twice_ = 0;
  int parts_ = 0, instances_ = 0;
};

}  // namespace

ReadTetMesh read_abaqus(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  return AbaqusReader(bytes, name).read(options);
}

}  // namespace tetwright
