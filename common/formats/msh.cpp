#include "common/formats/msh.h"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "common/error.h"
#include "common/formats/number_text.h"
#include "common/formats/text_scanner.h"
#include "common/interfaces.h"

namespace tetwright {

namespace {

constexpr std::int64_t triangle_type = 2;
constexpr std::int64_t tet_type = 4;

/// The file's numbers of its nodes, which need be neither dense nor sorted, and ours.
class NodeNumbers {
 public:
  void add(std::int64_t number) {
    dense_ = dense_ && number == std::ssize(numbers_) + 1;
    numbers_.emplace_back(number, static_cast<Index>(numbers_.size()));
  }
  /// A number that appears twice, if there is one; find() may be used afterwards.
  std::optional<std::int64_t> sort() {
    if (dense_) return std::nullopt;
    std::sort(numbers_.begin(), numbers_.end());
    const auto twice = std::adjacent_find(numbers_.begin(), numbers_.end(),
                                          [](const auto& a, const auto& b) { return a.first == b.first; });
    return twice == numbers_.end() ? std::nullopt : std::optional(twice->first);
  }
  /// no_index if there is no such node.
  Index find(std::int64_t number) const {
    if (dense_)
      return number >= 1 && number <= std::ssize(numbers_) ? static_cast<Index>(number - 1) : no_index;
    const auto at = std::lower_bound(numbers_.begin(), numbers_.end(), number,
                                     [](const auto& a, std::int64_t b) { return a.first < b; });
    return at != numbers_.end() && at->first == number ? at->second : no_index;
  }

 private:
  std::vector<std::pair<std::int64_t, Index>> numbers_;
  bool dense_ = true;
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : in_(bytes, name) {}

  ReadTetMesh read() {
    if (in_.at_end()) in_.fail("the file is empty");
    read_format();
    for (std::string_view section; !(section = in_.word()).empty();) {
      if (section[0] != '$') in_.fail("expected a section such as $Nodes, found " + in_quotes(section));
      if (section == "$PhysicalNames")
        read_names();
      else if (section == "$Nodes")
        read_nodes();
      else if (section == "$Elements")
        read_elements();
      else if (section == "$ParametricNodes")
        in_.fail("parametric nodes are not supported; save the file without them");
      else
        skip(section);
    }
    if (!has_elements_) in_.fail("there is no section $Elements in it; the file is cut short");
    TetMesh& mesh = result_.mesh;
    if (mesh.tets.empty())
      in_.fail("there are no tets of four points (type 4) in it; a volume mesh is needed, not a surface");
    if (any_tag_)
      result_.material_field = "gmsh:physical";
    else
      std::fill(mesh.materials.begin(), mesh.materials.end(), 1);
    mesh.material_names = std::move(names_);
    return std::move(result_);
  }

 private:
  void read_format() {
    if (const std::string_view word = in_.word(); word != "$MeshFormat")
      in_.fail("expected $MeshFormat at the beginning, found " + in_quotes(word) + "; is this a Gmsh file?");
    const std::string_view version = in_.word();
    if (!version.starts_with("2"))
      in_.fail("version " + in_quotes(version) +
               " of the format is not supported; save it as version 2.2 ASCII (gmsh -format msh22)");
    if (in_.word() != "0") in_.fail("binary files are not supported; save it as version 2.2 ASCII");
    (void)in_.integer("size of a number");
    expect("$EndMeshFormat");
  }

  void expect(std::string_view end) {
    const std::string_view word = in_.word();
    if (word.empty()) in_.fail_cut_short(end);
    if (word != end) in_.fail("expected " + std::string(end) + ", found " + in_quotes(word));
  }

  void skip(std::string_view section) {
    const std::string end = "$End" + std::string(section.substr(1));
    in_.skip_line();
    for (;;) {
      if (in_.at_end()) in_.fail_cut_short("line " + in_quotes(end));
      if (in_.word_on_line() == end) return;
      in_.skip_line();
    }
  }

  void read_names() {
    const std::size_t n = in_.count("number of physical names", 6);
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t dimension = in_.integer("dimension of a physical group");
      const std::int64_t tag = in_.integer("physical group");
      std::string_view name = in_.rest_of_line();
      const std::size_t open = name.find('"'), close = name.rfind('"');
      if (open == close)
        in_.fail("expected the name of a physical group in quotes, found " + in_quotes(name));
      name = name.substr(open + 1, close - open - 1);
      if (dimension == 3) names_[checked_material(tag, in_.name(), in_.line())] = std::string(name);
    }
    expect("$EndPhysicalNames");
  }

