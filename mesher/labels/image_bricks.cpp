// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/image_bricks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mesher/images/material_image.h"
#include "mesher/tuning/image_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr int cells = LabelBricks::cells, nodes = LabelBricks::nodes;
/// Voxels around a brick in which the nearest voxel of another region is looked for: beyond the band.
constexpr int depth_reach = 3;
static_assert(depth_reach >= LabelSmoother::band + 0.5);
constexpr int box_side = nodes + 2 * depth_reach;

constexpr int box_index(int x, int y, int z) { return (z * box_side + y) * box_side + x; }

/// Steps to the voxels around one that may be nearer than the band, by ascending length.
struct DepthStep {
  int step;
  float depth;  ///< distance from the centre to a face halfway to that voxel, voxels
};

std::vector<DepthStep> depth_steps() {
  std::vector<DepthStep> steps;
  for (int z = -depth_reach; z <= depth_reach; ++z)
    for (int y = -depth_reach; y <= depth_reach; ++y)
      for (int x = -depth_reach; x <= depth_reach; ++x) {
        const float depth = std::sqrt(static_cast<float>(x * x + y * y + z * z)) - 0.5F;
        if (depth > 0 && depth < LabelSmoother::band) steps.push_back({box_index(x, y, z), depth});
      }
  std::sort(steps.begin(), steps.end(), [](const DepthStep& a, const DepthStep& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.step < b.step;
  });
  return steps;
}

/// The bricks of a row along the first axis.
struct RowBricks {
  std::vector<LabelBricks::Brick> bricks;  ///< channels are numbered within the row
  std::vector<RegionIndex> channels;
  std::vector<std::int16_t> values;
};

