// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/mesh_builder.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <numeric>

#include "common/mesh/face_buckets.h"
#include "common/parallel/parallel_sort.h"
#include "common/parallel/touched_memory.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;

/// Lowers `smallest` to `value`, so that messages name the first finding in the file, whichever thread makes
/// it.
void lower(std::atomic<Index>& smallest, Index value) {
  Index known = smallest.load();
  while (value < known && !smallest.compare_exchange_weak(known, value)) {
  }
}

std::string place(const Vec3& p) {
  return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " + std::to_string(p.z()) + ")";
}

}  // namespace

void MeshBuilder::build(TetMesh&& input) {
  // Faces are numbered 4 * tet + face in 32 bits.
  if (input.tets.size() >= FaceLink::max_tets)
    throw InputError(name_, 0, std::to_string(input.tets.size()) + " tets are more than the 2^30 possible");
  mesh_.names_ = std::move(input.material_names);
  mesh_.patch_groups_ = std::move(input.patch_groups);
  mesh_.coordinate_system_ = std::move(input.space);
  take_points(std::move(input.points));
  take_tets(input);
  const std::vector<InterfaceTriangle> interfaces = std::move(input.interfaces);
  input = TetMesh();
  mesh_.live_ = mesh_.tets_.size();
  mesh_.free_tets_.reset(mesh_.tets_.size(), mesh_.tets_.size());
  mesh_.reservations_.reset(mesh_.positions_.size());
  mesh_.free_points_.reset(mesh_.positions_.size(), mesh_.positions_.size());
  mesh_.touched_.assign(mesh_.positions_.size(), 0);
  link_faces();
  mesh_.set_incident_tets();
  take_sheets(interfaces);
  take_patches(interfaces);
  split_stars();
  freeze_sheet_corners();
}

void MeshBuilder::replace_tets(std::vector<Tet>&& tets, std::vector<RegionId>&& regions,
                               const std::vector<InterfaceFace>& faces) {
  std::vector<TetRecord>().swap(mesh_.tets_);
  reserve_touched(mesh_.tets_, tets.size());
  mesh_.tets_.resize(tets.size());
  parallel_for(0, tets.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) mesh_.tets_[i] = {tets[i], {}};
  });
  std::vector<Tet>().swap(tets);
  mesh_.regions_ = std::move(regions);
  mesh_.qualities_.assign(mesh_.tets_.size(), 0);
  mesh_.live_ = mesh_.tets_.size();
  mesh_.free_tets_.reset(mesh_.tets_.size(), mesh_.tets_.size());
  link_faces();
  mesh_.set_incident_tets();
  set_faces(faces);
}

void MeshBuilder::take_points(std::vector<Vec3>&& points) {
  std::atomic<bool> finite{true};  // relaxed: it only has to become visible eventually
  parallel_for(0, points.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      if (!points[p].allFinite()) finite.store(false, std::memory_order_relaxed);
  });
  if (!finite.load()) throw InputError(name_, 0, "a coordinate is not finite");
  mesh_.space_ = WorkingSpace::of(points);
  if (!mesh_.space_.valid()) throw InputError(name_, 0, "coordinates are too far apart");
  mesh_.positions_ = std::move(points);
  parallel_for(0, mesh_.positions_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      mesh_.positions_[p] = mesh_.space_.to_working(mesh_.positions_[p]);
  });
}

