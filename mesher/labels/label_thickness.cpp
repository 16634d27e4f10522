// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_thickness.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/labels/label_field.h"
#include "mesher/tuning/domain_tuning.h"
#include "mesher/tuning/label_tuning.h"

namespace tetwright {

namespace {

using Sides = VoxelIndex;

/// Finds the voxels of some slices that no box of `sides` voxels of their region contains. Other slices as
/// far as boxes reach, and their neighbours, are read with them.
class Opening {
 public:
  Opening(const LabelInput& labels, const Sides& sides, int first, int last, const Progress* progress)
      : size_(labels.size),
        sides_(sides),
        progress_(progress),
        slice_(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1])),
        first_(first),
        last_(last),
        low_(std::max(0, first - sides[2])),
        high_(std::min(size_[2], last + sides[2])),
        regions_(static_cast<std::size_t>(high_ - low_) * slice_),
        holds_(regions_.size(), 1),
        runs_(regions_.size()) {
    parallel_for(0, static_cast<std::size_t>(high_ - low_), 1, [&](std::size_t begin, std::size_t end) {
      labels.regions.read_slices(low_ + static_cast<int>(begin), low_ + static_cast<int>(end),
                                 std::span(regions_).subspan(begin * slice_, (end - begin) * slice_));
    });
  }

  /// Ascending numbers of voxels of the volume.
  std::vector<std::size_t> thin_voxels() {
    // Process one axis after another: a box starts at a voxel if enough consecutive voxels pass the test of
    // the previous axes. Then mark every voxel of such a box as thick.
    for (int axis = 0; axis < 3; ++axis) sweep(axis, [&](int a, auto&&... p) { start_boxes(a, p...); });
    for (int axis = 0; axis < 3; ++axis) sweep(axis, [&](int a, auto&&... p) { fill_boxes(a, p...); });
    return parallel_collect<std::size_t>(
        static_cast<std::size_t>(first_ - low_) * slice_, static_cast<std::size_t>(last_ - low_) * slice_,
        LabelGrains::voxels, [&](std::size_t begin, std::size_t end, std::vector<std::size_t>& out) {
          for (std::size_t i = begin; i < end; ++i)
            if (!holds_[i] && !beside_thick(i) &&
                !(regions_[i] == outside_region && in_box_from_outside_volume(i)))
              out.push_back(static_cast<std::size_t>(low_) * slice_ + i);
        });
  }

 private:
  /// Voxels along an axis that were read.
  int extent(int axis) const { return axis == 2 ? high_ - low_ : size_[axis]; }