/// The slope of interfaces, which varies slowly: means in blocks, trilinear between their centres.
class InterfaceSlopes {
 public:
  InterfaceSlopes(const LabelInput& labels, const MaterialImage& image, const std::array<int, 3>& counts,
                  const Progress* progress)
      : labels_(labels), image_(image), counts_(counts) {
    band_of_.assign(labels.materials.size() + 1, 0);
    for (std::size_t b = 0; b < image.bands(); ++b)
      if (labels.band_regions[b] != on_interface) band_of_[labels.band_regions[b]] = b;
    const std::size_t blocks = static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1]) *
                               static_cast<std::size_t>(counts[2]);
    std::vector<Sum> own(blocks);
    parallel_for(0, blocks, ImageGrains::slices, [&](std::size_t begin, std::size_t end) {
      if (progress) progress->throw_if_stopped();
      for (std::size_t b = begin; b < end; ++b) own[b] = sum_in_block(position(b));
    });
    Sum all;
    for (const Sum& s : own) all += s;
    const double mean = all.edges > 0 ? all.slopes / all.edges : 1;
    slopes_.assign(blocks, 0);
    parallel_for(0, blocks, ImageGrains::voxels, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        const Sum around = sum_around(position(b), own);
        if (around.edges > 0)
          slopes_[b] = std::max(around.slopes / around.edges, ImageTuning::min_local_slope * mean);
      }
    });
    limit_changes();
    for (double& slope : slopes_)
      if (slope == 0) slope = mean;
  }

  /// \param node index of a node of the whole volume
  double at(const std::array<int, 3>& node) const {
    std::array<int, 3> low, high;
    std::array<double, 3> share;
    for (std::size_t a = 0; a < 3; ++a) {
      // Centres of blocks are in their middle node.
      constexpr int middle = cells / 2;
      const double along = static_cast<double>(node[a] - middle) / cells;
      const double whole = std::floor(along);
      low[a] = std::clamp(static_cast<int>(whole), 0, counts_[a] - 1);
      high[a] = std::clamp(static_cast<int>(whole) + 1, 0, counts_[a] - 1);
      share[a] = along - whole;
    }
    double result = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::array<int, 3> at{};
      for (std::size_t a = 0; a < 3; ++a) {
        const bool upper = (corner >> a & 1) != 0;
        weight *= upper ? share[a] : 1 - share[a];
        at[a] = upper ? high[a] : low[a];
      }
      result += weight * slopes_[block(at)];
    }
    return result;
  }

 private:
  struct Sum {
    double slopes = 0, edges = 0;
    Sum& operator+=(const Sum& o) {
      slopes += o.slopes;
      edges += o.edges;
      return *this;
    }
  };
  std::size_t block(const std::array<int, 3>& at) const {
    return (static_cast<std::size_t>(at[2]) * static_cast<std::size_t>(counts_[1]) +
            static_cast<std::size_t>(at[1])) *
               static_cast<std::size_t>(counts_[0]) +
           static_cast<std::size_t>(at[0]);
  }
  std::array<int, 3> position(std::size_t number) const {
    const auto x = static_cast<std::size_t>(counts_[0]), y = static_cast<std::size_t>(counts_[1]);
    return {static_cast<int>(number % x), static_cast<int>(number / x % y), static_cast<int>(number / x / y)};
  }

  /// Raises slopes beside much larger ones: a change from one voxel to the next moves interfaces. Blocks far
  /// from interfaces have none.
  void limit_changes() {
    for (bool changed = true; changed;) {
      changed = false;
      std::vector<double> raised = slopes_;
      for (std::size_t b = 0; b < slopes_.size(); ++b) {
        if (slopes_[b] == 0) continue;
        const std::array<int, 3> at = position(b);
        for (std::size_t a = 0; a < 3; ++a)
          for (const int step : {-1, 1}) {
            std::array<int, 3> there = at;
            there[a] += step;
            if (there[a] < 0 || there[a] >= counts_[a]) continue;
            raised[b] = std::max(raised[b], slopes_[block(there)] / ImageTuning::max_slope_ratio);
          }
        changed |= raised[b] > slopes_[b];
      }
      slopes_ = std::move(raised);
    }
  }

  /// Length of the gradient, by central differences, index space.
  double slope(const VoxelIndex& at, std::size_t a, std::size_t b) const {
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      VoxelIndex low = at, high = at;
      low[axis] = std::max(0, at[axis] - 1);
      high[axis] = std::min(labels_.size[axis] - 1, at[axis] + 1);
      if (low[axis] == high[axis]) continue;
      const double change = image_.contrast(image_.voxel(high[0], high[1], high[2]), a, b) -
                            image_.contrast(image_.voxel(low[0], low[1], low[2]), a, b);
      squared += change * change / (high[axis] - low[axis]) / (high[axis] - low[axis]);
    }
    return std::sqrt(squared);
  }

  /// Edges between voxel centres of different regions whose lower end is in the block.
  Sum sum_in_block(const std::array<int, 3>& at) const {
    VoxelIndex low, high, read;
    for (std::size_t a = 0; a < 3; ++a) {
      if (at[a] * cells - LabelBricks::padding >= labels_.size[a]) return {};
      low[a] = std::clamp(at[a] * cells - LabelBricks::padding, 0, labels_.size[a] - 1);
      high[a] = std::clamp((at[a] + 1) * cells - LabelBricks::padding, low[a] + 1, labels_.size[a]);
      read[a] = std::min(labels_.size[a], high[a] + 1);
    }
    std::array<RegionIndex, (cells + 1) * (cells + 1) * (cells + 1)> regions;
    const int width = read[0] - low[0], height = read[1] - low[1];
    const int count = width * height * (read[2] - low[2]);
    labels_.regions.read(low, read, std::span(regions).first(static_cast<std::size_t>(count)));
    const std::array<int, 3> steps{1, width, width * height};
    Sum sum;
    for (int z = low[2]; z < high[2]; ++z)
      for (int y = low[1]; y < high[1]; ++y)
        for (int x = low[0]; x < high[0]; ++x) {
          const VoxelIndex here{x, y, z};
          const int i = (z - low[2]) * steps[2] + (y - low[1]) * steps[1] + (x - low[0]);
          for (std::size_t a = 0; a < 3; ++a) {
            if (here[a] + 1 >= read[a]) continue;
            const int next = i + steps[a];
            const RegionIndex r = regions[static_cast<std::size_t>(i)],
                              s = regions[static_cast<std::size_t>(next)];
            if (r == s) continue;
            VoxelIndex there = here;
            ++there[a];
            const std::size_t b = band_of_[r], c = band_of_[s];
            sum += {0.5 * (slope(here, b, c) + slope(there, b, c)), 1};
          }
        }
    return sum;
  }

  /// Weighted sum over the block and its neighbours, so that means of adjacent blocks differ little.
  Sum sum_around(const std::array<int, 3>& at, const std::vector<Sum>& own) const {
    Sum sum;
    for (int k = 0; k < 27; ++k) {
      const std::array<int, 3> step{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
      std::array<int, 3> there;
      bool inside = true;
      double weight = 1;
      for (std::size_t a = 0; a < 3; ++a) {
        there[a] = at[a] + step[a];
        inside &= there[a] >= 0 && there[a] < counts_[a];
        if (step[a] == 0) weight *= 2;
      }
      if (!inside) continue;
      const Sum& s = own[block(there)];
      sum += {weight * s.slopes, weight * s.edges};
    }
    return sum;
  }

  const LabelInput& labels_;
  const MaterialImage& image_;
  const std::array<int, 3> counts_;
  std::vector<std::size_t> band_of_;  ///< of each region
  std::vector<double> slopes_;        ///< of each block
};

