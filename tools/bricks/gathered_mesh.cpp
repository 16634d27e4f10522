// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/gathered_mesh.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "common/geometry/self_intersection.h"
#include "common/mesh/point_joining.h"
#include "common/parallel/parallel_sort.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

Triangle ascending(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

struct KeyedFace {
  Triangle key;  ///< ascending points
  InterfaceTriangle face;
  bool operator<(const KeyedFace& other) const {
    return key != other.key ? key < other.key : face.material < other.face.material;
  }
};

/// Adds those of the cut faces that separate two materials, or a material from the outside, ascending.
void add_interfaces(std::vector<KeyedFace> cut, std::vector<InterfaceTriangle>& interfaces) {
  parallel_sort(cut);
  for (std::size_t i = 0; i < cut.size(); ++i) {
    InterfaceTriangle face = cut[i].face;
    if (i + 1 < cut.size() && cut[i + 1].key == cut[i].key) {
      face.other = cut[++i].face.material;
      TETWRIGHT_CHECK(i + 1 == cut.size() || cut[i + 1].key != cut[i].key);
      if (face.is_sheet()) continue;
    }
    interfaces.push_back(face);
  }
}

/// Sets the patches of the faces on the border of the volume.
void set_patches(std::vector<KeyedFace> patched, std::vector<InterfaceTriangle>& interfaces) {
  if (patched.empty()) return;
  parallel_sort(patched);
  for (InterfaceTriangle& t : interfaces) {
    if (t.other) continue;
    const KeyedFace wanted{ascending(t.ids), {{}, std::numeric_limits<MaterialTag>::min(), {}}};
    const auto found = std::lower_bound(patched.begin(), patched.end(), wanted);
    if (found != patched.end() && found->key == wanted.key) t.patch = found->face.patch;
  }
}

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
TetMesh joined_surface(std::vector<BrickPart>& parts) {
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
      cut.push_back({ascending(face.ids), face});
    }
  }
  add_interfaces(std::move(cut), all.interfaces);
  drop_unused_points(all);
  return all;
}

/// GatheredMesh::meeting.
/// \param brick_of the brick of a boundary face, or the number of bricks if none has moved it
template <class BrickOf>
std::vector<std::size_t> meeting_bricks(const TetMesh& mesh, const BrickOf& brick_of) {
  std::vector<Triangle> boundary;
  std::vector<std::size_t> bricks;
  bool any = false;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (!t.other) {
      boundary.push_back(t.ids);
      bricks.push_back(brick_of(t));
      any |= t.patch == 0;
    }
  std::vector<std::size_t> meeting;
  if (!any) return meeting;  // the border of the volume is flat
  for (const auto& [first, second] : self_intersections(mesh.points, boundary))
    if (bricks[first] != bricks[second]) meeting.insert(meeting.end(), {bricks[first], bricks[second]});
  std::sort(meeting.begin(), meeting.end());
  meeting.erase(std::unique(meeting.begin(), meeting.end()), meeting.end());
  return meeting;
}

}  // namespace

GatheredMesh gather(std::vector<BrickPart>& parts, std::map<MaterialTag, std::string> names) {
  GatheredMesh all;
  all.dense = statistics_of(parts);
  for (const BrickPart& part : parts) {
    all.leaves += part.leaves;
    all.lattice_tets += part.lattice_tets;
    all.isolated_vertices += part.isolated_vertices;
  }
  std::vector<std::vector<std::uint8_t>> shared;
  std::vector<PiecePoints> pieces;
  std::size_t tets = 0;
  for (const BrickPart& part : parts) {
    std::vector<std::uint8_t>& of_part = shared.emplace_back(part.flags);
    for (std::uint8_t& flag : of_part) flag &= BrickPart::shared;
    pieces.push_back({part.mesh.points, of_part});
    tets += part.mesh.tets.size();
  }
  JoinedPoints points = join_points(pieces);
  TetMesh& mesh = all.mesh;
  mesh.points.resize(points.count);
  mesh.tets.reserve(tets);
  mesh.materials.reserve(tets);
  std::vector<std::uint8_t> candidates(points.count), shared_points(points.count);
  std::vector<std::uint32_t> brick_of_point(points.count);
  std::vector<KeyedFace> patched;
  for (std::size_t b = 0; b < parts.size(); ++b) {
    const TetMesh& part = parts[b].mesh;
    const std::vector<Index> numbers = std::move(points.numbers[b]);
    for (std::size_t p = 0; p < numbers.size(); ++p) {
      mesh.points[numbers[p]] = part.points[p];
      candidates[numbers[p]] |= parts[b].flags[p];
      shared_points[numbers[p]] = shared[b][p];
      brick_of_point[numbers[p]] = static_cast<std::uint32_t>(b);
    }
    for (Tet t : part.tets) {
      for (Index& p : t) p = numbers[p];
      mesh.tets.push_back(t);
    }
    mesh.materials.insert(mesh.materials.end(), part.materials.begin(), part.materials.end());
    for (InterfaceTriangle t : part.interfaces) {
      for (Index& p : t.ids) p = numbers[p];
      patched.push_back({ascending(t.ids), t});
    }
  }
  // Shared points are frozen, so the coarsened meshes have all of them.
  all.dense.points +=
      static_cast<std::size_t>(std::count(shared_points.begin(), shared_points.end(), BrickPart::shared));
  mesh.interfaces = find_interfaces(mesh, &candidates);
  set_patches(std::move(patched), mesh.interfaces);
  mesh.material_names = std::move(names);
  all.meeting = meeting_bricks(mesh, [&](const InterfaceTriangle& t) {
    // A face of shared points alone was not moved.
    const auto moved = std::find_if(t.ids.begin(), t.ids.end(), [&](Index p) { return !shared_points[p]; });
    return moved == t.ids.end() ? parts.size() : brick_of_point[*moved];
  });
  if (!all.meeting.empty()) return all;
  std::vector<std::vector<std::uint8_t>>().swap(shared);
  for (std::vector<std::uint8_t>* of_points : {&candidates, &shared_points})
    std::vector<std::uint8_t>().swap(*of_points);
  std::vector<std::uint32_t>().swap(brick_of_point);
  for (BrickPart& part : parts) {
    part.mesh = {};
    std::vector<std::uint8_t>().swap(part.flags);
  }
  for (const auto& [tag, material] : all.dense.materials) all.original.volumes[tag] = material.volume;
  all.original.tets = all.dense.tets;
  all.original.surface = joined_surface(parts);
  MeshStatistics faces = mesh_statistics(all.original.surface);
  all.dense.interfaces = std::move(faces.interfaces);
  all.dense.junction_edges = faces.junction_edges;
  return all;
}

}  // namespace tetwright
