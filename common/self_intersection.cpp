#include "common/self_intersection.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "common/parallel.h"
#include "common/triangle_intersection.h"

namespace tetwright {

namespace {

struct TriangleBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const TriangleBox& b) {
    low = low.cwiseMin(b.low);
    high = high.cwiseMax(b.high);
  }
  bool meets(const TriangleBox& b) const {
    return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all();
  }
};

/// Spreads the lowest 21 bits, two zeros between each.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffu;
  v = (v | v << 16) & 0x1f0000ff0000ffu;
  v = (v | v << 8) & 0x100f00f00f00f00fu;
  v = (v | v << 4) & 0x10c30c30c30c30c3u;
  return (v | v << 2) & 0x1249249249249249u;
}

/// A balanced binary tree of boxes over triangles in the order of a space-filling curve, stored as a heap:
/// node 1 is the root, the leaves are the last `leaves_` nodes and hold `leaf_size` triangles each.
class BoxTree {
 public:
  BoxTree(std::span<const Vec3> points, std::span<const Triangle> triangles) {
    const std::size_t n = triangles.size();
    boxes_.resize(n);
    TriangleBox all;
    for (std::size_t t = 0; t < n; ++t) {
      for (Index v : triangles[t]) boxes_[t].add(points[v]);
      all.add(boxes_[t]);
    }
    std::vector<std::pair<std::uint64_t, Index>> codes(n);
    constexpr double cells = 0x1p21 - 1;
    for (std::size_t t = 0; t < n; ++t) {
      std::uint64_t code = 0;
      for (int k = 0; k < 3; ++k) {
        // Halved first: the extent of huge coordinates would overflow.
        const double extent = 0.5 * all.high[k] - 0.5 * all.low[k];
        const double centre = 0.25 * boxes_[t].low[k] + 0.25 * boxes_[t].high[k] - 0.5 * all.low[k];
        const double at = extent > 0 ? std::clamp(centre / extent, 0.0, 1.0) : 0.0;
        code |= spread(static_cast<std::uint64_t>(at * cells)) << k;
      }
      codes[t] = {code, static_cast<Index>(t)};
    }
    std::sort(codes.begin(), codes.end());
    order_.resize(n);
    for (std::size_t i = 0; i < n; ++i) order_[i] = codes[i].second;

    leaves_ = std::bit_ceil(std::max<std::size_t>(1, (n + leaf_size - 1) / leaf_size));
    nodes_.resize(2 * leaves_);
    for (std::size_t i = 0; i < n; ++i) nodes_[leaves_ + i / leaf_size].add(boxes_[order_[i]]);
    for (std::size_t node = leaves_; node-- > 1;) {
      nodes_[node].add(nodes_[2 * node]);
      nodes_[node].add(nodes_[2 * node + 1]);
    }
  }

  std::size_t leaves() const { return leaves_; }

  std::span<const Index> leaf(std::size_t i) const {
    const std::size_t begin = std::min(order_.size(), i * leaf_size);
    return std::span(order_).subspan(begin, std::min(leaf_size, order_.size() - begin));
  }

  const TriangleBox& box(Index triangle) const { return boxes_[triangle]; }

  /// Calls `call(j)` for leaf `i` and each later leaf `j` whose box meets its own.
  template <class Call>
  void for_each_near_leaf(std::size_t i, const Call& call) const {
    const TriangleBox& own = nodes_[leaves_ + i];
    std::size_t stack[2 * 64];
    std::size_t size = 0;
    stack[size++] = 1;
    while (size > 0) {
      const std::size_t node = stack[--size];
      // The last leaf below a node: earlier ones have dealt with the pair themselves.
      const int height = std::countl_zero(node) - std::countl_zero(leaves_);
      if (((node + 1) << height) - 1 - leaves_ < i || !own.meets(nodes_[node])) continue;
      if (height == 0) {
        call(node - leaves_);
      } else {
        stack[size++] = 2 * node + 1;
        stack[size++] = 2 * node;
      }
    }
  }

 private:
  static constexpr std::size_t leaf_size = 4;
  std::vector<TriangleBox> boxes_;  ///< of the triangles
  std::vector<Index> order_;
  std::size_t leaves_ = 0;
  std::vector<TriangleBox> nodes_;
};

}  // namespace

std::vector<std::pair<Index, Index>> self_intersections(std::span<const Vec3> points,
                                                        std::span<const Triangle> triangles) {
  const BoxTree tree(points, triangles);
  const auto with_points = [&](Index t) {
    const Triangle& ids = triangles[t];
    return MeshTriangle{ids, {points[ids[0]], points[ids[1]], points[ids[2]]}};
  };
  constexpr std::size_t leaves_per_chunk = 256;
  const std::size_t chunks = (tree.leaves() + leaves_per_chunk - 1) / leaves_per_chunk;
  std::vector<std::vector<std::pair<Index, Index>>> found(chunks);
  parallel_chunks(chunks, [&](std::size_t chunk, unsigned) {
    const std::size_t last = std::min(tree.leaves(), (chunk + 1) * leaves_per_chunk);
    for (std::size_t i = chunk * leaves_per_chunk; i < last; ++i)
      tree.for_each_near_leaf(i, [&](std::size_t j) {
        for (Index f : tree.leaf(i))
          for (Index g : tree.leaf(j)) {
            // Within one leaf each pair comes twice.
            if ((i == j && f >= g) || !tree.box(f).meets(tree.box(g))) continue;
            if (triangles_intersect(with_points(f), with_points(g)))
              found[chunk].emplace_back(std::min(f, g), std::max(f, g));
          }
      });
  });
  std::vector<std::pair<Index, Index>> out;
  for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace tetwright
