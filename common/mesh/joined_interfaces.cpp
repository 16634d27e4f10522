// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/mesh/disjoint_sets.h"
#include "common/mesh/interface_sides.h"
#include "common/mesh/new_patches.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/parted_interfaces.h"
#include "tetwright/sheets.h"

namespace tetwright {

namespace {

class Joiner {
 public:
  explicit Joiner(TetMesh& mesh) : mesh_(mesh), points_(mesh.points.size()) {}

  JoinedInterfaces join() {
    const FoundSides found = find_interface_sides(mesh_);
    for (const SidesApart& apart : found.apart) result_.apart.emplace_back(apart.name, apart.faces);
    for (const InterfaceSides& sides : found.sides) join_sides(sides);
    if (faces_.empty() && mesh_.wedges.empty()) return std::move(result_);
    find_cohesive();
    merge_points();
    recompute_interfaces();
    return std::move(result_);
  }

 private:
  /// A face of the joined mesh that was parted.
  struct JoinedFace {
    Triangle ids;  ///< of the first side before points are merged, its normal pointing out
    MaterialTag first, second;
    std::size_t interface;  ///< index into names
  };

  void join_sides(const InterfaceSides& sides) {
    const std::size_t interface = result_.names.size();
    for (const auto& [f, g] : sides.faces) {
      const InterfaceTriangle &first = mesh_.interfaces[f], &second = mesh_.interfaces[g];
      const Triangle p = by_coordinates(mesh_, first.ids), q = by_coordinates(mesh_, second.ids);
      for (std::size_t k = 0; k < 3; ++k) points_.unite(p[k], q[k]);
      const bool swapped = second.material < first.material;
      const InterfaceTriangle& smaller = swapped ? second : first;
      faces_.push_back(
          {smaller.ids, smaller.material, swapped ? first.material : second.material, interface});
      wedge_faces_[coordinates_of(mesh_, first.ids)] = interface;
    }
    InterfaceToPart part;
    if (sides.by_materials)
      part.materials = std::pair(faces_.back().first, faces_.back().second);
    else
      part.group = sides.name;
    result_.parts.push_back(part);
    result_.names.push_back(sides.name);
  }

  void find_cohesive() {
    std::vector<std::size_t> without(result_.parts.size(), 0);  // faces without a wedge
    for (const auto& [place, interface] : wedge_faces_) ++without[interface];
    std::set<FaceCoordinates> done;
    for (const Wedge& wedge : mesh_.wedges) {
      const FaceCoordinates place = coordinates_of(mesh_, {wedge[0], wedge[1], wedge[2]});
      const auto known = wedge_faces_.find(place);
      if (known == wedge_faces_.end()) {
        ++result_.other_wedges;
        continue;
      }
      result_.parts[known->second].cohesive = true;
      if (done.insert(place).second)
        --without[known->second];
      else
        ++result_.repeated_wedges;
    }
    for (std::size_t i = 0; i < without.size(); ++i)
      if (result_.parts[i].cohesive) result_.missing_wedges += without[i];
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
      new_index_[p] = kept++;
    }
    for (MeshField& field : mesh_.point_fields) merge_values(field, kept);
    result_.points = mesh_.points.size() - kept;
    mesh_.points.resize(kept);
    for (Tet& tet : mesh_.tets)
      for (Index& p : tet) p = new_index_[p];
  }

  /// Keeps the values of the first copies, and counts others that differ.
  void merge_values(MeshField& field, Index kept) {
    const auto n = static_cast<std::size_t>(field.components);
    std::size_t lost = 0;
    for (Index p = 0; p < new_index_.size(); ++p) {
      const auto from = field.values.begin() + static_cast<std::ptrdiff_t>(p * n),
                 to = field.values.begin() + static_cast<std::ptrdiff_t>(new_index_[p] * n);
      if (points_.is_root(p))
        std::copy_n(from, n, to);
      else
        lost += !std::equal(from, from + static_cast<std::ptrdiff_t>(n), to);
    }
    field.values.resize(n * kept);
    if (lost > 0) result_.lost_values.emplace_back(field.name, lost);
  }

  Triangle renumbered(const Triangle& ids) const {
    return {new_index_[ids[0]], new_index_[ids[1]], new_index_[ids[2]]};
  }

  void recompute_interfaces() {
    std::set<Triangle> parted;
    for (const JoinedFace& face : faces_) parted.insert(ascending_ids(renumbered(face.ids)));
    std::map<Triangle, std::uint16_t> patches_before;
    std::vector<InterfaceTriangle> sheets;
    for (InterfaceTriangle t : mesh_.interfaces) {
      t.ids = renumbered(t.ids);
      if (parted.contains(ascending_ids(t.ids))) continue;
      if (t.is_sheet())
        sheets.push_back(t);
      else
        patches_before[ascending_ids(t.ids)] = t.patch;
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
        patches_before[ascending_ids(t.ids)] = t.patch;
    }
    mesh_.interfaces = find_interfaces(mesh_);
    for (InterfaceTriangle& t : mesh_.interfaces)
      if (const auto known = patches_before.find(ascending_ids(t.ids)); known != patches_before.end())
        t.patch = known->second;
    append_sheets(mesh_.interfaces, std::move(sheets));
    drop_unused_groups(mesh_);
  }

  TetMesh& mesh_;
  DisjointSets points_;
  std::vector<JoinedFace> faces_;
  std::map<FaceCoordinates, std::size_t> wedge_faces_;  ///< interfaces of joined faces
  std::vector<Index> new_index_;
  JoinedInterfaces result_;
};

}  // namespace

JoinedInterfaces join_parted_interfaces(TetMesh& mesh) { return Joiner(mesh).join(); }

}  // namespace tetwright
