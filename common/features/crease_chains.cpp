// SPDX-License-Identifier: Apache-2.0
#include "common/features/crease_chains.h"

#include <algorithm>
#include <utility>

#include "common/features/crease_pieces.h"

namespace tetwright {

namespace {

/// Follows sharp edges from point to point.
class ChainWalker {
 public:
  ChainWalker(std::size_t point_count, const std::vector<SharpEdge>& edges)
      : edges_(edges), at_(point_count), walked_(edges.size(), 0) {
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (const Index p : edges[e].ends) {
        AtPoint& at = at_[p];
        if (at.count < 2) at.edges[at.count] = static_cast<Index>(e);
        if (at.count < 3) ++at.count;
      }
  }

  bool is_walked(Index e) const { return walked_[e]; }
  bool ends_at(Index p) const {
    const AtPoint& at = at_[p];
    return at.count != 2 || edges_[at.edges[0]].fate != edges_[at.edges[1]].fate;
  }
  /// Calls visit(edge, its farther end) for `first`, from its end `from` on, and for each edge that continues
  /// it.
  template <class Visit>
  void walk(Index first, Index from, const Visit& visit) {
    for (Index e = first, p = from; !walked_[e];) {
      walked_[e] = 1;
      p = edges_[e].ends[0] == p ? edges_[e].ends[1] : edges_[e].ends[0];
      visit(e, p);
      if (ends_at(p)) return;
      e = at_[p].edges[0] == e ? at_[p].edges[1] : at_[p].edges[0];
    }
  }

 private:
  struct AtPoint {
    std::array<Index, 2> edges{};  ///< the first two
    std::uint8_t count = 0;        ///< at most 3
  };
  const std::vector<SharpEdge>& edges_;
  std::vector<AtPoint> at_;
  std::vector<std::uint8_t> walked_;
};

/// A chain as a range of the points in the order in which they were visited.
struct WalkedChain {
  std::size_t first, last;  ///< inclusive
  double length = 0, turn_by_length = 0;
  CreaseChain::Fate fate;
};

Vec3 middle_of(std::span<const Vec3> points, std::span<const Index> line, double length) {
  double left = length / 2;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec3 &a = points[line[i]], &b = points[line[i + 1]];
    const double step = (b - a).norm();
    if (step > 0 && left <= step) return a + (b - a) * (left / step);
    left -= step;
  }
  return points[line.back()];
}

}  // namespace

std::size_t CreaseChains::count() const {
  std::size_t all = 0;
  for (const Total& t : totals) all += t.count;
  return all;
}

std::vector<InnerEdge> edges_between_groups(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                            const std::vector<EdgeUse>& uses) {
  const auto differ = [](const EdgeUse& x, const EdgeUse& y) { return x.key == y.key && x.group != y.group; };
  if (std::adjacent_find(uses.begin(), uses.end(), differ) == uses.end()) return {};
  std::vector<std::uint32_t> groups(triangles.size());
  std::vector<EdgeUse> ungrouped = uses;
  for (EdgeUse& use : ungrouped) {
    groups[use.triangle] = use.group;
    use.group = 0;
  }
  std::vector<InnerEdge> edges = inner_edges(points, triangles, ungrouped);
  std::erase_if(edges, [&](const InnerEdge& e) { return groups[e.triangles[0]] == groups[e.triangles[1]]; });
  return edges;
}

void give_up_edges(std::vector<Vec3>& points, std::vector<SharpEdge>& edges, double piece,
                   const std::function<bool(const Vec3&)>& is_given_up) {
  std::vector<SharpEdge> divided;
  for (const SharpEdge& e : edges) {
    if (e.fate != CreaseChain::Fate::kept) {
      divided.push_back(e);
      continue;
    }
    const Vec3 a = points[e.ends[0]], b = points[e.ends[1]];
    Index from = e.ends[0];
    for_each_run(
        a, b, piece, [&](const Vec3& p, const Vec3& q) { return is_given_up(p) || is_given_up(q); },
        [&](const Vec3& p, const Vec3& q, bool lost) {
          const bool is_last = q == b;
          const Index to = is_last ? e.ends[1] : static_cast<Index>(points.size());
          if (!is_last) points.push_back(q);
          divided.push_back(
              {{from, to}, (q - p).norm(), e.turn, lost ? CreaseChain::Fate::given_up : e.fate});
          from = to;
        });
  }
  edges = std::move(divided);
}

CreaseChains chains_of(std::span<const Vec3> points, const std::vector<SharpEdge>& edges) {
  CreaseChains result;
  if (edges.empty()) return result;
  ChainWalker walker(points.size(), edges);
  std::vector<Index> order;
  std::vector<WalkedChain> chains;
  order.reserve(2 * edges.size());
  const auto add_chain = [&](Index first, Index from) {
    WalkedChain chain{order.size(), 0, 0, 0, edges[first].fate};
    order.push_back(from);
    walker.walk(first, from, [&](Index e, Index p) {
      chain.length += edges[e].length;
      chain.turn_by_length += edges[e].turn * edges[e].length;
      order.push_back(p);
    });
    chain.last = order.size() - 1;
    chains.push_back(chain);
    CreaseChains::Total& total = result.totals[static_cast<std::size_t>(chain.fate)];
    ++total.count;
    total.length += chain.length;
  };
  for (Index e = 0; e < edges.size(); ++e)
    for (const Index end : edges[e].ends)
      if (!walker.is_walked(e) && walker.ends_at(end)) add_chain(e, end);
  // Only closed chains are left.
  for (Index e = 0; e < edges.size(); ++e)
    if (!walker.is_walked(e)) add_chain(e, edges[e].ends[0]);

  const auto listed =
      chains.begin() + static_cast<std::ptrdiff_t>(std::min(chains.size(), CreaseChains::max_listed));
  std::partial_sort(chains.begin(), listed, chains.end(), [](const WalkedChain& x, const WalkedChain& y) {
    return x.length != y.length ? x.length > y.length : x.first < y.first;
  });
  for (auto chain = chains.begin(); chain != listed; ++chain) {
    const std::span<const Index> line(&order[chain->first], chain->last - chain->first + 1);
    CreaseChain& added = result.longest.emplace_back();
    added.fate = chain->fate;
    added.length = chain->length;
    added.turn = chain->length > 0 ? chain->turn_by_length / chain->length : 0;
    added.middle = middle_of(points, line, chain->length);
    if (added.is_kept())
      for (const Index p : line) added.line.push_back(points[p]);
  }
  return result;
}

}  // namespace tetwright
