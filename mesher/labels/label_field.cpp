// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_field.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/labels/distance_transform.h"
#include "mesher/labels/image_bricks.h"
#include "mesher/labels/interface_cells.h"
#include "mesher/labels/label_bricks.h"
#include "mesher/tuning/image_tuning.h"
#include "mesher/tuning/label_tuning.h"

namespace tetwright {

namespace {

constexpr int padding = LabelBricks::padding;
constexpr int brick_cells = LabelBricks::cells, brick_nodes = LabelBricks::nodes;
constexpr int brick_volume = LabelBricks::volume;

/// For each node of a brick, finds the channel of the smallest distance; ties go to the first.
void find_own_channels(const LabelBricks& all, const LabelBricks::Brick& brick,
                       std::array<std::uint16_t, brick_volume>& own) {
  std::array<std::int16_t, brick_volume> smallest;
  smallest.fill(INT16_MAX);
  for (std::uint16_t c = 0; c < brick.count; ++c) {
    const std::int16_t* v = all.channel(brick.first + c);
    for (int i = 0; i < brick_volume; ++i)
      if (v[i] < smallest[i]) smallest[i] = v[i], own[i] = c;
  }
}

/// Calls `use(cube)` with the lowest node of each cube of eight nodes that do not all have the same channel.
template <class Use>
void for_each_mixed_cube(const std::array<std::uint16_t, brick_volume>& own, Use&& use) {
  for (int k = 0; k < brick_cells * brick_cells * brick_cells; ++k) {
    const std::array<int, 3> cube{k % brick_cells, k / brick_cells % brick_cells,
                                  k / (brick_cells * brick_cells)};
    const int i = (cube[2] * brick_nodes + cube[1]) * brick_nodes + cube[0];
    constexpr int y = brick_nodes, z = brick_nodes * brick_nodes;
    const std::uint16_t o = own[i];
    if (own[i + 1] != o || own[i + y] != o || own[i + y + 1] != o || own[i + z] != o || own[i + z + 1] != o ||
        own[i + z + y] != o || own[i + z + y + 1] != o)
      use(cube);
  }
}

/// True if the axes are left-handed. The frame reverses the last axis of such a volume.
bool is_mirrored(const LabelInput& labels) { return labels.directions.determinant() < 0; }

}  // namespace

double voxel_size(const LabelInput& labels) { return labels.directions.colwise().norm().minCoeff(); }

bool needs_depths(const LabelInput& labels, double cell_size) {
  return cell_size > (1 + tolerance::coinciding_cells) * voxel_size(labels);
}

GridFrame label_frame(const LabelInput& labels, double cell_size, bool uniform) {
  Eigen::Matrix3d edges = labels.directions;
  Vec3 corner = Vec3::Constant(-0.5);
  for (int a = 0; a < 3; ++a) edges.col(a) *= labels.size[a];
  if (is_mirrored(labels)) {
    edges.col(2) = -edges.col(2);
    corner[2] = labels.size[2] - 0.5;
  }
  return make_box_frame(labels.origin + labels.directions * corner, edges, cell_size, uniform);
}

/// Data shared by the fields of all refinements.
struct LabelField::Shared {
  LabelBricks bricks;
  bool of_image;
  double voxel;      ///< smallest spacing, input units
  double min_slope;  ///< smallest spacing by largest
  /// Voxels per cell of the frame, along each axis; negative along a reversed axis.
  Vec3 voxels_per_cell;
  Vec3 first_node;  ///< the frame's origin, in nodes
  /// For cells larger than a voxel, whose corners may be farther than the band from an interface; otherwise
  /// empty.
  DistanceTransform depths;
};

std::shared_ptr<const LabelField> LabelField::make(const LabelInput& labels, const GridFrame& frame,
                                                   bool keep_outside, Progress* progress) {
  auto made = std::make_shared<Shared>();
  made->of_image = labels.image != nullptr;
  made->bricks = labels.image ? make_image_bricks(labels, progress) : make_label_bricks(labels, progress);
  made->voxel = voxel_size(labels);
  made->min_slope = made->voxel / labels.directions.colwise().norm().maxCoeff();
  if (labels.image) made->min_slope *= ImageTuning::min_slope;
  const CellBox volume = frame.volume();
  for (int a = 0; a < 3; ++a)
    made->voxels_per_cell[a] = static_cast<double>(labels.size[a]) / (volume.high[a] - volume.low[a]);
  made->first_node = Vec3::Constant(padding - 0.5);
  if (is_mirrored(labels)) {
    made->voxels_per_cell[2] = -made->voxels_per_cell[2];
    made->first_node[2] += labels.size[2];
  }
  for (int a = 0; a < 3; ++a) made->first_node[a] -= volume.low[a] * made->voxels_per_cell[a];
  if (needs_depths(labels, frame.cell_size)) made->depths = distance_transform(labels);
  std::vector<FieldRegion> regions{{keep_outside ? outside_name : "", outside_tag}};
  for (const LabelMaterial& m : labels.materials) regions.push_back({m.name, m.tag});
  return std::shared_ptr<const LabelField>(new LabelField(std::move(made), frame, std::move(regions), 0));
}

double LabelField::band_in_cells(const Shared& shared, const GridFrame& voxels) {
  // With depths the band is as wide as that of level sets, as lattice edges require.
  return shared.depths.steps.empty() ? LabelSmoother::band * shared.voxel / voxels.cell_size : level_set_band;
}

LabelField::LabelField(std::shared_ptr<const Shared> shared, const GridFrame& voxels,
                       std::vector<FieldRegion> regions, int refinement)
    : MaterialField(voxels, std::move(regions), band_in_cells(*shared, voxels), refinement),
      shared_(std::move(shared)),
      nodes_per_unit_(shared_->voxels_per_cell * std::ldexp(1, -refinement)) {}

Vec3 LabelField::to_nodes(const Vec3& point) const {
  return point.cwiseProduct(nodes_per_unit_) + shared_->first_node;
}

LabelField::~LabelField() { drop_samplers(); }

std::shared_ptr<const MaterialField> LabelField::refined(int refinement) const {
  return std::shared_ptr<const LabelField>(new LabelField(shared_, voxels(), regions(), refinement));
}

class LabelField::Sampler final : public FieldSampler {
 public:
  explicit Sampler(const LabelField& f)
      : FieldSampler(std::ldexp(1, f.refinement()), f.shared_->min_slope),
        field_(f),
        shared_(*f.shared_),
        bricks_(f.shared_->bricks),
        units_per_voxel_(bricks_.units_per_voxel),
        band_units_(bricks_.band_units()),
        per_unit_(f.shared_->voxel / f.frame().cell_size / units_per_voxel_),
        max_mixed_margin_(static_cast<float>(per_unit_ * units_per_voxel_ * ImageTuning::max_mixed_margin)),
        cells_per_voxel_(std::ldexp(1, f.refinement())) {}

