#pragma once

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "common/parallel.h"
#include "mesher/labelled_lattice.h"

namespace tetwright {

/// Works on blocks of points of a lattice as if one block after the other in the order given, but on several
/// threads: deterministic reservations (Blelloch et al. 2012, "Internally deterministic parallel algorithms
/// can be fast"). A block reserves the closed stars of its points; of two that share a point of their stars
/// the earlier one goes first and the later one waits for a later round, so the outcome is the same for any
/// number of threads. Blocks of near points save most of the time that memory takes.
class IndependentRounds {
 public:
  explicit IndependentRounds(const LabelledLattice& lattice)
      : lattice_(lattice), reserved_(lattice.stars.points().size(), free_) {}

  /// Block b has the points [starts[b], starts[b + 1]) of the list. Calls `body(blocks)`, concurrently, with
  /// lists of blocks; it may write what belongs to their points, and read what belongs to points one edge
  /// away, and two edges away by way of a point near an interface. The points are near interfaces, each there
  /// once. After each round `between_rounds(done)` with the number of blocks done so far.
  template <class Body, class BetweenRounds>
  void run(std::span<const Index> points, std::span<const std::size_t> starts, Body&& body,
           BetweenRounds&& between_rounds) {
    // Many enough to be worth a parallel loop, few enough that most do not meet.
    constexpr std::size_t smallest_round = 128, rounds_wanted = 48, grain = 4;
    const std::size_t blocks = starts.size() - 1, most = std::max(smallest_round, blocks / rounds_wanted);
    struct Block {
      Index number;
      std::vector<Index> slots;  ///< of the points of its closed stars, as far as those are near
    };
    std::vector<Block> waiting, losers;
    std::vector<Index> winners;
    std::vector<std::uint8_t> wins;
    const auto for_waiting = [&](auto&& work) {
      parallel_for(0, waiting.size(), 4 * grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) work(i);
      });
    };
    for (std::size_t next = 0, done = 0; done < blocks;) {
      while (waiting.size() < most && next < blocks) waiting.push_back({static_cast<Index>(next++), {}});
      for_waiting([&](std::size_t i) {
        Block& block = waiting[i];
        if (block.slots.empty())
          block.slots = slots_around(points.subspan(
              starts[block.number], starts[block.number + std::size_t{1}] - starts[block.number]));
        for (Index slot : block.slots) {
          // The smallest number wins, in whatever order they come; relaxed, read after the loop.
          std::atomic_ref<std::uint32_t> holder(reserved_[slot]);
          std::uint32_t held = holder.load(std::memory_order_relaxed);
          while (block.number < held &&
                 !holder.compare_exchange_weak(held, block.number, std::memory_order_relaxed)) {
          }
        }
      });
      wins.assign(waiting.size(), 0);
      for_waiting([&](std::size_t i) {
        const Block& block = waiting[i];
        wins[i] = std::all_of(block.slots.begin(), block.slots.end(),
                              [&](Index slot) { return reserved_[slot] == block.number; });
      });
      for_waiting([&](std::size_t i) {
        for (Index slot : waiting[i].slots)
          std::atomic_ref<std::uint32_t>(reserved_[slot]).store(free_, std::memory_order_relaxed);
      });
      winners.clear();
      losers.clear();
      for (std::size_t i = 0; i < waiting.size(); ++i)
        if (wins[i])
          winners.push_back(waiting[i].number);
        else
          losers.push_back(std::move(waiting[i]));
      parallel_for(0, winners.size(), grain, [&](std::size_t begin, std::size_t end) {
        body(std::span<const Index>(winners).subspan(begin, end - begin));
      });
      done += winners.size();
      waiting.swap(losers);
      between_rounds(done);
    }
  }

 private:
  static constexpr std::uint32_t free_ = ~std::uint32_t{0};

  /// The slots of the points in the closed stars of some points, each once.
  std::vector<Index> slots_around(std::span<const Index> points) const {
    std::vector<Index> slots;
    for (Index p : points)
      for (Index t : lattice_.stars.tets(p))
        for (Index q : lattice_.tets[t])
          if (const Index s = lattice_.stars.slot(q); s != no_index) slots.push_back(s);
    std::sort(slots.begin(), slots.end());
    return {slots.begin(), std::unique(slots.begin(), slots.end())};
  }

  const LabelledLattice& lattice_;
  std::vector<std::uint32_t> reserved_;  ///< by slot, the block that holds the point
};

}  // namespace tetwright
