// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tetwright/label_source.h"

namespace tetwright {

/// Index of a region of space: 0 is the outside, the materials follow.
using RegionIndex = std::uint16_t;
inline constexpr RegionIndex outside_region = 0;
/// Marks a point on an interface, instead of its region.
inline constexpr RegionIndex on_interface = 0xffff;

/// The region of each voxel of a volume, compressed: tiles of 32^3 voxels list their regions and have a
/// number of 0, 1, 2, 4, 8 or 16 bits for each voxel.
///
/// Functions that are const may be called concurrently.
class RegionGrid {
 public:
  static constexpr int side = 32;  ///< of a tile, voxels

  RegionGrid() = default;
  /// All voxels are outside.
  explicit RegionGrid(const VoxelIndex& size);

  const VoxelIndex& size() const { return size_; }
  std::uint64_t voxels() const {
    return static_cast<std::uint64_t>(size_[0]) * static_cast<std::uint64_t>(size_[1]) *
           static_cast<std::uint64_t>(size_[2]);
  }
  /// Memory of all tiles, bytes. O(tiles).
  std::size_t bytes() const;

  /// \pre 0 <= x < size()[0], and so on
  RegionIndex at(int x, int y, int z) const {
    const Tile& tile = tiles_[tile_number(x / side, y / side, z / side)];
    if (tile.bits == 0) return tile.palette[0];
    return tile.palette[tile.index(row_number(y, z), static_cast<unsigned>(x) % side)];
  }
  /// \param voxel number of the voxel, the first axis fastest
  RegionIndex operator[](std::uint64_t voxel) const;

  /// Reads the half-open box of voxels from `low` to `high`.
  /// \param out receives the regions, the first axis fastest
  /// \pre 0 <= low < high <= size() along each axis, and `out` has the size of the box
  void read(const VoxelIndex& low, const VoxelIndex& high, std::span<RegionIndex> out) const;
  /// Reads the slices from `first` to before `last`.
  void read_slices(int first, int last, std::span<RegionIndex> out) const {
    read({0, 0, first}, {size_[0], size_[1], last}, out);
  }

  /// Replaces the slices from `first` on. Parallel over tiles.
  /// \param regions the first axis fastest
  /// \pre `regions` are whole layers of tiles: `first` is a multiple of `side`, and so is the number of
  ///   slices unless the last of them is that of the volume
  void write_slices(int first, std::span<const RegionIndex> regions);

  /// Replaces `count` voxels along the first axis.
  /// \pre 0 < count, and all of them are in the volume
  void fill(const VoxelIndex& first, int count, RegionIndex region);

  /// Replaces each region r by `table[r]`. Parallel; O(tiles and their regions).
  void renumber(std::span<const RegionIndex> table);

 private:
  struct Tile {
    std::vector<RegionIndex> palette{outside_region};
    /// Numbers of voxels in the palette. Rows along the first axis have 32 numbers, `bits` words.
    std::vector<std::uint32_t> words;
    std::uint8_t bits = 0;  ///< of a number; 0: all voxels are in palette[0]

    unsigned index(std::size_t row, unsigned x) const {
      const unsigned bit = x * bits;
      return words[row * bits + bit / 32] >> bit % 32 & ((1u << bits) - 1);
    }
    void set_index(std::size_t row, unsigned x, unsigned index) {
      const unsigned bit = x * bits;
      std::uint32_t& word = words[row * bits + bit / 32];
      word = (word & ~(((1u << bits) - 1) << bit % 32)) | index << bit % 32;
    }
    /// Copies the voxels `from` to `to` of a row.
    void read_row(std::size_t row, int from, int to, RegionIndex* out) const;
  };
  class Packer;

  std::size_t tile_number(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(counts_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(counts_[0]) +
           static_cast<std::size_t>(x);
  }
  /// Voxels of a tile along an axis; those at the end of the volume have fewer.
  int extent(int axis, int tile) const {
    return std::min(side, size_[static_cast<std::size_t>(axis)] - tile * side);
  }
  /// Number of a row of voxels in its tile.
  std::size_t row_number(int y, int z) const {
    const int row = z % side * extent(1, y / side) + y % side;
    return static_cast<std::size_t>(row);
  }
  /// Adds a region to the palette of a tile, and returns its number. A full palette loses those that no voxel
  /// has.
  unsigned add_region(Tile& tile, const VoxelIndex& extents, RegionIndex region) const;

  VoxelIndex size_{};
  std::array<int, 3> counts_{};  ///< tiles along each axis
  std::vector<Tile> tiles_;      ///< the first axis fastest
};

}  // namespace tetwright
