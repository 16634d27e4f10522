// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/mesh_pieces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <span>
#include <tuple>

#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

std::span<const Index> corners_of(const std::vector<Tet>& tets) {
  static_assert(sizeof(Tet) == 4 * sizeof(Index));
  return {tets.empty() ? nullptr : tets[0].data(), 4 * tets.size()};
}

std::span<const Index> corners_of(const std::vector<std::array<Index, 6>>& of_tets) {
  static_assert(sizeof(std::array<Index, 6>) == 6 * sizeof(Index));
  return {of_tets.empty() ? nullptr : of_tets[0].data(), 6 * of_tets.size()};
}

void sort_unique(std::vector<Index>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

/// Position in an ascending list that contains the item.
Index position_of(const std::vector<Index>& items, Index item) {
  return static_cast<Index>(std::lower_bound(items.begin(), items.end(), item) - items.begin());
}

/// Fields of the items `chosen`, in this order.
std::vector<MeshField> chosen_fields(const std::vector<MeshField>& fields, const std::vector<Index>& chosen,
                                     const std::vector<FieldType>& types) {
  std::vector<MeshField> out;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const MeshField& field = fields[f];
    const auto n = static_cast<std::size_t>(field.components);
    MeshField& copy = out.emplace_back();
    copy.name = field.name;
    copy.components = field.components;
    copy.integer = types[f] != FieldType::real;
    copy.values.reserve(n * chosen.size());
    for (const Index i : chosen)
      for (std::size_t k = 0; k < n; ++k) copy.values.push_back(field.values[i * n + k]);
  }
  return out;
}

/// Sorts items by part. \return the positions at which the items of each part begin, and their end
std::vector<std::size_t> starts_of_parts(const std::vector<std::size_t>& counts) {
  std::vector<std::size_t> starts(counts.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), starts.begin() + 1);
  return starts;
}

/// Whether the face of a positive tet, seen from outside, has the orientation of a triangle.
bool same_turn(const Tet& tet, std::uint8_t face, const Triangle& ids) {
  const Index first = tet[tet_faces[face][0]], second = tet[tet_faces[face][1]];
  for (std::size_t k = 0; k < 3; ++k)
    if (ids[k] == first) return ids[(k + 1) % 3] == second;
  return false;
}

}  // namespace

FieldType field_type(const MeshField& field) {
  if (!field.integer) return FieldType::real;
  constexpr double first_inexact = 0x1p53;
  bool narrow = true;
  for (const double value : field.values) {
    if (!(std::fabs(value) < first_inexact) || value != std::floor(value)) return FieldType::real;
    narrow &= value >= INT32_MIN && value <= INT32_MAX;
  }
  return narrow ? FieldType::int32 : FieldType::int64;
}

MeshPieces::MeshPieces(const TetMesh& mesh, const MidsideNodes* midside, const TetPartition& partition)
    : mesh_(mesh),
      midside_(midside),
      partition_(partition),
      points_(corners_of(mesh.tets), 4, mesh.points.size(), partition) {
  TETWRIGHT_CHECK(partition.part_of.empty() || partition.part_of.size() == mesh.tets.size());
  if (midside) midside_points_.emplace(corners_of(midside->of_tets), 6, midside->points.size(), partition);
  std::vector<std::size_t> counts(partition.parts, 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) ++counts[partition.of(t)];
  tet_starts_ = starts_of_parts(counts);
  tets_.resize(mesh.tets.size());
  std::vector<std::size_t> next = tet_starts_;
  for (Index t = 0; t < mesh.tets.size(); ++t) tets_[next[partition.of(t)]++] = t;
  counts.assign(partition.parts, 0);
  for_each_ghost(mesh, partition, points_, [&](PartNumber part, Index) { ++counts[part]; });
  ghost_starts_ = starts_of_parts(counts);
  ghosts_.resize(ghost_starts_.back());
  next = ghost_starts_;
  for_each_ghost(mesh, partition, points_, [&](PartNumber part, Index t) { ghosts_[next[part]++] = t; });
  for (Index p = 0; p < mesh.points.size(); ++p)
    if (!points_.has_tet(p)) points_without_tet_.push_back(p);
  find_sides();
  describe_whole();
}

void MeshPieces::find_sides() {
  std::vector<std::uint8_t> candidates(mesh_.points.size(), 0);
  for (const InterfaceTriangle& t : mesh_.interfaces)
    for (const Index p : t.ids) candidates[p] = 1;
  std::vector<MeshFace> faces;
  if (!mesh_.interfaces.empty()) faces = mesh_faces(mesh_.tets, mesh_.points.size(), &candidates);
  face_owners_.assign(mesh_.interfaces.size(), 0);
  for (std::size_t i = 0; i < mesh_.interfaces.size(); ++i) {
    const InterfaceTriangle& interface = mesh_.interfaces[i];
    Triangle ids = interface.ids;
    std::sort(ids.begin(), ids.end());
    const auto face = std::lower_bound(faces.begin(), faces.end(), ids,
                                       [](const MeshFace& f, const Triangle& key) { return f.ids < key; });
    TETWRIGHT_CHECK(face != faces.end() && face->ids == ids);
    for (const Index t : {face->first, face->second}) {
      if (t == no_index) continue;
      std::uint8_t opposite = 0;
      while (std::find(ids.begin(), ids.end(), mesh_.tets[t][opposite]) != ids.end()) ++opposite;
      sides_.push_back({t, opposite, i});
      if (mesh_.materials[t] == interface.material &&
          (!interface.is_sheet() || same_turn(mesh_.tets[t], opposite, interface.ids)))
        face_owners_[i] = partition_.of(t);
    }
  }
  std::sort(sides_.begin(), sides_.end(), [](const InterfaceSide& a, const InterfaceSide& b) {
    return std::tie(a.tet, a.face) < std::tie(b.tet, b.face);
  });
}