  NearestRegion nearest(const Vec3& point) override {
    const Place p = find(point);
    if (const std::optional<Far> far = far_from_interfaces(p, point))
      return {far->region, static_cast<float>(std::min(far->depth, field_.band()))};
    return nearest(p).first;
  }
  NearestRegion nearest_at_voxel(int x, int y, int z) override {
    return nearest(cells_per_voxel_ * Vec3(x, y, z));
  }
  void values(const Vec3& point, std::span<const RegionIndex> regions, float* out) override {
    const Place p = find(point);
    if (const std::optional<Far> far = far_from_interfaces(p, point)) {
      for (RegionIndex r : regions) *out++ = static_cast<float>(r == far->region ? -far->depth : far->depth);
      return;
    }
    for (RegionIndex r : regions) *out++ = static_cast<float>(per_unit_ * value(p, r));
  }
  void values_at_voxel(int x, int y, int z, std::span<const RegionIndex> regions, float* out) override {
    values(cells_per_voxel_ * Vec3(x, y, z), regions, out);
  }
  std::optional<RegionSet> two_nearest(const Vec3& point) override {
    const auto [first, second] = nearest(find(point));
    if (first.margin >= field_.band() || first.region == second) return std::nullopt;
    RegionSet both;
    both.insert(first.region);
    both.insert(second);
    return both;
  }

