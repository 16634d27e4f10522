// SPDX-License-Identifier: Apache-2.0
#include "common/samples/foam.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/portable_math.h"
#include "common/random.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Units of positions in a voxel, an even number.
constexpr std::int64_t units = 64;
constexpr std::uint64_t voxels_per_grain = 64;
constexpr std::uint64_t max_grains = 1'000'000;
constexpr std::uint32_t usual_grains = 20;
/// Minimum distance between seeds, in edges of a cube with the volume of an average grain. Balls of this
/// radius around all seeds have 0.9 of the cube's volume, so a tenth or more is always free for another seed.
/// With 64 voxels for each grain the distance is 2.4 voxels, so that the voxel of a seed, whose centre is
/// within 0.87 of it, is in its grain.
constexpr double relative_distance = 0.6;
/// Bricks are half as long as an average grain: most then have a few seeds to compare. Longer ones than 32
/// gain nothing.
constexpr int min_brick = 4, max_brick = 32;
constexpr std::uint64_t foam_seed = 1;
constexpr std::uint32_t no_seed = std::numeric_limits<std::uint32_t>::max();

std::int64_t centre_of_voxel(int index) { return units * index + units / 2; }

std::int64_t squared_distance(const std::array<std::int64_t, 3>& a, const std::array<std::int64_t, 3>& b) {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/// A whole number that is at least sqrt(squared), and not much more.
std::int64_t root_above(std::int64_t squared) {
  return static_cast<std::int64_t>(std::sqrt(static_cast<double>(squared))) + 1;
}

LabelGrid grid_of_cube(int voxels) {
  LabelGrid grid;
  grid.size = {voxels, voxels, voxels};
  return grid;
}

/// Edge of a cube with the volume of an average grain, voxels.
double average_edge(int voxels, std::uint32_t grains) { return voxels / portable_cbrt(grains); }

}  // namespace

std::uint32_t max_foam_grains(int voxels) {
  const auto n = static_cast<std::uint64_t>(voxels);
  return static_cast<std::uint32_t>(std::min(n * n * n / voxels_per_grain, max_grains));
}

std::uint32_t default_foam_grains(int voxels) { return std::min(usual_grains, max_foam_grains(voxels)); }

/// The seeds that may be nearest to a voxel of a brick, by their functions along a row of its voxels: the
/// squared distance without its part that all seeds share is linear.
struct Foam::RowScratch {
  struct Line {
    std::int64_t at_first;  ///< value at the centre of the first voxel
    std::int64_t step;      ///< change from a voxel to the next
    MaterialTag label;
  };
  std::vector<std::uint32_t> rivals;
  std::vector<Line> lines;

  /// Label of the seed that is nearest to a voxel of the row; the lower label if two are equally near.
  MaterialTag nearest(int index) const {
    const Line* best = lines.data();
    std::int64_t least = best->at_first + best->step * index;
    for (const Line& line : lines)
      if (const std::int64_t value = line.at_first + line.step * index; value < least) {
        least = value;
        best = &line;
      }
    return best->label;
  }

  /// Fills the labels between two voxels of the row whose labels are known. Voxels between two of a label
  /// have that label, since grains are convex, also if ties are broken by labels.
  void fill(int first, MaterialTag first_label, int last, MaterialTag last_label, MaterialTag* row) const {
    if (first_label == last_label) {
      std::fill(row + first, row + last + 1, first_label);
    } else if (last == first + 1) {
      row[first] = first_label;
      row[last] = last_label;
    } else {
      const int middle = first + (last - first) / 2;
      const MaterialTag label = nearest(middle);
      fill(first, first_label, middle, label, row);
      fill(middle, label, last, last_label, row);
    }
  }
};

Foam::Foam(int voxels, std::uint32_t grains) : LabelSource(grid_of_cube(voxels)), edge_(units * voxels) {
  TETWRIGHT_CHECK(min_foam_voxels <= voxels && voxels <= max_foam_voxels);
  TETWRIGHT_CHECK(1 <= grains && grains <= max_foam_grains(voxels));
  const double edge = average_edge(voxels, grains);
  seed_distance_ = static_cast<std::int64_t>(relative_distance * edge * static_cast<double>(units));
  cells_ = (edge_ + seed_distance_ - 1) / seed_distance_;
  brick_ = std::clamp(static_cast<int>(edge / 2), min_brick, max_brick);
  throw_seeds(grains);
}

Vec3 Foam::seed(MaterialTag grain) const {
  const Position& at = seeds_[static_cast<std::size_t>(grain - 1)];
  return Vec3(static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])) / units -
         Vec3::Constant(0.5);
}

std::size_t Foam::cell_of(const Position& at) const {
  return static_cast<std::size_t>(((at[2] / seed_distance_) * cells_ + at[1] / seed_distance_) * cells_ +
                                  at[0] / seed_distance_);
}

