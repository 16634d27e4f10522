// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/editable_mesh.h"

#include <algorithm>
#include <atomic>

#include "common/geometry/predicates.h"
#include "common/mesh/face_buckets.h"
#include "common/parallel/parallel_sort.h"
#include "simplify/mesh/compaction.h"
#include "simplify/mesh/mesh_builder.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;
using Slots = SimplifyTuning::Slots;

}  // namespace

EditableMesh::EditableMesh(TetMesh&& mesh, const std::string& name) {
  MeshBuilder(*this, name).build(std::move(mesh));
}

void EditableMesh::compact(std::size_t spare_tets, std::size_t spare_points, SlotNumbers* numbers) {
  MeshCompaction(*this).run(spare_tets, spare_points, numbers);
}

void EditableMesh::reserve_twice() {
  tets_.reserve(2 * tets_.size());
  regions_.reserve(2 * tets_.size());
  qualities_.reserve(2 * tets_.size());
  const std::size_t points = 2 * positions_.size();
  positions_.reserve(points);
  incident_tets_.reserve(points);
  touched_.reserve(points);
  reservations_.reserve(points);
  if (any_frozen()) frozen_.reserve(points);
  if (!originals_.empty()) originals_.reserve(points);
}

TetMesh EditableMesh::to_mesh() && { return MeshCompaction(*this).to_mesh(); }

void EditableMesh::set_incident_tets() {
  // The first tet of each point.
  incident_tets_.assign(positions_.size(), no_index);
  parallel_for(0, tets_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (tets_[i].points[0] == no_index) continue;
      const auto t = static_cast<Index>(i);
      for (Index p : tets_[i].points) {
        // Relaxed: the values are read after the loop.
        const std::atomic_ref<Index> first(incident_tets_[p]);
        Index known = first.load(std::memory_order_relaxed);
        while (t < known && !first.compare_exchange_weak(known, t, std::memory_order_relaxed)) {
        }
      }
    }
  });
}

void EditableMesh::freeze(const std::vector<std::uint8_t>& mask) {
  frozen_.resize(positions_.size(), 0);
  for (std::size_t p = 0; p < positions_.size(); ++p) {
    const Index came_as = original(static_cast<Index>(p));
    if (came_as < mask.size() && mask[came_as] != 0) frozen_[p] |= with_tets;
  }
}

void EditableMesh::freeze_interfaces() {
  frozen_.resize(positions_.size(), 0);
  for (const InterfaceFace& f : interface_faces())
    for (Index p : f.ids) frozen_[p] |= alone;
}

std::size_t EditableMesh::touching_points() const {
  std::vector<std::uint8_t> is_original(originals_.size(), 0);
  for (Index p = 0; p < originals_.size(); ++p)
    if (originals_[p] != p) is_original[originals_[p]] = 1;
  return static_cast<std::size_t>(std::count(is_original.begin(), is_original.end(), 1));
}

void EditableMesh::make_room(std::size_t tets, std::size_t points) {
  // Vectors grow geometrically, so few of these resizes copy.
  if (const std::size_t have = free_tets_.available(); have < tets) {
    const std::size_t more = std::max(tets - have, Slots::growth);
    if (tets_.size() + more >= FaceLink::max_tets) throw OutputError("more than the 2^30 tets possible");
    tets_.resize(tets_.size() + more, {dead_tet, {}});
    regions_.resize(tets_.size(), 0);
    qualities_.resize(tets_.size(), 0);
    free_tets_.grow(more);
  }
  if (const std::size_t have = free_points_.available(); have < points) {
    const std::size_t more = std::max(points - have, Slots::growth);
    const std::size_t size = positions_.size() + more;
    if (size >= no_index) throw OutputError("more than the 2^32 points possible");
    if (!originals_.empty())
      for (std::size_t p = positions_.size(); p < size; ++p) originals_.push_back(static_cast<Index>(p));
    positions_.resize(size, Vec3::Zero());
    incident_tets_.resize(size, no_index);
    touched_.resize(size, 0);
    if (any_frozen()) frozen_.resize(size, 0);
    reservations_.grow(size);
    free_points_.grow(more);
  }
}

double EditableMesh::dead_share() const {
  const auto used = static_cast<double>(tets_.size() - free_tets_.unused());
  return used > 0 ? 1 - static_cast<double>(live_) / used : 0;
}

