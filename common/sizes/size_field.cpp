// SPDX-License-Identifier: Apache-2.0
#include "tetwright/sizes.h"

#include <algorithm>
#include <cmath>

#include "common/portable_math.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Approximate number of nodes: 8 MB, sampled in one or two seconds.
constexpr double nodes_wanted = 1 << 21;
/// Maximum number of nodes along an axis; more do not help in a flat or slender box.
constexpr double max_nodes_along = 512;
constexpr int margin = 1;  ///< nodes around the box
/// Maximum number of passes in both directions. Each pass propagates a size any distance along the directions
/// of a node's neighbours; further passes change hardly anything.
constexpr int max_passes = 8;
/// Search radius for known nodes, in grid spacings.
constexpr int max_reach = 6;
constexpr std::size_t place_grain = 1024;
/// Paths along a node's 26 neighbours are longer than a straight line by up to this factor (Borgefors 1986).
constexpr double max_detour = 1.13;

}  // namespace

SizeField::SizeField(const SizeSource& source, const Vec3& low, const Vec3& high, const SizeLimits& limits)
    : limits_(limits) {
  const Vec3 sides = high - low;
  const double longest = sides.maxCoeff();
  // Flat boxes are treated as one node thick.
  const Vec3 solid = sides.cwiseMax(longest / max_nodes_along);
  spacing_ = std::max(portable_cbrt(solid.prod() / nodes_wanted), longest / max_nodes_along);
  low_ = low - Vec3::Constant(margin * spacing_);
  for (int a = 0; a < 3; ++a)
    size_[static_cast<std::size_t>(a)] =
        static_cast<std::size_t>(std::ceil(sides[a] / spacing_)) + 2 * margin + 1;
  sample(source);
  lower_at_values(source);
  limit_growth();
}

void SizeField::sample(const SizeSource& source) {
  const std::size_t count = size_[0] * size_[1] * size_[2];
  values_.assign(count, std::numeric_limits<float>::infinity());
  known_.assign(count, 0);
  parallel_for(0, size_[1] * size_[2], 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t x = 0; x < size_[0]; ++x) {
        const auto y = static_cast<int>(row % size_[1]), z = static_cast<int>(row / size_[1]);
        const Vec3 place = node(static_cast<int>(x), y, z);
        const std::optional<WantedLength> wanted = source.at(place);
        if (!wanted) continue;
        const std::size_t i = row * size_[0] + x;
        known_[i] = 1;
        values_[i] = static_cast<float>(std::clamp(wanted->length, limits_.min_edge, limits_.max_edge) +
                                        growth(wanted->distance, source));
      }
  });
}

double SizeField::growth(double distance, const SizeSource& source) const {
  // A surface may pass between nodes. The length must not grow within the cells that it crosses, or the
  // interpolated length would exceed the target.
  const double cell = source.fills_space() ? 0 : std::sqrt(3.0) * spacing_;
  return limits_.grading * std::max(0.0, distance - cell);
}

void SizeField::lower_at_values(const SizeSource& source) {
  source.for_each_value([&](const Vec3& place, double length) {
    const double wanted = std::clamp(length, limits_.min_edge, limits_.max_edge);
    std::array<int, 3> first;
    for (int a = 0; a < 3; ++a) {
      const double at = (place[a] - low_[a]) / spacing_;
      // Skip a value outside the grid: the grid's nodes are nearer to others.
      if (!(at >= 0 && at < static_cast<double>(size_[static_cast<std::size_t>(a)] - 1))) return;
      first[static_cast<std::size_t>(a)] = static_cast<int>(at);
    }
    for (int k = 0; k < 8; ++k) {
      const int x = first[0] + (k & 1), y = first[1] + (k >> 1 & 1), z = first[2] + (k >> 2);
      float& value = values_[index(x, y, z)];
      known_[index(x, y, z)] = 1;
      value = std::min(value, static_cast<float>(wanted + growth((node(x, y, z) - place).norm(), source)));
    }
  });
}

