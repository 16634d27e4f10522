// SPDX-License-Identifier: Apache-2.0

// The smallest number of tets of a simulation mesh, from volumes and areas.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/box_tree.h"
#include "mesher/input/region_extents.h"
#include "mesher/labels/label_extents.h"
#include "mesher/tuning/estimate_tuning.h"
#include "tetwright/mesher.h"

namespace tetwright {

namespace {

using Filling = EstimateTuning::Filling;

/// Constants that depend on the kind of input.
struct Kind {
  double per_closed_part, per_open_part, per_tet;
};
constexpr Kind of_surfaces{Filling::per_surface_part, Filling::per_surface_part, Filling::surface_per_tet};
constexpr Kind of_labels{Filling::per_closed_interface, Filling::per_contact, Filling::label_per_tet};

/// A material of volume V and area A is as thick as 2 V / A in the mean, and takes tets in proportion to
/// V / (2 V / A)^3. Parts of different thickness take more tets than this mean shows, never fewer.
MinTets min_tets_of(const std::string& name, const RegionExtent& extent, const Kind& kind) {
  const double slenderness = std::pow(extent.area, 3) / (extent.volume * extent.volume),
               closed = static_cast<double>(extent.closed_parts),
               open = static_cast<double>(extent.open_parts),
               slender = std::max(0.0, slenderness - Filling::of_cube * std::max(1.0, closed));
  const double of_parts = kind.per_closed_part * closed + kind.per_open_part * open;
  return {name, 2 * extent.volume / extent.area, of_parts + extent.unevenness * slender / kind.per_tet,
          of_parts, extent.closed_parts + extent.open_parts};
}

/// Divides the first body into its layers, which lie below its own surface, and what is left. Areas shrink
/// inwards as those of a ball whose volume and area are in the same ratio. Without what is left, if layers
/// take all. \param all without what later bodies take
void add_layers(const MesherInput& input, const RegionExtent& all, std::vector<MinTets>& needs) {
  const RegionExtent own = extent_within(input.bodies[0].surface);
  if (!(own.volume > 0)) return;
  const auto share_left = [&](double depth) {
    return std::max(0.0, 1 - depth * own.area / (3 * own.volume));
  };
  double depth = 0;
  for (const MaterialLayer& layer : input.layers) {
    const double before = share_left(depth), after = share_left(depth += layer.thickness);
    if (!(after > 0)) return;
    needs.push_back(min_tets_of(layer.name,
                                {own.volume * (std::pow(before, 3) - std::pow(after, 3)),
                                 own.area * (before * before + after * after), 2, 0},
                                of_surfaces));
  }
  const double left = share_left(depth), volume = all.volume - own.volume * (1 - std::pow(left, 3));
  if (volume > 0)
    needs.push_back(min_tets_of(
        input.bodies[0].name,
        {volume, all.area - own.area * (1 - left * left), all.closed_parts, all.open_parts}, of_surfaces));
}

/// For each material whether more than half of its voxels are in the box of a body.
std::vector<std::uint8_t> are_in_boxes(const LabelInput& labels, const MesherInput& bodies) {
  std::vector<Box3> boxes(bodies.bodies.size());  // in voxels
  const Eigen::Matrix3d to_voxels = labels.directions.inverse();
  for (std::size_t b = 0; b < boxes.size(); ++b)
    for (const Vec3& p : bodies.bodies[b].surface.points) boxes[b].add(to_voxels * (p - labels.origin));
  std::vector<std::uint64_t> within(labels.materials.size() + 1);
  std::vector<RegionIndex> slice(static_cast<std::size_t>(labels.size[0]) *
                                 static_cast<std::size_t>(labels.size[1]));
  for (int z = 0; z < labels.size[2]; ++z) {
    const auto meets = [&](const Box3& box) { return box.low.z() <= z && z <= box.high.z(); };
    if (std::none_of(boxes.begin(), boxes.end(), meets)) continue;
    labels.regions.read_slices(z, z + 1, slice);
    std::size_t i = 0;
    for (int y = 0; y < labels.size[1]; ++y)
      for (int x = 0; x < labels.size[0]; ++x, ++i)
        within[slice[i]] += std::any_of(boxes.begin(), boxes.end(), [&](const Box3& box) {
          return meets(box) && box.low.y() <= y && y <= box.high.y() && box.low.x() <= x && x <= box.high.x();
        });
  }
  std::vector<std::uint8_t> result(labels.materials.size());
  for (std::size_t m = 0; m < result.size(); ++m) result[m] = within[m + 1] > labels.materials[m].voxels / 2;
  return result;
}

}  // namespace

std::vector<MinTets> min_tets(const MesherInput& input) {
  std::vector<MinTets> needs;
  const std::vector<std::optional<RegionExtent>> extents = region_extents(input);
  for (std::size_t b = 0; b < extents.size(); ++b) {
    if (!extents[b]) continue;
    if (b == 0 && !input.layers.empty())
      add_layers(input, *extents[b], needs);
    else
      needs.push_back(min_tets_of(input.bodies[b].name, *extents[b], of_surfaces));
  }
  return needs;
}

std::vector<MinTets> min_tets(const LabelInput& labels) {
  const std::vector<RegionExtent> extents = label_extents(labels);
  std::vector<MinTets> needs;
  for (std::size_t m = 0; m < extents.size(); ++m)
    needs.push_back(min_tets_of(labels.materials[m].name, extents[m], of_labels));
  return needs;
}

std::vector<MinTets> min_tets(const ImplantedVolume& volume) {
  const std::vector<MinTets> labels = min_tets(volume.labels);
  const std::vector<std::uint8_t> in_boxes = are_in_boxes(volume.labels, volume.bodies);
  std::vector<MinTets> needs;
  for (std::size_t m = 0; m < labels.size(); ++m)
    if (!in_boxes[m]) needs.push_back(labels[m]);
  const std::vector<MinTets> bodies = min_tets(volume.bodies);
  needs.insert(needs.end(), bodies.begin(), bodies.end());
  return needs;
}

}  // namespace tetwright
