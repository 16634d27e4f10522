// SPDX-License-Identifier: Apache-2.0
#include "common/io/names/mesh_fields.h"
#include "common/io/tets/msh_reader.h"
#include "tetwright/error.h"
#include "tetwright/parted_interfaces.h"

namespace tetwright {

namespace {

/// Sorts items and their values by number if the numbers are a permutation of 1 to n. Files list items by
/// entity; this restores the original order.
template <class... Values>
void sort_by(std::vector<std::int64_t>& numbers, std::vector<Values>&... values) {
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> order(numbers.size(), none);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] < 1 || numbers[i] > std::ssize(numbers)) return;
    std::size_t& place = order[static_cast<std::size_t>(numbers[i] - 1)];
    if (place != none) return;  // repeated number
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

}  // namespace

Vec3 MshReader::read_point() {
  Vec3 p;
  for (int k = 0; k < 3; ++k) p[k] = numbers_.coordinate();
  return p;
}

std::size_t MshReader::begin_nodes(std::size_t n) {
  if (n >= no_index) in_.fail("more than " + std::to_string(no_index - 1) + " points; split the mesh");
  return n;
}

void MshReader::end_nodes() {
  expect("$EndNodes");
  if (const std::optional<std::int64_t> twice = nodes_.sort())
    in_.fail("node " + std::to_string(*twice) + " appears twice");
}

void MshReader::read_nodes_2() {
  if (!result_.mesh.points.empty()) in_.fail("a second section $Nodes");
  result_.mesh.points.resize(begin_nodes(in_.count("number of nodes", 8)));
  numbers_.begin_binary();
  for (Vec3& p : result_.mesh.points) {
    nodes_.add(numbers_.integer("number of a node"));
    p = read_point();
  }
  end_nodes();
}

void MshReader::read_nodes_4() {
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
      in_.fail("the blocks have more nodes than the " + std::to_string(n) + " that $Nodes gives");
    const auto read_place = [&] {
      result_.mesh.points.push_back(read_point());
      for (std::int64_t k = 0; k < dimension * parametric; ++k) (void)numbers_.number("parameter of a node");
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
             std::to_string(n) + " were expected; the file is damaged");
  sort_by(order, result_.mesh.points);
  for (const std::int64_t number : order) nodes_.add(number);
  end_nodes();
}

void MshReader::read_range_of_numbers() {
  if (version_40_) return;
  (void)numbers_.size("smallest number");
  (void)numbers_.size("largest number");
}

MshReader::EntityName MshReader::read_entity() {
  EntityName entity{};
  // Version 4.0 has the two in reverse order.
  for (const bool dimension : {!version_40_, version_40_}) {
    if (!dimension) {
      entity.number = numbers_.integer("number of an entity");
      continue;
    }
    entity.dimension = numbers_.integer("dimension of an entity");
    if (entity.dimension < 0 || entity.dimension > 3)
      in_.fail("dimension " + std::to_string(entity.dimension) + " of an entity; 0 to 3 are possible");
  }
  return entity;
}

void MshReader::read_entities() {
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

void MshReader::begin_elements() {
  if (has_elements_) in_.fail("a second section $Elements");
  if (result_.mesh.points.empty()) in_.fail("the elements come before the nodes, or there are no nodes");
  has_elements_ = true;
  keep_numbers_ = version_4_ || bytes_.find("$ElementData") != std::string_view::npos;
}

bool MshReader::read_face(std::int64_t type, std::int64_t element, std::int64_t group) {
  if (type == element::triangle.msh || type == element::quadratic_triangle.msh) {
    others_.add_triangle(read_ids<Triangle>(element, surface_, "node of a triangle"), without_sign(group));
    if (type == element::quadratic_triangle.msh)
      midside_.add_triangle(read_ids<Triangle>(element, surface_, "node of a triangle"));
  } else if (type == element::quad.msh && surface_) {
    others_.add_quad(read_ids<std::array<Index, 4>>(element, true, "node of a quad"), without_sign(group));
  } else {
    return false;
  }
  return true;
}

void MshReader::read_tet(std::int64_t type, std::int64_t element) {
  const Tet tet = read_ids<Tet>(element, true, "node of a tet");
  result_.mesh.tets.push_back(tet);
  if (type == element::quadratic_tet.msh)
    midside_.add_tet(read_ids<std::array<Index, 6>>(element, true, "node of a tet"));
  if (keep_numbers_) tet_numbers_.push_back(element);
}

void MshReader::read_wedge(std::int64_t element) {
  const std::size_t line = in_.line();
  const Wedge wedge = read_ids<Wedge>(element, true, "node of a prism");
  if (is_cohesive(wedge, result_.mesh.points))
    result_.mesh.wedges.push_back(wedge);
  else
    others_.add_volume(element::wedge.msh, element, line);
}

void MshReader::skip_nodes(std::int64_t type) {
  if (!numbers_.binary()) {
    in_.skip_line();
    return;
  }
  const ElementType* known = msh_element_type(type);
  const std::size_t n = known ? known->nodes : 0;
  if (n == 0) in_.fail("elements of the unknown type " + std::to_string(type) + "; export the file as ASCII");
  for (std::size_t k = 0; k < n; ++k) (void)read_node("node of an element");
}

void MshReader::read_elements_2() {
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
    } else if (type == element::wedge.msh) {
      read_wedge(element);
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
  if (in_block > 0) in_.fail("the last block has more elements than $Elements gives; it is damaged");
  expect("$EndElements");
  end_elements();
}

void MshReader::read_elements_4() {
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
      in_.fail("the blocks have more elements than the " + std::to_string(n) + " that $Elements gives");
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
      } else if (type == element::wedge.msh) {
        read_wedge(element);
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
             " were expected; the file is damaged");
  expect("$EndElements");
  end_elements();
}

void MshReader::end_elements() {
  TetMesh& mesh = result_.mesh;
  if (geometrical_.empty())
    sort_by(tet_numbers_, mesh.tets, mesh.materials);
  else
    sort_by(tet_numbers_, mesh.tets, mesh.materials, geometrical_);
  for (const std::int64_t number : tet_numbers_) elements_.add(number);
}

void MshReader::add_groups(std::int64_t physical, std::int64_t geometrical) {
  if (volumes_.empty() || last_volume_ != std::pair(physical, geometrical)) {
    last_volume_ = {physical, geometrical};
    volumes_.insert(last_volume_);
  }
  result_.mesh.materials.push_back(checked_material(tag_of(physical), in_.name(), in_.line()));
  // In version 2, elements with a geometrical group also have a physical one.
  if (version_4_ || options_.material_field == geometrical_name)
    geometrical_.push_back(checked_material(geometrical, in_.name(), in_.line()));
}

}  // namespace tetwright
