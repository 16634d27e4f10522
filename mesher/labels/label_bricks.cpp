// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_bricks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "mesher/tuning/label_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr int bricks_per_tile = LabelSmoother::cells / LabelBricks::cells;
constexpr int tile_parts = LabelSmoother::parts;

/// The bricks of one tile.
struct TileBricks {
  struct Made {
    std::array<int, 3> at;
    std::uint32_t first;
    std::uint16_t count;
    RegionIndex alone;
  };
  std::vector<Made> bricks;
  std::vector<RegionIndex> channels;
  std::vector<std::int16_t> values;
  /// Volumes of labels in each part of the tile, voxels; parts x fastest.
  std::array<std::vector<std::pair<RegionIndex, double>>, tile_parts * tile_parts * tile_parts> shares;
  std::vector<LabelSmoother::Contact> contacts;
};

/// Copies the voxels in and around a tile; beyond the volume the closest voxel is repeated. Returns false if
/// all voxels are in one region.
bool copy_voxels(const LabelInput& labels, const std::array<int, 3>& tile, std::span<RegionIndex> out) {
  constexpr int side = LabelSmoother::side;
  const std::array<int, 3>& size = labels.size;
  std::array<int, 3> first, low, high, extents;  // first index copied, box in the volume
  for (int a = 0; a < 3; ++a) {
    first[a] = tile[a] * LabelSmoother::cells - LabelSmoother::reach - LabelBricks::padding;
    low[a] = std::clamp(first[a], 0, size[a] - 1);
    high[a] = std::clamp(first[a] + side, low[a] + 1, size[a]);
    extents[a] = high[a] - low[a];
  }
  if (extents == std::array<int, 3>{side, side, side}) {
    labels.regions.read(low, high, out);
  } else {
    std::vector<RegionIndex> box(static_cast<std::size_t>(extents[0]) * extents[1] * extents[2]);
    labels.regions.read(low, high, box);
    const auto nearest = [&](int a, int i) { return std::clamp(first[a] + i, low[a], high[a] - 1) - low[a]; };
    RegionIndex* to = out.data();
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y) {
        const RegionIndex* const row =
            box.data() + (static_cast<std::size_t>(nearest(2, z)) * extents[1] + nearest(1, y)) * extents[0];
        for (int x = 0; x < side; ++x) *to++ = row[nearest(0, x)];
      }
  }
  return !std::equal(out.begin() + 1, out.end(), out.begin());
}

void add_brick(const LabelSmoother& smoother, const std::array<int, 3>& in_tile, const std::array<int, 3>& at,
               TileBricks& out) {
  TileBricks::Made made{at, static_cast<std::uint32_t>(out.channels.size()), 0, outside_region};
  std::array<std::int16_t, LabelBricks::volume> values;
  bool all_far = true;
  constexpr float units = LabelBricks::units_of_labels;
  constexpr auto band_units = static_cast<std::int16_t>(LabelSmoother::band * units);
  for (std::size_t l = 0; l < smoother.labels().size(); ++l) {
    std::int16_t smallest = band_units, largest = -band_units;
    int i = 0;
    for (int z = 0; z < LabelBricks::nodes; ++z)
      for (int y = 0; y < LabelBricks::nodes; ++y)
        for (int x = 0; x < LabelBricks::nodes; ++x, ++i) {
          const float d =
              smoother.distance(l, in_tile[0] * LabelBricks::cells + x, in_tile[1] * LabelBricks::cells + y,
                                in_tile[2] * LabelBricks::cells + z);
          values[i] = static_cast<std::int16_t>(std::lrint(units * d));
          smallest = std::min(smallest, values[i]);
          largest = std::max(largest, values[i]);
        }
    if (smallest >= band_units) continue;
    if (largest <= -band_units) made.alone = smoother.labels()[l];
    all_far &= largest <= -band_units;
    out.channels.push_back(smoother.labels()[l]);
    out.values.insert(out.values.end(), values.begin(), values.end());
    ++made.count;
  }
  if (made.count == 1 && all_far) {
    made.count = 0;
    out.channels.pop_back();
    out.values.resize(out.values.size() - LabelBricks::volume);
  }
  out.bricks.push_back(made);
}

