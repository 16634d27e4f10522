#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "common/error.h"
#include "common/formats/byte_order.h"
#include "common/formats/mesh_fields.h"
#include "common/formats/midside_nodes_read.h"
#include "common/formats/msh.h"
#include "common/formats/msh_data.h"
#include "common/formats/msh_elements.h"
#include "common/formats/msh_numbers.h"
#include "common/formats/text_scanner.h"

namespace tetwright {

namespace {

/// The number of a group of faces, or of what is less: where a sign is, Gmsh means the other orientation.
std::int64_t without_sign(std::int64_t number) {
  return number < 0 && number != std::numeric_limits<std::int64_t>::min() ? -number : number;
}

class MshReader {
 public:
  MshReader(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options)
      : in_(bytes, name), options_(options), bytes_(bytes) {}

  ReadTetMesh read() {
    read_sections();
    if (result_.mesh.tets.empty())
      in_.fail("there are no tets (type 4 or 11) in it; a volume mesh is needed, not a surface");
    read_data();
    midside_.remove_from(result_, others_.triangles());
    set_materials();
    note_dropped();
    return std::move(result_);
  }

  TriangleMesh read_surface(std::vector<Dropped>* dropped) {
    surface_ = true;
    read_sections();
    if (!result_.mesh.tets.empty()) throw InputError(in_.name() + surface_expected(result_.mesh.tets.size()));
    TriangleMesh surface = others_.surface(std::move(result_.mesh.points), in_.name(), dropped);
    if (!dropped) return surface;
    for (const auto& [section, places] :
         {std::pair("fields of nodes", &node_data_), std::pair("fields of elements", &element_data_)})
      if (!places->empty()) dropped->push_back({section, places->size()});
    append_dropped_names(*dropped, "sections", other_sections_);
    return surface;
  }

  std::optional<SurfaceWithFields> read_surface_with_fields() {
    surface_ = true;
    read_sections();
    if (!result_.mesh.tets.empty()) return {};
    std::size_t room = bytes_.size();
    read_node_data(room);
    return SurfaceWithFields{others_.surface(std::move(result_.mesh.points), in_.name(), nullptr),
                             std::move(result_.mesh.point_fields)};
  }

 private:
  void read_sections() {
    if (in_.at_end()) in_.fail("the file is empty");
    read_format();
    for (std::string_view section; !(section = in_.word()).empty();) {
      if (section[0] != '$') in_.fail("expected a section such as $Nodes, found " + in_quotes(section));
      if (section == "$PhysicalNames")
        read_names();
      else if (section == "$Nodes")
        version_4_ ? read_nodes_4() : read_nodes_2();
      else if (section == "$Elements")
        version_4_ ? read_elements_4() : read_elements_2();
      else if (section == "$Entities" && version_4_)
        read_entities();
      else if (section == "$PartitionedEntities")
        in_.fail("the mesh is partitioned; save it as one (gmsh -part 0, or Mesh > Unpartition)");
      else if (section == "$ParametricNodes")
        in_.fail("parametric nodes are not supported; save the file without them");
      else
        keep_or_skip(section);
    }
    if (!has_elements_) in_.fail("there is no section $Elements in it; the file is cut short");
    others_.refuse_volumes(in_.name());
  }

  void read_format() {
    if (const std::string_view word = in_.word(); word != "$MeshFormat")
      in_.fail("expected $MeshFormat at the beginning, found " + in_quotes(word) + "; is this a Gmsh file?");
    const std::string_view version = in_.word();
    version_4_ = version == "4.1" || version == "4" || version == "4.0";
    version_40_ = version_4_ && version != "4.1";
    if (!version.starts_with("2") && !version_4_)
      in_.fail("version " + in_quotes(version) +
               " of the format is not supported; save it as version 2.2, 4.0 or 4.1 (gmsh -format msh41)");
    const std::int64_t type = in_.integer("type of the file");
    if (type != 0 && type != 1)
      in_.fail("the type of the file is " + std::to_string(type) + "; 0 (ASCII) and 1 (binary) are known");
    const std::int64_t size = in_.integer("size of a number");
    if (type == 1) {
      if (size != 8 && !(size == 4 && version_4_))
        in_.fail("numbers of " + std::to_string(size) + " bytes; 8 are known");
      in_.skip_line();
      const std::string_view one = in_.take_bytes(sizeof(std::int32_t));
      if (one.size() < sizeof(std::int32_t)) in_.fail_cut_short("number 1, which tells the order of bytes");
      const bool as_is = load<std::int32_t>(one.data(), false) == 1;
      if (!as_is && load<std::int32_t>(one.data(), true) != 1)
        in_.fail("a 1 as four bytes was expected, which tells their order; the file is damaged");
      numbers_.set_binary(!as_is, static_cast<std::size_t>(size));
    }
    expect("$EndMeshFormat");
  }