/// Makes bricks, one at a time.
class BrickMaker {
 public:
  BrickMaker(const LabelInput& labels, const MaterialImage& image, const InterfaceSlopes& slopes)
      : labels_(labels),
        image_(image),
        slopes_(slopes),
        steps_(depth_steps()),
        box_(box_side * box_side * box_side),
        lost_(image.bands(), 0),
        near_(image.bands(), 0),
        potentials_(image.bands()),
        values_(image.bands()) {
    for (std::size_t b = 0; b < lost_.size(); ++b) lost_[b] = labels.band_regions[b] == on_interface;
  }

  void add(const std::array<int, 3>& brick, RowBricks& out) {
    read_regions(brick);
    LabelBricks::Brick made{static_cast<std::uint32_t>(out.channels.size()), 0, box_[0]};
    if (std::all_of(box_.begin(), box_.end(), [&](RegionIndex r) { return r == box_[0]; })) {
      out.bricks.push_back(made);
      return;
    }
    near_.assign(image_.bands(), 0);
    for (std::size_t b = 0; b < image_.bands(); ++b)
      if (labels_.band_regions[b] != on_interface) near_[b] = region_near(labels_.band_regions[b]);
    int i = 0;
    for (int z = 0; z < nodes; ++z)
      for (int y = 0; y < nodes; ++y)
        for (int x = 0; x < nodes; ++x, ++i) set_node(brick, {x, y, z}, i);
    bool all_far = true;
    for (std::size_t b = 0; b < image_.bands(); ++b) {
      const RegionIndex region = labels_.band_regions[b];
      if (region == on_interface) continue;
      const auto [smallest, largest] = std::minmax_element(values_[b].begin(), values_[b].end());
      if (*smallest >= band_units || !occurs(b)) continue;
      if (*largest <= -band_units) made.alone = region;
      all_far &= *largest <= -band_units;
      out.channels.push_back(region);
      out.values.insert(out.values.end(), values_[b].begin(), values_[b].end());
      ++made.count;
    }
    if (made.count == 1 && all_far) {
      made.count = 0;
      out.channels.pop_back();
      out.values.resize(out.values.size() - LabelBricks::volume);
    }
    out.bricks.push_back(made);
  }

 private:
  static constexpr float units = LabelBricks::units_of_images;
  static constexpr auto band_units = static_cast<std::int16_t>(LabelSmoother::band * units);

  /// Index of the voxel at a node; beyond the volume that of the closest voxel.
  int voxel_along(int axis, int node) const {
    return std::clamp(node - LabelBricks::padding, 0, labels_.size[static_cast<std::size_t>(axis)] - 1);
  }

