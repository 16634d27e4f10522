// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/border_sides.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/message_text.h"
#include "mesher/tuning/domain_tuning.h"
#include "mesher/tuning/label_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using Border = LabelTuning::Border;

Box3 box_in_cells(const MesherInput& bodies, const GridFrame& voxels) {
  const Eigen::Matrix3d to_cells = voxels.axes.inverse() / voxels.cell_size;
  Box3 box;
  for (const MesherInput::Body& body : bodies.bodies)
    for (const Vec3& p : body.surface.points) box.add(to_cells * (p - voxels.origin));
  return box;
}

/// LabelTuning::Border::slack in cells, along each axis.
Vec3 slack_in_cells(const LabelInput& labels, const GridFrame& voxels) {
  const CellBox box = voxels.volume();
  std::array<int, 3> size = labels.size;
  Vec3 slack;
  for (int a = 0; a < 3; ++a) slack[a] = Border::slack * (box.high[a] - box.low[a]) / size[a];
  return slack;
}

/// Continues the faces of a closed surface in one side of the volume.
/// \param in_side for each point: it is in that side
void continue_faces(const std::vector<std::uint8_t>& in_side, const Vec3& step, RepairedSurface& surface) {
  const auto is_in = [&](const Triangle& t) { return in_side[t[0]] && in_side[t[1]] && in_side[t[2]]; };
  using Edge = std::pair<Index, Index>;
  std::set<Edge> edges;
  for (const Triangle& t : surface.triangles)
    if (is_in(t))
      for (std::size_t k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
  if (edges.empty()) return;
  std::map<Index, Index> moved;
  const auto moved_of = [&](Index p) {
    const auto [known, is_new] = moved.try_emplace(p, static_cast<Index>(surface.points.size()));
    if (is_new) surface.points.push_back(surface.points[p] + step);
    return known->second;
  };
  const std::size_t count = surface.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle old = surface.triangles[i];
    if (!is_in(old)) continue;
    for (std::size_t k = 0; k < 3; ++k) surface.triangles[i][k] = moved_of(old[k]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Index u = old[k], v = old[(k + 1) % 3];
      if (edges.contains({v, u})) continue;
      surface.triangles.push_back({u, v, moved_of(v)});
      surface.triangles.push_back({u, moved_of(v), moved_of(u)});
      if (!surface.groups.empty()) surface.groups.insert(surface.groups.end(), 2, surface.groups[i]);
    }
  }
}

/// Drops points that no triangle has, and measures the box again.
void tidy(RepairedSurface& surface) {
  std::vector<Index> number(surface.points.size(), no_index);
  std::vector<Vec3> points;
  Box3 box;
  for (Triangle& t : surface.triangles)
    for (Index& p : t) {
      if (number[p] == no_index) {
        number[p] = static_cast<Index>(points.size());
        points.push_back(surface.points[p]);
        box.add(points.back());
      }
      p = number[p];
    }
  surface.points = std::move(points);
  surface.low = box.low;
  surface.high = box.high;
}

}  // namespace

GridFrame frame_around(const MesherInput& bodies, const GridFrame& voxels, const std::string& file) {
  const Box3 box = box_in_cells(bodies, voxels);
  std::array<int, 3> before{}, after{};
  for (int a = 0; a < 3; ++a) {
    const auto needed = [&](double room) {
      if (room >= Border::min_room) return 0;
      constexpr double too_many = DomainTuning::Frames::max_resolution;
      return Border::room + static_cast<int>(std::ceil(std::clamp(-room, 0.0, too_many)));
    };
    before[a] = needed(box.low[a]);
    after[a] = needed(voxels.box[a] - box.high[a]);
    const double cells = 1.0 * voxels.box[a] + before[a] + after[a];
    if (cells > DomainTuning::Frames::max_resolution)
      throw InputError(bodies.bodies.front().file, 0,
                       "a mesh of the bodies and the volume " + file + " would have " + short_number(cells) +
                           " cells along a side; at most " +
                           std::to_string(DomainTuning::Frames::max_resolution) +
                           " are possible: check the units, or cut off what is far outside");
  }
  if (before == std::array<int, 3>{} && after == std::array<int, 3>{}) return voxels;
  return continued_frame(voxels, before, after);
}

unsigned crossed_sides(const ImplantedVolume& volume, const GridFrame& voxels) {
  const Box3 box = box_in_cells(volume.bodies, voxels);
  const CellBox border = voxels.volume();
  const Vec3 slack = slack_in_cells(volume.labels, voxels);
  unsigned sides = 0;
  for (int a = 0; a < 3; ++a) {
    if (box.low[a] < border.low[a] - slack[a]) sides |= 1u << 2 * a;
    if (box.high[a] > border.high[a] + slack[a]) sides |= 2u << 2 * a;
  }
  return sides;
}

RepairedSurface continued_beyond(const ImplantedVolume& volume, const GridFrame& voxels, unsigned crossed,
                                 RepairedSurface surface) {
  if (!voxels.continues() || surface.closed != surface.triangles.size()) return surface;
  const Eigen::Matrix3d to_cells = voxels.axes.inverse() / voxels.cell_size;
  const Vec3 slack = slack_in_cells(volume.labels, voxels);
  const std::size_t count = surface.triangles.size();
  // One side after the other: where two meet, the second one continues what the first one has added.
  for (int a = 0; a < 3; ++a)
    for (const bool upper : {false, true}) {
      if (crossed >> (2 * a + upper) & 1) continue;
      const int side = upper ? voxels.border.high[a] : voxels.border.low[a];
      std::vector<std::uint8_t> in_side;
      for (const Vec3& p : surface.points)
        in_side.push_back(std::abs((to_cells.row(a) * (p - voxels.origin)).value() - side) <= slack[a]);
      continue_faces(in_side, (upper ? 1 : -1) * Border::continuation * voxels.cell_size * voxels.axes.col(a),
                     surface);
    }
  if (surface.triangles.size() != count) tidy(surface);
  surface.closed = surface.triangles.size();
  return surface;
}

}  // namespace tetwright
