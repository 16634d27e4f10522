// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_part.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/mesh/point_table.h"
#include "mesher/field_mesher.h"
#include "tools/bricks/surface_thinning.h"
#include "tools/tuning/brick_rounds_tuning.h"

namespace tetwright {

namespace {

/// Divides the faces of a brick's dense mesh into those of the volume's surface and those where it was cut
/// off.
void keep_surface(const TetMesh& dense, const std::vector<std::uint8_t>& shared, BrickPart& part) {
  std::vector<Index> number(dense.points.size(), no_index);
  const auto renumbered = [&](InterfaceTriangle t) {
    for (Index& p : t.ids) {
      if (number[p] == no_index) {
        number[p] = static_cast<Index>(part.surface.points.size());
        part.surface.points.push_back(dense.points[p]);
        part.surface_shared.push_back(shared[p]);
      }
      p = number[p];
    }
    return t;
  };
  for (const InterfaceTriangle& t : dense.interfaces) {
    const bool cut = !t.other && t.patch == 0 &&
                     std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return shared[p] != 0; });
    (cut ? part.cut_faces : part.surface.interfaces).push_back(renumbered(t));
  }
}

/// Thins the dense surface of a part, and keeps its statistics.
/// \param density final tets per volume
void thin_dense_surface(double density, BrickPart& part) {
  part.dense.interfaces = mesh_statistics(part.surface).interfaces;
  // Edges of regular tets of the mean final volume.
  const double edge = std::cbrt(6 * std::sqrt(2.0) / density);
  thin_surface(part.surface, part.surface_shared, BrickRoundsTuning::Surface::distance_edges * edge,
               part.cut_faces);
}

}  // namespace

std::vector<std::uint8_t> flags_of(const TetMesh& mesh, const std::vector<Vec3>& shared) {
  PointTable known(shared, shared.size());
  for (Index p = 0; p < shared.size(); ++p) known.add(p);
  std::vector<std::uint8_t> flags(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) flags[p] = BrickPart::on_interface;
  for (std::size_t p = 0; p < flags.size(); ++p)
    if (known.find(mesh.points[p]) != no_index) flags[p] |= BrickPart::shared;
  return flags;
}

BrickPart make_brick_part(const BrickMesher& mesher, const CellBox& box, const BrickTask& task,
                          double density, CoarsenOptions options, double threshold, Progress* progress) {
  BrickPart part;
  part.kept_surface = task.keep_surface;
  BrickMesh made = mesher.mesh(box, task.halo, progress);
  part.border = std::move(made.border);
  part.leaves = made.leaves;
  part.lattice_tets = made.lattice_tets;
  part.isolated_vertices = made.isolated_vertices;
  if (made.mesh.tets.empty()) return part;
  DenseMesh dense;
  set_mesh(std::move(made.mesh), mesher.field(), dense);
  keep_surface(dense.mesh, made.shared, part);
  std::vector<InterfaceTriangle> interfaces = std::move(dense.mesh.interfaces);
  dense.mesh.interfaces.clear();
  part.dense = mesh_statistics(dense.mesh, threshold);
  part.dense.points -= static_cast<std::size_t>(std::count(made.shared.begin(), made.shared.end(), 1));
  dense.mesh.interfaces = std::move(interfaces);
  std::vector<Vec3> shared;
  for (std::size_t p = 0; p < made.shared.size(); ++p)
    if (made.shared[p]) shared.push_back(dense.mesh.points[p]);
  options.target_tets = density * part.dense.volume;
  options.reference = dense.reference.get();
  options.frozen = std::move(made.shared);
  if (task.keep_surface)
    for (const InterfaceTriangle& t : dense.mesh.interfaces)
      if (!t.other && t.patch == 0)
        for (const Index p : t.ids) options.frozen[p] = 1;
  part.mesh = coarsen(std::move(dense.mesh), options, nullptr, progress);
  part.flags = flags_of(part.mesh, shared);
  if (task.thin) thin_dense_surface(density, part);
  std::erase_if(part.mesh.interfaces, [](const InterfaceTriangle& t) { return t.patch == 0; });
  return part;
}

}  // namespace tetwright
