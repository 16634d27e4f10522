// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/beyond_border.h"

#include <utility>

#include "mesher/tuning/cut_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

void clear_far_beyond(const MaterialField& field, const LatticePoints& points,
                      std::vector<NearestRegion>& regions) {
  const VoxelVolume* volume = field.volume();
  if (!volume || !field.frame().continues()) return;
  parallel_for(0, regions.size(), CutGrains::tets, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (volume->leaves_out(regions[i].region, points.positions[i]) &&
          volume->is_far_beyond(points.positions[i]))
        regions[i] = {outside_region, static_cast<float>(field.band())};
  });
}

void drop_beyond_border(const MaterialField& field, CutMesh& mesh) {
  const VoxelVolume* volume = field.volume();
  if (!volume || !field.frame().continues()) return;
  std::vector<std::uint8_t> is_left_out(mesh.tets.size());
  parallel_for(0, mesh.tets.size(), CutGrains::tets, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, c, d] = mesh.tets[i];
      const Vec3 middle = (mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d]) / 4;
      is_left_out[i] = volume->leaves_out(mesh.regions[i], middle);
    }
  });
  std::vector<Index> number(mesh.points.size(), no_index);
  std::size_t tets = 0;
  Index next = 0;
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    if (is_left_out[i]) continue;
    Tet t = mesh.tets[i];
    for (Index& p : t) {
      if (number[p] == no_index) number[p] = next++;
      p = number[p];
    }
    mesh.tets[tets] = t;
    mesh.regions[tets++] = mesh.regions[i];
  }
  mesh.tets.resize(tets);
  mesh.regions.resize(tets);
  std::vector<Vec3> points(next);
  std::vector<std::uint8_t> on_interface(next);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] != no_index) {
      points[number[p]] = mesh.points[p];
      on_interface[number[p]] = mesh.on_interface[p];
    }
  mesh.points = std::move(points);
  mesh.on_interface = std::move(on_interface);
}

std::vector<std::uint8_t> on_interface_off_border(const MaterialField& field, const CutMesh& mesh) {
  std::vector<std::uint8_t> flags = mesh.on_interface;
  const GridFrame& frame = field.frame();
  if (!frame.continues()) return flags;
  for (std::size_t p = 0; p < flags.size(); ++p)
    if (side_planes(mesh.points[p], frame.border)) flags[p] = 0;
  return flags;
}

}  // namespace tetwright
