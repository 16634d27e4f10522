// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/gathered_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/mesh/point_joining.h"
#include "tools/bricks/joined_parts.h"
#include "tools/bricks/keyed_faces.h"

namespace tetwright {

namespace {

void add(const MeshStatistics& part, MeshStatistics& all) {
  if (part.tets == 0) return;
  all.min_solid_angle =
      all.tets == 0 ? part.min_solid_angle : std::min(all.min_solid_angle, part.min_solid_angle);
  // The sum, until all parts are added.
  all.mean_solid_angle += part.mean_solid_angle * static_cast<double>(part.tets);
  all.tets += part.tets;
  all.points += part.points;
  all.volume += part.volume;
  all.below_count += part.below_count;
  // A comparison with NaN is false, and fmin() takes the number.
  all.min_dihedral = std::fmin(all.min_dihedral, part.min_dihedral);
  all.max_dihedral = std::fmax(all.max_dihedral, part.max_dihedral);
  for (const auto& [tag, material] : part.materials) {
    all.materials[tag].tets += material.tets;
    all.materials[tag].volume += material.volume;
  }
  for (std::size_t a = 0; a < QualityHistogram::angle_bins; ++a)
    for (std::size_t v = 0; v < QualityHistogram::volume_bins; ++v)
      all.histogram.counts[a][v] += part.histogram.counts[a][v];
  for (std::size_t b = 0; b < DihedralHistogram::bins; ++b)
    all.dihedrals.counts[b] += part.dihedrals.counts[b];
}

MeshStatistics statistics_of(const std::vector<BrickPart>& parts) {
  MeshStatistics all;
  for (const BrickPart& part : parts) add(part.dense, all);
  if (all.tets == 0) return all;
  all.mean_solid_angle /= static_cast<double>(all.tets);
  all.below_percent = 100 * static_cast<double>(all.below_count) / static_cast<double>(all.tets);
  return all;
}

/// Removes the points without an interface: those of cut faces between equal materials.
void drop_unused_points(TetMesh& surface) {
  std::vector<Index> number(surface.points.size(), no_index);
  std::vector<Vec3> points;
  for (InterfaceTriangle& t : surface.interfaces)
    for (Index& p : t.ids) {
      if (number[p] == no_index) {
        number[p] = static_cast<Index>(points.size());
        points.push_back(surface.points[p]);
      }
      p = number[p];
    }
  surface.points = std::move(points);
}

/// Joins the surfaces of the dense meshes, and frees each of them.
/// \param faces_across receives the number of faces between bricks: the last ones
TetMesh joined_surface(std::vector<BrickPart>& parts, std::size_t& faces_across) {
  std::vector<PiecePoints> pieces;
  pieces.reserve(parts.size());
  for (const BrickPart& part : parts) pieces.push_back({part.surface.points, part.surface_shared});
  JoinedPoints points = join_points(pieces);
  TetMesh all;
  all.points.resize(points.count);
  std::size_t faces = 0;
  for (const BrickPart& part : parts) faces += part.surface.interfaces.size();
  all.interfaces.reserve(faces);
  std::vector<KeyedFace> cut;
  for (std::size_t b = 0; b < parts.size(); ++b) {
    const std::vector<Index> numbers = std::move(points.numbers[b]);
    const TetMesh surface = std::exchange(parts[b].surface, {});
    for (std::size_t p = 0; p < numbers.size(); ++p) all.points[numbers[p]] = surface.points[p];
    const auto renumbered = [&](InterfaceTriangle t) {
      for (Index& p : t.ids) p = numbers[p];
      return t;
    };
    for (const InterfaceTriangle& t : surface.interfaces) all.interfaces.push_back(renumbered(t));
    for (const InterfaceTriangle& t : std::exchange(parts[b].cut_faces, {})) {
      const InterfaceTriangle face = renumbered(t);
      cut.push_back(keyed(face));
    }
  }
  const std::size_t inside = all.interfaces.size();
  add_interfaces(std::move(cut), all.interfaces);
  faces_across = all.interfaces.size() - inside;
  drop_unused_points(all);
  return all;
}

/// Sets the statistics of the dense mesh's faces.
/// \param surface thinned if parts have statistics of their own faces
void set_interfaces(const std::vector<BrickPart>& parts, const TetMesh& surface, std::size_t faces_across,
                    MeshStatistics& dense) {
  MeshStatistics faces = mesh_statistics(surface);
  // Thinning keeps all edges where materials meet.
  dense.junction_edges = faces.junction_edges;
  const auto has_own = [](const BrickPart& part) { return !part.dense.interfaces.empty(); };
  if (std::none_of(parts.begin(), parts.end(), has_own)) {
    dense.interfaces = std::move(faces.interfaces);
    return;
  }
  TetMesh across;
  across.points = surface.points;
  across.interfaces.assign(surface.interfaces.end() - static_cast<std::ptrdiff_t>(faces_across),
                           surface.interfaces.end());
  dense.interfaces = mesh_statistics(across).interfaces;
  for (const BrickPart& part : parts)
    for (const auto& [pair, known] : part.dense.interfaces) {
      dense.interfaces[pair].triangles += known.triangles;
      dense.interfaces[pair].area += known.area;
    }
}

}  // namespace

GatheredMesh gather(std::vector<BrickPart>& parts, std::map<MaterialTag, std::string> names) {
  return gather(parts, parts, 0, std::move(names));
}

GatheredMesh gather(std::vector<BrickPart>& parts, std::vector<BrickPart>& bricks, std::size_t shared_points,
                    std::map<MaterialTag, std::string> names) {
  GatheredMesh all;
  all.dense = statistics_of(bricks);
  for (const BrickPart& brick : bricks) {
    all.leaves += brick.leaves;
    all.lattice_tets += brick.lattice_tets;
    all.isolated_vertices += brick.isolated_vertices;
  }
  JoinedParts joined = join_parts(parts);
  // Shared points are frozen, so the meshes coarsened once have all of them.
  if (&parts == &bricks)
    shared_points =
        static_cast<std::size_t>(std::count(joined.shared.begin(), joined.shared.end(), BrickPart::shared));
  all.dense.points += shared_points;
  all.meeting = meeting_parts(joined, parts.size());
  all.mesh = std::move(joined.mesh);
  all.mesh.material_names = std::move(names);
  if (!all.meeting.empty()) return all;
  joined = {};
  for (BrickPart& part : parts) {
    part.mesh = {};
    std::vector<std::uint8_t>().swap(part.flags);
  }
  for (const auto& [tag, material] : all.dense.materials) all.original.volumes[tag] = material.volume;
  all.original.tets = all.dense.tets;
  std::size_t faces_across = 0;
  all.original.surface = joined_surface(bricks, faces_across);
  set_interfaces(bricks, all.original.surface, faces_across, all.dense);
  return all;
}

}  // namespace tetwright
