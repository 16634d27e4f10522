#include "mesher/cutting.h"

#include <algorithm>
#include <cmath>

#include "common/parallel_sort.h"
#include "common/quality.h"

namespace tetwright {

namespace {

constexpr std::size_t grain = 1 << 13;  // tets to a task, some ten nanoseconds each

/// Cuts stay this share of the edge off its ends, for the sake of the shape of the pieces. Only points that
/// could not be moved have cuts that near.
constexpr double smallest_share = 0.25;

using EdgeKey = std::uint64_t;
EdgeKey edge_key(Index a, Index b) { return static_cast<EdgeKey>(std::min(a, b)) << 32 | std::max(a, b); }

bool is_cut(const LabelledLattice& lattice, const Tet& t) {
  bool in = false, out = false;
  for (Index v : t) {
    in |= lattice.sides[v] == Side::inside;
    out |= lattice.sides[v] == Side::outside;
  }
  return in && out;
}

bool is_inside(const LabelledLattice& lattice, const Tet& t) {
  bool in = false;
  for (Index v : t) {
    if (lattice.sides[v] == Side::outside) return false;
    in |= lattice.sides[v] == Side::inside;
  }
  return in;
}

/// The edges that are cut, ascending.
std::vector<EdgeKey> cut_edges(const LabelledLattice& lattice) {
  std::vector<EdgeKey> edges = parallel_collect<EdgeKey>(
      0, lattice.tets.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<EdgeKey>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const Tet& t = lattice.tets[i];
          if (!is_cut(lattice, t)) continue;
          for (const auto& e : tet_edges) {
            const Side a = lattice.sides[t[e[0]]], b = lattice.sides[t[e[1]]];
            if (a != b && a != Side::on && b != Side::on) out.push_back(edge_key(t[e[0]], t[e[1]]));
          }
        }
      });
  parallel_sort_unique(edges);
  return edges;
}

Vec3 cut_point(const LabelledLattice& lattice, EdgeKey key) {
  const auto a = static_cast<Index>(key >> 32), b = static_cast<Index>(key);
  const double da = lattice.distances[a], db = lattice.distances[b];
  const double share = std::clamp(da / (da - db), smallest_share, 1 - smallest_share);
  return lattice.positions[a] + share * (lattice.positions[b] - lattice.positions[a]);
}

/// Numbers the points in the order of their first use and drops the rest.
CutMesh compact(const std::vector<Vec3>& positions, const std::vector<Vec3>& cuts, std::vector<Tet> tets) {
  CutMesh mesh;
  std::vector<Index> number(positions.size() + cuts.size(), no_index);
  Index next = 0;
  for (Tet& t : tets)
    for (Index& v : t) {
      if (number[v] == no_index) number[v] = next++;
      v = number[v];
    }
  mesh.points.resize(next);
  parallel_for(0, number.size(), 4 * grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (number[i] != no_index)
        mesh.points[number[i]] = i < positions.size() ? positions[i] : cuts[i - positions.size()];
  });
  mesh.tets = std::move(tets);
  return mesh;
}

CutCase cut_case(const LabelledLattice& lattice, const Tet& t) {
  CutCase cut;
  for (int k = 0; k < 4; ++k) {
    cut.sides[k] = lattice.sides[t[k]];
    cut.ranks[k] = 0;
    for (int l = 0; l < 4; ++l) {
      // Farthest from the interface first: the longest edge is the one to be cut short.
      const float a = std::abs(lattice.distances[t[l]]), b = std::abs(lattice.distances[t[k]]);
      cut.ranks[k] += a > b || (a == b && t[l] < t[k]);
    }
  }
  return cut;
}

/// cut_inside() with the shorter diagonal; `point_of(a, b)` is the cut between two corners.
template <class PointOf>
int cut_inside(const CutCase& cut, std::array<Piece, 3>& pieces, PointOf&& point_of) {
  std::array<int, 2> in{}, out{};
  int inside = 0, outside = 0;
  for (int k = 0; k < 4; ++k) {
    if (cut.sides[k] == Side::inside && inside++ < 2) in[inside - 1] = k;
    if (cut.sides[k] == Side::outside && outside++ < 2) out[outside - 1] = k;
  }
  if (inside != 2 || outside != 2) return cut_inside(cut, false, pieces);
  // Corners in the order of cut_inside(), so that the two diagonals are 02-13 and 03-12.
  if (cut.ranks[in[1]] < cut.ranks[in[0]]) std::swap(in[0], in[1]);
  if (cut.ranks[out[1]] < cut.ranks[out[0]]) std::swap(out[0], out[1]);
  const double one = (point_of(in[0], out[0]) - point_of(in[1], out[1])).squaredNorm();
  const double other = (point_of(in[0], out[1]) - point_of(in[1], out[0])).squaredNorm();
  return cut_inside(cut, other < one, pieces);
}

}  // namespace

