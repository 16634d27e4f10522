// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/compaction.h"

#include <algorithm>
#include <numeric>
#include <type_traits>

#include "common/geometry/morton.h"
#include "common/parallel/bucket_sort.h"
#include "common/parallel/parallel_sort.h"
#include "common/parallel/touched_memory.h"
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
  const Box3 box = mesh_.bounding_box();
  const MortonGrid grid(box.low, box.high);
  struct Key {
    std::uint64_t morton;
    Index point;
  };
  std::vector<Key> keys = parallel_collect<Key>(
      0, positions.size(), Grains::slots, [&](std::size_t begin, std::size_t end, std::vector<Key>& out) {
        for (std::size_t p = begin; p < end; ++p)
          if (mesh_.incident_tets_[p] != no_index)
            out.push_back({grid.key(positions[p]), static_cast<Index>(p)});
      });
  parallel_sort(keys, [](const Key& a, const Key& b) {
    return a.morton != b.morton ? a.morton < b.morton : a.point < b.point;
  });
  std::vector<Index> order(keys.size());
  parallel_for(0, keys.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) order[i] = keys[i].point;
  });
  return order;
}

void MeshCompaction::move_points(const std::vector<Index>& order, const std::vector<Index>& new_point,
                                 std::size_t spare) {
  std::vector<Vec3> positions;
  reserve_touched(positions, order.size() + spare);
  positions.resize(order.size() + spare, Vec3::Zero());
  parallel_for(0, order.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) positions[i] = mesh_.positions_[order[i]];
  });
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
  const auto first_point = [&](Index t) {
    const Tet& ids = mesh_.tets_[t].points;
    return std::min(std::min(new_point[ids[0]], new_point[ids[1]]),
                    std::min(new_point[ids[2]], new_point[ids[3]]));
  };
  std::vector<Index> starts, order;
  bucket_sort(
      mesh_.tets_.size(), points,
      [&](std::size_t i, const auto& emit) {
        const auto t = static_cast<Index>(i);
        if (mesh_.tets_[t].points[0] != no_index) emit(first_point(t), t);
      },
      first_point, starts, order);
  live = order.size();
  std::vector<Index> new_tet;
  reserve_touched(new_tet, mesh_.tets_.size());
  new_tet.resize(mesh_.tets_.size(), no_index);
  parallel_for(0, live, Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) new_tet[order[i]] = static_cast<Index>(i);
  });
  return new_tet;
}

void MeshCompaction::move_tets(const std::vector<Index>& new_point, const std::vector<Index>& new_tet,
                               std::size_t live, std::size_t spare) {
  // Move one array after the other: memory peaks while both old and new tets exist.
  const std::size_t slots = mesh_.tets_.size();
  {
    std::vector<TetRecord> tets;
    reserve_touched(tets, live + spare);
    tets.resize(live + spare, {dead_tet, {}});
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
    std::remove_reference_t<decltype(values)> moved;
    reserve_touched(moved, live + spare);
    moved.resize(live + spare, 0);
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
    parallel_for(0, points, Grains::slots, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) new_point[order[i]] = static_cast<Index>(i);
    });
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
    if (is_original(p)) mesh.points[number[p]] = mesh.points[p];
  mesh.points.resize(next);
  parallel_for(0, mesh.points.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) mesh.points[p] = mesh_.space_.to_input(mesh.points[p]);
  });
  reserve_touched(mesh.tets, mesh_.tets_.size());
  mesh.tets.resize(mesh_.tets_.size());
  mesh.materials.resize(mesh_.tets_.size());
  parallel_for(0, mesh.tets.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = mesh_.tets_[i].points;
      mesh.tets[i] = {number[t[0]], number[t[1]], number[t[2]], number[t[3]]};
      mesh.materials[i] = mesh_.tags_[mesh_.regions_[i]];
    }
  });
  const FacePatches patches = this->patches(number);
  std::vector<InterfaceTriangle> sheets = mesh_.sheets(number);
  mesh.material_names = std::move(mesh_.names_);
  mesh.patch_groups = std::move(mesh_.patch_groups_);
  mesh.space = std::move(mesh_.coordinate_system_);
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
