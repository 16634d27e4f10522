// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tetwright/label_source.h"

namespace tetwright {

/// Name of the sample.
inline constexpr const char* foam_name = "foam";

inline constexpr int min_foam_voxels = 4;
inline constexpr int max_foam_voxels = 4096;
inline constexpr int default_foam_voxels = 64;

/// Maximum number of grains of a foam: a 64th of its voxels, so that each grain has several, and at most a
/// million, so that their seeds take little memory.
/// \param voxels voxels along each edge
std::uint32_t max_foam_grains(int voxels);

/// 20, or fewer if the volume has no room for them.
std::uint32_t default_foam_grains(int voxels);

/// A cube filled with grains of different sizes, as in a polycrystal or a foam. Labels are computed on
/// demand.
///
/// Each voxel has the label, 1 to the number of grains, of the seed nearest to its centre, so that grains are
/// convex. Seeds are random, uniform, and no nearer to each other than 0.6 edges of a cube with the volume of
/// an average grain (dart throwing: Cook 1986, Stochastic sampling in computer graphics), so that no grain is
/// tiny: each has voxels around its seed. Voxels have edges of length 1, and the first has its centre at 0.
///
/// All decisions are exact in integers: the same labels on every machine and for any boxes.
class Foam final : public LabelSource {
 public:
  /// \param voxels voxels along each edge, min_foam_voxels to max_foam_voxels
  /// \param grains 1 to max_foam_grains(voxels)
  Foam(int voxels, std::uint32_t grains);

  VoxelIndex block() const override { return {brick_, brick_, brick_}; }
  /// The largest label.
  MaterialTag grains() const { return static_cast<MaterialTag>(seeds_.size()); }
  /// Exact position of the seed of a grain, in edges of voxels.
  /// \pre 1 <= grain <= grains()
  Vec3 seed(MaterialTag grain) const;

 protected:
  void read_box(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const override;

 private:
  using Position = std::array<std::int64_t, 3>;  ///< in units of a 64th of a voxel from the cube's corner
  struct Box {
    VoxelIndex low, high;
  };
  struct RowScratch;

  /// Calls visit(seed) for each seed in the cells that have a point within `radius` of `centre` along each
  /// axis.
  template <class Visit>
  void visit_near(const Position& centre, std::int64_t radius, const Visit& visit) const;
  void throw_seeds(std::uint32_t grains);
  std::size_t cell_of(const Position& at) const;
  std::int64_t nearest_distance(const Position& centre) const;
  void find_rivals(const Box& brick, std::vector<std::uint32_t>& rivals) const;
  void fill_brick(const Box& brick, const Box& box, RowScratch& scratch, std::span<MaterialTag> out) const;

  std::int64_t edge_;           ///< of the cube
  std::int64_t seed_distance_;  ///< minimum distance between seeds, and edge of the grid's cells
  std::int64_t cells_;          ///< of the grid along each axis
  int brick_;                   ///< edge of the boxes whose seeds are looked up together, voxels
  std::vector<Position> seeds_;
  std::vector<std::uint32_t> first_in_cell_, next_in_cell_;  ///< lists of seeds; no_seed: end
};

}  // namespace tetwright
