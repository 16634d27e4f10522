// SPDX-License-Identifier: Apache-2.0
#include "tetwright/region_grid.h"

#include <utility>

#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Bits of numbers below `count`: a power of two, so that no number is in two words.
std::uint8_t bits_for(std::size_t count) {
  std::uint8_t bits = 0;
  while (std::size_t{1} << bits < count) bits = static_cast<std::uint8_t>(bits == 0 ? 1 : 2 * bits);
  return bits;
}

/// Copies the voxels `from` to `to` of a row of numbers.
template <int bits>
void unpack(const std::uint32_t* row, const RegionIndex* palette, int from, int to, RegionIndex* out) {
  constexpr int in_word = 32 / bits;
  constexpr std::uint32_t mask = (1u << bits) - 1, ones = ~0u / mask;
  for (int x = from; x < to;) {
    std::uint32_t word = row[x / in_word];
    const int end = std::min(to, (x / in_word + 1) * in_word);
    if (word == (word & mask) * ones) {  // all numbers of the word are equal, as most often
      out = std::fill_n(out, end - x, palette[word & mask]);
      x = end;
      continue;
    }
    word >>= x % in_word * bits;
    for (; x < end; ++x, word >>= bits) *out++ = palette[word & mask];
  }
}

}  // namespace

/// Compresses tiles.
class RegionGrid::Packer {
 public:
  /// \param first the tile's first voxel, followed by others at steps of 1, `row` and `slice`
  void pack(const RegionIndex* first, std::size_t row, std::size_t slice, const VoxelIndex& extents,
            Tile& out) {
    const auto width = static_cast<unsigned>(extents[0]);
    const auto for_each_row = [&](const auto& body) {
      for (int z = 0; z < extents[2]; ++z)
        for (int y = 0; y < extents[1]; ++y) {
          const RegionIndex* const r =
              first + static_cast<std::size_t>(z) * slice + static_cast<std::size_t>(y) * row;
          body(r, std::equal(r + 1, r + width, r));
        }
    };
    std::vector<RegionIndex> palette;
    for_each_row([&](const RegionIndex* r, bool alike) {
      for (unsigned x = 0; x < (alike ? 1 : width); ++x) {
        if (numbers_[r[x]] != none) continue;
        numbers_[r[x]] = static_cast<std::uint16_t>(palette.size());
        palette.push_back(r[x]);
      }
    });
    Tile tile;
    tile.bits = bits_for(palette.size());
    if (const unsigned bits = tile.bits; bits > 0) {
      const unsigned in_word = 32 / bits;
      tile.words.reserve(static_cast<std::size_t>(extents[1]) * static_cast<std::size_t>(extents[2]) * bits);
      for_each_row([&](const RegionIndex* r, bool alike) {
        if (alike) {
          tile.words.insert(tile.words.end(), bits, numbers_[*r] * (~0u / ((1u << bits) - 1)));
          return;
        }
        for (unsigned x = 0; x < side; x += in_word) {
          std::uint32_t word = 0;
          for (unsigned k = 0; k < in_word && x + k < width; ++k) word |= numbers_[r[x + k]] << k * bits;
          tile.words.push_back(word);
        }
      });
    }
    for (const RegionIndex r : palette) numbers_[r] = none;
    tile.palette.assign(palette.begin(), palette.end());
    out = std::move(tile);
  }

 private:
  static constexpr std::uint16_t none = 0xffff;  // more than the voxels of a tile
  std::vector<std::uint16_t> numbers_ = std::vector<std::uint16_t>(1 << 16, none);  ///< by region
};

void RegionGrid::Tile::read_row(std::size_t row, int from, int to, RegionIndex* out) const {
  const std::uint32_t* const of_row = words.data() + row * bits;
  switch (bits) {
    case 0:
      std::fill_n(out, to - from, palette[0]);
      return;
    case 1:
      unpack<1>(of_row, palette.data(), from, to, out);
      return;
    case 2:
      unpack<2>(of_row, palette.data(), from, to, out);
      return;
    case 4:
      unpack<4>(of_row, palette.data(), from, to, out);
      return;
    case 8:
      unpack<8>(of_row, palette.data(), from, to, out);
      return;
    default:
      unpack<16>(of_row, palette.data(), from, to, out);
  }
}

RegionGrid::RegionGrid(const VoxelIndex& size) : size_(size) {
  for (std::size_t a = 0; a < 3; ++a) counts_[a] = (size[a] - 1) / side + 1;
  tiles_.resize(tile_number(0, 0, counts_[2]));
}

std::size_t RegionGrid::bytes() const {
  std::size_t sum = tiles_.size() * sizeof(Tile);
  for (const Tile& t : tiles_)
    sum += t.palette.capacity() * sizeof(RegionIndex) + t.words.capacity() * sizeof(std::uint32_t);
  return sum;
}

RegionIndex RegionGrid::operator[](std::uint64_t voxel) const {
  const auto nx = static_cast<std::uint64_t>(size_[0]), ny = static_cast<std::uint64_t>(size_[1]);
  return at(static_cast<int>(voxel % nx), static_cast<int>(voxel / nx % ny),
            static_cast<int>(voxel / (nx * ny)));
}

