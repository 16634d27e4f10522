// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <limits>

#include "common/mesh/point_table.h"
#include "common/mesh/tet_tree.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr std::size_t sample_grain = 1024;

/// Copies `fields` for another number of points or tets, without values.
std::vector<MeshField> empty_fields(const std::vector<MeshField>& fields, std::size_t count) {
  std::vector<MeshField> result;
  result.reserve(fields.size());
  for (const MeshField& f : fields)
    result.push_back({f.name, f.components, f.integer,
                      std::vector<double>(count * static_cast<std::size_t>(f.components),
                                          f.integer ? 0 : std::numeric_limits<double>::quiet_NaN())});
  return result;
}

void copy_values(const std::vector<MeshField>& from, std::size_t i, std::vector<MeshField>& to,
                 std::size_t j) {
  for (std::size_t f = 0; f < from.size(); ++f) {
    const auto components = static_cast<std::size_t>(from[f].components);
    for (std::size_t k = 0; k < components; ++k)
      to[f].values[j * components + k] = from[f].values[i * components + k];
  }
}

void interpolate(const std::vector<MeshField>& from, const Tet& t, const TetWeights& weights,
                 std::vector<MeshField>& to, std::size_t j) {
  int main = 0;
  for (int i = 1; i < 4; ++i)
    if (weights[i] > weights[main] || (weights[i] == weights[main] && t[i] < t[main])) main = i;
  for (std::size_t f = 0; f < from.size(); ++f) {
    const auto components = static_cast<std::size_t>(from[f].components);
    for (std::size_t k = 0; k < components; ++k) {
      const auto value = [&](int i) { return from[f].values[t[i] * components + k]; };
      double sum = value(main);
      // Interpolating differences reproduces equal values bit by bit. Terms of weight 0 are skipped, since 0
      // * NaN is NaN.
      if (!from[f].integer)
        for (int i = 0; i < 4; ++i)
          if (i != main && weights[i] > 0) sum += weights[i] * (value(i) - value(main));
      to[f].values[j * components + k] = sum;
    }
  }
}

void transfer_point_fields(const TetMesh& before, TetMesh& after) {
  after.point_fields = empty_fields(before.point_fields, after.points.size());
  if (before.point_fields.empty()) return;
  PointTable places(before.points, before.points.size());
  for (std::size_t p = 0; p < before.points.size(); ++p) places.add(static_cast<Index>(p));
  const TetTree tree(before, TetTree::Order::place);
  parallel_for(0, after.points.size(), sample_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      if (const Index same = places.find(after.points[p]); same != no_index) {
        copy_values(before.point_fields, same, after.point_fields, p);
      } else if (const FoundTet found = tree.find(after.points[p], tree.all()); found.tet != no_index) {
        interpolate(before.point_fields, before.tets[found.tet], found.weights, after.point_fields, p);
      }
    }
  });
}

void transfer_cell_fields(const TetMesh& before, TetMesh& after) {
  after.cell_fields = empty_fields(before.cell_fields, after.tets.size());
  if (before.cell_fields.empty()) return;
  const TetTree tree(before, TetTree::Order::material_place);
  parallel_for(0, after.tets.size(), sample_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      Vec3 centroid = Vec3::Zero();
      for (const Index p : after.tets[t]) centroid += after.points[p] / 4;
      const FoundTet found = tree.find(centroid, tree.of(after.materials[t]));
      if (found.tet != no_index) copy_values(before.cell_fields, found.tet, after.cell_fields, t);
    }
  });
}

}  // namespace

void transfer_fields(const TetMesh& before, TetMesh& after) {
  transfer_point_fields(before, after);
  transfer_cell_fields(before, after);
}

}  // namespace tetwright
