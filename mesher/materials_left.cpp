// SPDX-License-Identifier: Apache-2.0
#include "mesher/materials_left.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/geometry/box_tree.h"
#include "common/message_text.h"
#include "mesher/tuning/cell_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// True if all points are on the plane of the largest triangle.
bool is_flat(const RepairedSurface& surface) {
  Vec3 normal = Vec3::Zero(), on_plane = Vec3::Zero();
  Box3 box;
  for (const Triangle& t : surface.triangles) {
    const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
    for (const Vec3& p : {a, b, c}) box.add(p);
    const Vec3 n = (b - a).cross(c - a);
    if (n.squaredNorm() <= normal.squaredNorm()) continue;
    normal = n;
    on_plane = a;
  }
  const double slack = CellTuning::Patches::flat_surface * normal.norm() * (box.high - box.low).norm();
  return std::all_of(surface.triangles.begin(), surface.triangles.end(), [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](Index p) { return std::fabs(normal.dot(surface.points[p] - on_plane)) <= slack; });
  });
}

/// Why open surfaces did not become one, to be appended to an error; empty if there are none.
std::string gap_text(const MesherInput& input) {
  for (const Diagnostic& f : input.findings)
    if (f.code == DiagnosticCode::surfaces_not_joined)
      return "; " + std::to_string(f.count) + " " + f.what + ", at " + place_text(f.places[0]);
  return "";
}

}  // namespace

void validate_encloses(const MesherInput& input, const MesherInput::Body& body) {
  if (is_flat(body.surface))
    throw InputError(body.file, 0,
                     "the surface lies in a plane and encloses nothing; give the surface of a solid, or use "
                     "--thicken D for "
                     "a plate" +
                         gap_text(input));
  if (body.surface.closed < body.surface.triangles.size())
    throw InputError(
        body.file, 0,
        "the surface is not closed and encloses nothing that cells of this size can resolve; close "
        "its holes, or use a higher resolution if it is closed but for small ones. --base makes a block of a "
        "height field, --thicken a shell of a sheet" +
            gap_text(input));
}

void validate_materials_left(const MesherInput& input, const MaterialField& field,
                             const std::vector<std::uint8_t>& there) {
  if (std::count(there.begin() + 1, there.end(), 1) == 0) {
    validate_encloses(input, input.bodies[0]);
    if (input.bodies.size() > 1)
      throw NothingToMeshError(input.bodies[0].file +
                               ": this and all other surfaces are smaller than a cell, since together they "
                               "extend from " +
                               place_text(input.low) + " to " + place_text(input.high) +
                               "; check the units and positions of all, or use a higher resolution");
    throw NothingToMeshError(
        input.bodies[0].file +
        ": the surface is smaller than a cell; use a higher resolution or a smaller voxel size");
  }
  for (std::size_t r = 1; r < there.size(); ++r) {
    if (there[r]) continue;
    const FieldRegion& region = field.regions()[r];
    const auto body = std::find_if(input.bodies.begin(), input.bodies.end(),
                                   [&](const MesherInput::Body& b) { return b.tag == region.tag; });
    if (body == input.bodies.end())
      throw InputError(
          input.bodies[0].file, 0,
          "nothing is left of the layer '" + region.name +
              "': it is thinner than the smallest cells or later surfaces cover it; use a higher "
              "resolution, or list the surfaces that enclose it first");
    if (body == input.bodies.begin() && !input.layers.empty())
      throw InputError(body->file, 0,
                       "nothing is left of '" + region.name +
                           "' inside its layers; make the layers thinner or use a higher resolution");
    validate_encloses(input, *body);
    throw InputError(
        body->file, 0,
        "nothing is left of the material '" + region.name +
            "': it is smaller than a cell or later surfaces cover it; list the outermost surface "
            "first, or use a higher resolution");
  }
}

void validate_carved_labels_left(const ImplantedVolume& volume, const std::vector<std::uint8_t>& there) {
  for (std::size_t r = 1; r < there.size(); ++r)
    if (!there[r])
      throw InputError(volume.labels.file, 0,
                       "nothing is left of '" + volume.labels.materials[r - 1].name +
                           "' beside the bodies: they cover it, or what they leave is smaller than a cell; "
                           "leave it out by --labels, keep it by --protect-labels, or use a smaller "
                           "--voxel-size");
}

void validate_unprotected_left(const ImplantedVolume& volume, const std::vector<BodyInLabels>& in_labels,
                               const std::vector<std::uint8_t>& there) {
  for (std::size_t b = 0; b < there.size(); ++b)
    if (!there[b] && 2 * in_labels[b].in_protected > in_labels[b].in_volume)
      throw InputError(volume.bodies.bodies[b].file, 0,
                       "nothing is left of '" + volume.bodies.bodies[b].name +
                           "', since it gives way to the labels of --protect-labels, and " +
                           short_number(100 * in_labels[b].in_protected / in_labels[b].in_volume) +
                           " % of it is inside them; leave them out there, or check its position");
}

}  // namespace tetwright
