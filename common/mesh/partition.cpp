// SPDX-License-Identifier: Apache-2.0
#include "tetwright/partition.h"

#include <algorithm>

#include "common/mesh/disjoint_sets.h"
#include "common/mesh/part_points.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

PartPoints::PartPoints(std::span<const Index> of_tets, std::size_t corners, std::size_t points,
                       const TetPartition& partition)
    : owners_(points, none), shared_(points, 0) {
  for (std::size_t i = 0; i < of_tets.size(); ++i) {
    const PartNumber part = partition.of(i / corners);
    PartNumber& owner = owners_[of_tets[i]];
    if (owner != none && owner != part) shared_[of_tets[i]] = 1;
    owner = std::min(owner, part);
  }
  for (std::size_t i = 0; i < of_tets.size(); ++i)
    if (shared_[of_tets[i]]) uses_.emplace_back(of_tets[i], partition.of(i / corners));
  std::sort(uses_.begin(), uses_.end());
  uses_.erase(std::unique(uses_.begin(), uses_.end()), uses_.end());
}

void PartPoints::add_parts(Index point, std::vector<PartNumber>& parts) const {
  for (auto use = std::lower_bound(uses_.begin(), uses_.end(), std::pair(point, PartNumber{0}));
       use != uses_.end() && use->first == point; ++use)
    parts.push_back(use->second);
}

PartitionStatistics partition_statistics(const TetMesh& mesh, const TetPartition& partition) {
  PartitionStatistics statistics;
  statistics.parts.resize(partition.parts);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) ++statistics.parts[partition.of(t)].tets;
  std::size_t largest = 0;
  for (const PartSize& part : statistics.parts) largest = std::max(largest, part.tets);
  if (!mesh.tets.empty())
    statistics.imbalance =
        static_cast<double>(largest) * partition.parts / static_cast<double>(mesh.tets.size()) - 1;

  static_assert(sizeof(Tet) == 4 * sizeof(Index));
  const PartPoints points({mesh.tets.empty() ? nullptr : mesh.tets[0].data(), 4 * mesh.tets.size()}, 4,
                          mesh.points.size(), partition);
  points.for_each([&](Index, PartNumber part) { ++statistics.parts[part].points; });
  std::vector<std::pair<PartNumber, PartNumber>> neighbours;
  for_each_ghost(mesh, partition, points, [&](PartNumber part, Index tet) {
    ++statistics.parts[part].ghosts;
    const std::pair<PartNumber, PartNumber> both{part, partition.of(tet)};
    if (neighbours.empty() || neighbours.back() != both) neighbours.push_back(both);
  });
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  for (const auto& [part, other] : neighbours) ++statistics.parts[part].neighbours;

  DisjointSets connected(mesh.tets.size());
  for (const MeshFace& face : mesh_faces(mesh.tets, mesh.points.size())) {
    if (face.second == no_index) continue;
    if (partition.of(face.first) == partition.of(face.second))
      connected.unite(face.first, face.second);
    else
      ++statistics.cut_faces;
  }
  for (Index t = 0; t < mesh.tets.size(); ++t)
    statistics.parts[partition.of(t)].pieces += connected.is_root(t);
  return statistics;
}

}  // namespace tetwright
