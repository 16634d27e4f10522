#include "common/formats/file_triangles.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "common/error.h"
#include "common/formats/msh_data.h"
#include "common/formats/surface_builder.h"
#include "common/formats/text_scanner.h"
#include "common/mesh/interfaces.h"
#include "common/mesh/mesh_faces.h"

namespace tetwright {

namespace {

constexpr std::size_t max_patches = 0xffff;

Triangle sorted(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

class TriangleTaker {
 public:
  TriangleTaker(const FileTriangles& listed, const std::string& group_word, const std::string& file,
                ReadTetMesh& read)
      : listed_(listed), group_word_(group_word), file_(file), read_(read) {
    std::vector<std::uint8_t> candidates(read.mesh.points.size(), 0);
    for (const Triangle& triangle : listed.triangles)
      for (const Index vertex : triangle)
        if (vertex < candidates.size()) candidates[vertex] = 1;
    faces_ = mesh_faces(read.mesh.tets, read.mesh.points.size(), &candidates);
  }

  void take() {
    for (std::size_t i = 0; i < listed_.triangles.size(); ++i) add(i);
    std::map<MaterialPair, std::size_t> groups_of_pair;
    std::set<MaterialPair> pairs;
    for (const auto& [number, group] : groups_)
      for (const MaterialPair& pair : group.pairs) {
        pairs.insert(pair);
        groups_of_pair[pair] += number != 0;
      }
    const auto is_of_pair = [&](std::int64_t number, const Group& group) {
      if (number == 0) return true;
      if (group.pairs.size() > 1) return false;
      const MaterialPair& pair = *group.pairs.begin();
      const auto name = listed_.names.find(number);
      if (name != listed_.names.end())
        return name->second == msh_name(pair_name(pair, read_.mesh.material_names));
      return groups_of_pair[pair] == 1 && number == std::distance(pairs.begin(), pairs.find(pair)) + 1;
    };
    const bool all_of_pairs = std::all_of(groups_.begin(), groups_.end(),
                                          [&](const auto& g) { return is_of_pair(g.first, g.second); });
    std::size_t restored = 0;
    for (const auto& [number, group] : groups_)
      if (all_of_pairs || number == 0) restored += group.triangles;
    if (!all_of_pairs) set_patches();
    note(restored, all_of_pairs ? groups_.size() - groups_.count(0) : 0);
  }

 private:
  struct Group {
    std::size_t triangles = 0;  ///< that are faces of boundary or interfaces
    std::set<MaterialPair> pairs;
  };

  void add(std::size_t i) {
    const Triangle ids = sorted(listed_.triangles[i]);
    const std::int64_t number = listed_.groups[i];
    const auto face = std::lower_bound(faces_.begin(), faces_.end(), ids,
                                       [](const MeshFace& f, const Triangle& t) { return f.ids < t; });
    if (face == faces_.end() || face->ids != ids) {
      if (number != 0) fail(i);
      ++without_group_;
      return;
    }
    const std::vector<MaterialTag>& materials = read_.mesh.materials;
    MaterialPair pair{materials[face->first], std::nullopt};
    if (face->count > 1) {
      const MaterialTag other = materials[face->second];
      if (face->count > 2 || other == pair.first) {
        ++(number != 0 ? inside_ : without_group_);
        return;
      }
      pair = {std::min(pair.first, other), std::max(pair.first, other)};
    }
    if (!group_of_.emplace(ids, number).second) {
      ++repeated_;
      return;
    }
    ++groups_[number].triangles;
    groups_[number].pairs.insert(pair);
  }

  std::string name_of(std::int64_t number) const {
    const auto name = listed_.names.find(number);
    return name == listed_.names.end() ? std::to_string(number) : name->second;
  }

  [[noreturn]] void fail(std::size_t i) const {
    const Triangle& ids = listed_.triangles[i];
    std::string place;
    for (const Index vertex : ids)
      if (vertex < read_.mesh.points.size()) {
        const Vec3& p = read_.mesh.points[vertex];
        place = " at (" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " +
                std::to_string(p.z()) + ")";
        break;
      }
    throw InputError(file_ + ": triangle " + std::to_string(i + 1) + " of those listed, of the " +
                     group_word_ + " " + in_quotes(name_of(listed_.groups[i])) + place +
                     ", is no face of a tet; the surfaces do not belong to this mesh: save both anew "
                     "from one mesh, or leave the triangles out");
  }

  void set_patches() {
    std::vector<std::int64_t> numbers;
    for (const auto& [number, group] : groups_)
      if (number != 0) numbers.push_back(number);
    if (numbers.size() > max_patches)
      throw InputError(file_ + ": its triangles are in " + std::to_string(numbers.size()) + " " +
                       group_word_ + "s; at most " + std::to_string(max_patches) +
                       " are possible: join some of them");
    TetMesh& mesh = read_.mesh;
    mesh.interfaces = find_interfaces(mesh);
    for (InterfaceTriangle& t : mesh.interfaces) {
      const auto listed = group_of_.find(sorted(t.ids));
      if (listed == group_of_.end() || listed->second == 0) continue;
      const auto number = std::lower_bound(numbers.begin(), numbers.end(), listed->second);
      t.patch = static_cast<std::uint16_t>(number - numbers.begin() + 1);
      const auto name = listed_.names.find(*number);
      mesh.patch_groups[{t.pair(), t.patch}] = {*number, name == listed_.names.end() ? "" : name->second};
    }
  }

  void note(std::size_t restored, std::size_t restored_groups) {
    const auto add = [&](const std::string& what, std::size_t count, bool is_restored) {
      if (count > 0) read_.dropped.push_back({what, count, is_restored});
    };
    add("boundary and interface triangles" +
            (restored_groups == 0
                 ? ""
                 : " of " + std::to_string(restored_groups) + (restored_groups == 1 ? " group" : " groups")),
        restored, true);
    add("triangles inside a material or of no tet", without_group_, false);
    add("triangles of " + group_word_ + "s inside a material", inside_, false);
    add("triangles that are in a " + group_word_ + " already", repeated_, false);
  }

  const FileTriangles& listed_;
  const std::string &group_word_, &file_;
  ReadTetMesh& read_;
  std::vector<MeshFace> faces_;  ///< those with points of listed triangles only
  std::map<Triangle, std::int64_t> group_of_;
  std::map<std::int64_t, Group> groups_;
  std::size_t without_group_ = 0, inside_ = 0, repeated_ = 0;
};

}  // namespace

void take_triangles(const FileTriangles& listed, const std::string& group_word, const std::string& file,
                    ReadTetMesh& read) {
  if (!listed.triangles.empty()) TriangleTaker(listed, group_word, file, read).take();
}

std::string surface_expected(std::size_t tets) {
  return ": there are " + std::to_string(tets) +
         " tets in it; it is a tet mesh, which 'tetwright simplify' and 'tetwright improve' take, and no "
         "surface";
}

TriangleMesh surface_of(const FileTriangles& listed, std::vector<Vec3> points, const std::string& file) {
  SurfaceBuilder surface(file);
  surface.reserve(points.size(), listed.triangles.size());
  for (const Vec3& p : points) surface.add_point(p, [] { return std::string("the points"); });
  points = {};
  std::vector<FaceGroup> groups;
  std::map<std::int64_t, std::uint32_t> indices;
  for (std::size_t i = 0; i < listed.triangles.size(); ++i) {
    const std::int64_t number = listed.groups[i];
    const auto [known, added] = indices.emplace(number, static_cast<std::uint32_t>(groups.size()));
    if (added) {
      const auto name = listed.names.find(number);
      groups.push_back({number, name == listed.names.end() ? "" : name->second});
    }
    surface.begin_group(known->second);
    const Triangle& t = listed.triangles[i];
    surface.add_polygon(std::array<std::int64_t, 3>{t[0], t[1], t[2]},
                        [&] { return "triangle " + std::to_string(i + 1) + " of those listed"; });
  }
  return surface.finish(nullptr, groups, listed.names.empty() ? 2 : 1);
}

}  // namespace tetwright