 private:
  /// A brick, the lowest node of a cell in it, and the position in the cell.
  struct Place {
    const LabelBricks::Brick* brick;
    int node;
    std::array<double, 3> share;
  };

  Place find(const Vec3& point) const {
    const Vec3 at = field_.to_nodes(point);
    Place p{};
    std::array<int, 3> brick, cell;
    for (int a = 0; a < 3; ++a) {
      // Beyond the border, values at the border continue. NaN becomes 0.
      const int nodes = bricks_.counts[a] * brick_cells;
      const double along = std::min(std::max(0.0, at[a]), static_cast<double>(nodes));
      const int whole = std::min(static_cast<int>(along), nodes - 1);
      brick[a] = whole / brick_cells;
      cell[a] = whole % brick_cells;
      p.share[a] = along - whole;
    }
    p.brick = &bricks_.brick(brick[0], brick[1], brick[2]);
    p.node = (cell[2] * brick_nodes + cell[1]) * brick_nodes + cell[0];
    return p;
  }

  static constexpr int step_y = brick_nodes, step_z = brick_nodes * brick_nodes;
  static double mix(double a, double b, double share) { return a + share * (b - a); }

  double channel_value(const Place& p, std::uint32_t channel) const {
    const std::int16_t* v = bricks_.channel(channel) + p.node;
    const double low =
        mix(mix(v[0], v[1], p.share[0]), mix(v[step_y], v[step_y + 1], p.share[0]), p.share[1]);
    const double high = mix(mix(v[step_z], v[step_z + 1], p.share[0]),
                            mix(v[step_z + step_y], v[step_z + step_y + 1], p.share[0]), p.share[1]);
    return mix(low, high, p.share[2]);
  }

  /// \param gradient receives the derivative per node
  double channel_value(const Place& p, std::uint32_t channel, Vec3& gradient) const {
    const std::int16_t* v = bricks_.channel(channel) + p.node;
    double along_x[2][2], slope_x[2][2];
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 2; ++y) {
        const std::int16_t* row = v + z * step_z + y * step_y;
        along_x[z][y] = mix(row[0], row[1], p.share[0]);
        slope_x[z][y] = row[1] - row[0];
      }
    const double low = mix(along_x[0][0], along_x[0][1], p.share[1]);
    const double high = mix(along_x[1][0], along_x[1][1], p.share[1]);
    gradient = {mix(mix(slope_x[0][0], slope_x[0][1], p.share[1]),
                    mix(slope_x[1][0], slope_x[1][1], p.share[1]), p.share[2]),
                mix(along_x[0][1] - along_x[0][0], along_x[1][1] - along_x[1][0], p.share[2]), high - low};
    return mix(low, high, p.share[2]);
  }

  std::optional<std::uint32_t> channel_of(const Place& p, RegionIndex region) const {
    for (std::uint32_t c = p.brick->first; c < p.brick->first + p.brick->count; ++c)
      if (bricks_.channels[c] == region) return c;
    return std::nullopt;
  }
  double far_value(const Place& p, RegionIndex region) const {
    if (p.brick->count == 0 && p.brick->alone == region) return -band_units_;
    // No less than any distance in the brick.
    return shared_.of_image && p.brick->count > 0 ? INT16_MAX : band_units_;
  }
  double value(const Place& p, RegionIndex region) const {
    const auto channel = channel_of(p, region);
    return channel ? channel_value(p, *channel) : far_value(p, region);
  }

