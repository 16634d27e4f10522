#include "mesher/label_blocks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

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
  std::vector<std::pair<RegionIndex, double>> shares;  ///< voxels of each label
  std::vector<LabelSmoother::Contact> contacts;
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

/// Tile number `t` of `tiles`, and those of its blocks that there are, of `blocks`. Contacts depend on voxels
/// alone: once is enough.
void make_tile(const PreparedLabels& labels, int t, const std::array<int, 3>& tiles,
               const std::array<int, 3>& blocks, std::span<const float> growth, LabelSmoother& smoother,
               bool with_contacts, TileBlocks& out) {
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
    const std::vector<double> shares = smoother.shares();
    for (std::size_t l = 0; l < shares.size(); ++l) out.shares.emplace_back(smoother.labels()[l], shares[l]);
    if (with_contacts) out.contacts = smoother.contacts();
  } else if (const RegionIndex alone = smoother.voxels()[0]; alone != outside_region) {
    constexpr double all = LabelSmoother::cells * LabelSmoother::cells * LabelSmoother::cells;
    out.shares.emplace_back(alone, all);
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
///
/// Where label r touches label s by f faces, growing r by d gains it about f * d voxels there and growing s
/// takes them away again. So the steps that even out the volumes of labels that are off solve a system of
/// one equation for each of them; how much less than its faces a label gives way is learnt from step to step.
class Growth {
 public:
  explicit Growth(std::size_t regions)
      : growth_(regions, 0), step_(regions, 0), volumes_(regions, 0), give_(regions, 1) {}

  const std::vector<float>& growth() const { return growth_; }  ///< by region, voxels
  /// Whether it was changed by the last adjust().
  bool changed(RegionIndex region) const { return step_[region] != 0; }

  /// Looks at the tiles, the first time at their contacts too; false if no label's growth changes any more.
  bool adjust(const PreparedLabels& labels, const std::vector<TileBlocks>& tiles) {
    if (!begun_) list_contacts(tiles);
    std::vector<double> now(growth_.size(), 0);
    for (const TileBlocks& t : tiles)
      for (const auto& [region, volume] : t.shares) now[region] += volume;
    if (begun_) learn(now);
    begun_ = true;
    volumes_ = std::move(now);
    return solve(labels);
  }

 private:
  struct Contact {
    RegionIndex with;
    double faces;
  };
  std::span<const Contact> contacts(std::size_t region) const {
    return {contacts_.data() + starts_[region], contacts_.data() + starts_[region + 1]};
  }

  void list_contacts(const std::vector<TileBlocks>& tiles) {
    std::map<std::pair<RegionIndex, RegionIndex>, double> faces;
    for (const TileBlocks& t : tiles)
      for (const LabelSmoother::Contact& c : t.contacts) {
        faces[{c.first, c.second}] += c.faces;
        faces[{c.second, c.first}] += c.faces;
      }
    starts_.assign(growth_.size() + 1, 0);
    for (const auto& [pair, count] : faces) {
      contacts_.push_back({pair.second, count});
      ++starts_[pair.first + 1u];
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  }

  /// Compares what the last steps did with what they should have done.
  void learn(const std::vector<double>& now) {
    // Voxels' faces are more than the interface's area, and a label that is held in place does not give way
    // all over.
    constexpr double least_give = 0.25, most_give = 1.25;
    constexpr double telling = 1e-3;  ///< share of the volume; less of a step says little
    for (std::size_t r = 1; r < growth_.size(); ++r) {
      double expected = 0;
      for (const Contact& c : contacts(r)) expected += c.faces * (step_[r] - step_[c.with]);
      if (std::abs(expected) > telling * volumes_[r])
        give_[r] = std::clamp((now[r] - volumes_[r]) / expected, least_give, most_give);
    }
  }

  bool solve(const PreparedLabels& labels) {
    // Of the label's voxels; the mesh adds a few tenths of a percent. Small labels are not promised as much.
    constexpr double tolerance = 0.004, tolerance_small = 0.02, small = 1000;
    constexpr int sweeps = 30;  // of Gauss and Seidel; outside and what is not off stay where they are
    std::vector<RegionIndex> off;
    for (std::size_t r = 1; r < growth_.size(); ++r) {
      step_[r] = 0;
      const auto voxels = static_cast<double>(labels.materials[r - 1].voxels);
      if (!contacts(r).empty() &&
          std::abs(voxels - volumes_[r]) > (voxels > small ? tolerance : tolerance_small) * voxels)
        off.push_back(static_cast<RegionIndex>(r));
    }
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (RegionIndex r : off) {
        double gain = (static_cast<double>(labels.materials[r - 1u].voxels) - volumes_[r]) / give_[r];
        double faces = 0;
        for (const Contact& c : contacts(r)) {
          gain += c.faces * step_[c.with];
          faces += c.faces;
        }
        const double most = LabelSmoother::most_growth;
        step_[r] = std::clamp(growth_[r] + gain / faces, -most, most) - growth_[r];
      }
    bool any = false;
    for (RegionIndex r : off) {
      const float before = growth_[r];
      growth_[r] = static_cast<float>(before + step_[r]);
      step_[r] = static_cast<double>(growth_[r]) - before;
      any |= step_[r] != 0;
    }
    return any;
  }

  bool begun_ = false;
  std::vector<float> growth_;
  std::vector<double> step_, volumes_;
  std::vector<double> give_;  ///< by region: what it gains or loses for each face and voxel of a step
  std::vector<std::size_t> starts_;
  std::vector<Contact> contacts_;  ///< rows by region
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
                                                     [&](const auto& v) { return growth.changed(v.first); });
        if (again)
          make_tile(labels, static_cast<int>(t), tiles, made.counts, growth.growth(), smoother, round == 0,
                    parts[t]);
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
