// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/tet_count.h"

#include <cmath>

#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using EdgeLengths = SimplifyTuning::EdgeLengths;

}  // namespace

double tets_for_edge(const EditableMesh& mesh, double length) {
  const double ideal = length * mesh.space().scale() / EdgeLengths::edge_to_ideal;
  return mesh.total_volume() / (ideal * ideal * ideal);
}

double tets_for_sizes(const EditableMesh& mesh, const EdgeSizes& sizes) {
  double count = 0;
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    if (mesh.dead(t)) continue;
    const Tet& p = mesh.points(t);
    const Vec3 centre =
        (mesh.position(p[0]) + mesh.position(p[1]) + mesh.position(p[2]) + mesh.position(p[3])) / 4;
    const double edge = sizes.target_length(centre) / EdgeLengths::edge_to_ideal;
    count += std::fabs(mesh.signed_volume(t)) / (edge * edge * edge);
  }
  return count;
}

}  // namespace tetwright
