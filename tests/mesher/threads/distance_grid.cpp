// SPDX-License-Identifier: Apache-2.0

// Replaces mesher/level_sets/openvdb_grids.cpp: a map of leaves, filled with exact distances from the
// triangles.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "common/geometry/distance_tree.h"
#include "mesher/level_sets/openvdb_grids.h"

namespace tetwright {

namespace {

constexpr auto band = static_cast<float>(level_set_band);

LeafOrigin origin_of(int x, int y, int z) {
  const auto lowest = [](int v) { return v & ~(leaf_side - 1); };
  return {lowest(x), lowest(y), lowest(z)};
}

}  // namespace

struct DistanceGrid::Impl {
  struct Leaf {
    std::array<float, leaf_points> values;
    std::array<std::uint64_t, leaf_points / 64> active{};
  };
  float background;
  std::map<LeafOrigin, Leaf> leaves;

  const Leaf* find(int x, int y, int z) const {
    const auto found = leaves.find(origin_of(x, y, z));
    return found == leaves.end() ? nullptr : &found->second;
  }
  Leaf& touch(const LeafOrigin& origin) {
    const auto [at, made] = leaves.try_emplace(origin);
    if (made) at->second.values.fill(background);
    return at->second;
  }
};

namespace {

template <class Value, class Leaf>
GridLeaf<Value> view_of(const LeafOrigin& origin, Leaf& leaf) {
  return {origin, leaf.values.data(), leaf.active.data()};
}

template <class Value, class Leaves>
std::vector<GridLeaf<Value>> views_of(Leaves& leaves) {
  std::vector<GridLeaf<Value>> views;
  for (auto& [origin, leaf] : leaves) views.push_back(view_of<Value>(origin, leaf));
  return views;
}

}  // namespace

DistanceGrid::DistanceGrid(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DistanceGrid::DistanceGrid(double background) : impl_(new Impl{static_cast<float>(background), {}}) {}
DistanceGrid::~DistanceGrid() = default;
DistanceGrid::DistanceGrid(DistanceGrid&&) noexcept = default;
DistanceGrid& DistanceGrid::operator=(DistanceGrid&&) noexcept = default;

DistanceGrid DistanceGrid::copy() const { return DistanceGrid(std::make_unique<Impl>(*impl_)); }

DistanceGrid DistanceGrid::unsigned_distances(std::span<const Vec3> points,
                                              std::span<const Triangle> triangles, Progress*) {
  DistanceGrid grid(level_set_band);
  const DistanceTree tree(points, triangles);
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const auto floor_of = [](double v) { return static_cast<int>(std::floor(v)); };
  const LeafOrigin first = origin_of(floor_of(low.x()) - level_set_band, floor_of(low.y()) - level_set_band,
                                     floor_of(low.z()) - level_set_band);
  for (int x = first[0]; x <= high.x() + level_set_band; x += leaf_side)
    for (int y = first[1]; y <= high.y() + level_set_band; y += leaf_side)
      for (int z = first[2]; z <= high.z() + level_set_band; z += leaf_side) {
        const GridLeaf<float> leaf = grid.touch_leaf({x, y, z});
        for (int k = 0; k < leaf_points; ++k) {
          const auto [px, py, pz] = leaf.point(k);
          const double distance = tree.distance(Vec3(px, py, pz), level_set_band);
          if (distance < level_set_band) leaf.activate(k, static_cast<float>(distance));
        }
      }
  return grid;
}

float DistanceGrid::active_or(int x, int y, int z, float otherwise) const {
  DistanceGridReader reader(*this);
  float value;
  return reader.active(x, y, z, value) ? value : otherwise;
}

std::vector<GridLeaf<const float>> DistanceGrid::leaves() const {
  return views_of<const float>(std::as_const(impl_->leaves));
}
std::vector<GridLeaf<float>> DistanceGrid::leaves() { return views_of<float>(impl_->leaves); }
GridLeaf<float> DistanceGrid::touch_leaf(const LeafOrigin& origin) {
  return view_of<float>(origin, impl_->touch(origin));
}

void DistanceGrid::prune_inactive() {
  std::erase_if(impl_->leaves, [](const auto& item) {
    return std::all_of(item.second.active.begin(), item.second.active.end(),
                       [](std::uint64_t w) { return w == 0; });
  });
}

// Fills the bounding box of all leaves with leaves, so that every row along z begins outside.
void DistanceGrid::fill_outside_band() {
  if (impl_->leaves.empty()) return;
  LeafOrigin low = impl_->leaves.begin()->first, high = low;
  for (const auto& [origin, leaf] : impl_->leaves)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], origin[a]), high[a] = std::max(high[a], origin[a]);
  for (int x = low[0]; x <= high[0]; x += leaf_side)
    for (int y = low[1]; y <= high[1]; y += leaf_side) {
      std::array<bool, leaf_side * leaf_side> inside{};  // at the end of each row so far
      for (int z = low[2]; z <= high[2]; z += leaf_side) {
        const GridLeaf<float> leaf = touch_leaf({x, y, z});
        for (int k = 0; k < leaf_points; ++k) {
          bool& in = inside[static_cast<std::size_t>(k / leaf_side)];
          if (leaf.active(k))
            in = leaf.values[k] < 0;
          else
            leaf.values[k] = in ? -band : band;
        }
      }
    }
}

struct DistanceGridReader::Impl {
  const DistanceGrid::Impl& grid;
};

DistanceGridReader::DistanceGridReader(const DistanceGrid& grid) : impl_(new Impl{grid.impl()}) {}
DistanceGridReader::~DistanceGridReader() = default;
DistanceGridReader::DistanceGridReader(DistanceGridReader&&) noexcept = default;

float DistanceGridReader::value(int x, int y, int z) {
  float value = impl_->grid.background;
  active(x, y, z, value);
  return value;
}

bool DistanceGridReader::active(int x, int y, int z, float& value) {
  const DistanceGrid::Impl::Leaf* leaf = impl_->grid.find(x, y, z);
  if (!leaf) return false;
  const GridLeaf<const float> view = view_of<const float>(origin_of(x, y, z), *leaf);
  const int k = view.number(x, y, z);
  value = view.values[k];
  return view.active(k);
}

const float* DistanceGridReader::leaf_values(int x, int y, int z) {
  const DistanceGrid::Impl::Leaf* leaf = impl_->grid.find(x, y, z);
  return leaf ? leaf->values.data() : nullptr;
}

void DistanceGridReader::corners(int x, int y, int z, double values[8]) {
  for (int k = 0; k < 8; ++k) values[k] = value(x + (k >> 2), y + (k >> 1 & 1), z + (k & 1));
}

}  // namespace tetwright