void SizeField::limit_growth() {
  struct Step {
    int x, y, z;
    float growth;
  };
  std::vector<Step> preceding_neighbours;  // the half of a node's 26 neighbours that precedes it
  for (int k = 0; k < 13; ++k) {
    const int x = k % 3 - 1, y = k / 3 % 3 - 1, z = k / 9 - 1;
    preceding_neighbours.push_back(
        {x, y, z,
         static_cast<float>(limits_.grading / max_detour * spacing_ * std::sqrt(x * x + y * y + z * z))});
  }
  const std::array<int, 3> size{static_cast<int>(size_[0]), static_cast<int>(size_[1]),
                                static_cast<int>(size_[2])};
  const auto inside = [](int i, int n) { return i >= 0 && i < n; };
  for (int pass = 0; pass < max_passes; ++pass) {
    bool changed = false;
    for (const int sign : {1, -1})
      for (int i = 0; i < size[2]; ++i)
        for (int j = 0; j < size[1]; ++j)
          for (int k = 0; k < size[0]; ++k) {
            const int x = sign > 0 ? k : size[0] - 1 - k, y = sign > 0 ? j : size[1] - 1 - j,
                      z = sign > 0 ? i : size[2] - 1 - i;
            float& value = values_[index(x, y, z)];
            for (const Step& s : preceding_neighbours) {
              const int nx = x + sign * s.x, ny = y + sign * s.y, nz = z + sign * s.z;
              if (!inside(nx, size[0]) || !inside(ny, size[1]) || !inside(nz, size[2])) continue;
              const float limit = values_[index(nx, ny, nz)] + s.growth;
              if (limit < value) {
                value = limit;
                changed = true;
              }
            }
          }
    if (!changed) break;
  }
}

double SizeField::at(const Vec3& place) const {
  std::array<int, 3> first;
  Vec3 share;
  for (int a = 0; a < 3; ++a) {
    const auto last = static_cast<double>(size_[static_cast<std::size_t>(a)] - 1);
    const double at = std::clamp((place[a] - low_[a]) / spacing_, 0.0, last);
    first[static_cast<std::size_t>(a)] = static_cast<int>(std::min(at, last - 1));
    share[a] = at - first[static_cast<std::size_t>(a)];
  }
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const int dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
    const double weight =
        (dx ? share[0] : 1 - share[0]) * (dy ? share[1] : 1 - share[1]) * (dz ? share[2] : 1 - share[2]);
    sum += weight * static_cast<double>(values_[index(first[0] + dx, first[1] + dy, first[2] + dz)]);
  }
  return std::min(sum, limits_.max_edge);
}

std::optional<Vec3> SizeField::first_beyond(const SizeSource& source, const std::vector<Vec3>& places) const {
  if (std::find(known_.begin(), known_.end(), 1) == known_.end()) return places.front();
  const auto reached = [&](const Vec3& place) {
    if (source.at(place).has_value()) return true;
    const double distance = at(place) + 2 * spacing_;
    const int reach = static_cast<int>(std::min<double>(std::ceil(distance / spacing_), max_reach));
    std::array<int, 3> centre;
    for (int a = 0; a < 3; ++a)
      centre[static_cast<std::size_t>(a)] = static_cast<int>(std::lround((place[a] - low_[a]) / spacing_));
    const auto range = [&](std::size_t a) {
      return std::array{std::max(0, centre[a] - reach),
                        std::min(static_cast<int>(size_[a]) - 1, centre[a] + reach)};
    };
    const auto [x0, x1] = range(0);
    const auto [y0, y1] = range(1);
    const auto [z0, z1] = range(2);
    for (int z = z0; z <= z1; ++z)
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
          if (known_[index(x, y, z)] && (node(x, y, z) - place).norm() <= distance) return true;
    return false;
  };
  std::vector<std::uint8_t> beyond(places.size(), 0);
  parallel_for(0, places.size(), place_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) beyond[i] = !reached(places[i]);
  });
  const auto first = std::find(beyond.begin(), beyond.end(), 1);
  if (first == beyond.end()) return {};
  return places[static_cast<std::size_t>(first - beyond.begin())];
}

}  // namespace tetwright
