// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "common/geometry/low_discrepancy.h"
#include "common/geometry/projection_tree.h"
#include "common/parallel/parallel_sort.h"
#include "tetwright/error.h"
#include "tetwright/progress.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr std::size_t max_pieces = std::size_t{1} << 22;
/// Maximum depth of bisection. Without it, ties between items that do not meet, such as duplicates, would be
/// bisected forever.
constexpr int max_levels = 150;
/// Every so many levels a piece is cut at the middle of its longest edge, so that pieces shrink.
constexpr int halving_period = 4;
constexpr int bisections = 40;  ///< steps to find where another item becomes the nearest
/// A cut nearer to an end of the edge than this fraction is moved to the midpoint.
constexpr double min_cut = 0.01;
constexpr std::size_t max_cuts = 4096;  ///< for each triangle, in triangles_beyond()
constexpr std::size_t grain = 256;
constexpr std::size_t rms_points = 100000;

/// A point and the item nearest to it.
struct Measured {
  Vec3 at;
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t item = 0;
};

/// A triangle or a part of one, with an upper bound of the distance of its points.
struct Piece {
  std::array<Measured, 3> corners;
  double upper;
};

double distance_to(const ProjectionTree& to, std::uint32_t item, const Vec3& p) {
  const ProjectionTree::Item& t = to.items()[item];
  return std::sqrt(squared_distance(p, to.corner(t, 0), to.corner(t, 1), to.corner(t, 2)));
}

/// Measures the distance of a point.
/// \param guess an item that may be near
Measured measure(const ProjectionTree& to, const Vec3& at, std::uint32_t guess) {
  Measured m{at, distance_to(to, guess, at), guess};
  if (const auto hit = to.nearest_of(at, m.distance, [](const ProjectionTree::Item&) { return true; }))
    m = {at, (hit->point - at).norm(), static_cast<std::uint32_t>(hit->item)};
  return m;
}

/// Measures points; neighbours in the list should be neighbours in space.
std::vector<Measured> measure_all(const ProjectionTree& to, const std::vector<Vec3>& points) {
  std::vector<Measured> out(points.size());
  parallel_for(0, (points.size() + grain - 1) / grain, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t block = first; block < last; ++block) {
      std::uint32_t guess = 0;
      for (std::size_t i = block * grain; i < std::min(points.size(), (block + 1) * grain); ++i) {
        out[i] = measure(to, points[i], guess);
        guess = out[i].item;
      }
    }
  });
  return out;
}

/// Common corners of two items, at most two.
struct SharedCorners {
  int count = 0;
  std::array<Index, 2> points{};

  SharedCorners(const ProjectionTree::Item& a, const ProjectionTree::Item& b) {
    for (const Index p : a.corners) {
      const bool in_both = p == b.corners[0] || p == b.corners[1] || p == b.corners[2];
      if (in_both && count < 2 && !(count == 1 && points[0] == p)) points[count++] = p;
    }
  }
};

/// Distance between two segments at their nearest points, up to rounding.
double distance_between(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Vec3 a = a1 - a0, b = b1 - b0, ba = a0 - b0;
  const double aa = a.squaredNorm(), ab = a.dot(b), bb = b.squaredNorm();
  const auto on_segment = [](double along, double squared) {
    return squared > 0 ? std::clamp(along / squared, 0.0, 1.0) : 0;
  };
  const double across = aa * bb - ab * ab;
  const double on_a = on_segment(ab * ba.dot(b) - bb * ba.dot(a), across);
  const double on_b = on_segment((ba + on_a * a).dot(b), bb);
  return (a0 + on_segment((b0 + on_b * b - a0).dot(a), aa) * a - b0 - on_b * b).norm();
}

/// Distance of the edge between two corners from the common corners of their items; infinite if they have
/// none.
double passing_distance(const ProjectionTree& to, const Measured& a, const Measured& b) {
  const SharedCorners shared(to.items()[a.item], to.items()[b.item]);
  if (shared.count == 0) return std::numeric_limits<double>::infinity();
  return distance_between(a.at, b.at, to.points()[shared.points[0]],
                          to.points()[shared.points[shared.count - 1]]);
}