  /// Calls `work(axis, first, step, lines)` for lines of voxels along an axis: the first voxel, the step
  /// between voxels of a line, and the number of adjacent lines.
  template <class Work>
  void sweep(int axis, Work&& work) {
    if (progress_) progress_->throw_if_stopped();
    const auto nx = static_cast<std::size_t>(size_[0]), ny = static_cast<std::size_t>(size_[1]);
    // Process whole rows along x at a time, for sequential memory access.
    if (axis < 2)
      parallel_for(0, static_cast<std::size_t>(extent(2)), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) {
          if (axis == 1) {
            work(axis, z * nx * ny, nx, nx);
            continue;
          }
          for (std::size_t y = 0; y < ny; ++y) work(axis, (z * ny + y) * nx, std::size_t{1}, std::size_t{1});
        }
      });
    else
      parallel_for(0, ny, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) work(axis, y * nx, nx * ny, nx);
      });
  }

  void start_boxes(int axis, std::size_t first, std::size_t step, std::size_t lines) {
    const int side = sides_[axis], n = extent(axis);
    // The outside continues beyond the volume. Boxes that begin in slices where it would matter that those
    // behind them were not read reach none of the slices asked for.
    const bool continues = axis < 2 || high_ == size_[2];
    for (int k = n - 1; k >= 0; --k)
      for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t i = first + static_cast<std::size_t>(k) * step + line;
        int run = 0;
        if (holds_[i])
          run = k + 1 == n
                    ? (continues && regions_[i] == outside_region ? side : 1)
                    : (regions_[i + step] == regions_[i] ? std::min<int>(runs_[i + step] + 1, side) : 1);
        runs_[i] = static_cast<std::uint8_t>(run);
      }
    for (int k = 0; k < n; ++k)
      for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t i = first + static_cast<std::size_t>(k) * step + line;
        holds_[i] = runs_[i] >= side;
      }
  }

  void fill_boxes(int axis, std::size_t first, std::size_t step, std::size_t lines) {
    const int side = sides_[axis], n = extent(axis);
    for (int k = 0; k < n; ++k)
      for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t i = first + static_cast<std::size_t>(k) * step + line;
        const int left = holds_[i] ? side : k > 0 ? std::max(0, runs_[i - step] - 1) : 0;
        runs_[i] = static_cast<std::uint8_t>(left);
      }
    for (int k = 0; k < n; ++k)
      for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t i = first + static_cast<std::size_t>(k) * step + line;
        holds_[i] = runs_[i] > 0;
      }
  }

  /// The position of a voxel among those that were read.
  std::array<int, 3> position(std::size_t i) const {
    const auto nx = static_cast<std::size_t>(size_[0]);
    return {static_cast<int>(i % nx), static_cast<int>(i % slice_ / nx), static_cast<int>(i / slice_)};
  }

  /// True for a voxel of the outside in a box that starts before the volume. sweep() does not find such
  /// boxes, so this tries all of them.
  bool in_box_from_outside_volume(std::size_t i) const {
    std::array<int, 3> at = position(i), low;
    at[2] += low_;
    if (at[0] >= sides_[0] - 1 && at[1] >= sides_[1] - 1 && at[2] >= sides_[2] - 1) return false;
    if (sides_[0] * sides_[1] * sides_[2] > LabelTuning::Thickness::max_tried) return true;
    for (low[2] = at[2] - sides_[2] + 1; low[2] <= at[2]; ++low[2])
      for (low[1] = at[1] - sides_[1] + 1; low[1] <= at[1]; ++low[1])
        for (low[0] = at[0] - sides_[0] + 1; low[0] <= at[0]; ++low[0])
          if (box_is_outside(low)) return true;
    return false;
  }
  bool box_is_outside(const std::array<int, 3>& low) const {
    std::array<int, 3> from, to;
    for (int a = 0; a < 3; ++a) {
      from[a] = std::max(0, low[a]);
      to[a] = std::min(size_[a], low[a] + sides_[a]);
    }
    for (int z = from[2]; z < to[2]; ++z)
      for (int y = from[1]; y < to[1]; ++y)
        for (int x = from[0]; x < to[0]; ++x)
          if (regions_[(static_cast<std::size_t>(z - low_) * size_[1] + y) * size_[0] + x] != outside_region)
            return false;
    return true;
  }

  /// True for a voxel next to a thick one, which is roughness of one voxel that smoothing removes.
  bool beside_thick(std::size_t i) const {
    const std::array<int, 3> at = position(i);
    std::size_t step = 1;
    for (int a = 0; a < 3; ++a) {
      if (at[a] > 0 && holds_[i - step] && regions_[i - step] == regions_[i]) return true;
      if (at[a] + 1 < extent(a) && holds_[i + step] && regions_[i + step] == regions_[i]) return true;
      step *= static_cast<std::size_t>(size_[a]);
    }
    return false;
  }

  const std::array<int, 3> size_;
  const Sides sides_;
  const Progress* progress_;
  const std::size_t slice_;  ///< voxels
  const int first_, last_;   ///< slices asked for, the last one excluded
  const int low_, high_;     ///< slices that were read
  std::vector<RegionIndex> regions_;
  std::vector<std::uint8_t> holds_, runs_;
};

/// True if the face-connected island of a voxel has fewer than `count` voxels.
bool in_small_island(const LabelInput& labels, std::size_t voxel, std::size_t count) {
  const std::array<int, 3>& n = labels.size;
  const std::array<std::size_t, 3> steps{1, static_cast<std::size_t>(n[0]),
                                         static_cast<std::size_t>(n[0]) * n[1]};
  std::vector<std::size_t> island{voxel};
  for (std::size_t k = 0; k < island.size(); ++k)
    for (int a = 0; a < 3; ++a) {
      const std::size_t at = island[k] / steps[a] % static_cast<std::size_t>(n[a]);
      const auto visit = [&](std::size_t beside) {
        if (labels.regions[beside] == labels.regions[voxel] &&
            std::find(island.begin(), island.end(), beside) == island.end())
          island.push_back(beside);
      };
      if (at > 0) visit(island[k] - steps[a]);
      if (at + 1 < static_cast<std::size_t>(n[a])) visit(island[k] + steps[a]);
      if (island.size() >= count) return false;
    }
  return true;
}

/// Finds the thin voxels of a volume and the cells that they need, starting with the frame's cells and
/// halving them repeatedly.
class ThinLabelFinder {
 public:
  ThinLabelFinder(const LabelInput& labels, const GridFrame& frame, const Progress* progress)
      : labels_(labels),
        frame_(frame),
        progress_(progress),
        spacing_(labels.directions.colwise().norm()),
        to_grid_(frame.axes.inverse() * labels.directions / frame.cell_size),
        first_(frame.to_grid(labels.origin)) {}

