// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/compaction.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <type_traits>

#include "common/geometry/morton.h"
#include "common/parallel/parallel_sort.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"
#include "tetwright/sheets.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;

}  // namespace

std::vector<Index> MeshCompaction::points_in_curve_order() const {
  const std::vector<Vec3>& positions = mesh_.positions_;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (std::size_t p = 0; p < positions.size(); ++p)
    if (mesh_.incident_tets_[p] != no_index) {
      low = low.cwiseMin(positions[p]);
      high = high.cwiseMax(positions[p]);
    }
  const MortonGrid grid(low, high);
  struct Key {
    std::uint64_t morton;
    Index point;
  };
  std::vector<Key> keys;
  keys.reserve(positions.size());
  for (std::size_t p = 0; p < positions.size(); ++p)
    if (mesh_.incident_tets_[p] != no_index) keys.push_back({grid.key(positions[p]), static_cast<Index>(p)});
  parallel_sort(keys, [](const Key& a, const Key& b) {
    return a.morton != b.morton ? a.morton < b.morton : a.point < b.point;
  });
  std::vector<Index> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].point;
  return order;
}

void MeshCompaction::move_points(const std::vector<Index>& order, const std::vector<Index>& new_point,
                                 std::size_t spare) {
  std::vector<Vec3> positions(order.size() + spare, Vec3::Zero());
  for (std::size_t i = 0; i < order.size(); ++i) positions[i] = mesh_.positions_[order[i]];
  mesh_.positions_ = std::move(positions);
  if (mesh_.any_frozen()) {
    std::vector<std::uint8_t> frozen(mesh_.positions_.size(), 0);
    for (std::size_t i = 0; i < order.size(); ++i) frozen[i] = mesh_.frozen_[order[i]];
    mesh_.frozen_ = std::move(frozen);
  }
  if (!mesh_.originals_.empty()) {
    std::vector<Index> originals(mesh_.positions_.size());
    std::iota(originals.begin(), originals.end(), Index{0});
    for (std::size_t i = 0; i < order.size(); ++i)
      originals[i] = new_point[mesh_.originals_[order[i]]];  // such points are frozen and never removed
    mesh_.originals_ = std::move(originals);
  }
  mesh_.interface_patches_ = renumbered(mesh_.interface_patches_, new_point);
}

std::vector<Index> MeshCompaction::number_tets(const std::vector<Index>& new_point, std::size_t points,
                                               std::size_t& live) const {
  // A counting sort.
  std::vector<Index> next(points + 1, 0);
  const auto first_point = [&](const TetRecord& t) {
    return std::min(std::min(new_point[t.points[0]], new_point[t.points[1]]),
                    std::min(new_point[t.points[2]], new_point[t.points[3]]));
  };
  live = 0;
  for (const TetRecord& t : mesh_.tets_)
    if (t.points[0] != no_index) {
      ++next[first_point(t) + 1];
      ++live;
    }
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<Index> new_tet(mesh_.tets_.size(), no_index);
  for (std::size_t t = 0; t < mesh_.tets_.size(); ++t)
    if (mesh_.tets_[t].points[0] != no_index) new_tet[t] = next[first_point(mesh_.tets_[t])]++;
  return new_tet;
}

void MeshCompaction::move_tets(const std::vector<Index>& new_point, const std::vector<Index>& new_tet,
                               std::size_t live, std::size_t spare) {
  // Move one array after the other: memory peaks while both old and new tets exist.
  const std::size_t slots = mesh_.tets_.size();
  {
    std::vector<TetRecord> tets(live + spare, {dead_tet, {}});
    parallel_for(0, slots, Grains::slots, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        if (new_tet[t] == no_index) continue;
        TetRecord r = mesh_.tets_[t];
        for (Index& p : r.points) p = new_point[p];
        for (FaceLink& n : r.links)
          if (!n.is_outside()) n = FaceLink::to(new_tet[n.tet()], n.is_interface());
        tets[new_tet[t]] = r;
      }
    });
    mesh_.tets_ = std::move(tets);
  }
  const auto move = [&](auto& values) {
    std::remove_reference_t<decltype(values)> moved(live + spare, 0);
    parallel_for(0, slots, Grains::slots, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        if (new_tet[t] != no_index) moved[new_tet[t]] = values[t];
    });
    values = std::move(moved);
  };
  move(mesh_.regions_);
  move(mesh_.qualities_);
}

void MeshCompaction::run(std::size_t spare_tets, std::size_t spare_points, SlotNumbers* numbers) {
  std::vector<Index> new_point(mesh_.positions_.size(), no_index);
  std::size_t points = 0;
  {
    const std::vector<Index> order = points_in_curve_order();
    points = order.size();
    for (std::size_t i = 0; i < order.size(); ++i) new_point[order[i]] = static_cast<Index>(i);
    move_points(order, new_point, spare_points);
  }
  std::size_t live = 0;
  {
    std::vector<Index> new_tet = number_tets(new_point, points, live);
    move_tets(new_point, new_tet, live, spare_tets);
    if (numbers) *numbers = {std::move(new_point), std::move(new_tet)};
  }
  mesh_.live_ = live;
  mesh_.free_tets_.reset(live, mesh_.tets_.size());
  mesh_.free_points_.reset(points, mesh_.positions_.size());
  mesh_.reservations_.reset(mesh_.positions_.size());
  mesh_.touched_.assign(mesh_.positions_.size(), 0);
  mesh_.set_incident_tets();
}

FacePatches MeshCompaction::patches(const std::vector<Index>& number) const {
  FacePatches patches;
  for (const InterfaceFace& f : mesh_.interface_faces())
    if (f.patch != 0)
      patches.emplace(face_key({number[f.ids[0]], number[f.ids[1]], number[f.ids[2]]}), f.patch);
  return patches;
}

TetMesh MeshCompaction::to_mesh() {
  run(0, 0, nullptr);
  const auto is_original = [&](std::size_t p) { return mesh_.original(static_cast<Index>(p)) == p; };
  std::vector<Index> number(mesh_.positions_.size());
  Index next = 0;
  for (std::size_t p = 0; p < number.size(); ++p)
    if (is_original(p)) number[p] = next++;
  for (std::size_t p = 0; p < number.size(); ++p) number[p] = number[mesh_.original(static_cast<Index>(p))];
  TetMesh mesh;
  mesh.points = std::move(mesh_.positions_);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (is_original(p)) mesh.points[number[p]] = mesh_.space_.to_input(mesh.points[p]);
  mesh.points.resize(next);
  mesh.tets.reserve(mesh_.tets_.size());
  mesh.materials.reserve(mesh_.tets_.size());
  for (std::size_t i = 0; i < mesh_.tets_.size(); ++i) {
    const Tet& t = mesh_.tets_[i].points;
    mesh.tets.push_back({number[t[0]], number[t[1]], number[t[2]], number[t[3]]});
    mesh.materials.push_back(mesh_.tags_[mesh_.regions_[i]]);
  }
  const FacePatches patches = this->patches(number);
  std::vector<InterfaceTriangle> sheets = mesh_.sheets(number);
  mesh.material_names = std::move(mesh_.names_);
  mesh.patch_groups = std::move(mesh_.patch_groups_);
  mesh_.tets_ = {};
  mesh_.regions_ = {};
  mesh_.qualities_ = {};
  mesh_.incident_tets_ = {};
  mesh.interfaces = find_interfaces(mesh);
  put_patches(patches, sheets);
  put_patches(patches, mesh.interfaces);
  append_sheets(mesh.interfaces, std::move(sheets));
  return mesh;
}

}  // namespace tetwright
