#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/morton.h"
#include "common/reference_surface.h"
#include "mesher/grid_frame.h"
#include "mesher/level_set.h"
#include "mesher/regions.h"

namespace tetwright {

/// A region as the finished mesh names it.
struct FieldRegion {
  std::string name;
  MaterialTag tag = 0;
};

/// The region that has a place, and how clearly: half of what the next one's distance is larger, at most the
/// band. With one material that is the distance from its surface.
struct NearestRegion {
  RegionIndex region;
  float margin;
};

/// Reads a field; remembers where it read last, so nearby readings are fast. For one thread; as many samplers
/// of one field as wanted.
class FieldSampler {
 public:
  virtual ~FieldSampler() = default;
  FieldSampler(const FieldSampler&) = delete;
  FieldSampler& operator=(const FieldSampler&) = delete;

  virtual NearestRegion nearest(const Vec3& point) = 0;
  /// At a corner of voxels, given in voxels.
  virtual NearestRegion nearest_at_voxel(int x, int y, int z) = 0;
  /// Signed distances of some regions.
  virtual void values(const Vec3& point, std::span<const RegionIndex> regions, float* out) = 0;
  virtual void values_at_voxel(int x, int y, int z, std::span<const RegionIndex> regions, float* out) = 0;
  /// The two regions of the smallest distances, ascending; nothing where only one is within the band.
  virtual std::optional<RegionSet> two_nearest(const Vec3& point) = 0;
  /// The thinnest of the sheets that pass within `reach` of the point, or nothing: a sheet is a region
  /// between two level sets that face each other.
  struct Sheet {
    RegionIndex region;
    double thickness;
    bool closed;  ///< so thin, between two bodies, that it counts as none
  };
  virtual std::optional<Sheet> thinnest_sheet(const Vec3& point, double reach) = 0;

  /// Half of how much nearer region b is than region a: negative where a is nearer, zero on their interface,
  /// of slope about 1 there. `gradient` by position.
  double between(RegionIndex a, RegionIndex b, const Vec3& point, Vec3& gradient);
  /// Walks to where all regions of the set are equally near, in a few steps; false where it does not get
  /// there or another region is nearer.
  bool project(const RegionSet& regions, Vec3& point);

 protected:
  /// `per_voxel`: lattice units to a voxel. `least_slope`: how flat a distance may be where it is read well.
  explicit FieldSampler(double per_voxel, double least_slope = 1)
      : per_voxel_(per_voxel), least_slope_(least_slope) {}

 private:
  /// Signed distances of up to four regions and their gradients.
  virtual void values_and_gradients(const Vec3& point, std::span<const RegionIndex> regions, double* values,
                                    Vec3* gradients) = 0;

  double per_voxel_, least_slope_;
};

/// The signed distances of all regions of space, outside included: at every place the region with the
/// smallest one has the place, the region of the smaller number where two are equal.
///
/// What is known about distances is known on voxels. The lattice may be finer: its unit is a voxel divided by
/// 2^refinement, and everything here is in lattice units unless it says voxels.
/// Immutable after construction; all functions may be called concurrently. signed_distance() and project()
/// set up a FieldSampler for each call: who reads much makes one of his own.
class MaterialField : public ReferenceSurface {
 public:
  ~MaterialField() override;
  MaterialField(const MaterialField&) = delete;
  MaterialField& operator=(const MaterialField&) = delete;

  virtual std::unique_ptr<FieldSampler> sampler() const = 0;
  /// The same distances under a finer lattice.
  virtual std::shared_ptr<const MaterialField> refined(int refinement) const = 0;
  /// The voxels that hold an interface, as ascending Morton keys of their lower corners.
  virtual std::vector<MortonKey> interface_voxels() const = 0;
  /// The leaves of 8 x 8 x 8 voxel corners where a region's distance is within the band or an edge of voxels
  /// passes its surface, ascending.
  virtual std::vector<LeafOrigin> band_leaves(RegionIndex region) const = 0;
  /// True if sheets between level sets can be told from other thin parts, see FieldSampler::thinnest_sheet().
  virtual bool knows_sheets() const = 0;
  /// True for places whose lattice points stay where they are: what is known about the region there is known
  /// exactly, and promised.
  virtual bool is_certain(const Vec3& point) const = 0;

  const GridFrame& voxels() const { return voxels_; }
  const GridFrame& frame() const { return frame_; }  ///< of the lattice
  int refinement() const { return refinement_; }
  const std::vector<FieldRegion>& regions() const { return regions_; }  ///< the first is outside
  /// Values are true up to this size and cut off there.
  double band() const { return band_; }

  double signed_distance(const Vec3& point, MaterialTag material) const override;
  std::optional<Vec3> project(const Vec3& point, Region first, Region second,
                              double max_distance) const override;

 protected:
  /// `band` in voxels.
  MaterialField(const GridFrame& voxels, std::vector<FieldRegion> regions, double band, int refinement);

 private:
  /// The number of a region by its tag, `outside_region` for nothing; nothing where no material bears it.
  std::optional<RegionIndex> find(Region region) const;

  GridFrame voxels_, frame_;
  std::vector<FieldRegion> regions_;
  int refinement_;
  double band_;
};

}  // namespace tetwright