void MeshBuilder::take_tets(const TetMesh& input) {
  std::vector<MaterialTag>& tags = mesh_.tags_;
  for (std::size_t i = 0; i < input.materials.size(); ++i) {
    const MaterialTag tag = input.materials[i];
    if (i > 0 && tag == input.materials[i - 1]) continue;
    const auto at = std::lower_bound(tags.begin(), tags.end(), tag);
    if (at == tags.end() || *at != tag) tags.insert(at, tag);
  }
  reserve_touched(mesh_.tets_, input.tets.size());
  mesh_.tets_.resize(input.tets.size());
  mesh_.regions_.resize(input.tets.size());
  mesh_.qualities_.resize(input.tets.size(), 0);
  std::atomic<Index> first_bad{no_index};
  parallel_for(0, input.tets.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = input.tets[i];
      const auto region = std::lower_bound(tags.begin(), tags.end(), input.materials[i]) - tags.begin();
      mesh_.tets_[i] = {t, {}};
      mesh_.regions_[i] = static_cast<RegionId>(region);
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < k; ++l)
          if (t[k] == t[l]) lower(first_bad, static_cast<Index>(i));
    }
  });
  if (const Index bad = first_bad.load(); bad != no_index)
    throw InputError(name_, 0,
                     "tet " + std::to_string(bad) + " has a point twice, at " +
                         place(mesh_.space_.to_input(mesh_.positions_[input.tets[bad][0]])) +
                         "; `tetwright check` lists all of them");
}

void MeshBuilder::link_faces() {
  std::vector<TetRecord>& tets = mesh_.tets_;
  const auto tet_at = [&](std::size_t t) -> const Tet& { return tets[t].points; };
  using Buckets = FaceBuckets<Index>;
  const Buckets buckets(tets.size(), mesh_.positions_.size(), tet_at);
  std::atomic<Index> bad{no_index};  // 4 * tet + face
  parallel_for(0, mesh_.positions_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    Buckets::Workspace ws;
    for (std::size_t p = begin; p < end; ++p)
      buckets.visit(static_cast<Index>(p), tet_at, ws,
                    [&](const Triangle&, std::span<const Buckets::Use> uses) {
                      if (uses.size() == 1) return;
                      const Buckets::Use &s = uses[0], &u = uses[1];
                      // Positive tets on opposite sides of a face list it with opposite orientations.
                      if (uses.size() > 2 || s.even == u.even) lower(bad, 4 * s.tet + s.face);
                      if (uses.size() > 2) return;
                      const bool interface = mesh_.regions_[s.tet] != mesh_.regions_[u.tet];
                      tets[s.tet].links[s.face] = FaceLink::to(u.tet, interface);
                      tets[u.tet].links[u.face] = FaceLink::to(s.tet, interface);
                    });
  });
  if (const Index face = bad.load(); face != no_index) {
    const Triangle s = sorted_face(tets[face / 4].points, static_cast<int>(face % 4)).vertices;
    throw InputError(name_, 0,
                     "the face of points " + std::to_string(s[0]) + ", " + std::to_string(s[1]) + ", " +
                         std::to_string(s[2]) + " at " +
                         place(mesh_.space_.to_input(mesh_.positions_[s[0]])) +
                         " has more than two tets, or two on one side; `tetwright check` lists all of them");
  }
}

void MeshBuilder::take_sheets(const std::vector<InterfaceTriangle>& interfaces) {
  std::map<Triangle, const InterfaceTriangle*> sheets;
  const auto refuse = [&](std::size_t count, const char* what, const Triangle& ids) {
    const std::vector<Vec3>& at = mesh_.positions_;
    throw InputError(name_, 0,
                     std::to_string(count) + what +
                         place(mesh_.space_.to_input((at[ids[0]] + at[ids[1]] + at[ids[2]]) / 3)) +
                         "; `tetwright check` lists all of them");
  };
  for (const InterfaceTriangle& t : interfaces)
    if (t.is_sheet() && !sheets.emplace(face_key(t.ids), &t).second)
      refuse(1, " face of its sheets is listed twice, at ", t.ids);
  if (sheets.empty()) return;
  std::vector<std::uint8_t> on_sheet(mesh_.positions_.size(), 0);
  for (const auto& [key, triangle] : sheets)
    for (const Index p : key) on_sheet[p] = 1;
  for (Index t = 0; t < mesh_.tets_.size(); ++t)
    for (int f = 0; f < 4; ++f) {
      TetRecord& tet = mesh_.tets_[t];
      const FaceLink link = tet.links[f];
      if (link.is_outside() || link.is_interface() || link.tet() < t) continue;
      const Triangle key = sorted_face(tet.points, f).vertices;
      if (!on_sheet[key[0]] || !on_sheet[key[1]] || !on_sheet[key[2]]) continue;
      const auto found = sheets.find(key);
      if (found == sheets.end() || found->second->material != mesh_.tags_[mesh_.regions_[t]]) continue;
      // Compare vertices: two tets may share more than one face.
      TetRecord& other = mesh_.tets_[link.tet()];
      for (int back = 0; back < 4; ++back)
        if (sorted_face(other.points, back).vertices == key) other.links[back] = FaceLink::to(t, true);
      tet.links[f] = FaceLink::to(link.tet(), true);
      sheets.erase(found);
    }
  if (!sheets.empty())
    refuse(sheets.size(), " faces of its sheets do not lie between two tets of their material, the first at ",
           sheets.begin()->first);
}