std::vector<InterfaceFace> EditableMesh::interface_faces() const {
  return parallel_collect<InterfaceFace>(
      0, tets_.size(), Grains::slots,
      [&](std::size_t begin, std::size_t end, std::vector<InterfaceFace>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const auto t = static_cast<Index>(i);
          const TetRecord& r = tets_[t];
          if (r.points[0] == no_index) continue;
          for (int f = 0; f < 4; ++f) {
            const FaceLink link = r.links[f];
            if (!link.is_interface() || (!link.is_outside() && link.tet() < t)) continue;
            const auto& c = tet_faces[f];
            const Triangle ids{r.points[c[0]], r.points[c[1]], r.points[c[2]]};
            PatchId patch = 0;
            if (link.is_outside()) {
              patch = link.patch();
            } else if (interface_patches()) {
              const Triangle key = face_key({original(ids[0]), original(ids[1]), original(ids[2])});
              const auto known = interface_patches_.find(key);
              if (known != interface_patches_.end()) patch = known->second;
            }
            out.push_back({ids, regions_[t], region_across(t, f), patch});
          }
        }
      });
}

std::vector<InterfaceTriangle> EditableMesh::sheets(const std::vector<Index>& numbers) const {
  std::vector<InterfaceTriangle> sheets;
  for (const InterfaceFace& f : interface_faces())
    if (f.is_sheet())
      sheets.push_back(
          {{numbers[f.ids[0]], numbers[f.ids[1]], numbers[f.ids[2]]}, tags_[f.inside], tags_[f.inside]});
  return sheets;
}

double EditableMesh::signed_volume(Index t) const {
  const Tet& p = tets_[t].points;
  return orient3d_value(positions_[p[0]], positions_[p[1]], positions_[p[2]], positions_[p[3]]) / 6;
}

double EditableMesh::total_volume() const {
  return parallel_sum(0, tets_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t)
      if (tets_[t].points[0] != no_index) sum += signed_volume(static_cast<Index>(t));
    return sum;
  });
}

Box3 EditableMesh::bounding_box() const {
  constexpr std::size_t grain = 16 * Grains::slots;
  std::vector<Box3> boxes((positions_.size() + grain - 1) / grain);
  parallel_for(0, positions_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      if (incident_tets_[p] != no_index) boxes[begin / grain].add(positions_[p]);
  });
  Box3 all;
  for (const Box3& box : boxes) all.add(box);
  return all;
}

double EditableMesh::diagonal() const {
  const Box3 box = bounding_box();
  return (box.high - box.low).norm();
}

bool EditableMesh::all_positive() const {
  std::atomic<bool> all{true};
  parallel_for(0, tets_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Tet& p = tets_[t].points;
      if (p[0] == no_index) continue;
      if (orient3d(positions_[p[0]], positions_[p[1]], positions_[p[2]], positions_[p[3]]) <= 0) {
        all.store(false, std::memory_order_relaxed);
        return;
      }
    }
  });
  return all;
}

bool EditableMesh::links_consistent() const {
  std::size_t live = 0;
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    const TetRecord& r = tets_[t];
    if (r.points[0] == no_index) {
      if (r.points != dead_tet) return false;
      continue;
    }
    ++live;
    for (int f = 0; f < 4; ++f) {
      if (incident_tets_[r.points[f]] == no_index) return false;
      if (r.links[f].is_outside()) continue;
      const Index n = r.links[f].tet();
      const TetRecord& o = tets_[n];
      if (o.points[0] == no_index) return false;
      if (regions_[n] != regions_[t] && !r.links[f].is_interface()) return false;
      const int back = face_towards(n, static_cast<Index>(t));
      if (o.links[back].tet() != t || o.links[back].is_interface() != r.links[f].is_interface() ||
          sorted_face(o.points, back).vertices != sorted_face(r.points, f).vertices)
        return false;
      if (sorted_face(o.points, back).even == sorted_face(r.points, f).even) return false;
    }
  }
  for (std::size_t p = 0; p < incident_tets_.size(); ++p) {
    if (incident_tets_[p] == no_index) continue;
    const Tet& t = tets_[incident_tets_[p]].points;
    if (std::find(t.begin(), t.end(), static_cast<Index>(p)) == t.end()) return false;
  }
  return live == live_tets();
}

}  // namespace tetwright