void MeshPieces::describe_whole() {
  whole_.parts = partition_.parts;
  whole_.tets = mesh_.tets.size();
  whole_.points = mesh_.points.size();
  whole_.faces = mesh_.interfaces.size();
  whole_.nodes = whole_.points + (midside_ ? midside_->points.size() : 0);
  whole_.second_order = midside_ != nullptr;
  if (!mesh_.points.empty()) whole_.low = whole_.high = mesh_.points[0];
  const auto extend = [&](const std::vector<Vec3>& points) {
    for (const Vec3& p : points) {
      whole_.low = whole_.low.cwiseMin(p);
      whole_.high = whole_.high.cwiseMax(p);
    }
  };
  extend(mesh_.points);
  if (midside_) extend(midside_->points);
  const std::set<MaterialTag> tags(mesh_.materials.begin(), mesh_.materials.end());
  whole_.names.materials.assign(tags.begin(), tags.end());
  whole_.names.material_names = mesh_.material_names;
  whole_.names.space = mesh_.space;
  whole_.names.patch_groups = mesh_.patch_groups;
  std::set<InterfacePatch> patches;
  for (const InterfaceTriangle& t : mesh_.interfaces)
    if (patches.insert({t.pair(), t.patch}).second)
      whole_.names.interfaces.push_back({{0, 0, 0}, t.material, t.other, t.patch});
  const auto describe = [](const std::vector<MeshField>& fields, std::vector<MeshField>& names,
                           std::vector<FieldType>& types) {
    for (const MeshField& field : fields) {
      types.push_back(field_type(field));
      names.push_back({field.name, field.components, types.back() != FieldType::real, {}});
    }
  };
  describe(mesh_.point_fields, whole_.names.point_fields, whole_.point_types);
  describe(mesh_.cell_fields, whole_.names.cell_fields, whole_.cell_types);
}

MeshPiece MeshPieces::piece(PartNumber part) const {
  MeshPiece piece;
  piece.part = part;
  const auto append = [&](const std::vector<Index>& items, const std::vector<std::size_t>& starts,
                          std::vector<Index>& to) {
    to.insert(to.end(), items.begin() + static_cast<std::ptrdiff_t>(starts[part]),
              items.begin() + static_cast<std::ptrdiff_t>(starts[part + std::size_t{1}]));
  };
  std::vector<Index> tets, points;
  append(tets_, tet_starts_, tets);
  piece.own_tets = tets.size();
  append(ghosts_, ghost_starts_, tets);
  for (const Index t : tets) points.insert(points.end(), mesh_.tets[t].begin(), mesh_.tets[t].end());
  if (part == 0) points.insert(points.end(), points_without_tet_.begin(), points_without_tet_.end());
  sort_unique(points);

  copy_points(points, piece);
  for (const Index t : tets) {
    Tet& tet = piece.mesh.tets.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) tet[k] = position_of(points, mesh_.tets[t][k]);
    piece.mesh.materials.push_back(mesh_.materials[t]);
    piece.tet_numbers.push_back(t);
    piece.tet_owners.push_back(partition_.of(t));
  }
  piece.mesh.material_names = mesh_.material_names;
  piece.mesh.space = mesh_.space;
  piece.mesh.patch_groups = mesh_.patch_groups;
  piece.mesh.cell_fields = chosen_fields(mesh_.cell_fields, tets, whole_.cell_types);
  if (midside_) copy_midside_nodes(tets, points, piece);
  copy_interfaces(tets, points, piece);
  return piece;
}

void MeshPieces::copy_points(const std::vector<Index>& points, MeshPiece& piece) const {
  for (const Index p : points) {
    piece.mesh.points.push_back(mesh_.points[p]);
    piece.node_numbers.push_back(p);
    piece.node_owners.push_back(points_.owner(p));
  }
  piece.mesh.point_fields = chosen_fields(mesh_.point_fields, points, whole_.point_types);
}