template <class Visit>
void Foam::visit_near(const Position& centre, std::int64_t radius, const Visit& visit) const {
  Position low, high;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = std::max<std::int64_t>(centre[k] - radius, 0) / seed_distance_;
    high[k] = std::min(centre[k] + radius, edge_ - 1) / seed_distance_;
  }
  for (std::int64_t z = low[2]; z <= high[2]; ++z)
    for (std::int64_t y = low[1]; y <= high[1]; ++y)
      for (std::int64_t x = low[0]; x <= high[0]; ++x)
        for (std::uint32_t seed = first_in_cell_[static_cast<std::size_t>((z * cells_ + y) * cells_ + x)];
             seed != no_seed; seed = next_in_cell_[seed])
          visit(seed);
}

void Foam::throw_seeds(std::uint32_t grains) {
  first_in_cell_.assign(static_cast<std::size_t>(cells_ * cells_ * cells_), no_seed);
  seeds_.reserve(grains);
  next_in_cell_.reserve(grains);
  Random random(foam_seed);
  const auto range = static_cast<std::uint32_t>(edge_);
  while (seeds_.size() < grains) {
    Position at;
    for (std::int64_t& x : at) x = random.below(range);
    bool free = true;
    visit_near(at, seed_distance_, [&](std::uint32_t other) {
      free = free && squared_distance(at, seeds_[other]) >= seed_distance_ * seed_distance_;
    });
    if (!free) continue;
    std::uint32_t& first = first_in_cell_[cell_of(at)];
    next_in_cell_.push_back(first);
    first = static_cast<std::uint32_t>(seeds_.size());
    seeds_.push_back(at);
  }
}

/// Upper bound of the distance of the nearest seed.
std::int64_t Foam::nearest_distance(const Position& centre) const {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::int64_t radius = seed_distance_; least == std::numeric_limits<std::int64_t>::max(); radius *= 2)
    visit_near(centre, radius,
               [&](std::uint32_t seed) { least = std::min(least, squared_distance(centre, seeds_[seed])); });
  return root_above(least);
}

/// Finds the seeds that may be nearest to a voxel of the brick, in order.
void Foam::find_rivals(const Box& brick, std::vector<std::uint32_t>& rivals) const {
  Position low, high, centre;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = centre_of_voxel(brick.low[k]);
    high[k] = centre_of_voxel(brick.high[k] - 1);
    centre[k] = (low[k] + high[k]) / 2;
  }
  // A seed that is nearest to a point of the brick is not farther from the centre than the seed nearest to
  // the centre by more than twice the distance of the point.
  const std::int64_t radius = nearest_distance(centre) + 2 * root_above(squared_distance(centre, high));
  rivals.clear();
  std::uint32_t winner = no_seed;
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  visit_near(centre, radius, [&](std::uint32_t seed) {
    rivals.push_back(seed);
    const std::int64_t squared = squared_distance(centre, seeds_[seed]);
    if (squared >= least) return;
    least = squared;
    winner = seed;
  });
  // The difference of squared distances is linear, so it is least at a corner.
  const Position& best = seeds_[winner];
  std::erase_if(rivals, [&](std::uint32_t seed) {
    const Position& at = seeds_[seed];
    std::int64_t difference = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t step = at[k] - best[k];
      difference += at[k] * at[k] - best[k] * best[k] - 2 * step * (step > 0 ? high[k] : low[k]);
    }
    return difference > 0;
  });
  std::sort(rivals.begin(), rivals.end());
}

void Foam::fill_brick(const Box& brick, const Box& box, RowScratch& scratch,
                      std::span<MaterialTag> out) const {
  find_rivals(brick, scratch.rivals);
  scratch.lines.resize(scratch.rivals.size());
  const auto row_size = static_cast<std::size_t>(box.high[0] - box.low[0]);
  const auto rows = static_cast<std::size_t>(box.high[1] - box.low[1]);
  const int last = brick.high[0] - 1 - brick.low[0];
  for (int z = brick.low[2]; z < brick.high[2]; ++z)
    for (int y = brick.low[1]; y < brick.high[1]; ++y) {
      const Position first{centre_of_voxel(brick.low[0]), centre_of_voxel(y), centre_of_voxel(z)};
      for (std::size_t i = 0; i < scratch.rivals.size(); ++i) {
        const std::uint32_t rival = scratch.rivals[i];
        const Position& s = seeds_[rival];
        std::int64_t value = 0;
        for (std::size_t k = 0; k < 3; ++k) value += s[k] * (s[k] - 2 * first[k]);
        scratch.lines[i] = {value, -2 * s[0] * units, static_cast<MaterialTag>(rival + 1)};
      }
      const std::size_t row =
          static_cast<std::size_t>(z - box.low[2]) * rows + static_cast<std::size_t>(y - box.low[1]);
      MaterialTag* to = &out[row * row_size + static_cast<std::size_t>(brick.low[0] - box.low[0])];
      scratch.fill(0, scratch.nearest(0), last, scratch.nearest(last), to);
    }
}

void Foam::read_box(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const {
  RowScratch scratch;
  const Box box{low, high};
  for (int z = low[2]; z < high[2]; z += brick_)
    for (int y = low[1]; y < high[1]; y += brick_)
      for (int x = low[0]; x < high[0]; x += brick_)
        fill_brick(
            {{x, y, z},
             {std::min(x + brick_, high[0]), std::min(y + brick_, high[1]), std::min(z + brick_, high[2])}},
            box, scratch, out);
}

}  // namespace tetwright