double worst_inside_angle(const LabelledLattice& lattice, const Tet& t) {
  constexpr double none = 4 * regular_solid_angle;
  const auto angle = [](const std::array<Vec3, 4>& p) { return min_solid_angle(p[0], p[1], p[2], p[3]); };
  if (is_inside(lattice, t))
    return angle(
        {lattice.positions[t[0]], lattice.positions[t[1]], lattice.positions[t[2]], lattice.positions[t[3]]});
  if (!is_cut(lattice, t)) return none;
  std::array<Piece, 3> pieces;
  const auto point_of = [&](int a, int b) { return cut_point(lattice, edge_key(t[a], t[b])); };
  const int n = cut_inside(cut_case(lattice, t), pieces, point_of);
  double worst = none;
  for (int p = 0; p < n; ++p) {
    std::array<Vec3, 4> x;
    for (int k = 0; k < 4; ++k) {
      const auto [from, to] = pieces[p][k];
      x[k] = from == to ? lattice.positions[t[from]] : point_of(from, to);
    }
    worst = std::min(worst, angle(x));
  }
  return worst;
}

int cut_inside(const CutCase& cut, bool other_diagonal, std::array<Piece, 3>& pieces) {
  // The corners in the order inside (by rank), on, outside, and whether that turned the tet over.
  std::array<int, 4> v{0, 1, 2, 3};
  const auto before = [&](int a, int b) {
    if (cut.sides[a] != cut.sides[b]) return cut.sides[a] < cut.sides[b];
    return cut.ranks[a] < cut.ranks[b];
  };
  bool turned = false;
  for (int i = 1; i < 4; ++i)
    for (int j = i; j > 0 && before(v[j], v[j - 1]); --j) {
      std::swap(v[j], v[j - 1]);
      turned = !turned;
    }
  const auto count = [&](Side s) { return std::count(cut.sides.begin(), cut.sides.end(), s); };
  const auto inside = count(Side::inside), outside = count(Side::outside);
  const auto corner = [&](int k) { return PieceVertex{v[k], v[k]}; };
  const auto between = [&](int k, int l) { return PieceVertex{v[k], v[l]}; };
  int n = 0;
  // The pieces list their vertices in the places of the corners they come from or are cut towards: each is
  // positive because its matrix of barycentric coordinates is triangular up to a positive minor.
  const auto emit = [&](PieceVertex a, PieceVertex b, PieceVertex c, PieceVertex d) {
    if (turned) std::swap(c, d);
    pieces[n++] = {a, b, c, d};
  };

  if (inside == 0) return 0;
  if (outside == 0) {
    emit(corner(0), corner(1), corner(2), corner(3));
  } else if (inside == 1) {
    // A smaller tet at the inside corner.
    const auto end = [&](int k) { return cut.sides[v[k]] == Side::outside ? between(0, k) : corner(k); };
    emit(corner(0), end(1), end(2), end(3));
  } else if (inside == 2 && outside == 1) {
    // A pyramid over the quadrilateral 0, 1, 13, 03 with its tip on the interface (corner 2).
    emit(corner(0), corner(1), corner(2), between(1, 3));
    emit(corner(0), between(1, 3), corner(2), between(0, 3));
  } else if (inside == 3) {
    // A prism between 0, 1, 2 and 03, 13, 23 with the diagonals 0-13, 0-23, 1-23.
    emit(corner(0), corner(1), corner(2), between(2, 3));
    emit(corner(0), corner(1), between(2, 3), between(1, 3));
    emit(corner(0), between(1, 3), between(2, 3), between(0, 3));
  } else {
    // A prism between 0, 02, 03 and 1, 12, 13 with the diagonals 0-12, 0-13 and either within the tet.
    emit(corner(0), corner(1), between(1, 2), between(1, 3));
    if (other_diagonal) {
      emit(corner(0), between(1, 3), between(1, 2), between(0, 3));
      emit(corner(0), between(1, 2), between(0, 2), between(0, 3));
    } else {
      emit(corner(0), between(1, 3), between(0, 2), between(0, 3));
      emit(corner(0), between(1, 2), between(0, 2), between(1, 3));
    }
  }
  return n;
}

CutMesh cut_lattice(const LabelledLattice& lattice) {
  const std::vector<EdgeKey> edges = cut_edges(lattice);
  std::vector<Vec3> cuts(edges.size());
  parallel_for(0, edges.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) cuts[i] = cut_point(lattice, edges[i]);
  });
  const auto first_cut = static_cast<Index>(lattice.positions.size());
  const auto cut_number = [&](Index a, Index b) {
    return static_cast<Index>(std::lower_bound(edges.begin(), edges.end(), edge_key(a, b)) - edges.begin());
  };

  std::vector<Tet> tets = parallel_collect<Tet>(
      0, lattice.tets.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<Tet>& out) {
        std::array<Piece, 3> pieces;
        for (std::size_t i = begin; i < end; ++i) {
          const Tet& t = lattice.tets[i];
          if (is_inside(lattice, t)) out.push_back(t);
          if (!is_cut(lattice, t)) continue;
          const int n = cut_inside(cut_case(lattice, t), pieces,
                                   [&](int a, int b) -> const Vec3& { return cuts[cut_number(t[a], t[b])]; });
          for (int p = 0; p < n; ++p) {
            Tet piece;
            for (int k = 0; k < 4; ++k) {
              const Index from = t[pieces[p][k].from], to = t[pieces[p][k].to];
              piece[k] = from == to ? from : first_cut + cut_number(from, to);
            }
            out.push_back(piece);
          }
        }
      });
  return compact(lattice.positions, cuts, std::move(tets));
}

}  // namespace tetwright