void MeshBuilder::freeze_sheet_corners() {
  const std::vector<Index> corners = sheet_corners();
  if (corners.empty()) return;
  mesh_.frozen_.resize(mesh_.positions_.size(), 0);
  for (const Index p : corners) mesh_.frozen_[p] |= EditableMesh::alone;
}

std::vector<Index> MeshBuilder::sheet_corners() const {
  const std::vector<InterfaceFace> faces = mesh_.interface_faces();
  if (std::none_of(faces.begin(), faces.end(), [](const InterfaceFace& f) { return f.is_sheet(); }))
    return {};
  struct Uses {
    std::size_t count = 0;
    bool sheet = false;
  };
  std::map<std::array<Index, 2>, Uses> edges;
  for (const InterfaceFace& f : faces)
    for (std::size_t k = 0; k < 3; ++k) {
      Uses& uses = edges[ascending_edge(f.ids[k], f.ids[(k + 1) % 3])];
      ++uses.count;
      uses.sheet |= f.is_sheet();
    }
  std::map<Index, std::vector<Index>> neighbours;  // along curves of sheets
  for (const auto& [ends, uses] : edges)
    if (uses.sheet && uses.count != 2)
      for (std::size_t k = 0; k < 2; ++k) neighbours[ends[k]].push_back(ends[1 - k]);
  std::vector<Index> corners;
  for (const auto& [p, others] : neighbours) {
    if (others.size() != 2) continue;
    const Vec3& at = mesh_.positions_[p];
    const Vec3 u = (at - mesh_.positions_[others[0]]).normalized(),
               v = (mesh_.positions_[others[1]] - at).normalized();
    if (u.dot(v) < SimplifyTuning::Features::sheet_corner_cosine) corners.push_back(p);
  }
  return corners;
}

void MeshBuilder::take_patches(const std::vector<InterfaceTriangle>& interfaces) {
  if (std::all_of(interfaces.begin(), interfaces.end(),
                  [](const InterfaceTriangle& t) { return t.patch == 0; }))
    return;
  std::map<Triangle, PatchId> patches;  // including patch 0, since faces are counted
  for (const InterfaceTriangle& t : interfaces) patches.emplace(face_key(t.ids), t.patch);
  FacePatches inner;
  std::size_t known = 0;
  for (Index t = 0; t < mesh_.tets_.size(); ++t)
    for (int f = 0; f < 4; ++f) {
      const FaceLink link = mesh_.tets_[t].links[f];
      if (!link.is_interface() || (!link.is_outside() && link.tet() < t)) continue;
      const Triangle key = sorted_face(mesh_.tets_[t].points, f).vertices;
      const auto patch = patches.find(key);
      if (patch == patches.end()) continue;
      ++known;
      if (link.is_outside()) {
        mesh_.tets_[t].links[f] = FaceLink::outside(patch->second);
      } else if (patch->second != 0) {
        inner.emplace(key, patch->second);
      }
    }
  if (known != patches.size())
    throw InputError(name_, 0,
                     std::to_string(patches.size() - known) +
                         " of its triangles with patches are no faces of boundary or interfaces");
  mesh_.interface_patches_ = std::move(inner);
}