  /// The highest level, up to `coarsest`, of cells that may contain an interface: cells of at most half a
  /// voxel. Larger ones would break the guarantees for finer cells.
  int coarsest_interface_level(int coarsest) const {
    constexpr double max_cell =
        1 / LabelTuning::Field::min_cells_per_voxel + tolerance::coinciding_cells;  // voxels
    while (coarsest > 0 && std::ldexp(frame_.cell_size, coarsest) > max_cell * spacing_.minCoeff())
      --coarsest;
    return coarsest;
  }

  /// Finds the voxels too thin for cells halved `depth` times; call for depth 0, 1, ... Returns false if
  /// there are none, or if smaller cells are not worth trying.
  bool find_voxels(int depth) {
    const Sides sides = sides_at(depth);
    if (sides != Sides{1, 1, 1}) {
      voxels_ = thin_voxels(labels_, sides, LabelTuning::Thickness::slab_bytes, progress_);
      return !voxels_.empty();
    }
    if (island_levels_ == 2 ||
        LabelTuning::Thickness::cells_per_island_voxel * frame_.cell_size <= spacing_.minCoeff())
      return false;
    ++island_levels_;
    if (depth == 0) voxels_ = thin_voxels(labels_, {2, 2, 2}, LabelTuning::Thickness::slab_bytes, progress_);
    std::erase_if(voxels_, [&](std::size_t v) {
      return labels_.regions[v] == outside_region ||
             !in_small_island(labels_, v, LabelTuning::Thickness::small_island);
    });
    return !voxels_.empty() && voxels_.size() <= LabelTuning::Thickness::max_island_voxels;
  }

  /// Whether only islands are among the voxels found.
  bool found_islands() const { return island_levels_ > 0; }

  /// The voxels found, as parts of their regions that even the smallest cells do not resolve.
  std::vector<ThinPart> too_thin() const {
    std::vector<ThinPart> parts;
    for (std::size_t r = 0; r <= labels_.materials.size(); ++r)
      parts.push_back({static_cast<RegionIndex>(r), 0, Vec3::Zero()});
    for (const std::size_t voxel : voxels_) {
      ThinPart& part = parts[labels_.regions[voxel]];
      if (part.places++ == 0) part.first = centre(voxel);
    }
    std::erase_if(parts, [](const ThinPart& part) { return part.places == 0; });
    return parts;
  }

  /// The cells halved `depth` times around the voxels found, ascending.
  std::vector<MortonKey> cells_around(int depth) const {
    const Vec3 reach = LabelTuning::Thickness::reach * to_grid_.cwiseAbs().rowwise().sum();
    std::vector<MortonKey> cells = parallel_collect<MortonKey>(
        0, voxels_.size(), LabelGrains::thin_voxels,
        [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
          for (std::size_t k = begin; k < end; ++k) {
            const Vec3 middle = centre(voxels_[k]);
            std::array<int, 3> from, to;
            for (int a = 0; a < 3; ++a) {
              const double low = std::ldexp(middle[a] - reach[a], depth),
                           high = std::ldexp(middle[a] + reach[a], depth);
              from[a] = std::max(0, static_cast<int>(std::floor(low + tolerance::coinciding_cells)));
              to[a] = std::min(frame_.box[a] << depth,
                               static_cast<int>(std::ceil(high - tolerance::coinciding_cells)));
            }
            for (int z = from[2]; z < to[2]; ++z)
              for (int y = from[1]; y < to[1]; ++y)
                for (int x = from[0]; x < to[0]; ++x) out.push_back(morton_encode(x, y, z));
          }
          // Adjacent voxels give the same cells, which would take many times the memory together.
          std::sort(out.begin(), out.end());
          out.erase(std::unique(out.begin(), out.end()), out.end());
          out.shrink_to_fit();
        });
    parallel_sort_unique(cells);
    return cells;
  }

 private:
  /// The number of voxels along each axis that two cells, halved `depth` times, span.
  Sides sides_at(int depth) const {
    const double cell = std::ldexp(frame_.cell_size, -depth);
    Sides sides;
    for (int a = 0; a < 3; ++a)
      sides[a] =
          std::clamp(static_cast<int>(std::ceil(LabelTuning::Thickness::min_cells * cell / spacing_[a] -
                                                tolerance::coinciding_cells)),
                     1, LabelTuning::Thickness::max_side);
    return sides;
  }

  /// The centre of a voxel, grid coordinates.
  Vec3 centre(std::size_t voxel) const {
    const auto nx = static_cast<std::size_t>(labels_.size[0]), ny = static_cast<std::size_t>(labels_.size[1]);
    const std::size_t x = voxel % nx, y = voxel / nx % ny, z = voxel / (nx * ny);
    return first_ + to_grid_ * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  }

