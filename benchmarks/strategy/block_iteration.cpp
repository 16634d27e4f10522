// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "benchmarks/strategy/orderings.h"
#include "simplify/schedule/block_runner.h"

namespace tetwright {

namespace {

constexpr double percent_step = 10;
constexpr int iteration_limit = 200;
constexpr int max_idle = 5;  ///< maximum number of consecutive iterations that remove hardly any tets

/// Quality^3 below which `percent` of the tets lie.
float cutoff(const EditableMesh& mesh, double percent) {
  std::vector<float> qualities;
  for (Index t = 0; t < mesh.tet_slots(); ++t)
    if (!mesh.dead(t)) qualities.push_back(mesh.quality(t));
  const auto k = static_cast<std::size_t>(percent / 100 * static_cast<double>(qualities.size()));
  if (k >= qualities.size()) return 1;
  std::nth_element(qualities.begin(), qualities.begin() + static_cast<std::ptrdiff_t>(k), qualities.end());
  return qualities[k];
}

std::vector<TetSnapshot> bad_tets(const EditableMesh& mesh, float limit) {
  std::vector<TetSnapshot> list;
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.dead(t) && mesh.quality(t) <= limit) list.push_back({t, mesh.points(t)});
  }
  return list;
}

void sort_by_weight(std::vector<WeighedCollapse>& candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const WeighedCollapse& a, const WeighedCollapse& b) {
    return a.weight != b.weight   ? a.weight < b.weight
           : a.origin != b.origin ? a.origin < b.origin
                                  : a.target < b.target;
  });
}

/// The loop common to both kinds of blocks. `block(limit)` processes the tets below the limit,
/// `grow(removed)` updates E.
template <class Block, class Grow>
void iterate(Workpiece& piece, const Block& block, const Grow& grow) {
  double percent = percent_step;
  int idle = 0;
  for (int i = 0; i < iteration_limit && !piece.reached() && idle < max_idle; ++i) {
    const auto before = static_cast<double>(piece.mesh.live_tets());
    block(cutoff(piece.mesh, percent));
    const double removed = 1 - static_cast<double>(piece.mesh.live_tets()) / before;
    grow(removed);
    idle = removed < 0.001 && percent >= 100 ? idle + 1 : 0;
    percent = std::min(100.0, percent + percent_step);
  }
}

}  // namespace

void block_of_tets(Workpiece& piece, std::uint64_t seed) {
  VolumeLedger ledger;
  BlockRunner runner(piece.mesh, piece.grid, ledger, seed, 0, nullptr);
  double& error = piece.rules.error.max.emplace(piece.rules.objective.quality.ideal_edge);
  std::vector<WeighedCollapse> candidates;
  const auto block = [&](float limit) {
    runner.tets(
        bad_tets(piece.mesh, limit),
        [&](Workspace& ws, const TetSnapshot& item, int) {
          if (!exists(piece.mesh, item) || piece.mesh.quality(item.tet) > limit) return Outcome::stale;
          candidates.clear();
          const auto of_the_tet = [&](Index p) {
            return std::find(item.points.begin(), item.points.end(), p) != item.points.end();
          };
          for (const Index p : item.points)
            if (piece.gather(ws, p)) piece.weigh(ws, candidates, of_the_tet);
          sort_by_weight(candidates);
          for (const WeighedCollapse& c : candidates) {
            if (c.weight > error) break;
            if (piece.gather(ws, c.origin) && piece.propose(ws, c.target)) return Outcome::done;
          }
          return Outcome::no_candidate;
        },
        [&] { return piece.reached(); });
    piece.counts.collapses += runner.take_totals().counts.of(Operation::collapse, Outcome::done);
  };
  iterate(piece, block, [&](double) {
    error *= std::cbrt(static_cast<double>(piece.mesh.live_tets()) / static_cast<double>(piece.target));
  });
}

void block_of_points(Workpiece& piece, std::uint64_t seed) {
  constexpr std::size_t max_targets = 4;
  VolumeLedger ledger;
  BlockRunner runner(piece.mesh, piece.grid, ledger, seed, 0, nullptr);
  double& error = piece.rules.error.max.emplace(4 * piece.rules.objective.quality.ideal_edge);
  std::vector<WeighedCollapse> candidates;
  const auto block = [&](float limit) {
    std::vector<Index> points;
    for (const TetSnapshot& t : bad_tets(piece.mesh, limit))
      points.insert(points.end(), t.points.begin(), t.points.end());
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    runner.points(
        points,
        [&](Workspace& ws, Index p) {
          if (!piece.gather(ws, p)) return Outcome::stale;
          candidates.clear();
          piece.weigh(ws, candidates);
          sort_by_weight(candidates);
          for (std::size_t i = 0; i < std::min(max_targets, candidates.size()); ++i) {
            if (candidates[i].weight > error) break;
            if (piece.propose(ws, candidates[i].target)) return Outcome::done;
          }
          return Outcome::no_candidate;
        },
        [&] { return piece.reached(); });
    piece.counts.collapses += runner.take_totals().counts.of(Operation::collapse, Outcome::done);
  };
  iterate(piece, block, [&](double removed) {
    if (removed < 0.15) error *= 1.3;
  });
}

}  // namespace tetwright