  /// Region, depth in it (lattice units) and gradient of the depth, at a point where all distances are
  /// clamped.
  struct Far {
    RegionIndex region;
    double depth;
    Vec3 slope;
  };
  /// std::nullopt where distances are not clamped, or if depths are not known.
  std::optional<Far> far_from_interfaces(const Place& p, const Vec3& point) const {
    if (shared_.depths.steps.empty()) return std::nullopt;
    const NearestRegion first = nearest(p).first;
    const double cut_off = per_unit_ * band_units_;
    if (first.margin < LabelTuning::Field::clamped_share * cut_off) return std::nullopt;
    const Vec3 index = field_.to_nodes(point) - Vec3::Constant(padding);
    Vec3 by_voxels;
    const double per_voxel = per_unit_ * units_per_voxel_;
    const double depth = per_voxel * shared_.depths.at(index, by_voxels);
    if (depth <= cut_off) return std::nullopt;
    return Far{first.region, depth, per_voxel * by_voxels.cwiseProduct(field_.nodes_per_unit_)};
  }

  /// Whether the region of a channel is not the nearest at all corners of a cell between nodes.
  bool is_mixed(const Place& p, std::uint32_t channel) const {
    const std::int16_t* v = bricks_.channel(channel) + p.node;
    for (const int corner :
         {0, 1, step_y, step_y + 1, step_z, step_z + 1, step_z + step_y, step_z + step_y + 1})
      if (v[corner] > 0) return true;
    return false;
  }

  /// The regions of the smallest and the second smallest distance.
  std::pair<NearestRegion, RegionIndex> nearest(const Place& p) const {
    const LabelBricks::Brick& b = *p.brick;
    const auto band = static_cast<float>(field_.band());
    if (b.count == 0) return {{b.alone, band}, b.alone};
    double smallest = HUGE_VAL, next = HUGE_VAL;
    RegionIndex first = 0, second = 0;
    std::uint32_t nearest = b.first;
    for (std::uint32_t c = b.first; c < b.first + b.count; ++c) {
      const double v = channel_value(p, c);
      if (v < smallest) {
        next = smallest, second = first;
        smallest = v, first = bricks_.channels[c], nearest = c;
      } else if (v < next) {
        next = v, second = bricks_.channels[c];
      }
    }
    float margin = std::min(static_cast<float>(0.5 * per_unit_ * (next - smallest)), band);
    // Contrast above the mean nearby does not make an interface more distant.
    if (shared_.of_image && is_mixed(p, nearest)) margin = std::min(margin, max_mixed_margin_);
    return {{first, margin}, second};
  }

  void values_and_gradients(const Vec3& point, std::span<const RegionIndex> regions, double* values,
                            Vec3* gradients) override {
    const Place p = find(point);
    if (const std::optional<Far> far = far_from_interfaces(p, point)) {
      for (RegionIndex r : regions) {
        const double sign = r == far->region ? -1 : 1;
        *values++ = sign * far->depth;
        *gradients++ = sign * far->slope;
      }
      return;
    }
    for (RegionIndex r : regions) {
      Vec3 by_nodes = Vec3::Zero();
      const auto channel = channel_of(p, r);
      *values++ = per_unit_ * (channel ? channel_value(p, *channel, by_nodes) : far_value(p, r));
      *gradients++ = per_unit_ * by_nodes.cwiseProduct(field_.nodes_per_unit_);
    }
  }

  const LabelField& field_;
  const Shared& shared_;
  const LabelBricks& bricks_;
  const float units_per_voxel_;
  const std::int16_t band_units_;
  const double per_unit_;         ///< lattice units
  const float max_mixed_margin_;  ///< lattice units
  const double cells_per_voxel_;  ///< lattice units per voxel of the frame
};

bool LabelField::is_certain(const Vec3& point) const {
  // The interfaces of an image may pass through voxel centres.
  if (shared_->of_image) return false;
  if (LabelTuning::Field::min_cells_per_voxel * voxels().cell_size >
      (1 + tolerance::coinciding_cells) * shared_->voxel)
    return false;
  const Vec3 at = to_nodes(point);
  // Only rounding separates such a point from a voxel centre; voxels.
  return (at - at.array().round().matrix()).cwiseAbs().maxCoeff() < tolerance::coinciding_cells;
}

std::unique_ptr<FieldSampler> LabelField::sampler() const { return std::make_unique<Sampler>(*this); }

