// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_extents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <numbers>

#include "mesher/tuning/label_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr int directions_of_pairs = 13;
using Offsets = std::array<std::array<int, 3>, directions_of_pairs>;

/// One of each two opposite neighbours of a voxel, all in its slice or the next one.
constexpr Offsets pair_offsets() {
  Offsets offsets{};
  std::size_t n = 0;
  for (int z = 0; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (z > 0 || y > 0 || (y == 0 && x > 0)) offsets[n++] = {x, y, z};
  return offsets;
}

/// Fraction of all directions that are nearer to each direction of pairs than to the others.
std::array<double, directions_of_pairs> direction_shares(const std::array<Vec3, directions_of_pairs>& unit) {
  std::array<double, directions_of_pairs> shares{};
  constexpr int samples = LabelTuning::Extents::directions;
  for (int i = 0; i < samples; ++i) {
    // Points of a spiral on the sphere, each for an equal area.
    const double z = 1 - (2 * i + 1.0) / samples, turn = 2 * std::numbers::pi * i / std::numbers::phi;
    const Vec3 p(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z);
    const auto nearest = std::max_element(unit.begin(), unit.end(), [&](const Vec3& a, const Vec3& b) {
      return std::abs(a.dot(p)) < std::abs(b.dot(p));
    });
    shares[static_cast<std::size_t>(nearest - unit.begin())] += 1.0 / samples;
  }
  return shares;
}

/// Numbers of pairs by region and direction.
class PairCounts {
 public:
  explicit PairCounts(std::size_t regions) : counts_(regions) {}

  void add(RegionIndex a, RegionIndex b, std::size_t direction) {
    ++counts_[a][direction];
    ++counts_[b][direction];
  }
  void add(const PairCounts& other) {
    for (std::size_t r = 0; r < counts_.size(); ++r)
      for (std::size_t d = 0; d < directions_of_pairs; ++d) counts_[r][d] += other.counts_[r][d];
  }
  const std::array<std::uint64_t, directions_of_pairs>& of(std::size_t region) const {
    return counts_[region];
  }

 private:
  std::vector<std::array<std::uint64_t, directions_of_pairs>> counts_;
};

/// Slices of a volume with a border of outside around each.
class BorderedSlices {
 public:
  explicit BorderedSlices(const LabelInput& labels)
      : labels_(labels),
        row_(static_cast<std::size_t>(labels.size[0]) + 2),
        rows_(static_cast<std::size_t>(labels.size[1]) + 2),
        inner_(static_cast<std::size_t>(labels.size[0]) * static_cast<std::size_t>(labels.size[1])) {}

  std::size_t row() const { return row_; }
  std::size_t rows() const { return rows_; }
  /// \param z from -1 to the number of slices
  void read(int z, std::vector<RegionIndex>& out) {
    out.assign(row_ * rows_, outside_region);
    if (z < 0 || z >= labels_.size[2]) return;
    labels_.regions.read_slices(z, z + 1, inner_);
    const std::size_t length = row_ - 2;
    for (std::size_t y = 0; y + 2 < rows_; ++y)
      std::copy_n(inner_.begin() + static_cast<std::ptrdiff_t>(y * length), length,
                  out.begin() + static_cast<std::ptrdiff_t>((y + 1) * row_ + 1));
  }

 private:
  const LabelInput& labels_;
  std::size_t row_, rows_;
  std::vector<RegionIndex> inner_;
};

PairCounts count_pairs(const LabelInput& labels) {
  constexpr Offsets offsets = pair_offsets();
  const std::size_t regions = labels.materials.size() + 1;
  PairCounts all(regions);
  std::mutex mutex;
  // Slice i is that below slice i of the volume.
  parallel_for(0, static_cast<std::size_t>(labels.size[2]) + 1, LabelGrains::counted_slices,
               [&](std::size_t begin, std::size_t end) {
                 PairCounts counts(regions);
                 BorderedSlices slices(labels);
                 std::vector<RegionIndex> slice, next;
                 slices.read(static_cast<int>(begin) - 1, slice);
                 const std::size_t row = slices.row();
                 for (std::size_t z = begin; z < end; ++z, slice.swap(next)) {
                   slices.read(static_cast<int>(z), next);
                   for (std::size_t d = 0; d < directions_of_pairs; ++d) {
                     const auto& [x, y, up] = offsets[d];
                     const RegionIndex* const other = (up ? next : slice).data();
                     const std::ptrdiff_t step = y * static_cast<std::ptrdiff_t>(row) + x;
                     const std::size_t last_row = slices.rows() - (y > 0 ? 1 : 0);
                     for (std::size_t r = y < 0 ? 1 : 0; r < last_row; ++r)
                       for (std::size_t i = r * row + (x < 0 ? 1 : 0), e = (r + 1) * row - (x > 0 ? 1 : 0);
                            i < e; ++i) {
                         const RegionIndex a = slice[i], b = other[static_cast<std::ptrdiff_t>(i) + step];
                         if (a != b) counts.add(a, b, d);
                       }
                   }
                 }
                 const std::lock_guard lock(mutex);
                 all.add(counts);
               });
  return all;
}

/// Counts the parts of the materials' boundaries. An interface is closed if the region on one side of it has
/// no other.
void count_parts(const LabelInput& labels, std::vector<RegionExtent>& extents) {
  const auto counts = [](const LabelContact& c) {
    return c.faces >= LabelTuning::Extents::min_contact_faces;
  };
  struct Region {
    std::size_t contacts = 0, parts = 1;
    RegionExtent* extent = nullptr;
  };
  std::map<MaterialOrOutside, Region> regions;
  for (const LabelContact& c : labels.contacts)
    if (counts(c)) ++regions[c.first].contacts, ++regions[c.second].contacts;
  for (std::size_t m = 0; m < extents.size(); ++m) {
    Region& region = regions[labels.materials[m].tag];
    region.parts = std::max<std::size_t>(1, labels.materials[m].parts.touching);
    region.extent = &extents[m];
    // A material that fills the volume meets nothing but its border.
    if (region.contacts == 0) extents[m].closed_parts = region.parts;
  }
  for (const LabelContact& c : labels.contacts) {
    if (!counts(c)) continue;
    const Region &first = regions[c.first], &second = regions[c.second];
    const std::size_t closed =
        std::max(first.contacts == 1 ? first.parts : 0, second.contacts == 1 ? second.parts : std::size_t{0});
    for (const Region* region : {&first, &second})
      if (region->extent)
        (closed ? region->extent->closed_parts : region->extent->open_parts) +=
            std::max<std::size_t>(1, closed);
  }
}

/// \param faces area of the voxel faces around the region
/// \param voxel volume of a voxel
double unevenness_of(const RegionExtent& extent, double faces, double voxel) {
  using Tuning = LabelTuning::Extents;
  const double thickness = 2 * extent.volume / extent.area / std::cbrt(voxel),
               oblique = (faces / extent.area - Tuning::faces_of_flat) /
                         (Tuning::faces_of_oblique - Tuning::faces_of_flat);
  return 1 + std::clamp(oblique, 0.0, 1.0) * std::max(0.0, Tuning::even_voxels - thickness);
}

}  // namespace

