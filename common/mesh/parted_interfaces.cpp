// SPDX-License-Identifier: Apache-2.0
#include "tetwright/parted_interfaces.h"

#include <algorithm>
#include <memory>
#include <set>

#include "common/mesh/disjoint_sets.h"
#include "common/mesh/new_patches.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/sheets.h"

namespace tetwright {

namespace {

constexpr std::size_t max_joined_places = 3;  ///< as many as messages show

Triangle ascending(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

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
    if (ascending(face) == ascending(ids)) return from_smallest(face) == from_smallest(ids);
  }
  return false;
}

SurfaceRegion group_of(const TetMesh& mesh, const InterfaceTriangle& face) {
  const auto known = mesh.patch_groups.find({face.pair(), face.patch});
  return known == mesh.patch_groups.end() ? SurfaceRegion{} : known->second;
}

std::string material_name(const TetMesh& mesh, MaterialTag tag) {
  const auto known = mesh.material_names.find(tag);
  return known == mesh.material_names.end() || known->second.empty() ? "material_" + std::to_string(tag)
                                                                     : known->second;
}

std::string name_of_pair(const TetMesh& mesh, const MaterialPair& pair) {
  return material_name(mesh, pair.first) + "|" +
         (pair.second ? material_name(mesh, *pair.second) : "outside");
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
    return ascending(a.ids) < ascending(b.ids);
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
    if (midside_) renumber_midside_nodes();
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
                         : group_of(mesh_, face).name == rule.group)
        return &rule;
    return nullptr;
  }

  void select_faces() {
    rules_.resize(mesh_.interfaces.size(), nullptr);
    for (std::size_t i = 0; i < rules_.size(); ++i)
      if ((rules_[i] = rule_for(mesh_.interfaces[i]))) {
        parted_.push_back(ascending(mesh_.interfaces[i].ids));
        pairs_of_[group_of(mesh_, mesh_.interfaces[i])].insert(mesh_.interfaces[i].pair());
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
    const Triangle key = ascending(ids);
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
    const std::array<std::uint16_t, 2> patches = patches_of(face, parted);
    after.push_back({a, face.material, std::nullopt, patches[0]});
    after.push_back({turned(b), *face.other, std::nullopt, patches[1]});
  }

  PartedInterface& result_for(const InterfaceTriangle& face, const InterfaceToPart& rule) {
    const SurfaceRegion group = group_of(mesh_, face);
    std::string name = rule.materials ? name_of_pair(mesh_, face.pair()) : group.name;
    if (!rule.materials && pairs_of_[group].size() > 1) name += " " + name_of_pair(mesh_, face.pair());
    PartedInterface& parted = results_[{name, face.pair()}];
    if (rule.materials && !group.name.empty() &&
        std::find(parted.renamed_groups.begin(), parted.renamed_groups.end(), group.name) ==
            parted.renamed_groups.end())
      parted.renamed_groups.push_back(group.name);
    if (!parted.name.empty()) return parted;
    parted.name = name;
    parted.cohesive = rule.cohesive;
    if (face.is_sheet())
      parted.sides = {name + ":back", name + ":front"};
    else
      parted.sides = {name + ":" + material_name(mesh_, face.material),
                      name + ":" + material_name(mesh_, *face.other)};
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
};

using FaceCoordinates = std::array<std::array<double, 3>, 3>;

std::array<double, 3> coordinates_of(const Vec3& p) { return {p[0], p[1], p[2]}; }

/// Corners of a face in the order of their coordinates.
Triangle by_coordinates(const TetMesh& mesh, Triangle ids) {
  std::sort(ids.begin(), ids.end(), [&](Index a, Index b) {
    return coordinates_of(mesh.points[a]) < coordinates_of(mesh.points[b]);
  });
  return ids;
}

FaceCoordinates coordinates_of(const TetMesh& mesh, const Triangle& ids) {
  return {coordinates_of(mesh.points[ids[0]]), coordinates_of(mesh.points[ids[1]]),
          coordinates_of(mesh.points[ids[2]])};
}

class Joiner {
 public:
  /// \param mesh find() leaves it unchanged
  explicit Joiner(TetMesh& mesh) : mesh_(mesh), points_(mesh.points.size()) {}

  /// Finds the sides that coincide.
  /// \return their faces, as indices into TetMesh::interfaces
  std::vector<std::size_t> find() {
    collect_sides();
    std::vector<std::size_t> found;
    for (const auto& [name, sides] : sides_)
      if (sides.size() == 2 && sides[0]->is_sheet == sides[1]->is_sheet &&
          sides[0]->is_sheet == (sides[0]->material == sides[1]->material) &&
          join_sides(name, *sides[0], *sides[1]))
        for (const Side* side : sides) found.insert(found.end(), side->faces.begin(), side->faces.end());
    std::sort(found.begin(), found.end());
    return found;
  }

  JoinedInterfaces join() {
    (void)find();
    if (faces_.empty() && mesh_.wedges.empty()) return {};
    find_cohesive();
    merge_points();
    recompute_interfaces();
    return std::move(result_);
  }

 private:
  /// A group of boundary faces whose name says that it is the side of a parted interface.
  struct Side {
    MaterialTag material;
    bool is_sheet;                   ///< whether it is called the back or front of a sheet
    std::vector<std::size_t> faces;  ///< indices into TetMesh::interfaces
  };
  /// A face of the joined mesh that was parted.
  struct JoinedFace {
    Triangle ids;  ///< of the first side before points are merged, its normal pointing out
    MaterialTag first, second;
    std::size_t interface;  ///< index into names
  };

  void collect_sides() {
    std::map<std::string, Side> groups;
    std::set<std::string> of_several;  // groups with several materials
    for (std::size_t i = 0; i < mesh_.interfaces.size(); ++i) {
      const InterfaceTriangle& face = mesh_.interfaces[i];
      if (face.other) continue;
      const std::string name = group_of(mesh_, face).name;
      if (name.find(':') == std::string::npos) continue;
      Side& side = groups.try_emplace(name, Side{face.material, false, {}}).first->second;
      side.faces.push_back(i);
      if (side.material != face.material) of_several.insert(name);
    }
    for (auto& [name, group] : groups) {
      if (of_several.contains(name)) continue;
      const std::string material = material_name(mesh_, group.material);
      for (const std::string& suffix : {std::string("back"), std::string("front"), material}) {
        if (name.size() <= suffix.size() + 1 || !name.ends_with(":" + suffix)) continue;
        group.is_sheet = suffix != material;
        own_.push_back(std::make_unique<Side>(std::move(group)));
        sides_[name.substr(0, name.size() - suffix.size() - 1)].push_back(own_.back().get());
        break;
      }
    }
  }

  /// Joins the faces of two sides.
  /// \return false if they do not coincide
  bool join_sides(const std::string& name, const Side& a, const Side& b) {
    if (a.faces.size() != b.faces.size()) return false;
    std::map<FaceCoordinates, std::size_t> by_place;
    for (const std::size_t f : a.faces)
      if (!by_place.emplace(place_of(f), f).second) return false;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (const std::size_t f : b.faces) {
      const auto same = by_place.find(place_of(f));
      if (same == by_place.end()) return false;
      pairs.emplace_back(same->second, f);
      by_place.erase(same);
    }
    const std::size_t interface = result_.names.size();
    bool named_after_materials = true;
    for (const auto& [f, g] : pairs) {
      const InterfaceTriangle &first = mesh_.interfaces[f], &second = mesh_.interfaces[g];
      const Triangle p = by_coordinates(mesh_, first.ids), q = by_coordinates(mesh_, second.ids);
      for (std::size_t k = 0; k < 3; ++k) points_.unite(p[k], q[k]);
      const bool swapped = second.material < first.material;
      const InterfaceTriangle& smaller = swapped ? second : first;
      const MaterialTag larger = swapped ? first.material : second.material;
      faces_.push_back({smaller.ids, smaller.material, larger, interface});
      wedge_faces_[place_of(f)] = interface;
      named_after_materials &=
          smaller.material != larger && name == name_of_pair(mesh_, {smaller.material, larger});
    }
    InterfaceToPart part;
    if (named_after_materials)
      part.materials = std::pair(faces_.back().first, faces_.back().second);
    else
      part.group = name;
    result_.parts.push_back(part);
    result_.names.push_back(name);
    return true;
  }

  FaceCoordinates place_of(std::size_t face) const {
    return coordinates_of(mesh_, by_coordinates(mesh_, mesh_.interfaces[face].ids));
  }

  void find_cohesive() {
    for (const Wedge& wedge : mesh_.wedges) {
      const Triangle first{wedge[0], wedge[1], wedge[2]};
      const auto known = wedge_faces_.find(coordinates_of(mesh_, by_coordinates(mesh_, first)));
      if (known == wedge_faces_.end())
        ++result_.other_wedges;
      else
        result_.parts[known->second].cohesive = true;
    }
    mesh_.wedges.clear();
  }

  void merge_points() {
    new_index_.resize(mesh_.points.size());
    Index kept = 0;
    for (Index p = 0; p < mesh_.points.size(); ++p) {
      if (!points_.is_root(p)) {
        new_index_[p] = new_index_[points_.root(p)];
        continue;
      }
      mesh_.points[kept] = Vec3(mesh_.points[p]);
      for (MeshField& field : mesh_.point_fields) {
        const auto n = static_cast<std::size_t>(field.components);
        std::copy_n(field.values.begin() + static_cast<std::ptrdiff_t>(p * n), n,
                    field.values.begin() + static_cast<std::ptrdiff_t>(kept * n));
      }
      new_index_[p] = kept++;
    }
    result_.points = mesh_.points.size() - kept;
    mesh_.points.resize(kept);
    for (MeshField& field : mesh_.point_fields)
      field.values.resize(static_cast<std::size_t>(field.components) * kept);
    for (Tet& tet : mesh_.tets)
      for (Index& p : tet) p = new_index_[p];
  }

  Triangle renumbered(const Triangle& ids) const {
    return {new_index_[ids[0]], new_index_[ids[1]], new_index_[ids[2]]};
  }

  void recompute_interfaces() {
    std::map<Triangle, InterfaceTriangle> before;
    std::vector<InterfaceTriangle> sheets;
    std::set<Triangle> parted;
    for (const JoinedFace& face : faces_) parted.insert(ascending(renumbered(face.ids)));
    for (InterfaceTriangle t : mesh_.interfaces) {
      t.ids = renumbered(t.ids);
      if (parted.contains(ascending(t.ids))) continue;
      if (t.is_sheet())
        sheets.push_back(t);
      else
        before[ascending(t.ids)] = t;
    }
    NewPatches patches(mesh_);
    std::map<std::pair<std::size_t, MaterialPair>, std::uint16_t> patch_of;
    for (const JoinedFace& face : faces_) {
      const MaterialPair pair{face.first, face.second};
      const InterfaceToPart& part = result_.parts[face.interface];
      const auto [known, added] = patch_of.try_emplace({face.interface, pair}, std::uint16_t{0});
      if (added) {
        known->second = patches.add(pair);
        if (!part.materials) mesh_.patch_groups[{pair, known->second}] = {0, part.group};
      }
      const InterfaceTriangle t{renumbered(face.ids), face.first, face.second, known->second};
      if (t.is_sheet())
        sheets.push_back(t);
      else
        before[ascending(t.ids)] = t;
    }
    mesh_.interfaces = find_interfaces(mesh_);
    for (InterfaceTriangle& t : mesh_.interfaces)
      if (const auto known = before.find(ascending(t.ids)); known != before.end())
        t.patch = known->second.patch;
    append_sheets(mesh_.interfaces, std::move(sheets));
    drop_unused_groups();
  }

  /// Drops groups without faces, such as those of the sides.
  void drop_unused_groups() {
    std::set<InterfacePatch> used;
    for (const InterfaceTriangle& t : mesh_.interfaces) used.insert({t.pair(), t.patch});
    std::erase_if(mesh_.patch_groups, [&](const auto& group) { return !used.contains(group.first); });
  }

  TetMesh& mesh_;
  DisjointSets points_;
  std::vector<std::unique_ptr<Side>> own_;
  std::map<std::string, std::vector<const Side*>> sides_;  ///< by the name of their interface
  std::vector<JoinedFace> faces_;
  std::map<FaceCoordinates, std::size_t> wedge_faces_;  ///< interfaces of joined faces
  std::vector<Index> new_index_;
  JoinedInterfaces result_;
};

}  // namespace

