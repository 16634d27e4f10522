// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/backtracking_displacement.h"

#include <algorithm>
#include <atomic>

#include "common/geometry/quality.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

constexpr std::size_t move_grain = 1024, moved_tet_grain = 1 << 13;

}  // namespace

void displace_with_backtracking(std::vector<Vec3>& points, const std::vector<Tet>& tets,
                                std::vector<PointMove>& moves, double min_tangent) {
  std::vector<Index> move_of(points.size(), no_index);
  for (std::size_t m = 0; m < moves.size(); ++m) move_of[moves[m].point] = static_cast<Index>(m);
  struct Affected {
    Index tet;
    double tangent;  ///< before any move
  };
  const auto tangent_of = [&](const Tet& t) {
    return min_solid_angle_tangent(points[t[0]], points[t[1]], points[t[2]], points[t[3]]);
  };
  const std::vector<Affected> affected = parallel_collect<Affected>(
      0, tets.size(), moved_tet_grain, [&](std::size_t begin, std::size_t end, std::vector<Affected>& out) {
        for (std::size_t t = begin; t < end; ++t)
          if (std::any_of(tets[t].begin(), tets[t].end(), [&](Index v) { return move_of[v] != no_index; }))
            out.push_back({static_cast<Index>(t), tangent_of(tets[t])});
      });
  for (bool again = true; again;) {
    parallel_for(0, moves.size(), move_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m)
        points[moves[m].point] = moves[m].from + moves[m].share() * moves[m].step;
    });
    std::vector<std::uint8_t> shorten(moves.size(), 0);
    parallel_for(0, affected.size(), moved_tet_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Tet& t = tets[affected[i].tet];
        if (tangent_of(t) >= std::min(min_tangent, affected[i].tangent)) continue;
        for (const Index v : t)
          if (move_of[v] != no_index)
            std::atomic_ref<std::uint8_t>(shorten[move_of[v]]).store(1, std::memory_order_relaxed);
      }
    });
    again = false;
    for (std::size_t m = 0; m < moves.size(); ++m)
      if (shorten[m] && moves[m].halvings <= PointMove::max_halvings) ++moves[m].halvings, again = true;
  }
}

void keep_remaining(const std::vector<Vec3>& points, std::vector<PointMove>& moves) {
  parallel_for(0, moves.size(), move_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) {
      PointMove& move = moves[m];
      move.step *= 1 - move.share();
      move.from = points[move.point];
      move.halvings = 0;
    }
  });
  std::erase_if(moves, [](const PointMove& m) { return m.step.isZero(0); });
}

}  // namespace tetwright