  void expect(std::string_view end) {
    const std::string_view word = in_.word();
    if (word.empty()) in_.fail_cut_short(end);
    if (word != end) in_.fail("expected " + std::string(end) + ", found " + in_quotes(word));
  }

  /// Sections of data are read when all nodes and elements are known: a copy of the scanner keeps their
  /// place.
  void keep_or_skip(std::string_view section) {
    if (section == "$NodeData") node_data_.push_back(in_);
    if (section == "$ElementData") element_data_.push_back(in_);
    if (section != "$NodeData" && section != "$ElementData" && section != "$Comments")
      other_sections_.emplace_back(section);
    const std::string end = "$End" + std::string(section.substr(1));
    in_.skip_line();
    if (section == "$Comments") {
      read_comments(end);
      return;
    }
    if (numbers_.binary()) {
      // Line feeds in binary numbers begin no lines.
      const std::size_t at = bytes_.find(end, in_.offset());
      if (at == std::string_view::npos) in_.fail_cut_short("line " + in_quotes(end));
      (void)in_.take_bytes(at - in_.offset());
      expect(end);
      return;
    }
    for (;;) {
      if (in_.at_end()) in_.fail_cut_short("line " + in_quotes(end));
      if (in_.word_on_line() == end) return;
      in_.skip_line();
    }
  }

  /// Those of write_msh41() tell which materials have tags that are no numbers of groups.
  void read_comments(const std::string& end) {
    for (;;) {
      if (in_.left() == 0) in_.fail_cut_short("line " + in_quotes(end));
      const std::size_t line = in_.line();
      const std::string_view text = in_.rest_of_line();
      if (text.starts_with(end)) return;
      if (!text.starts_with(msh_material_comment)) continue;
      TextScanner numbers(text.substr(std::string_view(msh_material_comment).size()), in_.name());
      std::int64_t group = 0, tag = 0;
      if (parse_number(numbers.word(), group) && parse_number(numbers.word(), tag))
        group_to_tag_[group] = checked_material(tag, in_.name(), line);
    }
  }

  /// The material of a physical group of tets.
  std::int64_t tag_of(std::int64_t group) const {
    const auto known = group_to_tag_.find(group);
    return known == group_to_tag_.end() ? group : known->second;
  }

  void read_names() {
    const std::size_t n = in_.count("number of physical names", 6);
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t dimension = in_.integer("dimension of a physical group");
      std::int64_t tag = in_.integer("physical group");
      if (dimension != 3) tag = without_sign(tag);
      const std::size_t line = in_.line();
      std::string_view name = in_.rest_of_line();
      const std::size_t open = name.find('"'), close = name.rfind('"');
      if (open == close)
        throw InputError(in_.name(), line,
                         "expected the name of a physical group in quotes, found " + in_quotes(name));
      name = name.substr(open + 1, close - open - 1);
      if (dimension == 2) {
        const auto [known, added] = surface_names_.emplace(std::string(name), tag);
        if (!added && known->second != tag)
          throw InputError(in_.name(), line,
                           "the physical surfaces " + std::to_string(known->second) + " and " +
                               std::to_string(tag) + " are both called " + in_quotes(name) +
                               "; give one of them another name, or both the same number");
      }
      others_.add_name(dimension, tag, std::string(name));
      if (dimension == 3)
        result_.mesh.material_names[checked_material(tag_of(tag), in_.name(), line)] = std::string(name);
    }
    expect("$EndPhysicalNames");
  }

  Vec3 read_point() {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = numbers_.coordinate();
    return p;
  }

  std::size_t begin_nodes(std::size_t n) {
    if (n >= no_index) in_.fail("more than " + std::to_string(no_index - 1) + " points; split the mesh");
    return n;
  }

