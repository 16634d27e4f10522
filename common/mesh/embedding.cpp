// SPDX-License-Identifier: Apache-2.0
#include "tetwright/embedding.h"

#include "common/geometry/box_tree.h"
#include "common/mesh/tet_tree.h"
#include "common/tolerances.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr std::size_t embedding_grain = 1024;

}  // namespace

Embedding embed_points(const TetMesh& mesh, std::span<const Vec3> points, const std::string& mesh_name) {
  std::vector<Index> usable = usable_tets(mesh);
  if (usable.empty())
    throw InputError(mesh_name, 0,
                     "none of its " + std::to_string(mesh.tets.size()) +
                         " tets has a positive volume, so that nothing can be embedded; check the mesh");
  const TetTree tree(mesh, std::move(usable));
  Embedding made;
  made.tets.resize(points.size());
  made.nodes.resize(points.size());
  made.weights.resize(points.size());
  made.distances.resize(points.size());
  parallel_for(0, points.size(), embedding_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const FoundTet found = tree.find_exactly(points[p]);
      made.tets[p] = found.tet;
      made.nodes[p] = mesh.tets[found.tet];
      made.weights[p] = found.weights;
      made.distances[p] = found.distance;
    }
  });
  return made;
}

EmbeddingSummary summary_of(const Embedding& embedding, const TetMesh& mesh, std::span<const Vec3> points) {
  Box3 box;
  for (const Tet& tet : mesh.tets)
    for (const Index p : tet) box.add(mesh.points[p]);
  const double inside = tolerance::within_mesh * (box.high - box.low).norm();
  EmbeddingSummary summary;
  summary.points = points.size();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double distance = embedding.distances[p];
    summary.outside += distance > inside;
    if (p > 0 && !(distance > summary.largest_distance)) continue;
    summary.largest_distance = distance;
    summary.place = points[p];
  }
  return summary;
}

}  // namespace tetwright