  void read_regions(const std::array<int, 3>& brick) {
    VoxelIndex low, high;
    std::array<std::array<int, box_side>, 3> at;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      for (int i = 0; i < box_side; ++i)
        at[axis][static_cast<std::size_t>(i)] = voxel_along(a, brick[axis] * cells + i - depth_reach);
      low[axis] = at[axis].front();
      high[axis] = at[axis].back() + 1;
    }
    const int width = high[0] - low[0], height = high[1] - low[1];
    std::vector<RegionIndex> read(static_cast<std::size_t>(width * height * (high[2] - low[2])));
    labels_.regions.read(low, high, read);
    std::size_t i = 0;
    for (const int z : at[2])
      for (const int y : at[1])
        for (const int x : at[0]) {
          const int from = ((z - low[2]) * height + (y - low[1])) * width + (x - low[0]);
          box_[i++] = read[static_cast<std::size_t>(from)];
        }
  }

  bool region_near(RegionIndex region) const {
    return std::find(box_.begin(), box_.end(), region) != box_.end();
  }

  /// Whether a band has a voxel near the brick, or may be the nearest between voxels, because in some cube no
  /// band near the brick is nearer at all corners. Sharp probability maps are nowhere far apart otherwise.
  bool occurs(std::size_t band) const {
    if (near_[band]) return true;
    constexpr int y = nodes, z = nodes * nodes;
    constexpr std::array<int, 8> corners{0, 1, y, y + 1, z, z + 1, z + y, z + y + 1};
    for (int k = 0; k < cells * cells * cells; ++k) {
      const int lowest = (k / (cells * cells) * nodes + k / cells % cells) * nodes + k % cells;
      bool beaten = false;
      for (std::size_t b = 0; b < near_.size() && !beaten; ++b)
        beaten = near_[b] && std::all_of(corners.begin(), corners.end(), [&](int c) {
                   const int node = lowest + c;
                   const auto corner = static_cast<std::size_t>(node);
                   return values_[b][corner] <= values_[band][corner];
                 });
      if (!beaten) return true;
    }
    return false;
  }

  void set_node(const std::array<int, 3>& brick, const std::array<int, 3>& in_brick, int i) {
    const int here =
        box_index(in_brick[0] + depth_reach, in_brick[1] + depth_reach, in_brick[2] + depth_reach);
    const RegionIndex own = box_[static_cast<std::size_t>(here)];
    float depth = LabelSmoother::band;
    RegionIndex nearest = own;
    for (const DepthStep& s : steps_) {
      const int there = here + s.step;
      const RegionIndex region = box_[static_cast<std::size_t>(there)];
      if (region == own) continue;
      depth = s.depth;
      nearest = region;
      break;
    }
    std::array<int, 3> node;
    VoxelIndex at;
    for (std::size_t a = 0; a < 3; ++a) {
      node[a] = brick[a] * cells + in_brick[a];
      at[a] = voxel_along(static_cast<int>(a), node[a]);
    }
    image_.potentials(image_.voxel(at[0], at[1], at[2]), lost_, potentials_);
    const std::vector<RegionIndex>& regions = labels_.band_regions;
    const std::size_t band =
        static_cast<std::size_t>(std::find(regions.begin(), regions.end(), own) - regions.begin());
    // Corners of a cube of eight voxels that an interface crosses.
    const bool at_interface = depth < corner_depth;
    const double per_potential = 1 / (2 * slopes_.at(node));
    // Half differences of distances.
    double lead = HUGE_VAL;
    bool smallest = true;
    for (std::size_t b = 0; b < potentials_.size(); ++b) {
      if (b == band || regions[b] == on_interface) continue;
      const double half = (potentials_[b] - potentials_[band]) * per_potential;
      smallest &= half >= 0;
      potentials_[b] = at_interface            ? half
                       : regions[b] == nearest ? std::max<double>(half, depth)
                                               : std::max<double>(half, LabelSmoother::band);
      lead = std::min(lead, potentials_[b]);
    }
    if (at_interface && image_.thresholds().empty()) {
      const double bias = outside_bias(band);
      for (std::size_t b = 0; b < potentials_.size(); ++b)
        if (b != band && (b == 0) != (band == 0)) potentials_[b] += band == 0 ? -bias : bias;
      lead = std::max<double>(lead - (band == 0 ? bias : 0), 0);
    }
    // The smallest difference that can be stored.
    const double min_lead = smallest ? 1 / units : ImageTuning::merged_depth;
    const float limit = at_interface ? INT16_MAX / units : LabelSmoother::band;
    lead = std::clamp<double>(lead, min_lead, limit);
    for (std::size_t b = 0; b < potentials_.size(); ++b) {
      if (regions[b] == on_interface) continue;
      const double distance = b == band ? -lead : 2 * std::max(potentials_[b], lead) - lead;
      values_[b][static_cast<std::size_t>(i)] =
          static_cast<std::int16_t>(std::lrint(units * std::min<double>(distance, limit)));
    }
  }

  /// How much farther the outside counts where two channels are about equal, voxels. Where it has just their
  /// value, as between two maps that add up to 1 with an outside probability of 0.5, rounding would else
  /// decide at every point of their interface. \param own band of the node, to which half differences refer
  double outside_bias(std::size_t own) const {
    double first = HUGE_VAL, second = HUGE_VAL;
    for (std::size_t b = 1; b < potentials_.size(); ++b) {
      if (labels_.band_regions[b] == on_interface) continue;
      const double half = b == own ? 0 : potentials_[b];
      if (half < first)
        second = first, first = half;
      else
        second = std::min(second, half);
    }
    return second < HUGE_VAL
               ? ImageTuning::tie_bias * std::max(0.0, 1 - (second - first) / ImageTuning::tie_reach)
               : 0;
  }

  /// Nodes with a voxel of another region among their 26 neighbours are less deep than this.
  static constexpr float corner_depth = 1.3F;  // sqrt(3) - 0.5 and a little

  const LabelInput& labels_;
  const MaterialImage& image_;
  const InterfaceSlopes& slopes_;
  const std::vector<DepthStep> steps_;
  std::vector<RegionIndex> box_;
  std::vector<std::uint8_t> lost_;  ///< by band: 1 if no voxel has it
  std::vector<std::uint8_t> near_;  ///< by band: 1 if a voxel near the brick has it
  std::vector<double> potentials_;  ///< of each band at a node
  std::vector<std::array<std::int16_t, LabelBricks::volume>> values_;
};

}  // namespace