  void end_nodes() {
    expect("$EndNodes");
    if (const std::optional<std::int64_t> twice = nodes_.sort())
      in_.fail("node " + std::to_string(*twice) + " appears twice");
  }

  void read_nodes_2() {
    if (!result_.mesh.points.empty()) in_.fail("a second section $Nodes");
    result_.mesh.points.resize(begin_nodes(in_.count("number of nodes", 8)));
    numbers_.begin_binary();
    for (Vec3& p : result_.mesh.points) {
      nodes_.add(numbers_.integer("number of a node"));
      p = read_point();
    }
    end_nodes();
  }

  void read_nodes_4() {
    if (!result_.mesh.points.empty()) in_.fail("a second section $Nodes");
    numbers_.begin_binary();
    const std::size_t blocks = numbers_.count("number of blocks of nodes", 8, 20);
    const std::size_t n = begin_nodes(numbers_.count("number of nodes", 8, 28));
    read_range_of_numbers();
    std::vector<std::int64_t> order;
    order.reserve(n);
    result_.mesh.points.reserve(n);
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = read_entity().dimension;
      const std::int64_t parametric = numbers_.integer("flag of parametric nodes");
      if (parametric != 0 && parametric != 1)
        in_.fail("the flag of parametric nodes is 0 or 1, not " + std::to_string(parametric));
      const std::size_t in_block = numbers_.count("number of nodes", 8, 28);
      if (in_block > n - result_.mesh.points.size())
        in_.fail("the blocks have more nodes than the " + std::to_string(n) + " that $Nodes promises");
      const auto read_place = [&] {
        result_.mesh.points.push_back(read_point());
        for (std::int64_t k = 0; k < dimension * parametric; ++k)
          (void)numbers_.number("parameter of a node");
      };
      if (version_40_) {
        for (std::size_t i = 0; i < in_block; ++i) {
          order.push_back(numbers_.integer("number of a node"));
          read_place();
        }
      } else {
        for (std::size_t i = 0; i < in_block; ++i) order.push_back(numbers_.size("number of a node"));
        for (std::size_t i = 0; i < in_block; ++i) read_place();
      }
    }
    if (result_.mesh.points.size() != n)
      in_.fail("the blocks have " + std::to_string(result_.mesh.points.size()) + " nodes, but " +
               std::to_string(n) + " were promised; the file is damaged");
    sort_by(order, result_.mesh.points);
    for (const std::int64_t number : order) nodes_.add(number);
    end_nodes();
  }

  /// The smallest and the largest number of a node or element.
  void read_range_of_numbers() {
    if (version_40_) return;
    (void)numbers_.size("smallest number");
    (void)numbers_.size("largest number");
  }

  struct EntityName {
    std::int64_t dimension, number;
  };

  EntityName read_entity() {
    EntityName entity{};
    // Version 4.0 has them the other way round.
    for (const bool dimension : {!version_40_, version_40_}) {
      if (!dimension) {
        entity.number = numbers_.integer("number of an entity");
        continue;
      }
      entity.dimension = numbers_.integer("dimension of an entity");
      if (entity.dimension < 0 || entity.dimension > 3)
        in_.fail("dimension " + std::to_string(entity.dimension) + " of an entity; 0 to 3 are known");
    }
    return entity;
  }