/// Computes tile `t`. Contacts depend only on voxels, so they are computed once.
/// \param tiles, bricks numbers of tiles and bricks along each axis
void make_tile(const LabelInput& labels, int t, const std::array<int, 3>& tiles,
               const std::array<int, 3>& bricks, std::span<const float> growth, LabelSmoother& smoother,
               bool with_contacts, TileBricks& out) {
  const std::array<int, 3> tile{t % tiles[0], t / tiles[0] % tiles[1], t / (tiles[0] * tiles[1])};
  out = {};
  const bool mixed = copy_voxels(labels, tile, smoother.voxels());
  std::array<int, 3> first_voxel, end_voxel;  // of the volume, in nodes of the tile
  for (int a = 0; a < 3; ++a) {
    first_voxel[a] = LabelBricks::padding - tile[a] * LabelSmoother::cells;
    end_voxel[a] = first_voxel[a] + labels.size[a];
  }
  smoother.set_volume(first_voxel, end_voxel);
  if (mixed) {
    if (smoother.number_labels() > LabelTuning::Smoothing::max_labels)
      throw InputError(
          labels.file, 0,
          "has more than " + std::to_string(LabelTuning::Smoothing::max_labels) + " labels within " +
              std::to_string(LabelSmoother::side) +
              " voxels, like an image of gray values; mesh an image with --iso, or choose --labels");
    smoother.smooth(growth);
    for (int k = 0; k < static_cast<int>(out.shares.size()); ++k) {
      const std::vector<double> shares =
          smoother.shares({k % tile_parts, k / tile_parts % tile_parts, k / (tile_parts * tile_parts)});
      for (std::size_t l = 0; l < shares.size(); ++l)
        out.shares[k].emplace_back(smoother.labels()[l], shares[l]);
    }
    if (with_contacts) out.contacts = smoother.contacts();
  } else if (const RegionIndex alone = smoother.voxels()[0]; alone != outside_region) {
    for (int k = 0; k < static_cast<int>(out.shares.size()); ++k)
      out.shares[k].emplace_back(alone, smoother.volume_of({k % tile_parts, k / tile_parts % tile_parts,
                                                            k / (tile_parts * tile_parts)}));
  }
  for (int k = 0; k < bricks_per_tile * bricks_per_tile * bricks_per_tile; ++k) {
    const std::array<int, 3> in_tile{k % bricks_per_tile, k / bricks_per_tile % bricks_per_tile,
                                     k / (bricks_per_tile * bricks_per_tile)};
    std::array<int, 3> at;
    bool inside = true;
    for (int a = 0; a < 3; ++a) {
      at[a] = tile[a] * bricks_per_tile + in_tile[a];
      inside &= at[a] < bricks[a];
    }
    if (!inside) continue;
    if (mixed)
      add_brick(smoother, in_tile, at, out);
    else
      out.bricks.push_back({at, 0, 0, smoother.voxels()[0]});
  }
}

/// Determines how far each label is grown so that it keeps its volume.
///
/// Where labels r and s share f faces, growing r by d adds about f * d voxels to r, and growing s by d
/// removes as many. The steps that correct all volumes solve a linear system with one equation for each label
/// whose volume is wrong. The ratio between actual and expected changes is estimated for each label from one
/// step to the next.
class Growth {
 public:
  explicit Growth(std::size_t regions)
      : growth_(regions, 0), step_(regions, 0), volumes_(regions, 0), response_(regions, 1) {}

  const std::vector<float>& growth() const { return growth_; }  ///< by region, voxels
  /// True if the last adjust() changed it.
  bool changed(RegionIndex region) const { return step_[region] != 0; }