std::vector<RegionExtent> label_extents(const LabelInput& labels) {
  constexpr Offsets offsets = pair_offsets();
  const PairCounts counts = count_pairs(labels);
  const double voxel = std::abs(labels.directions.determinant());
  std::array<Vec3, directions_of_pairs> unit;
  std::array<double, directions_of_pairs> length{};
  for (std::size_t d = 0; d < directions_of_pairs; ++d) {
    const Vec3 step = labels.directions * Vec3(offsets[d][0], offsets[d][1], offsets[d][2]);
    length[d] = step.norm();
    unit[d] = step / length[d];
  }
  const std::array<double, directions_of_pairs> shares = direction_shares(unit);
  std::vector<RegionExtent> extents(labels.materials.size());
  for (std::size_t m = 0; m < extents.size(); ++m) {
    const LabelMaterial& material = labels.materials[m];
    extents[m].volume = voxel * material.image_volume.value_or(static_cast<double>(material.voxels));
    // A line along each pair represents the area voxel / length across it, and the mean of an area's
    // projections along all directions is half of it.
    double faces = 0;
    for (std::size_t d = 0; d < directions_of_pairs; ++d) {
      const double across = voxel / length[d] * static_cast<double>(counts.of(m + 1)[d]);
      extents[m].area += 2 * shares[d] * across;
      const auto& [x, y, z] = offsets[d];
      if (std::abs(x) + std::abs(y) + z == 1) faces += across;
    }
    extents[m].unevenness = unevenness_of(extents[m], faces, voxel);
  }
  count_parts(labels, extents);
  return extents;
}

}  // namespace tetwright