LabelBricks make_image_bricks(const LabelInput& labels, const Progress* progress) {
  TETWRIGHT_CHECK(labels.image && labels.image->size() == labels.size);
  const MaterialImage& image = *labels.image;
  LabelBricks made;
  made.units_per_voxel = LabelBricks::units_of_images;
  for (std::size_t a = 0; a < 3; ++a)
    made.counts[a] =
        (labels.size[a] + 2 * LabelBricks::padding - 1 + LabelBricks::cells - 1) / LabelBricks::cells;
  const InterfaceSlopes slopes(labels, image, made.counts, progress);
  const std::size_t rows =
      static_cast<std::size_t>(made.counts[1]) * static_cast<std::size_t>(made.counts[2]);
  std::vector<RowBricks> parts(rows);
  parallel_for(0, rows, ImageGrains::rows, [&](std::size_t begin, std::size_t end) {
    if (progress) progress->throw_if_stopped();
    BrickMaker maker(labels, image, slopes);
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row % static_cast<std::size_t>(made.counts[1])),
                z = static_cast<int>(row / static_cast<std::size_t>(made.counts[1]));
      for (int x = 0; x < made.counts[0]; ++x) maker.add({x, y, z}, parts[row]);
    }
  });
  std::size_t channels = 0;
  for (const RowBricks& part : parts) channels += part.channels.size();
  made.channels.reserve(channels);
  made.values.reserve(channels * LabelBricks::volume);
  for (RowBricks& part : parts) {
    const auto first = static_cast<std::uint32_t>(made.channels.size());
    for (LabelBricks::Brick brick : part.bricks) {
      brick.first += first;
      made.bricks.push_back(brick);
    }
    made.channels.insert(made.channels.end(), part.channels.begin(), part.channels.end());
    made.values.insert(made.values.end(), part.values.begin(), part.values.end());
    part = {};
  }
  return made;
}

}  // namespace tetwright