std::vector<MortonKey> LabelField::interface_voxels() const {
  const LabelBricks& all = shared_->bricks;
  const auto to_cells = [&](const Vec3& node) -> Vec3 {
    return (node - shared_->first_node).cwiseQuotient(shared_->voxels_per_cell);
  };
  const std::shared_ptr<const MaterialField> on_voxels = refined(0);
  const bool smaller = voxels().cell_size < (1 - tolerance::coinciding_cells) * shared_->voxel;
  const auto rows = static_cast<std::size_t>(all.counts[1]) * all.counts[2];
  std::vector<MortonKey> keys = parallel_collect<MortonKey>(
      0, rows, 1, [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        InterfaceCells finder(*on_voxels, smaller);
        std::array<std::uint16_t, brick_volume> own;
        for (std::size_t row = begin; row < end; ++row)
          for (int bx = 0; bx < all.counts[0]; ++bx) {
            const int by = static_cast<int>(row) % all.counts[1], bz = static_cast<int>(row) / all.counts[1];
            const LabelBricks::Brick& b = all.brick(bx, by, bz);
            if (b.count == 0) continue;
            find_own_channels(all, b, own);
            for_each_mixed_cube(own, [&](const std::array<int, 3>& cube) {
              const Vec3 node(bx * brick_cells + cube[0], by * brick_cells + cube[1],
                              bz * brick_cells + cube[2]);
              Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
              for (int corner = 0; corner < 8; ++corner) {
                const Vec3 at = to_cells(node + Vec3(corner & 1, corner >> 1 & 1, corner >> 2));
                low = low.cwiseMin(at);
                high = high.cwiseMax(at);
              }
              finder.append_cells(low, high, out);
            });
          }
      });
  parallel_sort_unique(keys);
  return keys;
}

bool LabelField::is_at_border(const std::array<int, 3>& brick) const {
  const CellBox volume = voxels().volume();
  for (int a = 0; a < 3; ++a) {
    const auto node = [&](int cell) { return shared_->first_node[a] + cell * shared_->voxels_per_cell[a]; };
    for (const double border : {node(volume.low[a]), node(volume.high[a])})
      if (brick[a] * brick_cells <= border && border <= (brick[a] + 1) * brick_cells) return true;
  }
  return false;
}

std::vector<LeafOrigin> LabelField::band_leaves(RegionIndex region) const {
  const LabelBricks& all = shared_->bricks;
  const auto to_cells = [&](const Vec3& node) -> Vec3 {
    return (node - shared_->first_node).cwiseQuotient(shared_->voxels_per_cell);
  };
  const double around = std::max(1.0, std::ceil(std::ldexp(band(), -refinement())));
  std::vector<LeafOrigin> leaves;
  for (int bz = 0; bz < all.counts[2]; ++bz)
    for (int by = 0; by < all.counts[1]; ++by)
      for (int bx = 0; bx < all.counts[0]; ++bx) {
        const LabelBricks::Brick& b = all.brick(bx, by, bz);
        const auto channels = all.channels.begin() + b.first;
        const bool cut_off = b.count == 0 && b.alone == region && is_at_border({bx, by, bz});
        if (!cut_off && std::find(channels, channels + b.count, region) == channels + b.count) continue;
        Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
        for (int corner = 0; corner < 8; ++corner) {
          const Vec3 at =
              to_cells(brick_cells * Vec3(bx + (corner & 1), by + (corner >> 1 & 1), bz + (corner >> 2)));
          low = low.cwiseMin(at);
          high = high.cwiseMax(at);
        }
        // If cells are large, the other side of an interface may be in another brick.
        low -= Vec3::Constant(around);
        high += Vec3::Constant(around);
        const auto leaf = [](double x) { return static_cast<int>(std::floor(x / leaf_side)) * leaf_side; };
        for (int z = leaf(low[2]); z <= high[2]; z += leaf_side)
          for (int y = leaf(low[1]); y <= high[1]; y += leaf_side)
            for (int x = leaf(low[0]); x <= high[0]; x += leaf_side) leaves.push_back({x, y, z});
      }
  parallel_sort_unique(leaves);
  return leaves;
}

}  // namespace tetwright
