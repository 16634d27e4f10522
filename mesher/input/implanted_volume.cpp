// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "common/geometry/box_tree.h"
#include "common/images/grid_box.h"
#include "common/message_text.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

namespace {

using Implants = InputTuning::Implants;

/// Coordinates in which voxel centres are at integers.
class VoxelSpace {
 public:
  explicit VoxelSpace(const LabelInput& labels)
      : origin_(labels.origin), to_index_(labels.directions.inverse()) {}
  Vec3 operator()(const Vec3& place) const { return to_index_ * (place - origin_); }

 private:
  Vec3 origin_;
  Eigen::Matrix3d to_index_;
};

Box3 box_of(const LabelInput& labels) { return box_of_voxels(labels.size, labels.origin, labels.directions); }

std::string box_text(const Box3& box) {
  return "from " + place_text(box.low) + " to " + place_text(box.high);
}

void require_meeting(const LabelInput& labels, const MesherInput::Body& body) {
  const VoxelSpace voxels(labels);
  Box3 box, in_voxels;
  for (const Vec3& p : body.surface.points) {
    box.add(p);
    in_voxels.add(voxels(p));
  }
  bool meets = true;
  for (int a = 0; a < 3; ++a)
    meets &= in_voxels.high[a] > -0.5 && in_voxels.low[a] < labels.size[static_cast<std::size_t>(a)] - 0.5;
  if (!meets)
    throw InputError(body.file, 0,
                     "'" + body.name + "' extends " + box_text(box) + ", and the volume " + labels.file +
                         " " + box_text(box_of(labels)) +
                         ", so that they do not meet; check units and position, and --surface-space");
}

/// Whether names or tags of bodies are taken by labels.
void require_distinct(const LabelInput& labels, const MesherInput& bodies) {
  for (const MesherInput::Body& b : bodies.bodies)
    for (const LabelMaterial& m : labels.materials) {
      if (m.name == b.name)
        throw UsageError("both a label of " + labels.file + " and " + b.file + " are called '" + b.name +
                         "'; give the surface another name by --material NAME=FILE");
      if (m.tag == b.tag)
        throw UsageError("both the label '" + m.name + "' and the body '" + b.name + "' have the tag " +
                         std::to_string(m.tag));
    }
}

/// Voxels to be added before the first and after the last voxel along each axis.
struct Padding {
  std::array<int, 3> before{}, after{};
  bool any() const { return before != std::array<int, 3>{} || after != std::array<int, 3>{}; }
};

/// The padding that keeps bodies off the border.
Padding padding_for(const LabelInput& labels, const MesherInput& bodies) {
  const VoxelSpace voxels(labels);
  Box3 box;
  for (const MesherInput::Body& body : bodies.bodies)
    for (const Vec3& p : body.surface.points) box.add(voxels(p));
  Padding padding;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const double before = box.low[axis] + 0.5, after = labels.size[a] - 0.5 - box.high[axis];
    const auto needed = [&](double room) {
      if (room >= Implants::min_room) return 0;
      const double voxels_needed = std::ceil(Implants::room - room);
      constexpr double max_padding = 1 << 24;  // rejected below
      return static_cast<int>(std::min(voxels_needed, max_padding));
    };
    padding.before[a] = needed(before);
    padding.after[a] = needed(after);
  }
  return padding;
}

RegionGrid padded(const RegionGrid& from, const VoxelIndex& size, const Padding& padding) {
  RegionGrid result(size);
  const auto row = static_cast<std::size_t>(size[0]), slice = row * static_cast<std::size_t>(size[1]);
  std::vector<RegionIndex> layer, old;
  const VoxelIndex& inner = from.size();
  const auto old_row = static_cast<std::size_t>(inner[0]),
             old_slice = old_row * static_cast<std::size_t>(inner[1]);
  for (int first = 0; first < size[2]; first += RegionGrid::side) {
    const int last = std::min(first + RegionGrid::side, size[2]);
    const int low = std::max(first - padding.before[2], 0),
              high = std::min(last - padding.before[2], inner[2]);
    if (low >= high) continue;
    layer.assign(slice * static_cast<std::size_t>(last - first), outside_region);
    old.resize(old_slice * static_cast<std::size_t>(high - low));
    from.read_slices(low, high, old);
    for (int z = low; z < high; ++z)
      for (int y = 0; y < inner[1]; ++y) {
        const auto source =
            old.begin() + static_cast<std::ptrdiff_t>(old_slice * static_cast<std::size_t>(z - low) +
                                                      old_row * static_cast<std::size_t>(y));
        std::copy(source, source + inner[0],
                  layer.begin() + static_cast<std::ptrdiff_t>(
                                      slice * static_cast<std::size_t>(z + padding.before[2] - first) +
                                      row * static_cast<std::size_t>(y + padding.before[1]) +
                                      static_cast<std::size_t>(padding.before[0])));
      }
    result.write_slices(first, layer);
  }
  return result;
}