void MeshBuilder::set_faces(const std::vector<InterfaceFace>& faces) {
  using Face = std::pair<Triangle, const InterfaceFace*>;
  std::vector<Face> by_points(faces.size());
  parallel_for(0, faces.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) by_points[i] = {face_key(faces[i].ids), &faces[i]};
  });
  parallel_sort(by_points, [](const Face& x, const Face& y) { return x.first < y.first; });
  std::vector<std::uint8_t> on_sheet;
  for (const InterfaceFace& f : faces) {
    if (!f.is_sheet()) continue;
    on_sheet.resize(mesh_.positions_.size(), 0);
    for (const Index p : f.ids) on_sheet[p] = 1;
  }
  std::atomic<std::size_t> known{0};
  using Patch = std::pair<Triangle, PatchId>;
  std::vector<Patch> inner = parallel_collect<Patch>(
      0, mesh_.tets_.size(), Grains::slots, [&](std::size_t begin, std::size_t end, std::vector<Patch>& out) {
        std::size_t found = 0;
        for (std::size_t t = begin; t < end; ++t)
          for (int f = 0; f < 4; ++f) {
            FaceLink& link = mesh_.tets_[t].links[f];
            const Triangle ids = face_of(mesh_.tets_[t].points, f);
            if (!link.is_interface() &&
                (on_sheet.empty() || !on_sheet[ids[0]] || !on_sheet[ids[1]] || !on_sheet[ids[2]]))
              continue;
            const Triangle key = face_key(ids);
            const auto at = std::lower_bound(by_points.begin(), by_points.end(), key,
                                             [](const Face& x, const Triangle& y) { return x.first < y; });
            if (at == by_points.end() || at->first != key) continue;
            const PatchId patch = at->second->patch;
            found += link.is_outside() ? 2 : 1;  // an inner face is found from both sides
            if (!link.is_outside() && patch != 0)
              out.emplace_back(
                  face_key({mesh_.original(ids[0]), mesh_.original(ids[1]), mesh_.original(ids[2])}), patch);
            link = link.is_outside() ? FaceLink::outside(patch) : FaceLink::to(link.tet(), true);
          }
        known.fetch_add(found, std::memory_order_relaxed);
      });
  TETWRIGHT_CHECK(known.load() == 2 * faces.size());
  mesh_.interface_patches_ = FacePatches(inner.begin(), inner.end());
}

std::vector<Index> MeshBuilder::points_with_split_stars() const {
  // Each tet is in a part of the stars of its four points; if no star is split, the first parts have all.
  std::atomic<std::size_t> in_first_parts{0};
  parallel_for(0, mesh_.positions_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    LocalNumbers seen;
    std::vector<Index> part;
    std::size_t sum = 0;
    for (std::size_t p = begin; p < end; ++p) {
      if (mesh_.incident_tets_[p] == no_index) continue;
      part_of_star(static_cast<Index>(p), mesh_.incident_tets_[p], seen, part);
      sum += part.size();
    }
    in_first_parts.fetch_add(sum, std::memory_order_relaxed);
  });
  if (in_first_parts.load() == 4 * mesh_.tets_.size()) return {};
  std::vector<Index> tets_at(mesh_.positions_.size(), 0);
  for (const TetRecord& t : mesh_.tets_)
    for (Index p : t.points) ++tets_at[p];
  return parallel_collect<Index>(0, mesh_.positions_.size(), Grains::slots,
                                 [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                   LocalNumbers seen;
                                   std::vector<Index> part;
                                   for (std::size_t p = begin; p < end; ++p) {
                                     if (mesh_.incident_tets_[p] == no_index) continue;
                                     part_of_star(static_cast<Index>(p), mesh_.incident_tets_[p], seen, part);
                                     if (part.size() != tets_at[p]) out.push_back(static_cast<Index>(p));
                                   }
                                 });
}