  /// Reads the volumes of the tiles and, in the first call, their contacts. Returns false if no label's
  /// growth changes any more.
  /// \param tile_counts tiles along each axis, x fastest
  bool adjust(const LabelInput& labels, const std::vector<TileBricks>& tiles,
              const std::array<int, 3>& tile_counts) {
    if (!begun_) list_contacts(tiles);
    std::vector<double> now(growth_.size(), 0);
    // Sum part by part in the order of the whole volume, so that results do not depend on the tile size.
    for (int z = 0; z < tile_parts * tile_counts[2]; ++z)
      for (int y = 0; y < tile_parts * tile_counts[1]; ++y)
        for (int x = 0; x < tile_parts * tile_counts[0]; ++x) {
          const int tile =
              (z / tile_parts * tile_counts[1] + y / tile_parts) * tile_counts[0] + x / tile_parts;
          const int part = (z % tile_parts * tile_parts + y % tile_parts) * tile_parts + x % tile_parts;
          for (const auto& [region, volume] :
               tiles[static_cast<std::size_t>(tile)].shares[static_cast<std::size_t>(part)])
            now[region] += volume;
        }
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

  void list_contacts(const std::vector<TileBricks>& tiles) {
    std::map<std::pair<RegionIndex, RegionIndex>, double> faces;
    for (const TileBricks& t : tiles)
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

  /// Compares the effect of the last steps with the expected one.
  void learn(const std::vector<double>& now) {
    for (std::size_t r = 1; r < growth_.size(); ++r) {
      double expected = 0;
      for (const Contact& c : contacts(r)) expected += c.faces * (step_[r] - step_[c.with]);
      if (std::abs(expected) > LabelTuning::Growth::min_informative * volumes_[r])
        response_[r] = std::clamp((now[r] - volumes_[r]) / expected, LabelTuning::Growth::min_response,
                                  LabelTuning::Growth::max_response);
    }
  }

  static double voxels_of(const LabelInput& labels, std::size_t region) {
    return static_cast<double>(labels.materials[region - 1].voxels);
  }
  static bool is_small(const LabelInput& labels, std::size_t region) {
    return voxels_of(labels, region) <= LabelTuning::Growth::small_voxels;
  }

  bool solve(const LabelInput& labels) {
    std::vector<RegionIndex> off;
    for (std::size_t r = 1; r < growth_.size(); ++r) {
      step_[r] = 0;
      const double voxels = voxels_of(labels, r);
      if (!contacts(r).empty() &&
          std::abs(voxels - volumes_[r]) >
              (is_small(labels, r) ? LabelTuning::Growth::tolerance_small : LabelTuning::Growth::tolerance) *
                  voxels)
        off.push_back(static_cast<RegionIndex>(r));
    }
    for (int sweep = 0; sweep < LabelTuning::Growth::sweeps; ++sweep)
      for (RegionIndex r : off) {
        double gain = (voxels_of(labels, r) - volumes_[r]) / response_[r];
        double faces = 0;
        for (const Contact& c : contacts(r)) {
          gain += c.faces * step_[c.with];
          faces += c.faces;
        }
        const double max_growth = LabelTuning::Growth::max_growth;
        double low = -max_growth, high = max_growth;
        for (const Contact& c : contacts(r)) {
          const double beside = growth_[c.with] + step_[c.with];
          if (is_small(labels, r)) low = std::max(low, beside - LabelTuning::Growth::max_small_shrinking);
          if (c.with != outside_region && is_small(labels, c.with) &&
              volumes_[c.with] > voxels_of(labels, c.with))
            high = std::min(high, beside + LabelTuning::Growth::max_small_shrinking);
        }
        step_[r] = std::clamp(growth_[r] + gain / faces, std::min(low, high), high) - growth_[r];
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
  std::vector<double> response_;  ///< by region: gain in voxels per face and voxel of growth
  std::vector<std::size_t> starts_;
  std::vector<Contact> contacts_;  ///< rows by region
};

}  // namespace

LabelBricks make_label_bricks(const LabelInput& labels, const Progress* progress) {
  LabelBricks made;
  std::array<int, 3> tiles;
  for (int a = 0; a < 3; ++a) {
    made.counts[a] =
        (labels.size[a] + 2 * LabelBricks::padding - 1 + LabelBricks::cells - 1) / LabelBricks::cells;
    tiles[a] = (made.counts[a] + bricks_per_tile - 1) / bricks_per_tile;
  }
  const auto product = [](const std::array<int, 3>& n) {
    return static_cast<std::size_t>(n[0]) * n[1] * n[2];
  };
  made.bricks.resize(product(made.counts));

  const std::size_t tile_count = product(tiles);
  std::vector<TileBricks> parts(tile_count);
  // Recompute only tiles with labels whose growth changed.
  Growth growth(labels.materials.size() + 1);
  for (int round = 0;; ++round) {
    parallel_for(0, tile_count, LabelGrains::tiles, [&](std::size_t begin, std::size_t end) {
      if (progress) progress->throw_if_stopped();
      LabelSmoother smoother;
      for (std::size_t t = begin; t < end; ++t) {
        // Every part lists all labels that the tile depends on.
        const auto& listed = parts[t].shares[0];
        const bool again = round == 0 || std::any_of(listed.begin(), listed.end(),
                                                     [&](const auto& v) { return growth.changed(v.first); });
        if (again)
          make_tile(labels, static_cast<int>(t), tiles, made.counts, growth.growth(), smoother, round == 0,
                    parts[t]);
      }
    });
    if (round == LabelTuning::Growth::max_rounds || !growth.adjust(labels, parts, tiles)) break;
  }
  std::size_t channel_count = 0;
  for (const TileBricks& p : parts) channel_count += p.channels.size();
  made.channels.reserve(channel_count);
  made.values.reserve(channel_count * LabelBricks::volume);
  for (TileBricks& p : parts) {
    const auto first = static_cast<std::uint32_t>(made.channels.size());
    for (const TileBricks::Made& b : p.bricks)
      made.bricks[(static_cast<std::size_t>(b.at[2]) * made.counts[1] + b.at[1]) * made.counts[0] + b.at[0]] =
          {first + b.first, b.count, b.alone};
    made.channels.insert(made.channels.end(), p.channels.begin(), p.channels.end());
    made.values.insert(made.values.end(), p.values.begin(), p.values.end());
    p = {};
  }

  return made;
}

}  // namespace tetwright
