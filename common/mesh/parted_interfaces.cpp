// SPDX-License-Identifier: Apache-2.0
#include "tetwright/parted_interfaces.h"

#include <algorithm>
#include <map>
#include <set>

#include "common/mesh/disjoint_sets.h"
#include "common/mesh/interface_sides.h"
#include "common/mesh/new_patches.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/sheets.h"

namespace tetwright {

namespace {

constexpr std::size_t max_joined_places = 3;  ///< as many as messages show

/// The triangle seen from its other side.
Triangle turned(const Triangle& ids) { return {ids[0], ids[2], ids[1]}; }

/// Rotates the smallest id to the front, as find_interfaces() has it.
Triangle from_smallest(Triangle ids) {
  std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
  return ids;
}

std::size_t corner_of(const Tet& tet, Index point) {
  return static_cast<std::size_t>(std::find(tet.begin(), tet.end(), point) - tet.begin());
}

/// Whether the normal of the triangle, a face of the tet, points out of it.
bool points_out_of(const Triangle& ids, const Tet& tet) {
  for (const auto& corners : tet_faces) {
    const Triangle face = {tet[corners[0]], tet[corners[1]], tet[corners[2]]};
    if (ascending_ids(face) == ascending_ids(ids)) return from_smallest(face) == from_smallest(ids);
  }
  return false;
}

/// Sorts the triangles as find_interfaces() does, the sheets after the others.
void sort_interfaces(std::vector<InterfaceTriangle>& interfaces) {
  std::vector<InterfaceTriangle> sheets;
  std::erase_if(interfaces, [&](const InterfaceTriangle& t) {
    if (t.is_sheet()) sheets.push_back(t);
    return t.is_sheet();
  });
  for (InterfaceTriangle& t : interfaces) t.ids = from_smallest(t.ids);
  std::sort(interfaces.begin(), interfaces.end(), [](const InterfaceTriangle& a, const InterfaceTriangle& b) {
    return ascending_ids(a.ids) < ascending_ids(b.ids);
  });
  append_sheets(interfaces, std::move(sheets));
}

class Parter {
 public:
  Parter(TetMesh& mesh, MidsideNodes* midside, std::span<const InterfaceToPart> interfaces)
      : mesh_(mesh), midside_(midside), interfaces_(interfaces), patches_(mesh) {}

  std::vector<PartedInterface> part() {
    select_faces();
    if (parted_.empty()) return {};
    flag_points();
    faces_ = mesh_faces(mesh_.tets, mesh_.points.size(), &near_);
    double_points();
    renumber_interfaces();
    mesh_.tets = std::move(tets_);
    sort_interfaces(mesh_.interfaces);
    if (midside_) {
      renumber_midside_nodes();
      for (const PartedFace& face : parted_faces_) pair_midside_nodes(face);
    }
    std::vector<PartedInterface> result;
    for (auto& [name, parted] : results_) {
      std::sort(parted.pairs.begin(), parted.pairs.end());
      parted.pairs.erase(std::unique(parted.pairs.begin(), parted.pairs.end()), parted.pairs.end());
      result.push_back(std::move(parted));
    }
    return result;
  }

 private:
  const InterfaceToPart* rule_for(const InterfaceTriangle& face) const {
    if (!face.other) return nullptr;
    for (const InterfaceToPart& rule : interfaces_)
      if (rule.materials ? !face.is_sheet() && *rule.materials == std::pair(face.material, *face.other)
                         : region_of(mesh_, face).name == rule.group)
        return &rule;
    return nullptr;
  }

  void select_faces() {
    rules_.resize(mesh_.interfaces.size(), nullptr);
    for (std::size_t i = 0; i < rules_.size(); ++i)
      if ((rules_[i] = rule_for(mesh_.interfaces[i]))) {
        parted_.push_back(ascending_ids(mesh_.interfaces[i].ids));
        pairs_of_[region_of(mesh_, mesh_.interfaces[i])].insert(mesh_.interfaces[i].pair());
      }
    std::sort(parted_.begin(), parted_.end());
  }

  /// Flags the points of parted faces, and all points of the tets at them.
  void flag_points() {
    doubled_.assign(mesh_.points.size(), 0);
    for (const Triangle& ids : parted_)
      for (const Index p : ids) doubled_[p] = 1;
    near_ = doubled_;
    for (const Tet& tet : mesh_.tets)
      if (std::any_of(tet.begin(), tet.end(), [&](Index p) { return doubled_[p]; }))
        for (const Index p : tet) near_[p] = 1;
  }

