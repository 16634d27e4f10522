// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/msh_elements.h"

#include <utility>

#include "tetwright/error.h"

namespace tetwright {

bool OtherMshElements::is_volume(std::int64_t type) {
  const ElementType* known = msh_element_type(type);
  return known && known->dimension == 3 && type != element::tet.msh;
}

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
  OfType& of_type = flat_[type];
  ++of_type.elements;
  if (group != 0) of_type.groups.insert(group);
}

void OtherMshElements::refuse_volumes(const std::string& file) const {
  if (volumes_.empty()) return;
  KindCounts counts;
  for (const auto& [type, count] : volumes_) {
    const ElementType* known = msh_element_type(type);
    counts.add(known ? known->name : "volume elements of an unknown type", count);
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
  for (const auto& [type, of_type] : flat_) {
    const ElementType* known = msh_element_type(type);
    std::vector<std::string> groups;
    for (std::int64_t group : of_type.groups) {
      if (known) used[known->dimension].insert(group);
      groups.push_back(known ? name_of(known->dimension, group) : std::to_string(group));
    }
    dropped.push_back({(known ? known->name : "elements of type " + std::to_string(type)) +
                           (groups.empty() ? "" : " of physical groups (" + quoted_list(groups) + ")"),
                       of_type.elements});
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
