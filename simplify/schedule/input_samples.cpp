// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/input_samples.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/point_triangle.h"
#include "simplify/mesh/face_patches.h"

namespace tetwright {

void InputSamples::keep_surface(const TriangleMesh* surface, std::optional<OriginalSurface> original,
                                bool measured) {
  const EditableMesh& mesh = constrained_.mesh;
  surface_ = original ? std::make_unique<RepresentedSurface>(*std::move(original))
                      : std::make_unique<RepresentedSurface>(mesh, surface);
  if (measured) surface_->find_hidden(mesh);
}

void InputSamples::assign(double edge, const BlockRules& rules) {
  SurfaceGrid& grid = constrained_.grid;
  samples_ = std::make_unique<SurfaceSamples>(constrained_.mesh, grid.record_count(), *surface_, edge,
                                              [&](const Vec3& place) { return rules.scale_at(place); });
  samples_->set_spacing(spacing_);
  grid.set_samples(samples_.get());
}

std::vector<Triangle> InputSamples::add_far_samples(double limit) {
  const EditableMesh& mesh = constrained_.mesh;
  const std::vector<InterfaceFace> faces = mesh.interface_faces();
  std::vector<Triangle> far;
  SurfaceGrid::Edit edit;
  for (const RepresentedSurface::FarFace& f : surface_->far_faces(mesh, limit)) {
    const Triangle& ids = faces[f.face].ids;
    far.push_back(face_key(ids));
    if (!f.place) continue;
    const Vec3 &a = mesh.position(ids[0]), &b = mesh.position(ids[1]), &c = mesh.position(ids[2]);
    edit.clear();
    edit.removed.push_back({ids, {a, b, c}});
    constrained_.grid.find_records(edit);
    samples_->add(*f.place, edit.removed_records.front(), std::sqrt(squared_distance(*f.place, a, b, c)));
  }
  std::sort(far.begin(), far.end());
  return far;
}

DeviationReport InputSamples::deviation(const Progress* progress) const {
  return surface_->deviation(constrained_.mesh, progress);
}

}  // namespace tetwright