  void read_nodes() {
    if (!result_.mesh.points.empty()) in_.fail("a second section $Nodes");
    const std::size_t n = in_.count("number of nodes", 8);
    if (n >= no_index) in_.fail("more than " + std::to_string(no_index - 1) + " points; split the mesh");
    result_.mesh.points.resize(n);
    for (Vec3& p : result_.mesh.points) {
      nodes_.add(in_.integer("number of a node"));
      for (int k = 0; k < 3; ++k) p[k] = in_.coordinate();
    }
    expect("$EndNodes");
    if (const std::optional<std::int64_t> twice = nodes_.sort())
      in_.fail("node " + std::to_string(*twice) + " appears twice");
  }

  /// One element; in version 2 each has a line of its own.
  void read_element() {
    const std::int64_t number = in_.integer("number of an element");
    const std::int64_t type = in_.integer("type of an element");
    const std::int64_t tags = in_.integer("number of tags");
    if (type == tet_type) {
      std::int64_t physical = 0;
      for (std::int64_t k = 0; k < tags; ++k) {
        const std::int64_t tag = in_.integer("tag");
        if (k == 0) physical = tag;
      }
      any_tag_ = any_tag_ || tags > 0;
      Tet tet;
      for (Index& vertex : tet) {
        const std::int64_t node = in_.integer("node of a tet");
        vertex = nodes_.find(node);
        if (vertex == no_index)
          in_.fail("element " + std::to_string(number) + " names node " + std::to_string(node) +
                   ", which is not in $Nodes; export the file again");
      }
      result_.mesh.tets.push_back(tet);
      result_.mesh.materials.push_back(checked_material(physical, in_.name(), in_.line()));
    }
    in_.skip_line();
  }

  void read_elements() {
    if (has_elements_) in_.fail("a second section $Elements");
    if (result_.mesh.points.empty()) in_.fail("the elements come before the nodes, or there are no nodes");
    has_elements_ = true;
    const std::size_t n = in_.count("number of elements", 7);
    for (std::size_t i = 0; i < n; ++i) read_element();
    expect("$EndElements");
  }

  TextScanner in_;
  ReadTetMesh result_;
  NodeNumbers nodes_;
  std::map<MaterialTag, std::string> names_;
  bool has_elements_ = false;
  bool any_tag_ = false;
};

void append_name(std::string& out, int dimension, std::int64_t group, const std::string& name) {
  append_number(out, dimension);
  out += ' ';
  append_number(out, group);
  out += " \"";
  for (char c : name) out += c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ' ? '_' : c;
  out += "\"\n";
}

void append_element(std::string& out, std::size_t number, std::int64_t type, std::int64_t physical,
                    std::int64_t geometrical, std::span<const Index> points) {
  append_number(out, number);
  out += ' ';
  append_number(out, type);
  out += " 2 ";
  append_number(out, physical);
  out += ' ';
  append_number(out, geometrical);
  for (Index point : points) {
    out += ' ';
    append_number(out, std::uint64_t{point} + 1);
  }
  out += '\n';
}

}  // namespace

ReadTetMesh read_msh(std::string_view bytes, const std::string& name) { return Reader(bytes, name).read(); }

std::string write_msh(const TetMesh& mesh) {
  std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const std::vector<MaterialPair> groups = interface_groups(mesh.interfaces);
  if (!mesh.material_names.empty() || !groups.empty()) {
    out += "$PhysicalNames\n";
    append_number(out, groups.size() + mesh.material_names.size());
    out += '\n';
    for (std::size_t g = 0; g < groups.size(); ++g)
      append_name(out, 2, static_cast<std::int64_t>(g) + 1, pair_name(groups[g], mesh.material_names));
    for (const auto& [tag, name] : mesh.material_names) append_name(out, 3, tag, name);
    out += "$EndPhysicalNames\n";
  }
  out += "$Nodes\n";
  append_number(out, mesh.points.size());
  out += '\n';
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    append_number(out, i + 1);
    out += ' ';
    append_point(out, mesh.points[i]);
    out += '\n';
  }
  // Tets first: their numbers are the same with and without triangles, and simple readers look at the first
  // block of elements.
  out += "$EndNodes\n$Elements\n";
  append_number(out, mesh.tets.size() + mesh.interfaces.size());
  out += '\n';
  // The second tag is the geometrical entity: positive, one for each material, one for each pair.
  std::vector<MaterialTag> tags = mesh.materials;
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    append_element(out, t + 1, tet_type, mesh.materials[t],
                   std::lower_bound(tags.begin(), tags.end(), mesh.materials[t]) - tags.begin() + 1,
                   mesh.tets[t]);
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    const auto group = static_cast<std::int64_t>(group_number(groups, mesh.interfaces[i]));
    append_element(out, mesh.tets.size() + i + 1, triangle_type, group, group, mesh.interfaces[i].ids);
  }
  return out + "$EndElements\n";
}

}  // namespace tetwright
