#include "common/formats/msh.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/formats/msh_data.h"
#include "common/formats/msh_elements.h"
#include "common/mesh/boundary_groups.h"
#include "common/mesh/interfaces.h"
#include "common/number_text.h"

namespace tetwright {

namespace {

void append_name(std::string& out, int dimension, std::int64_t group, const std::string& name) {
  append_number(out, dimension);
  out += ' ';
  append_number(out, group);
  out += " \"" + msh_name(name) + "\"\n";
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

/// Gives each name that it is asked for once: msh_name(), or where that is taken with the suffix "_2", "_3"
/// and so on.
class NamesToWrite {
 public:
  std::string add(const std::string& name) {
    const std::string plain = msh_name(name);
    std::string unique = plain;
    std::size_t& number = next_.try_emplace(plain, 2).first->second;
    while (!used_.insert(unique).second) unique = plain + "_" + std::to_string(number++);
    return unique;
  }

  /// The same for the name of a pair of materials, which has the largest suffix of those with its name: so
  /// readers tell it from the user's. Those of the user must be there.
  std::string add_pair(const std::string& name) {
    const std::string plain = msh_name(name);
    const auto [last, first_time] = last_of_pairs_.try_emplace(plain, 0);
    if (first_time)
      for (auto other = used_.lower_bound(plain); other != used_.end() && other->starts_with(plain); ++other)
        last->second = std::max(last->second, name_suffix(plain, *other));
    ++last->second;
    return add(last->second == 1 ? plain : plain + "_" + std::to_string(last->second));
  }

 private:
  std::set<std::string> used_;
  std::map<std::string, std::size_t> next_;  ///< the next suffix to try
  /// The largest suffix of names of pairs, and of what the user calls like them.
  std::map<std::string, std::int64_t> last_of_pairs_;
};

/// Of the materials. Names that differ stay different, and equal ones equal.
std::map<MaterialTag, std::string> material_names_to_write(const std::map<MaterialTag, std::string>& names) {
  std::map<MaterialTag, std::string> written;
  std::map<std::string, std::string> written_of;
  NamesToWrite unique;
  for (const bool unchanged : {true, false})  // these keep their names
    for (const auto& [tag, name] : names) {
      if ((msh_name(name) == name) != unchanged) continue;
      const auto [known, added] = written_of.try_emplace(name);
      if (added) known->second = unique.add(name);
      written[tag] = known->second;
    }
  return written;
}

/// By the numbers of the groups; without those that have no name. No two are equal: groups of the user come
/// first, those before the others whose names stay as they are.
std::map<std::int64_t, std::string> group_names_to_write(const BoundaryGroups& groups,
                                                         const std::map<MaterialTag, std::string>& names) {
  std::map<std::int64_t, std::string> written;
  NamesToWrite unique;
  for (const bool unchanged : {true, false})
    for (const BoundaryGroups::Group& g : groups.all()) {
      const std::string& name = g.face_group.name;
      if (!name.empty() && (msh_name(name) == name) == unchanged) written[g.number] = unique.add(name);
    }
  // A number that cannot be kept.
  for (const BoundaryGroups::Group& g : groups.all())
    if (const FaceGroup& of_user = g.face_group;
        of_user.name.empty() && of_user.number != 0 && of_user.number != g.number)
      written[g.number] = unique.add(std::to_string(of_user.number));
  for (const BoundaryGroups::Group& g : groups.all())
    if (g.pair) written[g.number] = unique.add_pair(pair_name(*g.pair, names));
  return written;
}

}  // namespace

std::string write_msh(const TetMesh& mesh) {
  std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const BoundaryGroups groups(mesh);
  const std::map<MaterialTag, std::string> names = material_names_to_write(mesh.material_names);
  const std::map<std::int64_t, std::string> group_names = group_names_to_write(groups, names);
  if (!mesh.material_names.empty() || !group_names.empty()) {
    out += "$PhysicalNames\n";
    append_number(out, group_names.size() + mesh.material_names.size());
    out += '\n';
    for (const auto& [number, name] : group_names) append_name(out, 2, number, name);
    for (const auto& [tag, name] : names) append_name(out, 3, tag, name);
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
  // Tets first: their numbers are the same with and without triangles, and simple readers take the first
  // block of elements only.
  out += "$EndNodes\n$Elements\n";
  append_number(out, mesh.tets.size() + mesh.interfaces.size());
  out += '\n';
  // The second tag is the number of the geometrical entity, which must be positive: one for each material.
  std::vector<MaterialTag> tags = mesh.materials;
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    append_element(out, t + 1, msh_tet_type, mesh.materials[t],
                   std::lower_bound(tags.begin(), tags.end(), mesh.materials[t]) - tags.begin() + 1,
                   mesh.tets[t]);
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    const auto group = groups.number_of(mesh.interfaces[i]);
    append_element(out, mesh.tets.size() + i + 1, msh_triangle_type, group, group, mesh.interfaces[i].ids);
  }
  out += "$EndElements\n";
  append_msh_data(out, "NodeData", mesh.point_fields, mesh.points.size());
  append_msh_data(out, "ElementData", mesh.cell_fields, mesh.tets.size());
  return out;
}

}  // namespace tetwright