  const LabelInput& labels_;
  const GridFrame& frame_;
  const Progress* progress_;
  Vec3 spacing_;             ///< of the voxels, input units
  Eigen::Matrix3d to_grid_;  ///< maps steps between voxels
  Vec3 first_;               ///< the first voxel's centre, grid coordinates
  std::vector<std::size_t> voxels_;
  int island_levels_ = 0;  ///< levels created for small islands
};

}  // namespace

namespace {

std::size_t slice_bytes(const LabelInput& labels) {
  return LabelTuning::Thickness::bytes_per_voxel * static_cast<std::size_t>(labels.size[0]) *
         static_cast<std::size_t>(labels.size[1]);
}

/// Slices that are searched at a time; as many as the side of a box are read on both sides, too.
int slab_depth(const LabelInput& labels, int side, std::size_t slab_bytes) {
  const std::size_t slices =
      std::min(slab_bytes / slice_bytes(labels), static_cast<std::size_t>(labels.size[2]));
  return std::max(
      {static_cast<int>(slices) - 2 * side, LabelTuning::Thickness::min_slab * side, RegionGrid::side});
}

}  // namespace

double thin_search_bytes(const LabelInput& labels) {
  // Most searches are for boxes of a few voxels.
  constexpr int side = 2;
  const int slices =
      std::min(labels.size[2], slab_depth(labels, side, LabelTuning::Thickness::slab_bytes) + 2 * side);
  return static_cast<double>(slices) * static_cast<double>(slice_bytes(labels));
}

std::vector<std::size_t> thin_voxels(const LabelInput& labels, const VoxelIndex& sides,
                                     std::size_t slab_bytes, const Progress* progress) {
  const int depth = slab_depth(labels, sides[2], slab_bytes);
  std::vector<std::size_t> all;
  for (int first = 0; first < labels.size[2]; first += depth) {
    const int last = std::min(labels.size[2], first + depth);
    const std::vector<std::size_t> thin = Opening(labels, sides, first, last, progress).thin_voxels();
    all.insert(all.end(), thin.begin(), thin.end());
  }
  return all;
}

ThinLabels find_thin_labels(const LabelInput& labels, const GridFrame& frame, const Progress* progress) {
  ThinLabelFinder finder(labels, frame, progress);
  ThinLabels thin;
  int& coarsest = thin.finer.coarsest_interface_level;
  coarsest = finder.coarsest_interface_level(coarsest);
  std::vector<std::vector<MortonKey>> by_depth;
  for (int depth = 0; depth <= DomainTuning::Refinement::max_levels && finder.find_voxels(depth); ++depth) {
    if (depth == DomainTuning::Refinement::max_levels) {
      thin.too_thin = finder.too_thin();
    } else {
      by_depth.push_back(finder.cells_around(depth));
      if (finder.found_islands()) ++thin.island_levels;
    }
  }
  thin.finer.refinement = static_cast<int>(by_depth.size());
  thin.finer.cells.resize(by_depth.size() + 1);
  for (std::size_t depth = 0; depth < by_depth.size(); ++depth)
    thin.finer.cells[by_depth.size() - depth] = std::move(by_depth[depth]);
  return thin;
}

ThinCells count_thin_cells(const LabelInput& labels, const GridFrame& frame, const RefinementRegions& finer) {
  const Eigen::Matrix3d to_index = labels.directions.inverse();
  ThinCells count;
  for (std::size_t level = 0; level < finer.cells.size(); ++level) {
    const double side = std::ldexp(1, static_cast<int>(level) - finer.refinement);  // voxels of the frame
    for (const MortonKey key : finer.cells[level]) {
      const std::array<int, 3> low = morton_decode(key);
      const Vec3 centre = side * (Vec3(low[0], low[1], low[2]) + Vec3::Constant(0.5));
      const Vec3 index = to_index * (frame.to_input(centre) - labels.origin);
      VoxelIndex voxel{};
      bool in_volume = true;
      for (int a = 0; a < 3; ++a) {
        const double at = std::round(index[a]);
        in_volume &= at >= 0 && at < labels.size[a];
        if (!in_volume) break;
        voxel[a] = static_cast<int>(at);
      }
      ++(in_volume && labels.regions.at(voxel[0], voxel[1], voxel[2]) != outside_region ? count.inside
                                                                                        : count.outside);
    }
  }
  return count;
}

double largest_redundant_cell(const LabelInput& labels, const GridFrame& frame) {
  return voxel_size(labels) * (1 + tolerance::coinciding_cells) / frame.cell_size;
}

}  // namespace tetwright
