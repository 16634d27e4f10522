#include "mesher/cut/wall_restoring.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "common/geometry/quality.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

constexpr std::size_t point_grain = 1024, tet_grain = 1 << 13;
/// A wall counts as restored within this share of its thickness.
constexpr double restored_share = 0.1;
/// Of moves that would spoil a tet half is tried, then a quarter, ...; then none.
constexpr std::uint8_t max_halvings = 4;
/// What is left after a pass is tried again, since the neighbours have moved, too.
constexpr int passes = 3;
/// tan(0.1 sr / 2).
constexpr double min_tangent = 0.05004170837553879;

/// Lattice units: half of what is thickened at most, and as much for a point that was moved on from there.
constexpr double max_step = 1.25;

struct Move {
  Index point;
  Vec3 from, step;
  std::uint8_t halvings = 0;

  double share() const { return halvings > max_halvings ? 0.0 : std::ldexp(1, -halvings); }
};

/// The moves of the points that a thickened wall has displaced.
std::vector<Move> find_moves(const CutMesh& mesh, const MaterialField& field, const MaterialField& as_is) {
  return parallel_collect<Move>(
      0, mesh.points.size(), point_grain, [&](std::size_t begin, std::size_t end, std::vector<Move>& out) {
        const std::unique_ptr<FieldSampler> owned = as_is.sampler();
        for (std::size_t p = begin; p < end; ++p) {
          if (!mesh.on_interface[p] || !field.changes_walls(mesh.points[p])) continue;
          const std::optional<RegionSet> both = owned->two_nearest(mesh.points[p]);
          if (!both) continue;
          Vec3 gradient;
          const double off = owned->between((*both)[0], (*both)[1], mesh.points[p], gradient);
          const double slope = gradient.squaredNorm();
          // No wall was thickened by more; a longer step comes from where distances have no slope.
          if (!(std::abs(off) < max_step * std::sqrt(slope))) continue;
          out.push_back({static_cast<Index>(p), mesh.points[p], -gradient * (off / slope)});
        }
      });
}

/// Moves all points at once; moves at a tet that they spoil are shortened together, until none is spoilt.
void move_together(CutMesh& mesh, std::vector<Move>& moves) {
  std::vector<Index> move_of(mesh.points.size(), no_index);
  for (std::size_t m = 0; m < moves.size(); ++m) move_of[moves[m].point] = static_cast<Index>(m);
  struct Affected {
    Index tet;
    double tangent;  ///< before any move
  };
  const auto tangent_of = [&](const Tet& t) {
    return min_solid_angle_tangent(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]],
                                   mesh.points[t[3]]);
  };
  const std::vector<Affected> tets = parallel_collect<Affected>(
      0, mesh.tets.size(), tet_grain, [&](std::size_t begin, std::size_t end, std::vector<Affected>& out) {
        for (std::size_t t = begin; t < end; ++t)
          if (std::any_of(mesh.tets[t].begin(), mesh.tets[t].end(),
                          [&](Index v) { return move_of[v] != no_index; }))
            out.push_back({static_cast<Index>(t), tangent_of(mesh.tets[t])});
      });
  for (bool again = true; again;) {
    parallel_for(0, moves.size(), point_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m)
        mesh.points[moves[m].point] = moves[m].from + moves[m].share() * moves[m].step;
    });
    std::vector<std::uint8_t> shorten(moves.size(), 0);
    parallel_for(0, tets.size(), tet_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Tet& t = mesh.tets[tets[i].tet];
        if (tangent_of(t) >= std::min(min_tangent, tets[i].tangent)) continue;
        for (const Index v : t)
          if (move_of[v] != no_index)
            std::atomic_ref<std::uint8_t>(shorten[move_of[v]]).store(1, std::memory_order_relaxed);
      }
    });
    again = false;
    for (std::size_t m = 0; m < moves.size(); ++m)
      if (shorten[m] && moves[m].halvings <= max_halvings) ++moves[m].halvings, again = true;
  }
}

}  // namespace

ThickenedWalls restore_walls(CutMesh& mesh, const MaterialField& field, const MaterialField& as_is) {
  ThickenedWalls left;
  std::vector<Move> moves = find_moves(mesh, field, as_is);
  for (int pass = 0; pass < passes && !moves.empty(); ++pass) {
    move_together(mesh, moves);
    // Where a point has arrived its neighbours may have more room.
    parallel_for(0, moves.size(), point_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m) {
        Move& move = moves[m];
        move.step *= 1 - move.share();
        move.from = mesh.points[move.point];
        move.halvings = 0;
      }
    });
    std::erase_if(moves, [](const Move& m) { return m.step.isZero(0); });
  }
  struct Off {
    double offset, thickness;
    Vec3 place;
  };
  const std::vector<Off> off = parallel_collect<Off>(
      0, moves.size(), point_grain, [&](std::size_t begin, std::size_t end, std::vector<Off>& out) {
        for (std::size_t m = begin; m < end; ++m) {
          const double offset = moves[m].step.norm(), thickness = field.parallel_thickness(moves[m].from);
          if (2 * offset > restored_share * thickness) out.push_back({offset, thickness, moves[m].from});
        }
      });
  left.points = off.size();
  for (const Off& o : off)
    if (left.max_offset == 0 || o.offset * left.thickness > left.max_offset * o.thickness) {
      left.max_offset = o.offset;
      left.thickness = o.thickness;
      left.place = o.place;
    }
  return left;
}

}  // namespace tetwright