/// Upper bound of the distance of a triangle's points from the items nearest to its corners. Infinite if two
/// of these items do not meet, or if three have no common corner.
///
/// The triangle is mapped to the items piecewise linearly: each corner to its nearest point, a point of each
/// edge between different items to a common point of the two, and, for three items, an inner point to a
/// common corner of all. The image of each piece lies in one item, which is convex, and the distance between
/// a point and its image is largest at a corner of a piece.
double upper_bound_over_joints(const ProjectionTree& to, const std::array<Measured, 3>& corners) {
  double upper = 0;
  bool all_differ = true;
  for (int k = 0; k < 3; ++k) {
    const Measured &a = corners[k], &b = corners[(k + 1) % 3];
    upper = std::max(upper, a.distance);
    if (a.item == b.item)
      all_differ = false;
    else
      upper = std::max(upper, passing_distance(to, a, b));
  }
  if (!all_differ || std::isinf(upper)) return upper;
  double within = std::numeric_limits<double>::infinity();
  for (const Index p : to.items()[corners[0].item].corners) {
    const auto has = [p](const ProjectionTree::Item& item) {
      return item.corners[0] == p || item.corners[1] == p || item.corners[2] == p;
    };
    if (has(to.items()[corners[1].item]) && has(to.items()[corners[2].item]))
      within = std::min(
          within, std::sqrt(squared_distance(to.points()[p], corners[0].at, corners[1].at, corners[2].at)));
  }
  return std::max(upper, within);
}

double upper_bound(const ProjectionTree& to, const std::array<Measured, 3>& corners) {
  double longest = 0, farthest = 0;
  for (int k = 0; k < 3; ++k) {
    longest = std::max(longest, (corners[(k + 1) % 3].at - corners[k].at).norm());
    farthest = std::max(farthest, corners[k].distance);
  }
  // Every point of a triangle is within longest / sqrt(3) of a corner.
  double upper = farthest + longest / std::numbers::sqrt3;
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t item = corners[k].item;
    if (k > 0 && (item == corners[0].item || (k == 2 && item == corners[1].item))) continue;
    double of_item = 0;
    for (const Measured& c : corners)
      of_item = std::max(of_item, c.item == item ? c.distance : distance_to(to, item, c.at));
    upper = std::min(upper, of_item);
  }
  return std::min(upper, upper_bound_over_joints(to, corners));
}

/// Parameter on the edge between two corners at which the items of both are equally near.
double transition(const ProjectionTree& to, const Measured& a, const Measured& b) {
  double low = 0, high = 1;
  for (int i = 0; i < bisections; ++i) {
    const double middle = (low + high) / 2;
    const Vec3 at = a.at + middle * (b.at - a.at);
    (distance_to(to, a.item, at) <= distance_to(to, b.item, at) ? low : high) = middle;
  }
  return low;
}

/// Bisects a piece, preferably where the nearest item changes: a part with a single nearest item is settled.
/// Halving alone would refine around every edge of the other surface down to the accuracy.
std::array<Piece, 2> cut(const ProjectionTree& to, const Piece& piece, bool halve) {
  const auto& c = piece.corners;
  int edge = 0;
  double longest = -1, share = 0.5;
  for (int k = 0; k < 3; ++k) {
    const Measured &a = c[k], &b = c[(k + 1) % 3];
    const double length = (b.at - a.at).norm();
    // Distance of the other corner's item minus the distance of the nearest one.
    const double jump = a.item == b.item ? -1
                                         : std::max(distance_to(to, b.item, a.at) - a.distance,
                                                    distance_to(to, a.item, b.at) - b.distance);
    if ((halve ? length : jump) <= longest) continue;
    longest = halve ? length : jump;
    edge = k;
  }
  const Measured &a = c[edge], &b = c[(edge + 1) % 3], &opposite = c[(edge + 2) % 3];
  if (!halve) share = transition(to, a, b);
  if (!(share > min_cut && share < 1 - min_cut)) share = 0.5;
  const Measured between = measure(to, a.at + share * (b.at - a.at), a.item);
  std::array<Piece, 2> parts{Piece{{a, between, opposite}, piece.upper},
                             Piece{{between, b, opposite}, piece.upper}};
  for (Piece& part : parts) part.upper = std::min(part.upper, upper_bound(to, part.corners));
  return parts;
}

double rms_of(const ProjectionTree& from, const ProjectionTree& to) {
  const auto area = [&](const ProjectionTree::Item& item) {
    const Vec3& a = from.corner(item, 0);
    return (from.corner(item, 1) - a).cross(from.corner(item, 2) - a).norm() / 2;
  };
  double total = 0;
  for (const ProjectionTree::Item& item : from.items()) total += area(item);
  if (!(total > 0)) return 0;
  std::vector<Vec3> points;
  points.reserve(rms_points + 1);
  double due = 0.5;  // points due; 0.5 puts the first one after half of a point's share of the area
  for (const ProjectionTree::Item& item : from.items()) {
    const Vec3& a = from.corner(item, 0);
    for (due += area(item) / total * rms_points; due >= 1; --due) {
      const auto [u, v] = low_discrepancy_barycentric(points.size());
      points.emplace_back(a + u * (from.corner(item, 1) - a) + v * (from.corner(item, 2) - a));
    }
  }
  double sum = 0;
  for (const Measured& m : measure_all(to, points)) sum += m.distance * m.distance;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, points.size())));
}

