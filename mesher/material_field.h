#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/progress.h"
#include "common/reference_surface.h"
#include "mesher/grid_frame.h"
#include "mesher/morton.h"
#include "mesher/surface_input.h"

namespace tetwright {

/// Half-width of the signed distances' narrow band, in finest cells. Cut lattice edges around finest cells
/// are at most 2.6 cells long, so both of their ends have true distances.
inline constexpr int field_band = 3;

/// The signed distances of one material on the grid, an OpenVDB volume, plus its name and tag.
///
/// Distances are negative inside. The size comes from OpenVDB's unsigned conversion (its own signs fill
/// closed cavities), the sign at every grid point from the exact winding number. A point that is on the
/// surface is told inside or outside consistently and never has the value 0.
/// Immutable after construction; all functions may be called concurrently.
class MaterialField final : public ReferenceSurface {
 public:
  struct Material {
    std::string name;
    MaterialTag tag = 0;
  };

  /// `surface` in input units. Throws Interrupted. Working memory grows with the surface (N^2).
  MaterialField(const ClosedSurface& surface, const Material& material, const GridFrame& frame,
                Progress* progress);
  ~MaterialField() override;
  MaterialField(const MaterialField&) = delete;
  MaterialField& operator=(const MaterialField&) = delete;

  const GridFrame& frame() const { return frame_; }
  const Material& material() const { return material_; }

  /// The finest cells whose corners lie on both sides of the interface, as ascending Morton keys of their
  /// lower corners.
  std::vector<MortonKey> interface_cells() const;

  double signed_distance(const Vec3& point, MaterialTag material) const override;
  /// One interface: between the material and outside. Walks along the gradient.
  std::optional<Vec3> project(const Vec3& point, Region first, Region second,
                              double max_distance) const override;

 private:
  friend class FieldSampler;
  struct Impl;
  std::unique_ptr<Impl> impl_;
  GridFrame frame_;
  Material material_;
};

/// Reads a field in grid coordinates and finest cells; remembers where it read last, so nearby readings are
/// fast. For one thread; as many samplers of one field as wanted.
class FieldSampler {
 public:
  explicit FieldSampler(const MaterialField& field);
  ~FieldSampler();
  FieldSampler(const FieldSampler&) = delete;
  FieldSampler& operator=(const FieldSampler&) = delete;

  /// The distance at a grid point, at most field_band in size: farther away only the sign is true.
  double at_node(int x, int y, int z);
  /// Trilinear between grid points.
  double at(const Vec3& point);
  /// The same and its gradient (per finest cell; of length about 1 within the band).
  double at(const Vec3& point, Vec3& gradient);
  /// Walks down the distance to the interface in a few steps; false where it does not get there.
  bool project(Vec3& point);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// True for distances that were cut off at the band.
inline bool beyond_band(double distance) { return std::abs(distance) >= field_band; }

}  // namespace tetwright
