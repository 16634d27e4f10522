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

/// A region's signed distance is the largest of its terms: level sets, or their negatives.
struct RegionTerm {
  std::uint16_t level_set;
  bool negated;
  std::uint16_t body = 0;  ///< level sets of one body are exact offsets of each other, those of two may touch
};

struct FieldRegion {
  std::string name;
  MaterialTag tag = 0;
  std::vector<RegionTerm> terms;
};

/// The signed distances of all regions of space, outside included: at every place the region with the
/// smallest one has the place, the region of the smaller number where two are equal.
///
/// Level sets are read on their voxels, one finest cell each. The lattice may be finer than that: its unit is
/// a voxel divided by 2^refinement, and everything here is in lattice units unless it says voxels.
/// Immutable after construction; all functions may be called concurrently. signed_distance() and project()
/// set up a FieldSampler for each call: who reads much makes one of his own.
class MaterialField final : public ReferenceSurface {
 public:
  /// `regions[0]` is outside. `voxels` is the frame of the level sets.
  MaterialField(const GridFrame& voxels, std::vector<std::shared_ptr<const LevelSet>> level_sets,
                std::vector<FieldRegion> regions, int refinement = 0);
  ~MaterialField() override;
  MaterialField(const MaterialField&) = delete;
  MaterialField& operator=(const MaterialField&) = delete;

  /// The same level sets under a finer lattice.
  std::shared_ptr<const MaterialField> refined(int refinement) const;

  const GridFrame& voxels() const { return voxels_; }
  const GridFrame& frame() const { return frame_; }  ///< of the lattice
  int refinement() const { return refinement_; }
  const std::vector<FieldRegion>& regions() const { return regions_; }
  const std::vector<std::shared_ptr<const LevelSet>>& level_sets() const { return level_sets_; }
  /// Values are true up to this size and cut off there.
  double band() const { return band_; }

  /// The voxels that hold an interface, as ascending Morton keys of their lower corners.
  std::vector<MortonKey> interface_voxels() const;

  double signed_distance(const Vec3& point, MaterialTag material) const override;
  std::optional<Vec3> project(const Vec3& point, Region first, Region second,
                              double max_distance) const override;

 private:
  /// The number of a region by its tag, `outside_region` for nothing; nothing where no material bears it.
  std::optional<RegionIndex> find(Region region) const;

  GridFrame voxels_, frame_;
  int refinement_;
  double band_;
  std::vector<std::shared_ptr<const LevelSet>> level_sets_;
  std::vector<FieldRegion> regions_;
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
  explicit FieldSampler(const MaterialField& field);
  ~FieldSampler();
  FieldSampler(const FieldSampler&) = delete;
  FieldSampler& operator=(const FieldSampler&) = delete;

  NearestRegion nearest(const Vec3& point);
  /// At a corner of voxels, given in voxels.
  NearestRegion nearest_at_voxel(int x, int y, int z);
  /// Signed distances of some regions.
  void values(const Vec3& point, std::span<const RegionIndex> regions, float* out);
  void values_at_voxel(int x, int y, int z, std::span<const RegionIndex> regions, float* out);
  /// The two regions of the smallest distances, ascending; nothing where only one is within the band.
  std::optional<RegionSet> two_nearest(const Vec3& point);
  /// Half of how much nearer region b is than region a: negative where a is nearer, zero on their interface,
  /// of slope about 1 there. `gradient` by position.
  double between(RegionIndex a, RegionIndex b, const Vec3& point, Vec3& gradient);
  /// Walks to where all regions of the set are equally near, in a few steps; false where it does not get
  /// there or another region is nearer.
  bool project(const RegionSet& regions, Vec3& point);
  /// The thinnest of the sheets that pass within `reach` of the point, or nothing: a sheet is a region
  /// between two level sets that face each other.
  struct Sheet {
    RegionIndex region;
    double thickness;
    bool closed;  ///< so thin, between two bodies, that it counts as none
  };
  std::optional<Sheet> thinnest_sheet(const Vec3& point, double reach);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tetwright