  /// Copies points for the groups of tets that are connected at them.
  void double_points() {
    DisjointSets corners(4 * mesh_.tets.size());
    const auto corner = [&](Index t, Index p) {
      return static_cast<Index>(4 * std::size_t{t} + corner_of(mesh_.tets[t], p));
    };
    for (const MeshFace& face : faces_) {
      if (face.second == no_index) continue;
      if (std::binary_search(parted_.begin(), parted_.end(), face.ids)) continue;
      for (const Index p : face.ids)
        if (doubled_[p]) corners.unite(corner(face.first, p), corner(face.second, p));
    }
    tets_ = mesh_.tets;
    std::vector<std::uint8_t> used(mesh_.points.size(), 0);
    std::vector<Index> copied;  // the original of each copy
    for (std::size_t t = 0; t < tets_.size(); ++t)
      for (std::size_t k = 0; k < 4; ++k) {
        const Index p = mesh_.tets[t][k];
        if (!doubled_[p]) continue;
        // Roots are the smallest of their sets, so that their tets are renumbered already.
        const Index root = corners.root(static_cast<Index>(4 * t + k));
        if (root < 4 * t + k) {
          tets_[t][k] = tets_[root / 4][root % 4];
        } else if (used[p]) {
          tets_[t][k] = static_cast<Index>(mesh_.points.size() + copied.size());
          copied.push_back(p);
        } else {
          used[p] = 1;
        }
      }
    if (mesh_.points.size() + copied.size() >= no_index)
      throw OutputError("more than " + std::to_string(no_index - 1) + " points; part fewer interfaces");
    for (MeshField& field : mesh_.point_fields) {
      const auto n = static_cast<std::size_t>(field.components);
      for (const Index p : copied)
        for (std::size_t k = 0; k < n; ++k) field.values.push_back(field.values[p * n + k]);
    }
    for (const Index p : copied) mesh_.points.push_back(Vec3(mesh_.points[p]));
  }

  /// The triangle with the points that one of its tets has now.
  Triangle renumbered(const Triangle& ids, Index tet) const {
    Triangle result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = tets_[tet][corner_of(mesh_.tets[tet], ids[k])];
    return result;
  }

  const MeshFace* face_of(const Triangle& ids) const {
    const Triangle key = ascending_ids(ids);
    const auto face = std::lower_bound(faces_.begin(), faces_.end(), key,
                                       [](const MeshFace& f, const Triangle& t) { return f.ids < t; });
    return face != faces_.end() && face->ids == key ? &*face : nullptr;
  }

  void renumber_interfaces() {
    std::vector<InterfaceTriangle> after;
    after.reserve(mesh_.interfaces.size() + parted_.size());
    for (std::size_t i = 0; i < mesh_.interfaces.size(); ++i) {
      InterfaceTriangle face = mesh_.interfaces[i];
      const MeshFace* const between = face_of(face.ids);
      if (!between) {  // away from all parted faces
        after.push_back(face);
        continue;
      }
      if (!rules_[i] || between->second == no_index) {
        face.ids = renumbered(face.ids, between->first);
        after.push_back(face);
        continue;
      }
      // Normals point out of the first side.
      const bool first = face.is_sheet() ? points_out_of(face.ids, mesh_.tets[between->first])
                                         : mesh_.materials[between->first] == face.material;
      part_face(face, *rules_[i], first ? between->first : between->second,
                first ? between->second : between->first, after);
    }
    mesh_.interfaces = std::move(after);
  }

  void part_face(InterfaceTriangle face, const InterfaceToPart& rule, Index first, Index second,
                 std::vector<InterfaceTriangle>& after) {
    const Triangle a = renumbered(face.ids, first), b = renumbered(face.ids, second);
    PartedInterface& parted = result_for(face, rule);
    if (a == b) {
      if (++parted.joined_faces <= max_joined_places)
        parted.joined_places.push_back((mesh_.points[a[0]] + mesh_.points[a[1]] + mesh_.points[a[2]]) / 3);
      face.ids = a;
      after.push_back(face);
      return;
    }
    ++parted.faces;
    bool degenerate = false;
    for (std::size_t k = 0; k < 3; ++k)
      if (a[k] == b[k])
        degenerate = true;
      else
        parted.pairs.push_back({a[k], b[k]});
    if (rule.cohesive) {
      mesh_.wedges.push_back({a[0], a[1], a[2], b[0], b[1], b[2]});
      parted.degenerate_wedges += degenerate;
    }
    if (midside_) parted_faces_.push_back({a, b, &parted});
    const std::array<std::uint16_t, 2> patches = patches_of(face, parted);
    after.push_back({a, face.material, std::nullopt, patches[0]});
    after.push_back({turned(b), *face.other, std::nullopt, patches[1]});
  }