  /// Where the numbers that a file gives its items are 1 to n in another order, sorts these and what it gives
  /// for each in the same way: files list items by entity, but ours are numbered in the order that they had.
  template <class... Values>
  static void sort_by(std::vector<std::int64_t>& numbers, std::vector<Values>&... values) {
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> order(numbers.size(), none);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] < 1 || numbers[i] > std::ssize(numbers)) return;
      std::size_t& place = order[static_cast<std::size_t>(numbers[i] - 1)];
      if (place != none) return;  // twice
      place = i;
    }
    const auto apply = [&](auto& items) {
      auto sorted = items;
      for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = items[order[i]];
      items = std::move(sorted);
    };
    apply(numbers);
    (apply(values), ...);
  }

  void read_entities() {
    numbers_.begin_binary();
    std::array<std::size_t, 4> counts{};
    for (std::size_t& n : counts) n = numbers_.count("number of entities", 2, 4);
    for (std::size_t dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < counts[dimension]; ++i) {
        const auto number = [&](const char* what) {
          const std::int64_t value = numbers_.integer(what);
          return dimension < 3 ? without_sign(value) : value;
        };
        const std::int64_t tag = number("number of an entity");
        const int bounds = dimension == 0 && !version_40_ ? 3 : 6;
        for (int k = 0; k < bounds; ++k) (void)numbers_.number("bound of an entity");
        const std::size_t physical = numbers_.count("number of physical groups", 2, 4);
        for (std::size_t k = 0; k < physical; ++k) {
          const std::int64_t group = number("physical group");
          if (k == 0) entity_to_group_[dimension][tag] = group;
          if (k > 0) others_.add_further_group(dimension, group);
        }
        if (dimension == 0) continue;
        const std::size_t bounding = numbers_.count("number of bounding entities", 2, 4);
        for (std::size_t k = 0; k < bounding; ++k) (void)numbers_.integer("bounding entity");
      }
    expect("$EndEntities");
  }

  void begin_elements() {
    if (has_elements_) in_.fail("a second section $Elements");
    if (result_.mesh.points.empty()) in_.fail("the elements come before the nodes, or there are no nodes");
    has_elements_ = true;
    keep_numbers_ = version_4_ || bytes_.find("$ElementData") != std::string_view::npos;
  }

  /// In binary files of version 4.1 numbers of nodes and elements are sizes.
  std::int64_t read_node(const char* what) {
    return version_4_ && !version_40_ ? numbers_.size(what) : numbers_.integer(what);
  }

  /// Nodes that are not there are an error if they are `needed`.
  template <class Ids>
  Ids read_ids(std::int64_t element, bool needed, const char* what) {
    Ids ids;
    for (Index& vertex : ids) {
      const std::int64_t node = read_node(what);
      vertex = nodes_.find(node);
      if (needed && vertex == no_index)
        in_.fail("element " + std::to_string(element) + " names node " + std::to_string(node) +
                 ", which is not in $Nodes; export the file again");
    }
    return ids;
  }

  /// False: faces of this type are not taken. Beside tets quads are no faces.
  bool read_face(std::int64_t type, std::int64_t element, std::int64_t group) {
    if (type == msh_triangle_type || type == msh_quadratic_triangle_type) {
      others_.add_triangle(read_ids<Triangle>(element, surface_, "node of a triangle"), without_sign(group));
      if (type == msh_quadratic_triangle_type)
        midside_.add_triangle(read_ids<Triangle>(element, surface_, "node of a triangle"));
    } else if (type == msh_quad_type && surface_) {
      others_.add_quad(read_ids<std::array<Index, 4>>(element, true, "node of a quad"), without_sign(group));
    } else {
      return false;
    }
    return true;
  }

  /// Of four nodes, or of ten, of which the corners come first.
  void read_tet(std::int64_t type, std::int64_t element) {
    const Tet tet = read_ids<Tet>(element, true, "node of a tet");
    result_.mesh.tets.push_back(tet);
    if (type == msh_quadratic_tet_type)
      midside_.add_tet(read_ids<std::array<Index, 6>>(element, true, "node of a tet"));
    if (keep_numbers_) tet_numbers_.push_back(element);
  }

  static bool is_tet(std::int64_t type) { return type == msh_tet_type || type == msh_quadratic_tet_type; }

  /// Skips the nodes of an element, of which text has those of its line.
  void skip_nodes(std::int64_t type) {
    if (!numbers_.binary()) {
      in_.skip_line();
      return;
    }
    const std::size_t n = msh_nodes_of(type);
    if (n == 0)
      in_.fail("elements of the unknown type " + std::to_string(type) + "; export the file as ASCII");
    for (std::size_t k = 0; k < n; ++k) (void)read_node("node of an element");
  }

  /// In version 2 each element has a line of its own: number, type, tags, nodes. Binary ones have the type
  /// and the number of tags once for several.
  void read_elements_2() {
    begin_elements();
    const std::size_t n = in_.count("number of elements", 7);
    numbers_.begin_binary();
    std::int64_t type = 0, tags = 0, in_block = 0;
    for (std::size_t i = 0; i < n; ++i) {
      std::int64_t element = 0;
      if (!numbers_.binary()) {
        element = in_.integer("number of an element");
        type = in_.integer("type of an element");
        tags = in_.integer("number of tags");
      } else {
        if (in_block == 0) {
          type = numbers_.integer("type of an element");
          in_block = numbers_.integer("number of elements");
          tags = numbers_.integer("number of tags");
          if (in_block < 1) in_.fail("a block of " + std::to_string(in_block) + " elements; it is damaged");
        }
        --in_block;
        element = numbers_.integer("number of an element");
      }
      std::int64_t physical = 0, geometrical = 0;
      for (std::int64_t k = 0; k < tags; ++k) {
        const std::int64_t tag = numbers_.integer("tag");
        if (k == 0) physical = tag;
        if (k == 1) geometrical = tag;
      }
      if (is_tet(type)) {
        any_physical_ = any_physical_ || tags > 0;
        any_geometrical_ = any_geometrical_ || tags > 1;
        partitioned_ += tags > 2;
        add_groups(physical, geometrical);
        read_tet(type, element);
      } else if (OtherMshElements::is_volume(type)) {
        others_.add_volume(type, element, in_.line());
        skip_nodes(type);
        continue;
      } else if (!read_face(type, element, physical)) {
        others_.add_flat(type, without_sign(physical));
        skip_nodes(type);
        continue;
      }
      if (!numbers_.binary()) in_.skip_line();
    }
    if (in_block > 0) in_.fail("the last block has more elements than $Elements promises; it is damaged");
    expect("$EndElements");
    end_elements();
  }

  void read_elements_4() {
    begin_elements();
    numbers_.begin_binary();
    const std::size_t blocks = numbers_.count("number of blocks of elements", 8, 20);
    const std::size_t n = numbers_.count("number of elements", 4, 8);
    read_range_of_numbers();
    std::size_t done = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      auto [dimension, entity] = read_entity();
      if (dimension < 3) entity = without_sign(entity);
      const std::int64_t type = numbers_.integer("type of an element");
      const std::size_t in_block = numbers_.count("number of elements", 4, 8);
      if (in_block > n - done)
        in_.fail("the blocks have more elements than the " + std::to_string(n) + " that $Elements promises");
      done += in_block;
      const auto& groups = entity_to_group_[static_cast<std::size_t>(dimension)];
      const auto found = groups.find(entity);
      const std::int64_t group = found == groups.end() ? 0 : found->second;
      if (is_tet(type) && in_block > 0) {
        any_physical_ = any_physical_ || found != groups.end();
        any_geometrical_ = true;
      }
      for (std::size_t i = 0; i < in_block; ++i) {
        const std::int64_t element = read_node("number of an element");
        if (is_tet(type)) {
          add_groups(group, entity);
          read_tet(type, element);
        } else if (dimension == 3 || OtherMshElements::is_volume(type)) {
          others_.add_volume(type, element, in_.line());
          skip_nodes(type);
        } else if (!read_face(type, element, group)) {
          others_.add_flat(type, group);
          skip_nodes(type);
        }
      }
    }
    if (done != n)
      in_.fail("the blocks have " + std::to_string(done) + " elements, but " + std::to_string(n) +
               " were promised; the file is damaged");
    expect("$EndElements");
    end_elements();
  }

  void end_elements() {
    TetMesh& mesh = result_.mesh;
    if (geometrical_.empty())
      sort_by(tet_numbers_, mesh.tets, mesh.materials);
    else
      sort_by(tet_numbers_, mesh.tets, mesh.materials, geometrical_);
    for (const std::int64_t number : tet_numbers_) elements_.add(number);
  }

  void add_groups(std::int64_t physical, std::int64_t geometrical) {
    if (volumes_.empty() || last_volume_ != std::pair(physical, geometrical)) {
      last_volume_ = {physical, geometrical};
      volumes_.insert(last_volume_);
    }
    result_.mesh.materials.push_back(checked_material(tag_of(physical), in_.name(), in_.line()));
    // Version 2 has physical groups wherever it has others.
    if (version_4_ || options_.material_field == geometrical_name)
      geometrical_.push_back(checked_material(geometrical, in_.name(), in_.line()));
  }

  /// `room` is that of read_msh_data().
  void read_node_data(std::size_t& room) {
    for (TextScanner& in : node_data_) {
      MeshField field = read_msh_data(in, numbers_, "node", nodes_, result_.mesh.points.size(), false, room);
      if (field.values.empty())
        empty_fields_.push_back(field.name);
      else
        result_.mesh.point_fields.push_back(std::move(field));
    }
  }

  void read_data() {
    const TetMesh& mesh = result_.mesh;
    std::size_t room = bytes_.size();
    read_node_data(room);
    if (element_data_.empty()) return;
    if (const std::optional<std::int64_t> twice = elements_.sort())
      in_.fail("element " + std::to_string(*twice) + " appears twice");
    for (TextScanner& in : element_data_) {
      MeshField field = read_msh_data(in, numbers_, "element", elements_, mesh.tets.size(), true, room);
      if (field.values.empty())
        fields_of_others_.push_back(field.name);
      else
        result_.mesh.cell_fields.push_back(std::move(field));
    }
  }

  void set_materials() {
    TetMesh& mesh = result_.mesh;
    std::vector<std::string> also;
    const bool asked = options_.material_field == geometrical_name;
    if (any_geometrical_ && (asked || (version_4_ && !any_physical_))) {
      mesh.materials = std::move(geometrical_);
      result_.material_field = geometrical_name;
      // The names are those of physical groups.
      mesh.material_names.clear();
    } else if (any_physical_) {
      result_.material_field = "gmsh:physical";
      if (any_geometrical_) also.emplace_back(geometrical_name);
    }
    take_material(result_, options_, in_.name(), also);
  }

  void note_dropped() {
    others_.finish(in_.name(), result_);
    std::vector<Dropped>& dropped = result_.dropped;
    // Nothing is lost if each physical group has one volume only.
    std::set<std::int64_t> physical;
    for (const auto& volume : volumes_) physical.insert(volume.first);
    if (result_.material_field == "gmsh:physical" && volumes_.size() > physical.size())
      dropped.push_back(
          {"numbers of volumes within the physical groups; --material-field gmsh:geometrical takes them as "
           "materials",
           volumes_.size()});
    if (partitioned_ > 0) dropped.push_back({"tets with numbers of partitions", partitioned_});
    append_dropped_names(dropped, "fields without a value", empty_fields_);
    append_dropped_names(dropped, "fields of elements other than tets", fields_of_others_);
    append_dropped_names(dropped, "sections", other_sections_);
  }

  static constexpr const char* geometrical_name = "gmsh:geometrical";

  TextScanner in_;
  MshNumbers numbers_{in_};
  const ReadTetMeshOptions& options_;
  std::string_view bytes_;
  ReadTetMesh result_;
  FileNumbers nodes_, elements_;
  /// The first physical group of the entities of each dimension.
  std::array<std::unordered_map<std::int64_t, std::int64_t>, 4> entity_to_group_;
  std::vector<MaterialTag> geometrical_;
  std::vector<std::int64_t> tet_numbers_;
  MidsideNodesRead midside_;
  std::map<std::int64_t, MaterialTag> group_to_tag_;  ///< where comments of write_msh41() say so
  std::vector<TextScanner> node_data_, element_data_;
  OtherMshElements others_;
  std::map<std::string, std::int64_t> surface_names_;        ///< physical groups of faces
  std::set<std::pair<std::int64_t, std::int64_t>> volumes_;  ///< physical and geometrical number of the tets
  std::pair<std::int64_t, std::int64_t> last_volume_;
  std::size_t partitioned_ = 0;
  std::vector<std::string> empty_fields_, fields_of_others_, other_sections_;  ///< names of what is not taken
  bool surface_ = false;  ///< a surface is wanted, and no tets
  bool version_4_ = false, version_40_ = false;
  bool has_elements_ = false;
  bool any_physical_ = false, any_geometrical_ = false;
  bool keep_numbers_ = false;  ///< of the tets: there are fields that refer to them, or they are out of order
};

}  // namespace

ReadTetMesh read_msh(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  return MshReader(bytes, name, options).read();
}

TriangleMesh read_msh_surface(std::string_view bytes, const std::string& name,
                              std::vector<Dropped>* dropped) {
  const ReadTetMeshOptions options;
  return MshReader(bytes, name, options).read_surface(dropped);
}

std::optional<SurfaceWithFields> read_msh_surface_with_fields(std::string_view bytes,
                                                              const std::string& name) {
  const ReadTetMeshOptions options;
  return MshReader(bytes, name, options).read_surface_with_fields();
}

}  // namespace tetwright
