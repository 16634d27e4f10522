#include "mesher/label_blocks.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/parallel.h"

namespace tetwright {

namespace {

constexpr int blocks_per_tile = LabelSmoother::cells / LabelBlocks::cells;

/// What one tile adds.
struct TileBlocks {
  struct Made {
    std::array<int, 3> at;
    std::uint32_t first;
    std::uint16_t count;
    RegionIndex alone;
  };
  std::vector<Made> blocks;
  std::vector<RegionIndex> channels;
  std::vector<std::int16_t> values;
  std::vector<std::pair<RegionIndex, LabelSmoother::Share>> shares;
};

/// Copies the voxels around a tile; false if all are of one region, which is the first.
bool copy_voxels(const PreparedLabels& labels, const std::array<int, 3>& tile, std::span<RegionIndex> out) {
  constexpr int side = LabelSmoother::side;
  const std::array<int, 3>& size = labels.size;
  std::array<int, 3> low;  // first index copied
  for (int a = 0; a < 3; ++a)
    low[a] = tile[a] * LabelSmoother::cells - LabelSmoother::reach - LabelBlocks::padding;
  const int from = std::clamp(-low[0], 0, side), to = std::clamp(size[0] - low[0], from, side);
  bool alike = true;
  RegionIndex first = outside_region;
  RegionIndex* row = out.data();
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y, row += side) {
      const int iy = low[1] + y, iz = low[2] + z;
      if (iy < 0 || iz < 0 || iy >= size[1] || iz >= size[2]) {
        std::fill(row, row + side, outside_region);
      } else {
        const RegionIndex* in =
            labels.regions.data() + (static_cast<std::size_t>(iz) * size[1] + iy) * size[0] + (low[0] + from);
        std::fill(row, row + from, outside_region);
        std::copy(in, in + (to - from), row + from);
        std::fill(row + to, row + side, outside_region);
      }
      if (y == 0 && z == 0) first = row[0];
      if (alike)
        for (int x = 0; x < side; ++x) alike &= row[x] == first;
    }
  return !alike;
}

void add_block(const LabelSmoother& smoother, const std::array<int, 3>& in_tile, const std::array<int, 3>& at,
               TileBlocks& out) {
  TileBlocks::Made made{at, static_cast<std::uint32_t>(out.channels.size()), 0, outside_region};
  std::array<std::int16_t, LabelBlocks::volume> values;
  bool all_far = true;
  for (std::size_t l = 0; l < smoother.labels().size(); ++l) {
    std::int16_t smallest = LabelBlocks::band_units, largest = -LabelBlocks::band_units;
    int i = 0;
    for (int z = 0; z < LabelBlocks::nodes; ++z)
      for (int y = 0; y < LabelBlocks::nodes; ++y)
        for (int x = 0; x < LabelBlocks::nodes; ++x, ++i) {
          const float d =
              smoother.distance(l, in_tile[0] * LabelBlocks::cells + x, in_tile[1] * LabelBlocks::cells + y,
                                in_tile[2] * LabelBlocks::cells + z);
          values[i] = static_cast<std::int16_t>(std::lrint(LabelBlocks::units_per_voxel * d));
          smallest = std::min(smallest, values[i]);
          largest = std::max(largest, values[i]);
        }
    if (smallest >= LabelBlocks::band_units) continue;
    if (largest <= -LabelBlocks::band_units) made.alone = smoother.labels()[l];
    all_far &= largest <= -LabelBlocks::band_units;
    out.channels.push_back(smoother.labels()[l]);
    out.values.insert(out.values.end(), values.begin(), values.end());
    ++made.count;
  }
  if (made.count == 1 && all_far) {
    made.count = 0;
    out.channels.pop_back();
    out.values.resize(out.values.size() - LabelBlocks::volume);
  }
  out.blocks.push_back(made);
}

/// Tile number `t` of `tiles`, and those of its blocks that there are, of `blocks`.
void make_tile(const PreparedLabels& labels, int t, const std::array<int, 3>& tiles,
               const std::array<int, 3>& blocks, std::span<const float> growth, LabelSmoother& smoother,
               TileBlocks& out) {
  const std::array<int, 3> tile{t % tiles[0], t / tiles[0] % tiles[1], t / (tiles[0] * tiles[1])};
  out = {};
  const bool mixed = copy_voxels(labels, tile, smoother.voxels());
  if (mixed) {
    if (smoother.number_labels() > LabelSmoother::most_labels)
      throw InputError(
          labels.file, 0,
          "has more than " + std::to_string(LabelSmoother::most_labels) + " labels within " +
              std::to_string(LabelSmoother::side) +
              " voxels, like an image of gray values; give a segmented volume, or choose --labels");
    smoother.smooth(growth);
    const std::vector<LabelSmoother::Share> shares = smoother.shares();
    for (std::size_t l = 0; l < shares.size(); ++l) out.shares.emplace_back(smoother.labels()[l], shares[l]);
  } else if (const RegionIndex alone = smoother.voxels()[0]; alone != outside_region) {
    constexpr double all = LabelSmoother::cells * LabelSmoother::cells * LabelSmoother::cells;
    out.shares.push_back({alone, {all, 0}});
  }
  for (int k = 0; k < blocks_per_tile * blocks_per_tile * blocks_per_tile; ++k) {
    const std::array<int, 3> in_tile{k % blocks_per_tile, k / blocks_per_tile % blocks_per_tile,
                                     k / (blocks_per_tile * blocks_per_tile)};
    std::array<int, 3> at;
    bool inside = true;
    for (int a = 0; a < 3; ++a) {
      at[a] = tile[a] * blocks_per_tile + in_tile[a];
      inside &= at[a] < blocks[a];
    }
    if (!inside) continue;
    if (mixed)
      add_block(smoother, in_tile, at, out);
    else
      out.blocks.push_back({at, 0, 0, smoother.voxels()[0]});
  }
}

/// How often growth is adjusted: labels affect their neighbours.
constexpr int most_rounds = 4;

/// How much each label is grown all around, and what became of it.
struct Growth {
  std::vector<float> growth;          ///< by region, voxels
  std::vector<std::uint8_t> changed;  ///< by region: since the tiles were made last
  std::vector<double> volumes, slopes;

