#include "common/formats/file_triangles.h"

#include <algorithm>
#include <optional>

#include "common/formats/msh_data.h"
#include "common/mesh/interfaces.h"

namespace tetwright {

namespace {

Triangle sorted(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// The interface triangles of the mesh whose points are all used by triangles of the file.
std::vector<InterfaceTriangle> interfaces_near(const FileTriangles& listed, const TetMesh& mesh) {
  std::vector<std::uint8_t> candidates(mesh.points.size(), 0);
  for (const Triangle& triangle : listed.triangles)
    for (Index vertex : triangle)
      if (vertex < candidates.size()) candidates[vertex] = 1;
  return find_interfaces(mesh, &candidates);
}

struct Group {
  std::size_t triangles = 0;
  bool on_interfaces = true;  ///< every triangle is an interface triangle
  bool one_pair = true;       ///< of the same pair of materials
  std::optional<MaterialPair> pair;
};

}  // namespace

void note_dropped_triangles(const FileTriangles& listed, const std::string& group_word, ReadTetMesh& read) {
  if (listed.triangles.empty()) return;
  const std::vector<InterfaceTriangle> interfaces = interfaces_near(listed, read.mesh);
  const std::vector<MaterialPair> pairs = interface_groups(interfaces);
  std::map<std::int64_t, Group> groups;
  for (std::size_t i = 0; i < listed.triangles.size(); ++i) {
    Group& group = groups[listed.groups[i]];
    ++group.triangles;
    const Triangle ids = sorted(listed.triangles[i]);
    const auto found =
        std::lower_bound(interfaces.begin(), interfaces.end(), ids,
                         [](const InterfaceTriangle& a, const Triangle& b) { return sorted(a.ids) < b; });
    if (found == interfaces.end() || sorted(found->ids) != ids) {
      group.on_interfaces = false;
      continue;
    }
    if (!group.pair) group.pair = found->pair();
    if (*group.pair != found->pair()) group.one_pair = false;
  }
  std::map<MaterialPair, std::size_t> groups_of_pair;
  for (const auto& [number, group] : groups)
    if (number != 0 && group.pair) ++groups_of_pair[*group.pair];

  const auto is_restored = [&](std::int64_t number, const Group& group) {
    if (!group.on_interfaces) return false;
    if (number == 0) return true;
    if (!group.one_pair || groups_of_pair[*group.pair] > 1) return false;
    const auto name = listed.names.find(number);
    if (name != listed.names.end())
      return name->second == msh_name(pair_name(*group.pair, read.mesh.material_names));
    const auto place = std::find(pairs.begin(), pairs.end(), *group.pair) - pairs.begin();
    return number == place + 1;
  };
  std::size_t restored = 0, restored_groups = 0, lost = 0;
  std::vector<std::string> lost_groups;
  for (const auto& [number, group] : groups) {
    if (is_restored(number, group)) {
      restored += group.triangles;
      restored_groups += number != 0;
    } else if (number == 0) {
      read.dropped.push_back({"triangles inside a material or of no tet", group.triangles});
    } else {
      lost += group.triangles;
      const auto name = listed.names.find(number);
      lost_groups.push_back(name == listed.names.end() ? std::to_string(number) : name->second);
    }
  }
  if (restored > 0)
    read.dropped.push_back({"boundary and interface triangles" +
                                (restored_groups == 0 ? ""
                                                      : " of " + std::to_string(restored_groups) +
                                                            (restored_groups == 1 ? " group" : " groups")),
                            restored, true});
  if (lost > 0)
    read.dropped.push_back({"triangles of " + group_word + " (" + quoted_list(lost_groups) + ")", lost});
}

}  // namespace tetwright
