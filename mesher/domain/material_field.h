// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/morton.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/domain/narrow_band.h"
#include "tetwright/mesher_input.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Name and tag of a region in the finished mesh.
struct FieldRegion {
  std::string name;
  MaterialTag tag = 0;
};

/// The region that contains a point, and the margin: half the difference between the smallest signed distance
/// (its own) and the second smallest, at most the band. With one material the margin is the unsigned distance
/// from its surface.
struct NearestRegion {
  RegionIndex region;
  float margin;
};

/// A region between two level sets that face each other.
struct FieldSheet {
  RegionIndex region;
  double thickness;  ///< lattice units
  bool closed;       ///< lies between two bodies so close that they count as touching
};

/// Finds sheets. Only the samplers of fields of several level sets can, since only these tell sheets from
/// other thin parts. Not thread-safe.
class SheetSampler {
 public:
  /// The thinnest sheet within `reach` (lattice units) of the point, or nothing.
  virtual std::optional<FieldSheet> thinnest_sheet(const Vec3& point, double reach) = 0;

 protected:
  ~SheetSampler() = default;
};

/// Evaluates a field. Caches the last nodes read, so consecutive nearby points are fast. Not thread-safe; any
/// number of samplers of one field may be used concurrently. Points are in lattice units.
class FieldSampler {
 public:
  virtual ~FieldSampler() = default;
  FieldSampler(const FieldSampler&) = delete;
  FieldSampler& operator=(const FieldSampler&) = delete;

  virtual NearestRegion nearest(const Vec3& point) = 0;
  /// The nearest region at a voxel corner, given in voxels.
  virtual NearestRegion nearest_at_voxel(int x, int y, int z) = 0;
  /// Signed distances of `regions`, lattice units.
  virtual void values(const Vec3& point, std::span<const RegionIndex> regions, float* out) = 0;
  virtual void values_at_voxel(int x, int y, int z, std::span<const RegionIndex> regions, float* out) = 0;
  /// The two regions of the smallest distances, ascending; nothing if only one is within the band.
  virtual std::optional<RegionSet> two_nearest(const Vec3& point) = 0;
  /// A sampler for the sheets of the field that uses this sampler's cache; null if the field cannot find
  /// sheets.
  virtual SheetSampler* sheets() { return nullptr; }
  /// Signed distances of up to four regions, lattice units, and their derivatives with respect to the point.
  virtual void values_and_gradients(const Vec3& point, std::span<const RegionIndex> regions, double* values,
                                    Vec3* gradients) = 0;

  double per_voxel() const { return per_voxel_; }  ///< lattice units
  double min_slope() const { return min_slope_; }  ///< of the distances near interfaces

  /// Half the signed distance of region a minus that of region b: negative in a, zero on their interface,
  /// with a slope of about 1 there.
  /// \param gradient receives the derivative with respect to the point
  double between(RegionIndex a, RegionIndex b, const Vec3& point, Vec3& gradient);
  /// Moves the point to where all regions of the set have equal signed distances, by a few Newton steps.
  /// \param held_axes the point does not move along axis a if bit a is set
  /// \return false if the iteration does not converge or another region is nearer there; `point` is
  ///   unspecified then
  bool project(const RegionSet& regions, Vec3& point, unsigned held_axes = 0);

 protected:
  /// \param per_voxel lattice units per voxel
  /// \param min_slope the smallest slope of the distances near interfaces
  explicit FieldSampler(double per_voxel, double min_slope = 1)
      : per_voxel_(per_voxel), min_slope_(min_slope) {}

 private:
  double per_voxel_, min_slope_;
};

class MaterialField;
class SheetZone;

/// The thin walls and gaps of surfaces where a field changes the distances, see thin_walls.h. All functions
/// may be called concurrently; points are in the field's lattice units.
class WallChanges {
 public:
  /// The field with thin walls at their true thickness.
  virtual std::shared_ptr<const MaterialField> with_true_walls() const = 0;
  /// True where distances may be changed.
  virtual bool contains(const Vec3& point) const = 0;
  /// The thickness, lattice units, of the thin wall with parallel sides that has a side near the point;
  /// infinity if there is none.
  virtual double parallel_thickness(const Vec3& point) const = 0;