/// Finds a point of the triangle farther away than `limit`; std::nullopt if none is found within max_cuts
/// cuts.
std::optional<Measured> beyond(const ProjectionTree& to, const Piece& triangle, double limit,
                               double accuracy) {
  for (const Measured& corner : triangle.corners)
    if (corner.distance > limit) return corner;
  std::vector<Piece> open{triangle};
  for (std::size_t cuts = 0; cuts < max_cuts && !open.empty(); ++cuts) {
    const Piece piece = open.back();
    open.pop_back();
    const std::array<Piece, 2> parts = cut(to, piece, cuts % halving_period == halving_period - 1);
    if (const Measured& between = parts[0].corners[1]; between.distance > limit) return between;
    for (const Piece& part : parts)
      if (part.upper > limit + accuracy) open.push_back(part);
  }
  return {};
}

}  // namespace

SurfaceDeviation surface_deviation(const ProjectionTree& from, const ProjectionTree& to, double accuracy,
                                   const Progress* progress) {
  SurfaceDeviation result;
  if (from.empty()) return result;
  if (to.empty()) {
    result.lower = result.upper = result.rms = std::numeric_limits<double>::infinity();
    result.place = from.corner(from.items().front(), 0);
    return result;
  }
  const auto take = [&](const Measured& m) {
    if (m.distance <= result.lower) return;
    result.lower = m.distance;
    result.place = m.at;
  };
  // Number the corners in the order of the triangles.
  std::vector<Index> number(from.points().size(), no_index);
  std::vector<Vec3> points;
  for (const ProjectionTree::Item& item : from.items())
    for (const Index p : item.corners)
      if (number[p] == no_index) {
        number[p] = static_cast<Index>(points.size());
        points.push_back(from.points()[p]);
      }
  const std::vector<Measured> corners = measure_all(to, points);
  result.place = points.front();
  for (const Measured& m : corners) take(m);
  const auto enough = [&] {
    return std::max(result.lower * (1 + relative_deviation_accuracy), result.lower + accuracy);
  };

  double settled = result.lower;  // upper bound over the discarded triangles
  const std::size_t blocks = (from.items().size() + grain - 1) / grain;
  std::vector<double> block_settled(blocks, 0);
  const double limit = enough();
  std::vector<Piece> open = parallel_collect<Piece>(
      0, from.items().size(), grain, [&](std::size_t begin, std::size_t end, std::vector<Piece>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          Piece piece;
          for (int k = 0; k < 3; ++k) piece.corners[k] = corners[number[from.items()[i].corners[k]]];
          piece.upper = upper_bound(to, piece.corners);
          if (piece.upper > limit)
            out.push_back(piece);
          else
            block_settled[begin / grain] = std::max(block_settled[begin / grain], piece.upper);
        }
      });
  for (const double upper : block_settled) settled = std::max(settled, upper);
  const auto stopped = [&] {
    if (progress && progress->cancelled()) throw Interrupted();
    return progress && progress->out_of_time();
  };
  for (int level = 0; level < max_levels && !open.empty() && open.size() < max_pieces && !stopped();
       ++level) {
    std::vector<std::array<Piece, 2>> parts(open.size());
    const bool halve = level % halving_period == halving_period - 1;
    parallel_for(0, open.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) parts[i] = cut(to, open[i], halve);
    });
    for (const std::array<Piece, 2>& two : parts) take(two[0].corners[1]);
    open.clear();
    for (const std::array<Piece, 2>& two : parts)
      for (const Piece& piece : two) {
        if (piece.upper > enough())
          open.push_back(piece);
        else
          settled = std::max(settled, piece.upper);
      }
  }
  for (const Piece& piece : open) settled = std::max(settled, piece.upper);
  result.upper = std::max(settled, result.lower);
  result.rms = rms_of(from, to);
  return result;
}

std::vector<FarTriangle> triangles_beyond(const ProjectionTree& from, const ProjectionTree& to, double limit,
                                          double accuracy) {
  return parallel_collect<FarTriangle>(
      0, from.items().size(), grain, [&](std::size_t begin, std::size_t end, std::vector<FarTriangle>& out) {
        std::uint32_t guess = 0;
        for (std::size_t i = begin; i < end; ++i) {
          Piece triangle;
          for (int k = 0; k < 3; ++k) {
            triangle.corners[k] = measure(to, from.corner(from.items()[i], k), guess);
            guess = triangle.corners[k].item;
          }
          triangle.upper = upper_bound(to, triangle.corners);
          if (!(triangle.upper > limit + accuracy)) continue;
          if (const auto point = beyond(to, triangle, limit, accuracy))
            out.push_back({static_cast<std::uint32_t>(i), point->item, point->at});
        }
      });
}

}  // namespace tetwright