  PartedInterface& result_for(const InterfaceTriangle& face, const InterfaceToPart& rule) {
    const SurfaceRegion& group = region_of(mesh_, face);
    std::string name = rule.materials ? interface_name(mesh_, face.material, *face.other) : group.name;
    if (!rule.materials && pairs_of_[group].size() > 1)
      name += " " + interface_name(mesh_, face.material, *face.other);
    PartedInterface& parted = results_[{name, face.pair()}];
    if (rule.materials && !group.name.empty() &&
        std::find(parted.renamed_groups.begin(), parted.renamed_groups.end(), group.name) ==
            parted.renamed_groups.end())
      parted.renamed_groups.push_back(group.name);
    if (!parted.name.empty()) return parted;
    parted.name = name;
    parted.cohesive = rule.cohesive;
    if (face.is_sheet())
      parted.sides = {name + ":" + sheet_sides[0], name + ":" + sheet_sides[1]};
    else
      parted.sides = {name + ":" + unique_material_name(mesh_.material_names, face.material),
                      name + ":" + unique_material_name(mesh_.material_names, *face.other)};
    return parted;
  }

  /// Patches of both sides for the patch of a face.
  std::array<std::uint16_t, 2> patches_of(const InterfaceTriangle& face, const PartedInterface& parted) {
    const auto [known, added] = patches_of_.try_emplace({face.pair(), face.patch});
    if (!added) return known->second;
    const std::array<MaterialPair, 2> pairs{MaterialPair{face.material, std::nullopt},
                                            MaterialPair{*face.other, std::nullopt}};
    for (const std::size_t side : {0U, 1U}) {
      known->second[side] = patches_.add(pairs[side]);
      mesh_.patch_groups[{pairs[side], known->second[side]}] = {0, parted.sides[side]};
    }
    return known->second;
  }

  void renumber_midside_nodes() {
    MidsideNodes nodes = straight_midside_nodes(mesh_);
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
      for (std::size_t e = 0; e < 6; ++e)
        nodes.points[nodes.of_tets[t][e]] = midside_->points[midside_->of_tets[t][e]];
    *midside_ = std::move(nodes);
  }

  /// A face that was parted, corner by corner.
  struct PartedFace {
    Triangle first, second;
    PartedInterface* of;
  };

  /// Number of the node on an edge, after those of the points.
  Index midside_node(Index a, Index b) const {
    const auto edge = std::lower_bound(midside_->edges.begin(), midside_->edges.end(), ascending_edge(a, b));
    return static_cast<Index>(mesh_.points.size() + static_cast<std::size_t>(edge - midside_->edges.begin()));
  }

  void pair_midside_nodes(const PartedFace& face) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index first = midside_node(face.first[k], face.first[(k + 1) % 3]),
                  second = midside_node(face.second[k], face.second[(k + 1) % 3]);
      if (first != second) face.of->pairs.push_back({first, second});
    }
  }

  TetMesh& mesh_;
  MidsideNodes* midside_;
  std::span<const InterfaceToPart> interfaces_;
  NewPatches patches_;
  std::map<SurfaceRegion, std::set<MaterialPair>> pairs_of_;  ///< of the groups of parted faces
  std::vector<const InterfaceToPart*> rules_;                 ///< of each interface triangle; null: it stays
  std::vector<Triangle> parted_;                              ///< ids in ascending order, ascending
  std::vector<std::uint8_t> doubled_;                         ///< for each point: whether it has parted faces
  std::vector<std::uint8_t> near_;  ///< for each point: whether a tet at it has such a point
  std::vector<MeshFace> faces_;     ///< between points that are near
  std::vector<Tet> tets_;           ///< with the new points
  std::map<std::pair<std::string, MaterialPair>, PartedInterface> results_;
  std::map<InterfacePatch, std::array<std::uint16_t, 2>> patches_of_;
  std::vector<PartedFace> parted_faces_;  ///< only with midside nodes
};

}  // namespace

std::vector<PartedInterface> part_interfaces(TetMesh& mesh, MidsideNodes* midside,
                                             std::span<const InterfaceToPart> interfaces) {
  return Parter(mesh, midside, interfaces).part();
}

std::string table_of_pairs(std::span<const PartedInterface> parted) {
  std::string out = "interface,first,second\n";
  for (const PartedInterface& p : parted) {
    std::string name = "\"";
    for (const char c : p.name) name += c == '"' ? std::string("\"\"") : std::string(1, c);
    for (const auto& [first, second] : p.pairs)
      out += name + "\"," + std::to_string(std::uint64_t{first} + 1) + ',' +
             std::to_string(std::uint64_t{second} + 1) + '\n';
  }
  return out;
}

}  // namespace tetwright