/// Adds the contacts of the outside with labels at the sides of the volume where voxels are added.
void add_contacts(const Padding& padding, LabelInput& labels) {
  std::vector<std::uint8_t> known(labels.materials.size() + 1, 0);
  const VoxelIndex& size = labels.size;
  for (std::size_t a = 0; a < 3; ++a)
    for (const bool upper : {false, true}) {
      if ((upper ? padding.after[a] : padding.before[a]) == 0) continue;
      VoxelIndex low{0, 0, 0}, high = size;
      low[a] = upper ? size[a] - 1 : 0;
      high[a] = low[a] + 1;
      for (int z = low[2]; z < high[2]; ++z)
        for (int y = low[1]; y < high[1]; ++y)
          for (int x = low[0]; x < high[0]; ++x) {
            const RegionIndex region = labels.regions.at(x, y, z);
            if (region == outside_region || known[region]) continue;
            known[region] = 1;
            const MaterialTag tag = labels.materials[region - 1u].tag;
            if (std::none_of(labels.contacts.begin(), labels.contacts.end(),
                             [&](const LabelContact& c) { return !c.first && c.second == tag; }))
              labels.contacts.push_back({{}, tag, 0, labels.origin + labels.directions * Vec3(x, y, z)});
          }
    }
}

/// Adds outside voxels to sides of the volume where bodies come close to its border, so that no body is cut
/// off there.
void make_room(LabelInput& labels, MesherInput& bodies) {
  const Padding padding = padding_for(labels, bodies);
  if (!padding.any()) return;
  VoxelIndex size = labels.size;
  double growth = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    growth *= (1.0 * size[a] + padding.before[a] + padding.after[a]) / size[a];
    if (growth <= Implants::max_growth) size[a] += padding.before[a] + padding.after[a];
  }
  Box3 box;
  for (const MesherInput::Body& body : bodies.bodies)
    for (const Vec3& p : body.surface.points) box.add(p);
  const std::string extents =
      "the bodies extend " + box_text(box) + ", and the volume " + box_text(box_of(labels));
  if (labels.image)
    throw InputError(labels.file, 0,
                     extents +
                         ", which is too little of an image to surround them; enlarge the image, or "
                         "cut off what is outside");
  if (growth > Implants::max_growth)
    throw InputError(labels.file, 0,
                     extents + "; a volume around both would have " + short_number(growth) +
                         " times the voxels: check the units, or cut off what is far outside");
  add_contacts(padding, labels);
  const std::uint64_t before = labels.voxel_count();
  labels.regions = padded(labels.regions, size, padding);
  labels.size = size;
  labels.origin -= labels.directions * Vec3(padding.before[0], padding.before[1], padding.before[2]);
  bodies.findings.push_back({.code = DiagnosticCode::volume_enlarged,
                             .file = labels.file,
                             .what = "voxels of the outside",
                             .count = static_cast<std::size_t>(labels.voxel_count() - before),
                             .done = "added around the volume, since " + extents});
}

}  // namespace

ImplantedVolume make_implanted_volume(LabelInput labels, MesherInput bodies,
                                      std::vector<MaterialTag> protected_labels) {
  if (bodies.bodies.empty()) throw UsageError("there is no body for the volume; give at least one");
  if (!bodies.layers.empty()) throw UsageError("--layer is for surfaces alone; leave it out");
  if (bodies.complex && !bodies.complex->sheets.empty())
    throw UsageError(
        bodies.bodies.front().file +
        ": walls inside of a body are not possible in a segmented volume; --regions outer leaves "
        "them out");
  require_distinct(labels, bodies);
  for (const MaterialTag tag : protected_labels)
    if (std::none_of(labels.materials.begin(), labels.materials.end(),
                     [&](const LabelMaterial& m) { return m.tag == tag; }))
      throw UsageError("--protect-labels names the label " + std::to_string(tag) + ", which " + labels.file +
                       " does not have");
  for (const MesherInput::Body& body : bodies.bodies) require_meeting(labels, body);
  make_room(labels, bodies);
  std::sort(protected_labels.begin(), protected_labels.end());
  return {std::move(labels), std::move(bodies), std::move(protected_labels)};
}

}  // namespace tetwright
