// SPDX-License-Identifier: Apache-2.0
#include "tools/parts/part_balance.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "common/mesh/disjoint_sets.h"

namespace tetwright {

namespace {

class PartBalancer {
 public:
  PartBalancer(const TetNeighbours& neighbours, std::size_t most, TetPartition& partition)
      : neighbours_(neighbours),
        most_(most),
        part_of_(partition.part_of),
        members_(partition.parts),
        slots_(part_of_.size()),
        before_(partition.parts, partition.parts) {
    for (Index t = 0; t < part_of_.size(); ++t) add(t, part_of_[t]);
    for (PartNumber part = 0; part < partition.parts; ++part) by_size_.emplace(size(part), part);
  }

  void balance() {
    fill_empty_parts();
    for (;;) {
      const PartNumber from = largest();
      if (size(from) <= most_) return;
      const std::vector<PartNumber> chain = chain_to_room(from);
      if (chain.empty() || !shift(chain)) move_anywhere(from);
    }
  }

 private:
  /// Larger parts first, then lower numbers.
  struct LargerFirst {
    bool operator()(const std::pair<std::size_t, PartNumber>& a,
                    const std::pair<std::size_t, PartNumber>& b) const {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    }
  };

  std::size_t size(PartNumber part) const { return members_[part].size(); }
  PartNumber largest() const { return by_size_.begin()->second; }
  PartNumber smallest() const {
    return by_size_.lower_bound(std::pair(by_size_.rbegin()->first, PartNumber{0}))->second;
  }

  void add(Index tet, PartNumber to) {
    part_of_[tet] = to;
    slots_[tet] = static_cast<Index>(members_[to].size());
    members_[to].push_back(tet);
  }
  void move(Index tet, PartNumber to) {
    const PartNumber from = part_of_[tet];
    by_size_.erase({size(from), from});
    by_size_.erase({size(to), to});
    const Index last = members_[from].back();
    members_[from][slots_[tet]] = last;
    slots_[last] = slots_[tet];
    members_[from].pop_back();
    add(tet, to);
    by_size_.emplace(size(from), from);
    by_size_.emplace(size(to), to);
  }

  void fill_empty_parts() {
    for (PartNumber part = 0; part < members_.size(); ++part)
      if (members_[part].empty()) {
        const std::vector<Index>& tets = members_[largest()];
        move(*std::min_element(tets.begin(), tets.end()), part);
      }
  }

  /// Moves the surplus of a part to those with room, from its end.
  void move_anywhere(PartNumber from) {
    std::vector<Index> tets = members_[from];
    std::sort(tets.begin(), tets.end());
    for (; size(from) > most_; tets.pop_back()) move(tets.back(), smallest());
  }

  /// Parts beside another one, in ascending order.
  std::vector<PartNumber> parts_next_to(PartNumber part) const {
    std::vector<PartNumber> parts;
    for (const Index t : members_[part])
      for (const Index other : neighbours_[t])
        if (other != no_index && part_of_[other] != part) parts.push_back(part_of_[other]);
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    return parts;
  }

  /// Parts from one that has too many to the nearest that has room, each next to the one before; empty if
  /// there is none.
  std::vector<PartNumber> chain_to_room(PartNumber from) {
    const auto none = static_cast<PartNumber>(members_.size());
    std::vector<PartNumber> reached{from}, chain;
    before_[from] = from;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      PartNumber part = reached[i];
      if (size(part) < most_) {
        chain.push_back(part);
        for (; part != from; part = before_[part]) chain.push_back(before_[part]);
        std::reverse(chain.begin(), chain.end());
        break;
      }
      for (const PartNumber next : parts_next_to(part))
        if (before_[next] == none) {
          before_[next] = part;
          reached.push_back(next);
        }
    }
    for (const PartNumber part : reached) before_[part] = none;
    return chain;
  }

  /// Moves tets along a chain, the last step first, so that no part on it becomes larger than it was.
  /// \return false if the first part keeps its tets
  bool shift(const std::vector<PartNumber>& chain) {
    std::size_t amount = std::min(size(chain.front()) - most_, most_ - size(chain.back()));
    for (std::size_t step = chain.size() - 1; step-- > 0;)
      amount = move_next_to(chain[step], chain[step + 1], amount);
    return amount > 0;
  }

  /// Moves up to `amount` tets of a part that have a neighbour in another one, those first that are held
  /// least by their own part. \return the number of tets moved
  std::size_t move_next_to(PartNumber from, PartNumber to, std::size_t amount) {
    std::vector<std::pair<int, Index>> candidates;  // faces inside its part minus those to the other, tet
    for (const Index t : members_[from]) {
      int inside = 0, across = 0;
      for (const Index other : neighbours_[t])
        if (other != no_index) {
          inside += part_of_[other] == from;
          across += part_of_[other] == to;
        }
      if (across > 0) candidates.emplace_back(inside - across, t);
    }
    amount = std::min({amount, candidates.size(), size(from) - 1});
    std::sort(candidates.begin(), candidates.end());
    for (std::size_t i = 0; i < amount; ++i) move(candidates[i].second, to);
    return amount;
  }

