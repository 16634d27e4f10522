// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/msh_elements.h"

#include <utility>

#include "common/error.h"

namespace tetwright {

namespace {

constexpr std::size_t unknown_dimension = 3;

struct ElementKind {
  std::string name;       ///< plural
  std::size_t dimension;  ///< unknown_dimension for unknown types
};

const std::map<std::int64_t, ElementKind>& flat_kinds() {
  static const std::map<std::int64_t, ElementKind> kinds{{15, {"points", 0}},
                                                         {1, {"lines", 1}},
                                                         {8, {"lines of 3 points", 1}},
                                                         {26, {"lines of 4 points", 1}},
                                                         {27, {"lines of 5 points", 1}},
                                                         {28, {"lines of 6 points", 1}},
                                                         {2, {"triangles", 2}},
                                                         {3, {"quads", 2}},
                                                         {9, {"triangles of 6 points", 2}},
                                                         {10, {"quads of 9 points", 2}},
                                                         {16, {"quads of 8 points", 2}},
                                                         {20, {"triangles of 9 points", 2}},
                                                         {21, {"triangles of 10 points", 2}},
                                                         {22, {"triangles of 12 points", 2}},
                                                         {23, {"triangles of 15 points", 2}}};
  return kinds;
}

ElementKind flat_kind(std::int64_t type) {
  const auto known = flat_kinds().find(type);
  return known != flat_kinds().end()
             ? known->second
             : ElementKind{"elements of type " + std::to_string(type), unknown_dimension};
}

/// Plural of a volume element's kind; null for other or unknown types.
const char* volume_kind(std::int64_t type) {
  switch (type) {
    case 5:
      return "hexahedra";
    case 12:
    case 17:
      return "quadratic hexahedra";
    case 92:
    case 93:
      return "hexahedra of higher order";
    case 6:
      return "prisms";
    case 13:
    case 18:
      return "quadratic prisms";
    case 90:
    case 91:
      return "prisms of higher order";
    case 7:
      return "pyramids";
    case 14:
    case 19:
      return "quadratic pyramids";
    case 118:
    case 119:
      return "pyramids of higher order";
    case 11:
      return "quadratic tets";
    case 29:
    case 30:
    case 31:
    case 71:
    case 72:
    case 73:
    case 74:
    case 75:
      return "tets of higher order";
    default:
      return nullptr;
  }
}

}  // namespace

std::size_t msh_nodes_of(std::int64_t type) {
  static const std::map<std::int64_t, std::size_t> nodes{
      {1, 2},   {2, 3},   {3, 4},   {4, 4},   {5, 8},   {6, 6},   {7, 5},   {8, 3},   {9, 6},
      {10, 9},  {11, 10}, {12, 27}, {13, 18}, {14, 14}, {15, 1},  {16, 8},  {17, 20}, {18, 15},
      {19, 13}, {20, 9},  {21, 10}, {22, 12}, {23, 15}, {24, 15}, {25, 21}, {26, 4},  {27, 5},
      {28, 6},  {29, 20}, {30, 35}, {31, 56}, {90, 40}, {91, 75}, {92, 64}, {93, 125}};
  const auto known = nodes.find(type);
  return known == nodes.end() ? 0 : known->second;
}

bool OtherMshElements::is_volume(std::int64_t type) { return volume_kind(type) != nullptr; }

void OtherMshElements::add_name(std::int64_t dimension, std::int64_t group, const std::string& name) {
  if (dimension == 2) triangles_.names[group] = name;
  if (dimension == 0 || dimension == 1 || dimension == 3)
    names_[static_cast<std::size_t>(dimension)][group] = name;
}

void OtherMshElements::add_further_group(std::size_t dimension, std::int64_t group) {
  further_groups_[dimension].insert(group);
}

void OtherMshElements::add_volume(std::int64_t type, std::int64_t element, std::size_t line) {
  if (volumes_.empty()) {
    first_volume_ = element;
    first_volume_type_ = type;
    first_volume_line_ = line;
  }
  ++volumes_[type];
}

void OtherMshElements::add_flat(std::int64_t type, std::int64_t group) {
  OfKind& kind = flat_[type];
  ++kind.elements;
  if (group != 0) kind.groups.insert(group);
}

void OtherMshElements::refuse_volumes(const std::string& file) const {
  if (volumes_.empty()) return;
  KindCounts counts;
  for (const auto& [type, count] : volumes_) {
    const char* kind = volume_kind(type);
    counts.add(kind ? kind : "volume elements of an unknown type", count);
  }
  throw InputError(file, first_volume_line_,
                   unsupported_cells(counts, "element " + std::to_string(first_volume_) + " (type " +
                                                 std::to_string(first_volume_type_) + ")"));
}

void OtherMshElements::finish(const std::string& file, ReadTetMesh& read) const {
  take_triangles(triangles_, "physical group", file, read);
  note_dropped(read.dropped);
}

TriangleMesh OtherMshElements::surface(std::vector<Vec3> points, const std::string& file,
                                       std::vector<Dropped>* dropped) const {
  if (dropped) note_dropped(*dropped);
  return surface_of(triangles_, std::move(points), file);
}

void OtherMshElements::note_dropped(std::vector<Dropped>& dropped) const {
  const auto name_of = [&](std::size_t dimension, std::int64_t group) {
    const auto known = names_of(dimension).find(group);
    return known == names_of(dimension).end() ? std::to_string(group) : known->second;
  };
  std::array<std::set<std::int64_t>, 3> used;
  used[2].insert(triangles_.groups.begin(), triangles_.groups.end());
  for (const auto& [type, of_kind] : flat_) {
    const ElementKind kind = flat_kind(type);
    std::vector<std::string> groups;
    for (std::int64_t group : of_kind.groups) {
      const bool known = kind.dimension < unknown_dimension;
      if (known) used[kind.dimension].insert(group);
      groups.push_back(known ? name_of(kind.dimension, group) : std::to_string(group));
    }
    dropped.push_back(
        {kind.name + (groups.empty() ? "" : " of physical groups (" + quoted_list(groups) + ")"),
         of_kind.elements});
  }
  std::vector<std::string> unused;
  for (std::size_t dimension = 0; dimension < used.size(); ++dimension)
    for (const auto& [group, name] : names_of(dimension))
      if (!used[dimension].contains(group) && !further_groups_[dimension].contains(group))
        unused.push_back(name);
  append_dropped_names(dropped, "physical groups of points, lines or faces, without elements", unused);
  std::vector<std::string> further;
  for (std::size_t dimension = 0; dimension < further_groups_.size(); ++dimension)
    for (const std::int64_t group : further_groups_[dimension]) further.push_back(name_of(dimension, group));
  append_dropped_names(dropped, "further physical groups of entities", further);
}

}  // namespace tetwright
