#include "simplify/mesh/editable_mesh.h"

#include <algorithm>

#include "common/geometry/predicates.h"
#include "common/mesh/face_buckets.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"
#include "simplify/mesh/compaction.h"
#include "simplify/mesh/mesh_builder.h"

namespace tetwright {

namespace {

constexpr std::size_t grain = 8192;  ///< tets a parallel loop hands out at a time

}  // namespace

EditableMesh::EditableMesh(TetMesh&& mesh, const std::string& name) {
  MeshBuilder(*this, name).build(std::move(mesh));
}

void EditableMesh::compact(std::size_t spare_tets, std::size_t spare_points) {
  MeshCompaction(*this).run(spare_tets, spare_points);
}

TetMesh EditableMesh::to_mesh() && { return MeshCompaction(*this).to_mesh(); }

void EditableMesh::set_incident_tets() {
  incident_tets_.assign(positions_.size(), no_index);
  for (std::size_t t = tets_.size(); t-- > 0;)
    if (tets_[t].points[0] != no_index)
      for (Index p : tets_[t].points) incident_tets_[p] = static_cast<Index>(t);
}

std::size_t EditableMesh::pinned_points() const {
  std::size_t count = 0;
  for (Index p = 0; p < pinned_.size(); ++p) count += pinned_[p] && originals_[p] == p;
  return count;
}

std::vector<InterfaceFace> EditableMesh::interface_faces() const {
  return parallel_collect<InterfaceFace>(
      0, tets_.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<InterfaceFace>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const auto t = static_cast<Index>(i);
          const TetRecord& r = tets_[t];
          if (r.points[0] == no_index) continue;
          for (int f = 0; f < 4; ++f) {
            const Index other = r.neighbours[f];
            if (other != no_index && (other < t || tets_[other].region == r.region)) continue;
            const auto& c = tet_faces[f];
            out.push_back({{r.points[c[0]], r.points[c[1]], r.points[c[2]]}, r.region, region_across(t, f)});
          }
        }
      });
}

double EditableMesh::signed_volume(Index t) const {
  const Tet& p = tets_[t].points;
  return orient3d_value(positions_[p[0]], positions_[p[1]], positions_[p[2]], positions_[p[3]]) / 6;
}

double EditableMesh::total_volume() const {
  return parallel_sum(0, tets_.size(), grain, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = tets_[i].points;
      if (t[0] != no_index)
        sum += orient3d_value(positions_[t[0]], positions_[t[1]], positions_[t[2]], positions_[t[3]]) / 6;
    }
    return sum;
  });
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
      const Index n = r.neighbours[f];
      if (n == no_index) continue;
      const TetRecord& o = tets_[n];
      if (o.points[0] == no_index) return false;
      const int back = face_towards(n, static_cast<Index>(t));
      if (o.neighbours[back] != t ||
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
