#include "simplify/mesh/mesh_builder.h"

#include <algorithm>
#include <numeric>

#include "common/error.h"
#include "common/mesh/face_buckets.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

constexpr std::size_t grain = 8192;  ///< tets or points a parallel loop hands out at a time

/// Lowers `smallest` to `value`: the first place in the file is named, whichever thread finds it.
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
  if (input.tets.size() >= no_index / 4)
    throw InputError(name_, 0, std::to_string(input.tets.size()) + " tets are more than the 2^30 possible");
  mesh_.names_ = std::move(input.material_names);
  take_points(std::move(input.points));
  take_tets(input);
  input = TetMesh();
  mesh_.live_ = static_cast<std::int64_t>(mesh_.tets_.size());
  mesh_.free_tets_.reset(mesh_.tets_.size(), mesh_.tets_.size());
  mesh_.locks_.reset(mesh_.positions_.size());
  mesh_.free_points_.reset(mesh_.positions_.size(), mesh_.positions_.size());
  mesh_.touched_.assign(mesh_.positions_.size(), 0);
  link_faces();
  mesh_.set_incident_tets();
  split_stars();
}

void MeshBuilder::take_points(std::vector<Vec3>&& points) {
  for (const Vec3& p : points)
    if (!p.allFinite()) throw InputError(name_, 0, "a coordinate is not finite");
  mesh_.space_ = WorkingSpace::of(points);
  if (!mesh_.space_.valid()) throw InputError(name_, 0, "coordinates are too far apart");
  mesh_.positions_ = std::move(points);
  for (Vec3& p : mesh_.positions_) p = mesh_.space_.to_working(p);
}

void MeshBuilder::take_tets(const TetMesh& input) {
  std::vector<MaterialTag>& tags = mesh_.tags_;
  tags = input.materials;
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  mesh_.tets_.resize(input.tets.size());
  std::atomic<Index> first_bad{no_index};
  parallel_for(0, input.tets.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = input.tets[i];
      const auto region = std::lower_bound(tags.begin(), tags.end(), input.materials[i]) - tags.begin();
      mesh_.tets_[i] = {t, dead_tet, static_cast<RegionId>(region), 0};
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
  parallel_for(0, mesh_.positions_.size(), grain, [&](std::size_t begin, std::size_t end) {
    Buckets::Workspace ws;
    for (std::size_t p = begin; p < end; ++p)
      buckets.visit(static_cast<Index>(p), tet_at, ws,
                    [&](const Triangle&, std::span<const Buckets::Use> uses) {
                      if (uses.size() == 1) return;
                      const Buckets::Use &s = uses[0], &u = uses[1];
                      // Two positive tets on opposite sides of a face list it in opposite senses.
                      if (uses.size() > 2 || s.even == u.even) lower(bad, 4 * s.tet + s.face);
                      if (uses.size() > 2) return;
                      tets[s.tet].neighbours[s.face] = u.tet;
                      tets[u.tet].neighbours[u.face] = s.tet;
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

std::vector<Index> MeshBuilder::points_with_split_stars() const {
  std::vector<Index> tets_at(mesh_.positions_.size(), 0);
  for (const TetRecord& t : mesh_.tets_)
    for (Index p : t.points) ++tets_at[p];
  return parallel_collect<Index>(0, mesh_.positions_.size(), grain,
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
  std::vector<Index> points;
  for (const TetRecord& t : mesh_.tets_)
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = 0; l < k; ++l)
        if (t.neighbours[k] != no_index && t.neighbours[k] == t.neighbours[l])
          points.insert(points.end(), t.points.begin(), t.points.end());
  return points;
}

std::vector<std::array<Index, 2>> MeshBuilder::split_points(const std::vector<Index>& split,
                                                            std::vector<Index>& pins) {
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
        pins.push_back(id);
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
  const std::vector<Index> glued = points_of_glued_tets();
  if (split.empty() && glued.empty()) return;
  std::vector<Index> pins = split;
  pins.insert(pins.end(), glued.begin(), glued.end());
  const std::vector<std::array<Index, 2>> copies = split_points(split, pins);
  const std::size_t points = mesh_.positions_.size();
  mesh_.touched_.assign(points, 0);
  mesh_.pinned_.assign(points, 0);
  for (Index p : pins) mesh_.pinned_[p] = 1;
  // Copies that took the place of a glued tet's point are pinned with the others.
  mesh_.originals_.resize(points);
  std::iota(mesh_.originals_.begin(), mesh_.originals_.end(), Index{0});
  for (const auto& [copy, original] : copies) mesh_.originals_[copy] = original;
  mesh_.locks_.reset(points);
  mesh_.free_points_.reset(points, points);
}

void MeshBuilder::part_of_star(Index point, Index first, LocalNumbers& seen, std::vector<Index>& part) const {
  seen.clear();
  part.assign(1, first);
  bool added;
  seen.number(first, added);
  for (std::size_t i = 0; i < part.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const TetRecord& t = mesh_.tets_[part[i]];
      if (t.points[k] == point || t.neighbours[k] == no_index) continue;
      seen.number(t.neighbours[k], added);
      if (added) part.push_back(t.neighbours[k]);
    }
}

}  // namespace tetwright
