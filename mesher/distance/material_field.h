// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/morton.h"
#include "common/reference_surface.h"
#include "mesher/distance/narrow_band.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/domain/regions.h"

namespace tetwright {

/// Name and tag of a region in the finished mesh.
struct FieldRegion {
  std::string name;
  MaterialTag tag = 0;
};

/// The region that contains a point, and its margin: half the difference between the smallest signed distance
/// (its own) and the second smallest, at most the band. With one material the margin is the unsigned distance
/// from its surface.
struct NearestRegion {
  RegionIndex region;
  float margin;
};

/// Evaluates a field. Caches the nodes read last, so evaluating nearby points one after another is fast. Not
/// thread-safe; any number of samplers of one field may be used concurrently. Points are in lattice units.
class FieldSampler {
 public:
  virtual ~FieldSampler() = default;
  FieldSampler(const FieldSampler&) = delete;
  FieldSampler& operator=(const FieldSampler&) = delete;

  virtual NearestRegion nearest(const Vec3& point) = 0;
  /// At a corner of voxels; coordinates in voxels.
  virtual NearestRegion nearest_at_voxel(int x, int y, int z) = 0;
  /// Signed distances of `regions`, lattice units.
  virtual void values(const Vec3& point, std::span<const RegionIndex> regions, float* out) = 0;
  virtual void values_at_voxel(int x, int y, int z, std::span<const RegionIndex> regions, float* out) = 0;
  /// The two regions of the smallest distances, ascending; nothing if only one is within the band.
  virtual std::optional<RegionSet> two_nearest(const Vec3& point) = 0;
  /// The thinnest of the sheets within `reach` of the point, or nothing. A sheet is a region between two
  /// level sets that face each other.
  struct Sheet {
    RegionIndex region;
    double thickness;
    bool closed;  ///< between two bodies, and so thin that the bodies count as touching
  };
  virtual std::optional<Sheet> thinnest_sheet(const Vec3& point, double reach) = 0;

  /// Half the signed distance of region a minus that of region b: negative in a, zero on their interface,
  /// with a slope of about 1 there. `gradient` receives the derivative with respect to the point.
  double between(RegionIndex a, RegionIndex b, const Vec3& point, Vec3& gradient);
  /// Moves the point to where all regions of the set have the same signed distance, by a few Newton steps.
  /// Returns false if the iteration does not converge or another region is nearer there; the point is
  /// unspecified then. It does not move along the axes whose bits are set in `held_axes`.
  bool project(const RegionSet& regions, Vec3& point, unsigned held_axes = 0);

 protected:
  /// `per_voxel`: lattice units per voxel. `min_slope`: the smallest slope that distances have near
  /// interfaces.
  explicit FieldSampler(double per_voxel, double min_slope = 1)
      : per_voxel_(per_voxel), min_slope_(min_slope) {}

 private:
  /// Signed distances of up to four regions and their gradients.
  virtual void values_and_gradients(const Vec3& point, std::span<const RegionIndex> regions, double* values,
                                    Vec3* gradients) = 0;

  double per_voxel_, min_slope_;
};

/// The signed distances of all regions of space including the outside. Each point belongs to the region of
/// the smallest signed distance, of equal ones to the region of the smaller number.
///
/// Distances are stored on voxels. The lattice may be finer: its unit is a voxel divided by 2^refinement, and
/// all coordinates and distances are in lattice units unless stated otherwise. Immutable after construction;
/// all functions may be called concurrently. signed_distance() and project() borrow one of a few samplers
/// that the field keeps, as many as there were concurrent calls.
class MaterialField : public ReferenceSurface {
 public:
  ~MaterialField() override;
  MaterialField(const MaterialField&) = delete;
  MaterialField& operator=(const MaterialField&) = delete;

  virtual std::unique_ptr<FieldSampler> sampler() const = 0;
  /// The same distances in units of a finer lattice.
  virtual std::shared_ptr<const MaterialField> refined(int refinement) const = 0;
  /// The voxels that contain an interface, as ascending Morton keys of their lower corners.
  virtual std::vector<MortonKey> interface_voxels() const = 0;
  /// The leaves of 8 x 8 x 8 voxel corners in which the region's distance is within the band or a voxel edge
  /// crosses its surface, ascending.
  virtual std::vector<LeafOrigin> band_leaves(RegionIndex region) const = 0;
  /// True if sheets between level sets can be distinguished from other thin parts, see
  /// FieldSampler::thinnest_sheet().
  virtual bool knows_sheets() const = 0;
  /// The field with thin walls as thick as they are, see thin_walls.h; null where nothing was thickened.
  virtual std::shared_ptr<const MaterialField> with_true_walls() const { return nullptr; }
  /// True where the distances of thin walls may have been changed.
  virtual bool changes_walls(const Vec3&) const { return false; }
  /// The thickness of a thin wall with parallel sides of which a side is near the point, or infinity; lattice
  /// units.
  virtual double parallel_thickness(const Vec3&) const { return HUGE_VAL; }
  /// True if what reaches the frame's box is cut off there, as a volume's labels are at its border. The
  /// distances themselves know nothing of it.
  virtual bool ends_at_box() const { return false; }
  /// True for points whose region is known exactly and guaranteed in the mesh; lattice points there are not
  /// moved.
  virtual bool is_certain(const Vec3& point) const = 0;

  const GridFrame& voxels() const { return voxels_; }
  const GridFrame& frame() const { return frame_; }  ///< of the lattice
  int refinement() const { return refinement_; }
  const std::vector<FieldRegion>& regions() const { return regions_; }  ///< the first is outside
  /// Distances are correct up to this size and clamped to it.
  double band() const { return band_; }

  double signed_distance(const Vec3& point, MaterialTag material) const override;
  std::optional<Vec3> project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                              double max_distance) const override;

 protected:
  /// `band` in voxels.
  MaterialField(const GridFrame& voxels, std::vector<FieldRegion> regions, double band, int refinement);
  /// To be called by destructors of derived classes, whose members the samplers refer to.
  void drop_samplers() { samplers_.clear(); }

 private:
  class BorrowedSampler;

  /// The number of the region with a tag, outside_region for no tag; nothing if no material has the tag.
  std::optional<RegionIndex> find(MaterialOrOutside region) const;

  GridFrame voxels_, frame_;
  std::vector<FieldRegion> regions_;
  int refinement_;
  double band_;
  mutable std::mutex samplers_mutex_;
  mutable std::vector<std::unique_ptr<FieldSampler>> samplers_;  ///< those that nobody has borrowed
};

}  // namespace tetwright