std::vector<Index> MeshBuilder::points_of_glued_tets() const {
  return parallel_collect<Index>(0, mesh_.tets_.size(), Grains::slots,
                                 [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                   for (std::size_t i = begin; i < end; ++i) {
                                     const TetRecord& t = mesh_.tets_[i];
                                     for (std::size_t k = 0; k < 4; ++k)
                                       for (std::size_t l = 0; l < k; ++l)
                                         if (!t.links[k].is_outside() && t.links[k].tet() == t.links[l].tet())
                                           out.insert(out.end(), t.points.begin(), t.points.end());
                                   }
                                 });
}

std::vector<std::array<Index, 2>> MeshBuilder::split_points(const std::vector<Index>& split,
                                                            std::vector<Index>& frozen) {
  std::vector<std::vector<Index>> stars(split.size());
  for (std::size_t t = 0; t < mesh_.tets_.size(); ++t)
    for (Index p : mesh_.tets_[t].points) {
      const auto at = std::lower_bound(split.begin(), split.end(), p);
      if (at != split.end() && *at == p) stars[at - split.begin()].push_back(static_cast<Index>(t));
    }
  LocalNumbers seen;
  std::vector<Index> part;
  std::vector<std::array<Index, 2>> copies;
  for (std::size_t i = 0; i < split.size(); ++i) {
    std::vector<Index>& left = stars[i];
    Index id = split[i];
    while (!left.empty()) {
      part_of_star(split[i], left.front(), seen, part);
      std::sort(part.begin(), part.end());
      std::vector<Index> others;
      std::set_difference(left.begin(), left.end(), part.begin(), part.end(), std::back_inserter(others));
      if (id != split[i]) {
        copies.push_back({id, split[i]});
        frozen.push_back(id);
        mesh_.positions_.push_back(mesh_.positions_[split[i]]);
        mesh_.incident_tets_.push_back(no_index);
        for (Index t : part) mesh_.tets_[t].points[mesh_.slot_of(t, split[i])] = id;
      }
      mesh_.incident_tets_[id] = part.front();
      left = std::move(others);
      id = static_cast<Index>(mesh_.positions_.size());
    }
  }
  return copies;
}

void MeshBuilder::split_stars() {
  const std::vector<Index> split = points_with_split_stars();
  std::vector<Index> frozen = points_of_glued_tets();
  if (split.empty() && frozen.empty()) return;
  frozen.insert(frozen.end(), split.begin(), split.end());
  const std::vector<std::array<Index, 2>> copies = split_points(split, frozen);
  const std::size_t points = mesh_.positions_.size();
  mesh_.touched_.assign(points, 0);
  mesh_.originals_.resize(points);
  std::iota(mesh_.originals_.begin(), mesh_.originals_.end(), Index{0});
  for (const auto& [copy, original] : copies) mesh_.originals_[copy] = original;
  mesh_.reservations_.reset(points);
  mesh_.free_points_.reset(points, points);
  mesh_.frozen_.assign(points, 0);
  for (Index p : frozen) mesh_.frozen_[p] = EditableMesh::with_tets;
  // Also freeze all their tets: a change next to these points could make other parts touch there.
  std::vector<std::uint8_t> around(points, 0);
  for (const TetRecord& t : mesh_.tets_)
    if (std::any_of(t.points.begin(), t.points.end(), [&](Index p) { return mesh_.frozen_[p] != 0; }))
      for (Index p : t.points) around[p] = EditableMesh::with_tets;
  mesh_.frozen_ = std::move(around);
}

void MeshBuilder::part_of_star(Index point, Index first, LocalNumbers& seen, std::vector<Index>& part) const {
  seen.clear();
  part.assign(1, first);
  bool added;
  seen.number(first, added);
  for (std::size_t i = 0; i < part.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const TetRecord& t = mesh_.tets_[part[i]];
      if (t.points[k] == point || t.links[k].is_outside()) continue;
      seen.number(t.links[k].tet(), added);
      if (added) part.push_back(t.links[k].tet());
    }
}

}  // namespace tetwright
