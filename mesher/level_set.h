#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "common/morton.h"
#include "common/progress.h"
#include "mesher/grid_frame.h"
#include "mesher/surface_input.h"

namespace tetwright {

/// Half-width of the signed distances' narrow band, in finest cells. Cut lattice edges around finest cells
/// are at most 2.6 cells long, so both of their ends have true distances.
inline constexpr int level_set_band = 3;

/// Level sets are kept in leaves of 8 x 8 x 8 grid points; a leaf's lowest one names it.
using LeafOrigin = std::array<int, 3>;
inline constexpr int leaf_side = 8;
inline constexpr int leaf_points = leaf_side * leaf_side * leaf_side;

/// True for distances that were cut off at the band.
inline bool beyond_band(double distance) { return std::abs(distance) >= level_set_band; }

/// One signed distance function on the grid, an OpenVDB volume: negative inside, in finest cells, true within
/// the band and cut off beyond, where only its sign counts.
///
/// A grid point that is on the surface is told inside or outside consistently and never has the value 0.
/// Working memory grows with the surface (N^2). Immutable after construction; all functions may be called
/// concurrently.
class LevelSet {
 public:
  /// The boundary of the surface's inside. The size comes from OpenVDB's unsigned conversion (its own signs
  /// fill closed cavities), the sign at the grid points of the band from the exact winding number; what is
  /// beyond takes the sign of the band around it. Throws Interrupted.
  static std::shared_ptr<const LevelSet> of_surface(const PreparedSurface& surface, const GridFrame& frame,
                                                    Progress* progress);
  /// The surface `depth` finest cells (> 0, any number) inside of that: values are the distance plus `depth`,
  /// so what is deeper is inside, with a band of its own around its zero. Beyond the first band the distances
  /// are exact. Working memory grows with this surface. Throws Interrupted.
  static std::shared_ptr<const LevelSet> at_depth(const PreparedSurface& surface, double depth,
                                                  const GridFrame& frame, Progress* progress);
  /// The same where of_surface()'s result is at hand.
  static std::shared_ptr<const LevelSet> at_depth(const PreparedSurface& surface, const LevelSet& boundary,
                                                  double depth, const GridFrame& frame, Progress* progress);
  ~LevelSet();
  LevelSet(const LevelSet&) = delete;
  LevelSet& operator=(const LevelSet&) = delete;

  /// The finest cells whose corners lie on both sides, as ascending Morton keys of their lower corners.
  std::vector<MortonKey> interface_cells() const;
  /// The leaves that hold the band, in ascending order.
  std::vector<LeafOrigin> leaves() const;

 private:
  friend class LevelSetSampler;
  struct Impl;
  explicit LevelSet(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads a level set in grid coordinates and finest cells; remembers where it read last, so nearby readings
/// are fast. For one thread; as many samplers of one level set as wanted.
class LevelSetSampler {
 public:
  explicit LevelSetSampler(const LevelSet& level_set);
  ~LevelSetSampler();
  LevelSetSampler(const LevelSetSampler&) = delete;
  LevelSetSampler& operator=(const LevelSetSampler&) = delete;

  /// The distance at a grid point, at most level_set_band in size: farther away only the sign is true.
  double at_node(int x, int y, int z);
  /// Trilinear between grid points.
  double at(const Vec3& point);
  /// The same and its gradient (per finest cell; of length about 1 within the band).
  double at(const Vec3& point, Vec3& gradient);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tetwright