void RegionGrid::read(const VoxelIndex& low, const VoxelIndex& high, std::span<RegionIndex> out) const {
  std::array<std::size_t, 3> extents;
  for (std::size_t a = 0; a < 3; ++a) {
    TETWRIGHT_CHECK(0 <= low[a] && low[a] < high[a] && high[a] <= size_[a]);
    extents[a] = static_cast<std::size_t>(high[a] - low[a]);
  }
  TETWRIGHT_CHECK(out.size() == extents[0] * extents[1] * extents[2]);
  for (int z = low[2]; z < high[2]; ++z)
    for (int ty = low[1] / side; ty * side < high[1]; ++ty)
      for (int tx = low[0] / side; tx * side < high[0]; ++tx) {
        const Tile& tile = tiles_[tile_number(tx, ty, z / side)];
        const int from = std::max(low[0], tx * side), to = std::min(high[0], (tx + 1) * side);
        for (int y = std::max(low[1], ty * side); y < std::min(high[1], (ty + 1) * side); ++y)
          tile.read_row(
              row_number(y, z), from - tx * side, to - tx * side,
              out.data() +
                  (static_cast<std::size_t>(z - low[2]) * extents[1] + static_cast<std::size_t>(y - low[1])) *
                      extents[0] +
                  static_cast<std::size_t>(from - low[0]));
      }
}

void RegionGrid::write_slices(int first, std::span<const RegionIndex> regions) {
  const std::size_t row = static_cast<std::size_t>(size_[0]),
                    slice = row * static_cast<std::size_t>(size_[1]);
  const int last = first + static_cast<int>(regions.size() / slice);
  TETWRIGHT_CHECK(first % side == 0 && (last % side == 0 || last == size_[2]) && last <= size_[2]);
  const std::size_t begin = tile_number(0, 0, first / side),
                    end = tile_number(0, 0, (last + side - 1) / side);
  std::vector<Packer> packers(std::min<std::size_t>(thread_count(), end - begin));
  parallel_chunks(end - begin, [&](std::size_t chunk, unsigned worker) {
    const auto number = static_cast<std::ptrdiff_t>(begin + chunk);
    const VoxelIndex at{static_cast<int>(number % counts_[0]),
                        static_cast<int>(number / counts_[0] % counts_[1]),
                        static_cast<int>(number / counts_[0] / counts_[1])};
    const RegionIndex* const from = regions.data() + static_cast<std::size_t>(at[2] * side - first) * slice +
                                    static_cast<std::size_t>(at[1] * side) * row +
                                    static_cast<std::size_t>(at[0] * side);
    packers[worker].pack(from, row, slice, {extent(0, at[0]), extent(1, at[1]), extent(2, at[2])},
                         tiles_[begin + chunk]);
  });
}

unsigned RegionGrid::add_region(Tile& tile, const VoxelIndex& extents, RegionIndex region) const {
  const std::size_t rows = static_cast<std::size_t>(extents[1]) * static_cast<std::size_t>(extents[2]);
  const auto width = static_cast<unsigned>(extents[0]);
  if (tile.bits > 0 && tile.palette.size() < std::size_t{1} << tile.bits) {
    tile.palette.push_back(region);
    return static_cast<unsigned>(tile.palette.size() - 1);
  }
  const auto for_each_voxel = [&](const auto& body) {
    for (std::size_t row = 0; row < rows; ++row)
      for (unsigned x = 0; x < width; ++x) body(row, x, tile.bits > 0 ? tile.index(row, x) : 0);
  };
  std::vector<std::uint8_t> used(tile.palette.size(), 0);
  for_each_voxel([&](std::size_t, unsigned, unsigned index) { used[index] = 1; });
  Tile packed;
  packed.palette.clear();
  std::vector<unsigned> numbers(used.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    numbers[i] = static_cast<unsigned>(packed.palette.size());
    if (used[i]) packed.palette.push_back(tile.palette[i]);
  }
  packed.palette.push_back(region);
  packed.bits = bits_for(packed.palette.size());
  packed.words.resize(rows * packed.bits);
  for_each_voxel(
      [&](std::size_t row, unsigned x, unsigned index) { packed.set_index(row, x, numbers[index]); });
  tile = std::move(packed);
  return static_cast<unsigned>(tile.palette.size() - 1);
}

void RegionGrid::fill(const VoxelIndex& first, int count, RegionIndex region) {
  const int end = first[0] + count, ty = first[1] / side, tz = first[2] / side;
  for (int tx = first[0] / side; tx * side < end; ++tx) {
    Tile& tile = tiles_[tile_number(tx, ty, tz)];
    const auto found = std::find(tile.palette.begin(), tile.palette.end(), region);
    if (tile.bits == 0 && found != tile.palette.end()) continue;
    const unsigned index = found != tile.palette.end()
                               ? static_cast<unsigned>(found - tile.palette.begin())
                               : add_region(tile, {extent(0, tx), extent(1, ty), extent(2, tz)}, region);
    const std::size_t row = row_number(first[1], first[2]);
    for (int x = std::max(first[0], tx * side); x < std::min(end, (tx + 1) * side); ++x)
      tile.set_index(row, static_cast<unsigned>(x % side), index);
  }
}

void RegionGrid::renumber(std::span<const RegionIndex> table) {
  constexpr std::size_t grain = 1 << 12;  // tiles, some nanoseconds each
  parallel_for(0, tiles_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (RegionIndex& r : tiles_[t].palette) r = table[r];
  });
}

}  // namespace tetwright