  const TetNeighbours& neighbours_;
  std::size_t most_;
  std::vector<PartNumber>& part_of_;
  std::vector<std::vector<Index>> members_;  ///< tets of each part, in no particular order
  std::vector<Index> slots_;                 ///< of each tet among the members of its part
  std::set<std::pair<std::size_t, PartNumber>, LargerFirst> by_size_;
  /// Part before each on the way from the first one, in chain_to_room(); elsewhere the number of parts.
  std::vector<PartNumber> before_;
};

/// Pieces of parts, by the smallest tet of each.
struct PartPieces {
  PartPieces(const TetNeighbours& neighbours, const TetPartition& partition)
      : sets(neighbours.size()), sizes(neighbours.size(), 0), largest(partition.parts, no_index) {
    for (Index t = 0; t < neighbours.size(); ++t)
      for (const Index other : neighbours[t])
        if (other != no_index && partition.of(t) == partition.of(other)) sets.unite(t, other);
    for (Index t = 0; t < neighbours.size(); ++t) ++sizes[sets.root(t)];
    for (Index t = 0; t < neighbours.size(); ++t) {
      Index& known = largest[partition.of(t)];
      if (sets.is_root(t) && (known == no_index || sizes[t] > sizes[known])) known = t;
    }
  }
  DisjointSets sets;
  std::vector<std::size_t> sizes;  ///< at the first tet of each piece
  std::vector<Index> largest;      ///< piece of each part
};

/// Moves the smaller pieces of all parts once.
/// \return the number of pieces moved
std::size_t move_small_pieces(const TetNeighbours& neighbours, std::size_t most, TetPartition& partition) {
  PartPieces pieces(neighbours, partition);
  std::vector<std::size_t> part_sizes(partition.parts, 0);
  for (const PartNumber part : partition.part_of) ++part_sizes[part];
  std::vector<std::pair<Index, Index>> small;  // piece, tet
  for (Index t = 0; t < neighbours.size(); ++t)
    if (const Index piece = pieces.sets.root(t); piece != pieces.largest[partition.of(t)])
      small.emplace_back(piece, t);
  std::sort(small.begin(), small.end());
  std::size_t moved = 0;
  std::vector<PartNumber> across;
  for (std::size_t begin = 0, end = 0; begin < small.size(); begin = end) {
    const PartNumber own = partition.of(small[begin].second);
    across.clear();
    for (; end < small.size() && small[end].first == small[begin].first; ++end)
      for (const Index other : neighbours[small[end].second])
        if (other != no_index && partition.of(other) != own) across.push_back(partition.of(other));
    std::sort(across.begin(), across.end());
    PartNumber best = own;
    std::size_t faces = 0;
    for (std::size_t i = 0, j = 0; i < across.size(); i = j) {
      while (j < across.size() && across[j] == across[i]) ++j;
      if (j - i <= faces || part_sizes[across[i]] + (end - begin) > most) continue;
      faces = j - i;
      best = across[i];
    }
    if (best == own) continue;
    for (std::size_t i = begin; i < end; ++i) partition.part_of[small[i].second] = best;
    part_sizes[own] -= end - begin;
    part_sizes[best] += end - begin;
    ++moved;
  }
  return moved;
}

}  // namespace

void smooth_parts(const TetNeighbours& neighbours, std::size_t most, TetPartition& partition) {
  constexpr int max_rounds = 20;
  std::vector<std::size_t> sizes(partition.parts, 0);
  for (const PartNumber part : partition.part_of) ++sizes[part];
  bool moved = true;
  for (int round = 0; moved && round < max_rounds; ++round) {
    moved = false;
    for (Index t = 0; t < neighbours.size(); ++t) {
      const PartNumber own = partition.part_of[t];
      const auto faces_to = [&](PartNumber part) {
        return std::count_if(neighbours[t].begin(), neighbours[t].end(), [&](Index other) {
          return other != no_index && partition.part_of[other] == part;
        });
      };
      PartNumber best = own;
      auto faces = faces_to(own);
      for (const Index other : neighbours[t]) {
        if (other == no_index) continue;
        const PartNumber part = partition.part_of[other];
        if (part == own || part == best || sizes[part] >= most || sizes[own] == 1) continue;
        if (const auto shared = faces_to(part); shared > faces) {
          faces = shared;
          best = part;
        }
      }
      if (best == own) continue;
      --sizes[own];
      ++sizes[best];
      partition.part_of[t] = best;
      moved = true;
    }
  }
}

void connect_parts(const TetNeighbours& neighbours, std::size_t most, TetPartition& partition) {
  // A piece may be moved to a piece that is moved itself.
  constexpr int max_rounds = 4;
  for (int round = 0; round < max_rounds; ++round)
    if (move_small_pieces(neighbours, most, partition) == 0) return;
}

void balance_parts(const TetNeighbours& neighbours, std::size_t most, TetPartition& partition) {
  PartBalancer(neighbours, most, partition).balance();
}

}  // namespace tetwright