  explicit Growth(std::size_t regions)
      : growth(regions, 0), changed(regions, 1), volumes(regions, 0), slopes(regions, 0) {}

  /// Looks at the tiles; false if no label's volume is off.
  bool adjust(const PreparedLabels& labels, const std::vector<TileBlocks>& tiles) {
    // Of the label's voxels; the mesh adds a few tenths of a percent. Small labels are not promised as much.
    constexpr double tolerance = 0.004, tolerance_small = 0.02, small = 1000;
    // How slopes may differ from the voxels' faces: these are more than the interface's area, but a label
    // that is held in place does not give way all over.
    constexpr double flattest = 0.25, steepest = 1.25;
    std::vector<double> now(growth.size(), 0), faces(growth.size(), 0);
    for (const TileBlocks& t : tiles)
      for (const auto& [region, share] : t.shares) {
        now[region] += share.volume;
        faces[region] += share.faces;
      }
    std::vector<float> before = growth;
    for (std::size_t r = 1; r < growth.size(); ++r) {
      const auto voxels = static_cast<double>(labels.materials[r - 1].voxels);
      if (faces[r] <= 0) continue;
      if (slopes[r] <= 0) slopes[r] = faces[r];
      if (const double step = last_step_.empty() ? 0 : last_step_[r]; step != 0)
        slopes[r] = std::clamp((now[r] - volumes[r]) / step, flattest * faces[r], steepest * faces[r]);
      if (std::abs(voxels - now[r]) > (voxels > small ? tolerance : tolerance_small) * voxels)
        growth[r] = std::clamp(static_cast<float>(growth[r] + (voxels - now[r]) / slopes[r]),
                               -LabelSmoother::most_growth, LabelSmoother::most_growth);
    }
    volumes = std::move(now);
    bool any = false;
    last_step_.assign(growth.size(), 0);
    for (std::size_t r = 0; r < growth.size(); ++r) {
      last_step_[r] = static_cast<double>(growth[r]) - before[r];
      changed[r] = growth[r] != before[r];
      any |= changed[r] != 0;
    }
    return any;
  }

 private:
  std::vector<double> last_step_;
};

}  // namespace

LabelBlocks make_label_blocks(const PreparedLabels& labels, const Progress* progress) {
  LabelBlocks made;
  std::array<int, 3> tiles;
  for (int a = 0; a < 3; ++a) {
    made.counts[a] =
        (labels.size[a] + 2 * LabelBlocks::padding - 1 + LabelBlocks::cells - 1) / LabelBlocks::cells;
    tiles[a] = (made.counts[a] + blocks_per_tile - 1) / blocks_per_tile;
  }
  const auto product = [](const std::array<int, 3>& n) {
    return static_cast<std::size_t>(n[0]) * n[1] * n[2];
  };
  made.blocks.resize(product(made.counts));

  const std::size_t tile_count = product(tiles);
  std::vector<TileBlocks> parts(tile_count);
  // Volumes are evened out in a few rounds; only tiles where something changes are made again.
  Growth growth(labels.materials.size() + 1);
  for (int round = 0;; ++round) {
    constexpr std::size_t grain = 16;  // tiles to a task, a millisecond each where labels meet
    parallel_for(0, tile_count, grain, [&](std::size_t begin, std::size_t end) {
      if (progress) progress->throw_if_cancelled();
      LabelSmoother smoother;
      for (std::size_t t = begin; t < end; ++t) {
        const bool again = round == 0 || std::any_of(parts[t].shares.begin(), parts[t].shares.end(),
                                                     [&](const auto& v) { return growth.changed[v.first]; });
        if (again)
          make_tile(labels, static_cast<int>(t), tiles, made.counts, growth.growth, smoother, parts[t]);
      }
    });
    if (round == most_rounds || !growth.adjust(labels, parts)) break;
  }
  std::size_t channel_count = 0;
  for (const TileBlocks& p : parts) channel_count += p.channels.size();
  made.channels.reserve(channel_count);
  made.values.reserve(channel_count * LabelBlocks::volume);
  for (TileBlocks& p : parts) {
    const auto first = static_cast<std::uint32_t>(made.channels.size());
    for (const TileBlocks::Made& b : p.blocks)
      made.blocks[(static_cast<std::size_t>(b.at[2]) * made.counts[1] + b.at[1]) * made.counts[0] + b.at[0]] =
          {first + b.first, b.count, b.alone};
    made.channels.insert(made.channels.end(), p.channels.begin(), p.channels.end());
    made.values.insert(made.values.end(), p.values.begin(), p.values.end());
    p = {};
  }

  return made;
}

}  // namespace tetwright