void MeshPieces::copy_midside_nodes(const std::vector<Index>& tets, const std::vector<Index>& points,
                                    MeshPiece& piece) const {
  std::vector<Index> nodes;
  for (const Index t : tets)
    nodes.insert(nodes.end(), midside_->of_tets[t].begin(), midside_->of_tets[t].end());
  sort_unique(nodes);
  MidsideNodes& midside = piece.midside.emplace();
  for (const Index m : nodes) {
    const auto& [a, b] = midside_->edges[m];
    midside.edges.push_back({position_of(points, a), position_of(points, b)});
    midside.points.push_back(midside_->points[m]);
    piece.node_numbers.push_back(mesh_.points.size() + m);
    piece.node_owners.push_back(midside_points_->owner(m));
  }
  for (const Index t : tets) {
    std::array<Index, 6>& of_tet = midside.of_tets.emplace_back(midside_->of_tets[t]);
    for (Index& m : of_tet) m = position_of(nodes, m);
  }
}

void MeshPieces::copy_interfaces(const std::vector<Index>& tets, const std::vector<Index>& points,
                                 MeshPiece& piece) const {
  std::vector<std::size_t> interfaces;
  for (Index local = 0; local < tets.size(); ++local)
    for (auto side = std::lower_bound(sides_.begin(), sides_.end(), tets[local],
                                      [](const InterfaceSide&s, Index t) { return s.tet < t; });
         side != sides_.end() && side->tet == tets[local]; ++side) {
      piece.sides.push_back({local, side->face, side->interface});
      interfaces.push_back(side->interface);
    }
  std::sort(interfaces.begin(), interfaces.end());
  interfaces.erase(std::unique(interfaces.begin(), interfaces.end()), interfaces.end());
  for (InterfaceSide& side : piece.sides)
    side.interface = static_cast<std::size_t>(
        std::lower_bound(interfaces.begin(), interfaces.end(), side.interface) - interfaces.begin());
  for (const std::size_t i : interfaces) {
    InterfaceTriangle& t = piece.mesh.interfaces.emplace_back(mesh_.interfaces[i]);
    for (Index& p : t.ids) p = position_of(points, p);
    piece.face_numbers.push_back(i);
    piece.face_owners.push_back(face_owners_[i]);
    if (!midside_) continue;
    std::array<Index, 3>& of_face = piece.midside->of_faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<Index, 2> edge = ascending_edge(t.ids[k], t.ids[(k + 1) % 3]);
      of_face[k] = static_cast<Index>(
          std::lower_bound(piece.midside->edges.begin(), piece.midside->edges.end(), edge) -
          piece.midside->edges.begin());
    }
  }
}

OrderedMesh ordered_by_part(const MeshPieces& pieces) {
  const TetMesh& mesh = pieces.mesh();
  const TetPartition& partition = pieces.partition();
  std::vector<Index> tets(mesh.tets.size()), points(mesh.points.size()), new_point(mesh.points.size());
  std::iota(tets.begin(), tets.end(), Index{0});
  std::stable_sort(tets.begin(), tets.end(),
                   [&](Index a, Index b) { return partition.of(a) < partition.of(b); });
  std::iota(points.begin(), points.end(), Index{0});
  std::stable_sort(points.begin(), points.end(),
                   [&](Index a, Index b) { return pieces.points().owner(a) < pieces.points().owner(b); });
  for (Index p = 0; p < points.size(); ++p) new_point[points[p]] = p;

  OrderedMesh out;
  TetMesh& ordered = out.mesh;
  for (const Index p : points) ordered.points.push_back(mesh.points[p]);
  ordered.point_fields = chosen_fields(mesh.point_fields, points, pieces.whole().point_types);
  MeshField part_of{.name = partition_field, .integer = true, .values = {}};
  for (const Index t : tets) {
    Tet& tet = ordered.tets.emplace_back(mesh.tets[t]);
    for (Index& p : tet) p = new_point[p];
    ordered.materials.push_back(mesh.materials[t]);
    part_of.values.push_back(partition.of(t));
  }
  ordered.cell_fields = chosen_fields(mesh.cell_fields, tets, pieces.whole().cell_types);
  ordered.cell_fields.insert(ordered.cell_fields.begin(), std::move(part_of));
  ordered.material_names = mesh.material_names;
  ordered.space = mesh.space;
  ordered.patch_groups = mesh.patch_groups;
  ordered.interfaces = mesh.interfaces;
  for (InterfaceTriangle& t : ordered.interfaces)
    for (Index& p : t.ids) p = new_point[p];
  const MidsideNodes* midside = pieces.midside();
  if (!midside) return out;

  std::vector<std::pair<std::array<Index, 2>, Index>> edges;
  for (Index m = 0; m < midside->edges.size(); ++m)
    edges.emplace_back(ascending_edge(new_point[midside->edges[m][0]], new_point[midside->edges[m][1]]), m);
  std::sort(edges.begin(), edges.end());
  std::vector<Index> new_node(edges.size());
  MidsideNodes& nodes = out.midside.emplace();
  for (const auto& [edge, m] : edges) {
    new_node[m] = static_cast<Index>(nodes.edges.size());
    nodes.edges.push_back(edge);
    nodes.points.push_back(midside->points[m]);
  }
  for (const Index t : tets)
    for (Index& m : nodes.of_tets.emplace_back(midside->of_tets[t])) m = new_node[m];
  nodes.of_faces = midside->of_faces;
  for (std::array<Index, 3>& face : nodes.of_faces)
    for (Index& m : face) m = new_node[m];
  return out;
}

}  // namespace tetwright
