// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/reference_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tetwright {

namespace {

/// Most parts: for each triangle, and in addition for surfaces of few large triangles. With four for each, a
/// search among slivers takes a third of the time; with eight a fourth, but most surfaces only get a larger
/// tree.
constexpr std::size_t parts_per_triangle = 4, free_parts = 256;
/// Parts are not halved below this multiple of the longest side of all triangles divided by the square root
/// of their number: scans then have almost no triangles of several parts, which would make searches slower.
constexpr double min_length = 4;
/// Rounding of a clipped corner, as a share of the largest coordinate, with a margin.
constexpr double rounding = 1e-14;
/// Parts in a leaf. A box takes a tenth of a triangle's time: one part visits half as many triangles, but its
/// boxes are as many as the triangles and slower for scans.
constexpr std::size_t leaf_parts = 2;

/// A triangle clipped at planes: each of the six planes of a box adds at most one corner.
struct Part {
  static constexpr std::size_t max_corners = 9;
  Index triangle;
  std::size_t size = 0;
  std::array<Vec3, max_corners> corners;
  Box3 box;

  void add(const Vec3& p) {
    corners[size++] = p;
    box.add(p);
  }
};

/// The parts below and above a plane.
std::array<Part, 2> cut(const Part& part, Eigen::Index axis, double at) {
  std::array<Part, 2> out;
  for (int side = 0; side < 2; ++side) {
    Part& half = out[static_cast<std::size_t>(side)];
    half.triangle = part.triangle;
    const auto is_in = [&](const Vec3& p) { return side == 0 ? p[axis] <= at : p[axis] >= at; };
    for (std::size_t k = 0; k < part.size; ++k) {
      const Vec3 &p = part.corners[k], &q = part.corners[(k + 1) % part.size];
      if (is_in(p)) half.add(p);
      if ((p[axis] < at && q[axis] > at) || (p[axis] > at && q[axis] < at)) {
        Vec3 crossing = p + (at - p[axis]) / (q[axis] - p[axis]) * (q - p);
        crossing[axis] = at;
        half.add(crossing);
      }
    }
  }
  return out;
}

double longest_side(const Box3& box) { return (box.high - box.low).maxCoeff(); }

/// Halves parts until they are no longer than `length`. Returns no parts if these would be more than `most`.
std::vector<Part> halved(const std::vector<Part>& parts, double length, std::size_t most) {
  std::vector<Part> out, open;
  for (const Part& part : parts) {
    open.push_back(part);
    while (!open.empty()) {
      const Part next = open.back();
      open.pop_back();
      Eigen::Index axis;
      const double side = (next.box.high - next.box.low).maxCoeff(&axis);
      const double middle = next.box.low[axis] + side / 2;
      if (side <= length || !(next.box.low[axis] < middle && middle < next.box.high[axis])) {
        if (out.size() == most) return {};
        out.push_back(next);
        continue;
      }
      const std::array<Part, 2> halves = cut(next, axis, middle);
      open.push_back(halves[1]);
      open.push_back(halves[0]);
    }
  }
  return out;
}

}  // namespace

std::vector<TriangleReference> split_references(std::span<const std::array<Vec3, 3>> triangles) {
  std::vector<TriangleReference> references(triangles.size());
  Box3 whole;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    references[t].triangle = static_cast<Index>(t);
    for (const Vec3& c : triangles[t]) references[t].box.add(c);
    whole.add(references[t].box);
  }
  if (triangles.empty() || !(longest_side(whole) > 0)) return references;

  const std::size_t most = parts_per_triangle * triangles.size() + free_parts;
  const double shortest =
      min_length * longest_side(whole) / std::sqrt(static_cast<double>(2 * triangles.size() + free_parts));
  std::vector<Part> parts;  // of the triangles that are longer than `reached`
  std::size_t unsplit = triangles.size();
  double reached = std::numeric_limits<double>::infinity();
  for (double length = longest_side(whole) / 2; length >= shortest; length /= 2) {
    std::vector<Part> longer = parts;
    std::size_t others = unsplit;
    for (const TriangleReference& r : references) {
      const double side = longest_side(r.box);
      if (!(side > length && side <= reached)) continue;
      Part part;
      part.triangle = r.triangle;
      for (const Vec3& c : triangles[r.triangle]) part.add(c);
      longer.push_back(part);
      --others;
    }
    if (longer.empty()) continue;
    if (others + longer.size() > most) break;
    longer = halved(longer, length, most - others);
    if (longer.empty()) break;
    parts = std::move(longer);
    unsplit = others;
    reached = length;
  }
  if (parts.empty()) return references;
  std::erase_if(references, [&](const TriangleReference& r) { return longest_side(r.box) > reached; });
  for (const Part& part : parts) {
    double largest = 0;
    for (const Vec3& c : triangles[part.triangle]) largest = std::max(largest, c.lpNorm<Eigen::Infinity>());
    const Vec3 pad = Vec3::Constant(rounding * largest);
    references.push_back({part.triangle, {part.box.low - pad, part.box.high + pad}});
  }
  std::stable_sort(references.begin(), references.end(),
                   [](const auto& a, const auto& b) { return a.triangle < b.triangle; });
  return references;
}

ReferenceTree::ReferenceTree(std::span<const std::array<Vec3, 3>> triangles)
    : is_split_(triangles.size(), 0) {
  const std::vector<TriangleReference> references = split_references(triangles);
  std::vector<Box3> boxes(references.size());
  std::vector<Vec3> middles(references.size());  // times 2
  for (std::size_t i = 0; i < references.size(); ++i) {
    boxes[i] = references[i].box;
    middles[i] = boxes[i].low + boxes[i].high;
    if (i > 0 && references[i].triangle == references[i - 1].triangle) is_split_[references[i].triangle] = 1;
  }
  const std::vector<Index> order = median_order(boxes, middles, leaf_parts);
  tree_ = BoxTree(order.size(), leaf_parts, [&](std::size_t i) { return boxes[order[i]]; });
  triangles_.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) triangles_[i] = references[order[i]].triangle;
}

}  // namespace tetwright