 protected:
  ~WallChanges() = default;
};

/// The segmented volume from which a field is made. Its regions are cut off at the volume's border; the
/// distances themselves ignore it. The lattice ends there, or continues beyond it (GridFrame::border), and
/// the parts of regions beyond are left out afterwards. All functions may be called concurrently; points are
/// in lattice units.
class VoxelVolume {
 public:
  /// True if the mesh has no part of the region at the point, since it is beyond the border.
  virtual bool leaves_out(RegionIndex, const Vec3&) const { return false; }
  /// True for points so far beyond the border that the region there has no effect on the mesh.
  virtual bool is_far_beyond(const Vec3&) const { return false; }
  /// True for materials that the border does not cut off.
  virtual bool crosses_border(MaterialTag) const { return false; }
  /// True for points whose region is known exactly and guaranteed in the mesh. Lattice points
  /// there are not moved.
  virtual bool is_certain(const Vec3& point) const = 0;

 protected:
  ~VoxelVolume() = default;
};

/// The signed distances of all regions of space including the outside. Each point belongs to the region of
/// the smallest signed distance; ties go to the smaller region number.
///
/// Distances are stored on voxels. The lattice may be finer: its unit is a voxel divided by 2^refinement, and
/// all coordinates and distances are in lattice units unless stated otherwise. Immutable after construction;
/// all functions may be called concurrently. signed_distance() and project() borrow samplers from a pool that
/// grows to the number of concurrent calls.
class MaterialField : public ReferenceSurface {
 public:
  ~MaterialField() override;
  MaterialField(const MaterialField&) = delete;
  MaterialField& operator=(const MaterialField&) = delete;

  virtual std::unique_ptr<FieldSampler> sampler() const = 0;
  /// The field in units of a finer lattice.
  virtual std::shared_ptr<const MaterialField> refined(int refinement) const = 0;
  /// The voxels that contain an interface, as ascending Morton keys of their lower corners.
  virtual std::vector<MortonKey> interface_voxels() const = 0;
  /// The leaves of 8 x 8 x 8 voxel corners in which the region's distance is within the band or a voxel edge
  /// crosses its surface, ascending.
  virtual std::vector<LeafOrigin> band_leaves(RegionIndex region) const = 0;
  /// The thin walls and gaps where distances are changed; null if there are none.
  virtual const WallChanges* wall_changes() const { return nullptr; }
  /// The volume from which the field is made; null for surfaces.
  virtual const VoxelVolume* volume() const { return nullptr; }
  /// The sheets inside regions; null if there are none.
  virtual const SheetZone* sheets() const { return nullptr; }

  const GridFrame& voxels() const { return voxels_; }
  const GridFrame& frame() const { return frame_; }  ///< of the lattice
  int refinement() const { return refinement_; }
  const std::vector<FieldRegion>& regions() const { return regions_; }  ///< the first is outside
  /// Distances are correct up to this size, lattice units, and clamped to it.
  double band() const { return band_; }

  double signed_distance(const Vec3& point, MaterialTag material) const override;
  std::optional<Vec3> project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                              double max_distance) const override;

 protected:
  /// \param band voxels
  MaterialField(const GridFrame& voxels, std::vector<FieldRegion> regions, double band, int refinement);
  /// Must be called by destructors of derived classes, whose members the samplers refer to.
  void drop_samplers() { samplers_.clear(); }

 private:
  class BorrowedSampler;

  /// The index of the region with a tag; outside_region for no tag; nothing if no material has the tag.
  std::optional<RegionIndex> find(MaterialOrOutside region) const;

  GridFrame voxels_, frame_;
  std::vector<FieldRegion> regions_;
  int refinement_;
  double band_;
  mutable std::mutex samplers_mutex_;
  mutable std::vector<std::unique_ptr<FieldSampler>> samplers_;  ///< samplers not borrowed
};

}  // namespace tetwright
