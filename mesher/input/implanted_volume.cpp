// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "common/geometry/box_tree.h"
#include "common/images/grid_box.h"
#include "common/message_text.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/tuning/domain_tuning.h"
#include "mesher/tuning/input_tuning.h"
#include "mesher/tuning/label_tuning.h"
#include "tetwright/error.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

namespace {

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
  const std::size_t count = labels.materials.size() + bodies.bodies.size();
  if (count > InputTuning::Limits::max_materials)
    throw InputError(labels.file, 0,
                     "has " + std::to_string(labels.materials.size()) + " labels, and there are " +
                         std::to_string(bodies.bodies.size()) + " surfaces; at most " +
                         std::to_string(InputTuning::Limits::max_materials) +
                         " of both can be meshed at a time: choose fewer by --labels");
  for (const MesherInput::Body& b : bodies.bodies) {
    if (b.name == outside_name)
      throw UsageError(b.file + " is called '" + outside_name +
                       "', which is the name of the outside; give the surface another name by --material "
                       "NAME=FILE");
    for (const LabelMaterial& m : labels.materials) {
      if (m.name == b.name)
        throw UsageError("both a label of " + labels.file + " and " + b.file + " are called '" + b.name +
                         "'; give the surface another name by --material NAME=FILE");
      if (m.tag == b.tag)
        throw UsageError("both the label '" + m.name + "' and the body '" + b.name + "' have the tag " +
                         std::to_string(m.tag));
    }
  }
}

/// Reports bodies that are partly outside of the volume.
void report_leaving(const LabelInput& labels, MesherInput& bodies) {
  const VoxelSpace voxels(labels);
  Box3 all;
  std::string names;
  std::size_t count = 0;
  for (const MesherInput::Body& body : bodies.bodies) {
    Box3 box, in_voxels;
    for (const Vec3& p : body.surface.points) {
      box.add(p);
      in_voxels.add(voxels(p));
    }
    bool leaves = false;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      leaves |= in_voxels.low[axis] < -0.5 - LabelTuning::Border::slack ||
                in_voxels.high[axis] > labels.size[a] - 0.5 + LabelTuning::Border::slack;
    }
    if (!leaves) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      const double voxels_across =
          std::max(in_voxels.high[axis], labels.size[a] - 0.5) - std::min(in_voxels.low[axis], -0.5);
      if (voxels_across > DomainTuning::Frames::max_resolution)
        throw InputError(body.file, 0,
                         "'" + body.name + "' extends " + box_text(box) + ", and the volume " + labels.file +
                             " " + box_text(box_of(labels)) + ": together " + short_number(voxels_across) +
                             " voxels along a side, and at most " +
                             std::to_string(DomainTuning::Frames::max_resolution) +
                             " are possible; check the units, or cut off what is far outside");
    }
    all.add(box.low);
    all.add(box.high);
    names += (count++ ? ", '" : "'") + body.name + "'";
  }
  if (count == 0) return;
  bodies.findings.push_back({.code = DiagnosticCode::volume_enlarged,
                             .file = labels.file,
                             .what = count == 1 ? "body crosses its border" : "bodies cross its border",
                             .count = count,
                             .done = "meshed beyond it, where labels end: " + names + " " +
                                     (count == 1 ? "extends " : "extend ") + box_text(all) +
                                     ", and the volume " + box_text(box_of(labels))});
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
  report_leaving(labels, bodies);
  std::sort(protected_labels.begin(), protected_labels.end());
  return {std::move(labels), std::move(bodies), std::move(protected_labels)};
}

}  // namespace tetwright
