#pragma once

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "common/parallel_sort.h"
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
      : stars_(lattice.stars), reserved_(lattice.stars.points().size(), free_) {
    const std::vector<Index>& points = stars_.points();
    starts_.assign(points.size() + 1, 0);
    stars_by_slot_ = parallel_collect<Index>(
        0, points.size(), 1024, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
          for (std::size_t i = begin; i < end; ++i) {
            const std::size_t first = out.size();
            for (Index t : stars_.tets(points[i]))
              for (Index q : lattice.tets[t])
                if (const Index s = stars_.slot(q);
                    s != no_index &&
                    std::find(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), s) == out.end())
                  out.push_back(s);
            starts_[i + 1] = out.size() - first;
          }
        });
    for (std::size_t i = 0; i < points.size(); ++i) starts_[i + 1] += starts_[i];
  }

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
    const auto for_stars = [&](Index block, auto&& visit) {
      for (std::size_t i = starts[block]; i < starts[block + 1]; ++i) {
        const Index slot = stars_.slot(points[i]);
        for (std::size_t k = starts_[slot]; k < starts_[slot + 1]; ++k) visit(reserved_[stars_by_slot_[k]]);
      }
    };
    std::vector<Index> waiting, winners, losers;
    std::vector<std::uint8_t> wins;
    const auto for_waiting = [&](auto&& work) {
      parallel_for(0, waiting.size(), 4 * grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) work(i);
      });
    };
    for (std::size_t next = 0, done = 0; done < blocks;) {
      while (waiting.size() < most && next < blocks) waiting.push_back(static_cast<Index>(next++));
      for_waiting([&](std::size_t i) {
        for_stars(waiting[i], [&](std::uint32_t& slot) {
          // The smallest number wins, in whatever order they come; relaxed, read after the loop.
          std::atomic_ref<std::uint32_t> holder(slot);
          std::uint32_t held = holder.load(std::memory_order_relaxed);
          while (waiting[i] < held &&
                 !holder.compare_exchange_weak(held, waiting[i], std::memory_order_relaxed)) {
          }
        });
      });
      wins.assign(waiting.size(), 0);
      for_waiting([&](std::size_t i) {
        bool all = true;
        for_stars(waiting[i], [&](std::uint32_t& slot) { all &= slot == waiting[i]; });
        wins[i] = all;
      });
      for_waiting([&](std::size_t i) {
        for_stars(waiting[i], [&](std::uint32_t& slot) {
          std::atomic_ref<std::uint32_t>(slot).store(free_, std::memory_order_relaxed);
        });
      });
      winners.clear();
      losers.clear();
      for (std::size_t i = 0; i < waiting.size(); ++i) (wins[i] ? winners : losers).push_back(waiting[i]);
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

  const StarMap& stars_;
  std::vector<std::uint32_t> reserved_;  ///< by slot, the block that holds the point
  /// The closed star of each near point, as far as it is near: rows of slots.
  std::vector<std::size_t> starts_;
  std::vector<Index> stars_by_slot_;
};

}  // namespace tetwright
