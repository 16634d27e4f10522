// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <utility>
#include <vector>

#include "mesher/lattice/labelled_lattice.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

/// Processes groups of lattice points in parallel, with the result of processing them one after another in
/// the given order, by deterministic reservations (Blelloch et al. 2012, "Internally deterministic parallel
/// algorithms can be fast").
///
/// Each group reserves the closed stars of its points. If the stars of two groups share a point, the later
/// group waits for a later round, so the result does not depend on the number of threads. Grouping
/// neighbouring points saves most of the cost of cache misses.
class IndependentRounds {
 public:
  explicit IndependentRounds(const LabelledLattice& lattice)
      : lattice_(lattice), reserved_(lattice.stars.points().size(), free_) {}

  /// Calls `body(groups)` concurrently with lists of groups, and `between_rounds(done)` after each round with
  /// the number of groups processed so far. `body` may write data of the groups' points, and read data of
  /// points one edge away, or two edges away across a point near an interface.
  /// \param points points near interfaces, without repetitions
  /// \param starts group g consists of points [starts[g], starts[g + 1])
  template <class Body, class BetweenRounds>
  void run(std::span<const Index> points, std::span<const std::size_t> starts, Body&& body,
           BetweenRounds&& between_rounds) {
    const std::size_t groups = starts.size() - 1,
                      max_round = std::max(CutTuning::Rounds::min_groups, groups / CutTuning::Rounds::wanted);
    struct Group {
      Index number;
      std::vector<Index> slots;  ///< the points near interfaces in its closed stars
    };
    std::vector<Group> waiting, losers;
    std::vector<Index> winners;
    std::vector<std::uint8_t> wins;
    const auto for_waiting = [&](auto&& work) {
      parallel_for(0, waiting.size(), 4 * CutTuning::Rounds::grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) work(i);
      });
    };
    for (std::size_t next = 0, done = 0; done < groups;) {
      while (waiting.size() < max_round && next < groups) waiting.push_back({static_cast<Index>(next++), {}});
      for_waiting([&](std::size_t i) {
        Group& group = waiting[i];
        if (group.slots.empty())
          group.slots = slots_around(points.subspan(
              starts[group.number], starts[group.number + std::size_t{1}] - starts[group.number]));
        for (Index slot : group.slots) {
          // The smallest number wins in any order of arrival. Relaxed: results are read only after the loop.
          std::atomic_ref<std::uint32_t> holder(reserved_[slot]);
          std::uint32_t held = holder.load(std::memory_order_relaxed);
          while (group.number < held &&
                 !holder.compare_exchange_weak(held, group.number, std::memory_order_relaxed)) {
          }
        }
      });
      wins.assign(waiting.size(), 0);
      for_waiting([&](std::size_t i) {
        const Group& group = waiting[i];
        wins[i] = std::all_of(group.slots.begin(), group.slots.end(),
                              [&](Index slot) { return reserved_[slot] == group.number; });
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
      parallel_for(0, winners.size(), CutTuning::Rounds::grain, [&](std::size_t begin, std::size_t end) {
        body(std::span<const Index>(winners).subspan(begin, end - begin));
      });
      done += winners.size();
      waiting.swap(losers);
      between_rounds(done);
    }
  }

 private:
  static constexpr std::uint32_t free_ = ~std::uint32_t{0};

  /// The slots of the points in the closed stars of `points`, with few repetitions.
  std::vector<Index> slots_around(std::span<const Index> points) const {
    std::vector<Index> slots;
    // Most points are in many of the tets. A small table of those seen last drops nearly all repetitions;
    // others do no harm.
    std::array<Index, CutTuning::Rounds::seen_slots> seen;
    seen.fill(no_index);
    for (Index p : points)
      for (Index t : lattice_.stars.tets(p))
        for (Index q : lattice_.tets[t])
          if (const Index s = lattice_.stars.slot(q);
              s != no_index && std::exchange(seen[s % seen.size()], s) != s)
            slots.push_back(s);
    return slots;
  }

  const LabelledLattice& lattice_;
  std::vector<std::uint32_t> reserved_;  ///< by slot: the group that holds the point
};

}  // namespace tetwright
