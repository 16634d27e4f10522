// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "simplify/constraints/constrained_mesh.h"
#include "simplify/constraints/surface_samples.h"
#include "simplify/operations/block_rules.h"

namespace tetwright {

/// The surface that a mesh represents and, once assigned to the mesh's triangles, samples of it. Must not be
/// used while a task runs.
class InputSamples {
 public:
  explicit InputSamples(ConstrainedMesh& constrained) : constrained_(constrained) {}

  /// Keeps the input's surface: `surface` (input units), from which the mesh was made, or `original`, or, if
  /// there is neither, the mesh's own surface.
  ///
  /// \param measured deviation() will be called.
  /// \pre No operation has run.
  void keep_surface(const TriangleMesh* surface, std::optional<OriginalSurface> original, bool measured);
  /// Sets the max distance, working coordinates, between the points at which new triangles are tested.
  /// \pre assign() has not been called.
  void set_spacing(double spacing) { spacing_ = spacing; }
  /// Replaces the samples of the mesh's triangles by new samples of the input's surface, about ten for each
  /// triangle with edges of length `edge`, scaled by BlockRules::scale_at().
  /// \pre keep_surface() has been called; the grid has just been rebuilt.
  void assign(double edge, const BlockRules& rules);
  /// Whether triangles own samples.
  bool assigned() const { return samples_ != nullptr; }
  /// Adds a sample at each part of the input's surface that is farther than `limit` (working coordinates)
  /// from the mesh.
  ///
  /// \return face_key() of the boundary and interface faces that are farther than that from the input's
  ///   surface, or nearest to a part of it that is; ascending.
  /// \pre assigned().
  std::vector<Triangle> add_far_samples(double limit);
  /// Two-sided distance between the mesh's surface and the input's, with proven bounds; wider bounds once the
  /// deadline of `progress` has passed.
  DeviationReport deviation(const Progress* progress) const;

 private:
  ConstrainedMesh& constrained_;
  std::unique_ptr<RepresentedSurface> surface_;
  std::unique_ptr<SurfaceSamples> samples_;
  double spacing_ = std::numeric_limits<double>::infinity();
};

}  // namespace tetwright
