// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/joined_parts.h"

#include <algorithm>
#include <utility>

#include "common/geometry/self_intersection.h"
#include "common/mesh/point_joining.h"
#include "tetwright/mesh_quality.h"
#include "tools/bricks/keyed_faces.h"

namespace tetwright {

namespace {

/// meeting_parts().
/// \param part_of the part that has moved a boundary face, or the number of parts
template <class PartOf>
std::vector<std::size_t> meeting(const std::vector<Vec3>& points, const std::vector<InterfaceTriangle>& faces,
                                 const PartOf& part_of) {
  std::vector<Triangle> boundary;
  std::vector<std::size_t> parts;
  bool any = false;
  for (const InterfaceTriangle& t : faces)
    if (!t.other) {
      boundary.push_back(t.ids);
      parts.push_back(part_of(t));
      any |= t.patch == 0;
    }
  std::vector<std::size_t> all;
  if (!any) return all;  // the border of the volume is flat
  for (const auto& [first, second] : self_intersections(points, boundary))
    if (parts[first] != parts[second]) all.insert(all.end(), {parts[first], parts[second]});
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<InterfaceTriangle> renumbered(std::vector<InterfaceTriangle> faces,
                                          const std::vector<Index>& numbers) {
  for (InterfaceTriangle& t : faces)
    for (Index& p : t.ids) p = numbers[p];
  return faces;
}

}  // namespace

JoinedParts join_parts(const std::vector<BrickPart>& parts) {
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
  JoinedParts all;
  TetMesh& mesh = all.mesh;
  mesh.points.resize(points.count);
  mesh.tets.reserve(tets);
  mesh.materials.reserve(tets);
  std::vector<std::uint8_t> candidates(points.count);
  all.shared.resize(points.count);
  all.part.resize(points.count);
  std::vector<KeyedFace> patched;
  for (std::size_t b = 0; b < parts.size(); ++b) {
    const TetMesh& part = parts[b].mesh;
    const std::vector<Index> numbers = std::move(points.numbers[b]);
    for (std::size_t p = 0; p < numbers.size(); ++p) {
      mesh.points[numbers[p]] = part.points[p];
      candidates[numbers[p]] |= parts[b].flags[p];
      all.shared[numbers[p]] = shared[b][p];
      all.part[numbers[p]] = static_cast<std::uint32_t>(b);
    }
    for (Tet t : part.tets) {
      for (Index& p : t) p = numbers[p];
      mesh.tets.push_back(t);
    }
    mesh.materials.insert(mesh.materials.end(), part.materials.begin(), part.materials.end());
    for (const InterfaceTriangle& t : renumbered(part.interfaces, numbers)) patched.push_back(keyed(t));
  }
  mesh.interfaces = find_interfaces(mesh, &candidates);
  set_patches(std::move(patched), mesh.interfaces);
  return all;
}

std::vector<std::size_t> meeting_parts(const JoinedParts& joined, std::size_t parts) {
  return meeting(joined.mesh.points, joined.mesh.interfaces, [&](const InterfaceTriangle& t) {
    // A face of shared points alone was not moved.
    const auto moved = std::find_if(t.ids.begin(), t.ids.end(), [&](Index p) { return !joined.shared[p]; });
    return moved == t.ids.end() ? parts : joined.part[*moved];
  });
}

PartBoundary boundary_of(const BrickPart& part) {
  PartBoundary boundary;
  boundary.faces = find_interfaces(part.mesh, &part.flags);
  std::erase_if(boundary.faces, [](const InterfaceTriangle& t) { return t.other.has_value(); });
  std::vector<KeyedFace> patched;
  for (const InterfaceTriangle& t : part.mesh.interfaces) patched.push_back(keyed(t));
  set_patches(std::move(patched), boundary.faces);
  std::vector<Index> number(part.mesh.points.size(), no_index);
  for (InterfaceTriangle& t : boundary.faces)
    for (Index& p : t.ids) {
      if (number[p] == no_index) {
        number[p] = static_cast<Index>(boundary.points.size());
        boundary.points.push_back(part.mesh.points[p]);
        boundary.shared.push_back(part.flags[p] & BrickPart::shared);
      }
      p = number[p];
    }
  return boundary;
}

std::vector<std::size_t> meeting_parts(const std::vector<PartBoundary>& parts) {
  std::vector<PiecePoints> pieces;
  pieces.reserve(parts.size());
  for (const PartBoundary& part : parts) pieces.push_back({part.points, part.shared});
  const JoinedPoints joined = join_points(pieces);
  std::vector<Vec3> points(joined.count);
  std::vector<std::size_t> moved_by(joined.count, parts.size());
  std::vector<InterfaceTriangle> faces;
  std::vector<KeyedFace> cut;
  for (std::size_t b = 0; b < parts.size(); ++b) {
    const std::vector<Index>& numbers = joined.numbers[b];
    for (std::size_t p = 0; p < numbers.size(); ++p) {
      points[numbers[p]] = parts[b].points[p];
      if (!parts[b].shared[p]) moved_by[numbers[p]] = b;
    }
    for (const InterfaceTriangle& t : renumbered(parts[b].faces, numbers)) {
      const bool moved =
          std::any_of(t.ids.begin(), t.ids.end(), [&](Index p) { return moved_by[p] < parts.size(); });
      if (moved)
        faces.push_back(t);
      else
        cut.push_back(keyed(t));
    }
  }
  add_interfaces(std::move(cut), faces);
  return meeting(points, faces, [&](const InterfaceTriangle& t) {
    const auto moved =
        std::find_if(t.ids.begin(), t.ids.end(), [&](Index p) { return moved_by[p] < parts.size(); });
    return moved == t.ids.end() ? parts.size() : moved_by[*moved];
  });
}

}  // namespace tetwright
