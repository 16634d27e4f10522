// Level sets of balls: the surface's bounding box says which.
#include "mesher/distance/level_set.h"

#include <algorithm>

namespace tetwright {

struct LevelSet::Impl {
  Vec3 centre;    ///< grid coordinates
  double radius;  ///< finest cells
  std::array<int, 3> cells;

  double at(const Vec3& p) const {
    constexpr double band = level_set_band;
    return std::clamp((p - centre).norm() - radius, -band, band);
  }
};

LevelSet::LevelSet(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LevelSet::~LevelSet() = default;

std::shared_ptr<const LevelSet> LevelSet::of_surface(const RepairedSurface& surface, const GridFrame& frame,
                                                     Progress*) {
  const Vec3 low = frame.to_grid(surface.low), high = frame.to_grid(surface.high);
  auto impl = std::make_unique<Impl>(Impl{0.5 * (low + high), 0.5 * (high.x() - low.x()), frame.cells});
  return std::shared_ptr<const LevelSet>(new LevelSet(std::move(impl)));
}

std::vector<MortonKey> LevelSet::interface_cells() const {
  std::vector<MortonKey> keys;
  for (int x = 0; x < impl_->cells[0]; ++x)
    for (int y = 0; y < impl_->cells[1]; ++y)
      for (int z = 0; z < impl_->cells[2]; ++z) {
        int inside = 0;
        for (int k = 0; k < 8; ++k)
          inside += impl_->at(Vec3(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2))) < 0;
        if (inside > 0 && inside < 8) keys.push_back(morton_encode(x, y, z));
      }
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::vector<LeafOrigin> LevelSet::leaves() const { return {}; }

struct LevelSetSampler::Impl {
  const LevelSet::Impl& ball;
};

LevelSetSampler::LevelSetSampler(const LevelSet& level_set)
    : impl_(std::make_unique<Impl>(Impl{*level_set.impl_})) {}
LevelSetSampler::~LevelSetSampler() = default;

double LevelSetSampler::at_node(int x, int y, int z) { return impl_->ball.at(Vec3(x, y, z)); }
double LevelSetSampler::at(const Vec3& point) { return impl_->ball.at(point); }
double LevelSetSampler::at(const Vec3& point, Vec3& gradient) {
  gradient = (point - impl_->ball.centre).normalized();
  return impl_->ball.at(point);
}

}  // namespace tetwright