std::vector<PartedInterface> part_interfaces(TetMesh& mesh, MidsideNodes* midside,
                                             std::span<const InterfaceToPart> interfaces) {
  return Parter(mesh, midside, interfaces).part();
}

JoinedInterfaces join_parted_interfaces(TetMesh& mesh) { return Joiner(mesh).join(); }

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

std::vector<std::size_t> parted_faces(const TetMesh& mesh) {
  return Joiner(const_cast<TetMesh&>(mesh)).find();  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

bool is_cohesive(const Wedge& wedge, std::span<const Vec3> points) {
  bool apart = false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (points[wedge[k]] != points[wedge[k + 3]]) return false;
    apart |= wedge[k] != wedge[k + 3];
  }
  return apart;
}

std::map<std::string, std::vector<std::size_t>> wedges_by_interface(const TetMesh& mesh) {
  std::map<std::string, std::vector<std::size_t>> result;
  if (mesh.wedges.empty()) return result;
  std::map<Triangle, std::string> names;
  for (const InterfaceTriangle& face : mesh.interfaces)
    if (!face.other) names[ascending(face.ids)] = group_of(mesh, face).name;
  for (std::size_t w = 0; w < mesh.wedges.size(); ++w) {
    const Wedge& wedge = mesh.wedges[w];
    const auto side = names.find(ascending({wedge[0], wedge[1], wedge[2]}));
    const auto other = names.find(ascending({wedge[3], wedge[4], wedge[5]}));
    std::string name = "cohesive";
    if (side != names.end() && other != names.end()) {
      const std::string &a = side->second, &b = other->second;
      // The longest NAME of sides NAME:A and NAME:B.
      for (std::size_t colon = a.find(':'); colon != std::string::npos; colon = a.find(':', colon + 1))
        if (colon > 0 && b.compare(0, colon + 1, a, 0, colon + 1) == 0) name = a.substr(0, colon);
    }
    result[name].push_back(w);
  }
  return result;
}

}  // namespace tetwright
