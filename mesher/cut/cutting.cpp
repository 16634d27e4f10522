// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/cutting.h"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "common/parallel/parallel_sort.h"
#include "mesher/cut/cut_tet.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

/// The corners of an edge or face, ascending.
using EdgeKey = std::uint64_t;
EdgeKey edge_key(Index a, Index b) { return static_cast<EdgeKey>(std::min(a, b)) << 32 | std::max(a, b); }
using FaceKey = std::array<Index, 3>;
FaceKey face_key(Index a, Index b, Index c) {
  FaceKey key{a, b, c};
  std::sort(key.begin(), key.end());
  return key;
}

/// The regions of a tet's pure points; at most four.
RegionSet pure_regions(const LabelledLattice& lattice, const Tet& t) {
  RegionSet set;
  for (Index v : t)
    if (const RegionIndex r = lattice.region(v); r != on_interface) set.insert(r);
  return set;
}

/// How a tet is treated.
enum class Fate { cut, whole, dropped };
Fate fate(const LabelledLattice& lattice, const Tet& t, RegionIndex& region) {
  region = on_interface;
  for (Index v : t) {
    const RegionIndex r = lattice.region(v);
    if (r == on_interface) continue;
    if (region != on_interface && r != region) return Fate::cut;
    region = r;
  }
  // Moves leave no tet with all points on interfaces, but at the rims around sheets there are some.
  if (region == on_interface && lattice.has_rims) region = lattice.first_region[t[0]];
  TETWRIGHT_CHECK(region != on_interface);
  return (region == outside_region && !lattice.keep_outside) ? Fate::dropped : Fate::whole;
}

bool pure(const LabelledLattice& lattice, Index v) { return !lattice.is_on[v]; }

bool edge_is_cut(const LabelledLattice& lattice, Index a, Index b) {
  return pure(lattice, a) && pure(lattice, b) && lattice.first_region[a] != lattice.first_region[b];
}

bool face_is_cut(const LabelledLattice& lattice, Index a, Index b, Index c) {
  return edge_is_cut(lattice, a, b) && edge_is_cut(lattice, b, c) && edge_is_cut(lattice, c, a);
}

Vec3 edge_cut(const LabelledLattice& lattice, Index a, Index b) {
  if (b < a) std::swap(a, b);  // the same bits from both ends
  const double share = std::clamp(lattice.cut_share(a, lattice.first_region[a], b, lattice.first_region[b]),
                                  CutTuning::Cuts::min_edge_share, 1 - CutTuning::Cuts::min_edge_share);
  return lattice.positions[a] + share * (lattice.positions[b] - lattice.positions[a]);
}

/// Raises coordinates below `smallest` to it and lowers the others so that the sum stays 1. Returns them
/// unchanged if none is below.
template <int N>
Eigen::Matrix<double, N, 1> clamp_barycentric(const Eigen::Matrix<double, N, 1>& shares, double smallest) {
  Eigen::Matrix<double, N, 1> excess = (shares.array() - smallest).max(0.0);
  const double sum = excess.sum();
  // Make all equal if nothing is left to distribute or if the sum is not finite.
  if (!(sum > 0) || !std::isfinite(sum))
    excess.setConstant(1), excess /= N;
  else
    excess /= sum;
  return (excess.array() * (1 - N * smallest) + smallest).matrix();
}

/// The point of a simplex, with N corners in different regions, at which linear interpolation gives all
/// regions equal distances.
template <int N>
Vec3 meeting_point(const LabelledLattice& lattice, const std::array<Index, N>& corners, double smallest) {
  Eigen::Matrix<double, N, N> equations;
  Eigen::Matrix<double, N, 1> right;
  right.setZero();
  for (int c = 0; c < N; ++c) {
    const RegionIndex first = lattice.first_region[corners[0]];
    for (int r = 1; r < N; ++r)
      equations(r - 1, c) = lattice.gap(corners[c], first, lattice.first_region[corners[r]]);
    equations(N - 1, c) = 1;
  }
  right[N - 1] = 1;
  const Eigen::Matrix<double, N, 1> shares =
      clamp_barycentric<N>(equations.partialPivLu().solve(right), smallest);
  Vec3 point = Vec3::Zero();
  for (int c = 0; c < N; ++c) point += shares[c] * lattice.positions[corners[c]];
  return point;
}

Vec3 face_cut(const LabelledLattice& lattice, const FaceKey& key) {
  Vec3 point = meeting_point<3>(lattice, key, CutTuning::Cuts::min_face_share);
  // Shares add up to 1 only within rounding, but no vertex may leave a face of the box.
  const Vec3 &a = lattice.positions[key[0]], &b = lattice.positions[key[1]], &c = lattice.positions[key[2]];
  for (int k = 0; k < 3; ++k)
    if (a[k] == b[k] && a[k] == c[k]) point[k] = a[k];
  return point;
}

/// The interior point of a tet with three or four regions: the point where all four meet, or the middle of
/// the junction curve between its two faces of three regions.
Vec3 tet_cut(const LabelledLattice& lattice, const Tet& t) {
  if (pure_regions(lattice, t).size() == 4) {
    Tet sorted = t;
    std::sort(sorted.begin(), sorted.end());
    return meeting_point<4>(lattice, sorted, CutTuning::Cuts::min_tet_share);
  }
  Vec3 middle = Vec3::Zero();
  double faces = 0;
  for (const auto& f : tet_faces)
    if (face_is_cut(lattice, t[f[0]], t[f[1]], t[f[2]])) {
      middle += face_cut(lattice, face_key(t[f[0]], t[f[1]], t[f[2]]));
      faces += 1;
    }
  middle /= faces;
  // Barycentric coordinates of the middle, kept away from the faces.
  const Vec3 &a = lattice.positions[t[0]], &b = lattice.positions[t[1]], &c = lattice.positions[t[2]],
             &d = lattice.positions[t[3]];
  const double whole = tet_volume(a, b, c, d);
  const Eigen::Vector4d shares =
      clamp_barycentric<4>(Eigen::Vector4d(tet_volume(middle, b, c, d), tet_volume(a, middle, c, d),
                                           tet_volume(a, b, middle, d), tet_volume(a, b, c, middle)) /
                               whole,
                           CutTuning::Cuts::min_tet_share);
  return shares[0] * a + shares[1] * b + shares[2] * c + shares[3] * d;
}

CutCase cut_case(const LabelledLattice& lattice, const Tet& t) {
  CutCase cut;
  std::array<float, 4> margins;
  for (int k = 0; k < 4; ++k) {
    cut.regions[k] = lattice.region(t[k]);
    margins[k] = lattice.margin(t[k]);
  }
  for (int k = 0; k < 4; ++k) {
    cut.ranks[k] = 0;
    // The corner farthest from the interface comes first.
    for (int l = 0; l < 4; ++l)
      cut.ranks[k] += margins[l] > margins[k] || (margins[l] == margins[k] && t[l] < t[k]);
  }
  return cut;
}

/// cut_tet() with the shorter diagonal; `cut_of(a, b)` is the cut between two corners.
template <class CutOf>
int cut_tet_well(const CutCase& cut, Pieces& pieces, CutOf&& cut_of) {
  // The two corners of each region, in order of rank.
  std::array<int, 2> one{-1, -1}, other{-1, -1};
  for (int rank = 0; rank < 4; ++rank)
    for (int k = 0; k < 4; ++k) {
      if (cut.ranks[k] != static_cast<Index>(rank) || cut.regions[k] == on_interface) continue;
      auto& side = one[0] < 0 || cut.regions[k] == cut.regions[one[0]] ? one : other;
      if (side[0] >= 0 && (cut.regions[k] != cut.regions[side[0]] || side[1] >= 0))
        return cut_tet(cut, false, pieces);
      side[side[0] < 0 ? 0 : 1] = k;
    }
  if (one[1] < 0 || other[1] < 0) return cut_tet(cut, false, pieces);
  // In cut_tet()'s order of corners the diagonals are 02-13 and 03-12, whichever region comes first.
  const double straight = (cut_of(one[0], other[0]) - cut_of(one[1], other[1])).squaredNorm();
  const double crossed = (cut_of(one[0], other[1]) - cut_of(one[1], other[0])).squaredNorm();
  return cut_tet(cut, crossed < straight, pieces);
}

/// The cuts of a lattice, sorted: edges, then faces of three regions, then tets.
struct Cuts {
  std::vector<EdgeKey> edges;
  std::vector<FaceKey> faces;
  std::vector<Index> tets;  ///< those with an interior point

  explicit Cuts(const LabelledLattice& lattice) {
    edges = collect<EdgeKey>(lattice, [&](const Tet& t, std::vector<EdgeKey>& out) {
      for (const auto& e : tet_edges)
        if (edge_is_cut(lattice, t[e[0]], t[e[1]])) out.push_back(edge_key(t[e[0]], t[e[1]]));
    });
    faces = collect<FaceKey>(lattice, [&](const Tet& t, std::vector<FaceKey>& out) {
      for (const auto& f : tet_faces)
        if (face_is_cut(lattice, t[f[0]], t[f[1]], t[f[2]]))
          out.push_back(face_key(t[f[0]], t[f[1]], t[f[2]]));
    });
    if (faces.empty()) return;
    tets = parallel_collect<Index>(0, lattice.tets.size(), CutGrains::tets,
                                   [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                     for (std::size_t i = begin; i < end; ++i) {
                                       const Tet& t = lattice.tets[i];
                                       const bool all_pure = pure(lattice, t[0]) && pure(lattice, t[1]) &&
                                                             pure(lattice, t[2]) && pure(lattice, t[3]);
                                       if (all_pure && pure_regions(lattice, t).size() > 2)
                                         out.push_back(static_cast<Index>(i));
                                     }
                                   });
  }

  std::size_t size() const { return edges.size() + faces.size() + tets.size(); }
  Index edge(Index a, Index b) const { return place(edges, edge_key(a, b)); }
  Index face(Index a, Index b, Index c) const {
    return static_cast<Index>(edges.size()) + place(faces, face_key(a, b, c));
  }
  Index tet(Index t) const { return static_cast<Index>(edges.size() + faces.size()) + place(tets, t); }
  std::vector<Vec3> points(const LabelledLattice& lattice) const {
    std::vector<Vec3> points(size());
    parallel_for(0, points.size(), CutGrains::tets, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (i < edges.size())
          points[i] = edge_cut(lattice, static_cast<Index>(edges[i] >> 32), static_cast<Index>(edges[i]));
        else if (i < edges.size() + faces.size())
          points[i] = face_cut(lattice, faces[i - edges.size()]);
        else
          points[i] = tet_cut(lattice, lattice.tets[tets[i - edges.size() - faces.size()]]);
      }
    });
    return points;
  }

 private:
  /// Collects the keys that `body(tet, out)` appends for each tet that is cut; sorted, without repetitions.
  template <class Key, class Body>
  static std::vector<Key> collect(const LabelledLattice& lattice, Body&& body) {
    std::vector<Key> keys =
        parallel_collect<Key>(0, lattice.tets.size(), CutGrains::tets,
                              [&](std::size_t begin, std::size_t end, std::vector<Key>& out) {
                                RegionIndex unused;
                                for (std::size_t i = begin; i < end; ++i)
                                  if (fate(lattice, lattice.tets[i], unused) == Fate::cut)
                                    body(lattice.tets[i], out);
                                // Most tets that share an edge are in the same chunk, so this removes most
                                // repetitions.
                                std::sort(out.begin(), out.end());
                                out.erase(std::unique(out.begin(), out.end()), out.end());
                              });
    parallel_sort_unique(keys);
    return keys;
  }
  template <class Key>
  static Index place(const std::vector<Key>& ascending, const Key& key) {
    return static_cast<Index>(std::lower_bound(ascending.begin(), ascending.end(), key) - ascending.begin());
  }
};

/// The corners of a piece's vertex, ascending; returns their number.
int corners_of(PieceVertex vertex, std::array<int, 4>& corners) {
  int n = 0;
  for (int k = 0; k < 4; ++k)
    if (vertex >> k & 1) corners[n++] = k;
  return n;
}

/// Numbers the vertices by first use and drops unused ones.
void compact(const LabelledLattice& lattice, const std::vector<Vec3>& cuts, CutMesh& mesh) {
  const std::vector<Vec3>& positions = lattice.positions;
  std::vector<Index> number(positions.size() + cuts.size(), no_index);
  Index next = 0;
  for (Tet& t : mesh.tets)
    for (Index& v : t) {
      if (number[v] == no_index) number[v] = next++;
      v = number[v];
    }
  mesh.points.resize(next);
  mesh.on_interface.resize(next);
  parallel_for(0, number.size(), 4 * CutGrains::tets, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (number[i] == no_index) continue;
      const bool is_cut = i >= positions.size();
      mesh.points[number[i]] = is_cut ? cuts[i - positions.size()] : positions[i];
      mesh.on_interface[number[i]] = is_cut || lattice.is_on[i];
    }
  });
}

}  // namespace

double worst_piece_tangent(const LabelledLattice& lattice, const Tet& t, double enough) {
  constexpr double none = 1;  // the min solid angle of a tet is never as large as pi / 2
  const auto angle = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return min_solid_angle_tangent(a, b, c, d);
  };
  RegionIndex region;
  switch (fate(lattice, t, region)) {
    case Fate::dropped:
      return none;
    case Fate::whole:
      return angle(lattice.positions[t[0]], lattice.positions[t[1]], lattice.positions[t[2]],
                   lattice.positions[t[3]]);
    case Fate::cut:
      break;
  }
  // Positions of the pieces' vertices, computed on first use.
  std::array<Vec3, 16> places;
  unsigned known = 0;
  const auto place = [&](PieceVertex vertex) -> const Vec3& {
    if (!(known >> vertex & 1)) {
      std::array<int, 4> c;
      const int n = corners_of(vertex, c);
      places[vertex] = n == 1   ? lattice.positions[t[c[0]]]
                       : n == 2 ? edge_cut(lattice, t[c[0]], t[c[1]])
                       : n == 3 ? face_cut(lattice, face_key(t[c[0]], t[c[1]], t[c[2]]))
                                : tet_cut(lattice, t);
      known |= 1u << vertex;
    }
    return places[vertex];
  };
  Pieces pieces;
  const int n = cut_tet_well(cut_case(lattice, t), pieces,
                             [&](int a, int b) { return place(static_cast<PieceVertex>(1 << a | 1 << b)); });
  double worst = none;
  for (int p = 0; p < n; ++p) {
    if (pieces[p].region == outside_region && !lattice.keep_outside) continue;
    const auto& v = pieces[p].vertices;
    worst = std::min(worst, angle(place(v[0]), place(v[1]), place(v[2]), place(v[3])));
    if (worst <= enough) break;
  }
  return worst;
}

CutMesh cut_lattice(LabelledLattice lattice) {
  const Cuts cuts(lattice);
  const std::vector<Vec3> cut_points = cuts.points(lattice);
  const auto first_cut = static_cast<Index>(lattice.positions.size());

  struct CutTet {
    Tet tet;
    RegionIndex region;
    std::uint8_t owned;
  };
  // The pieces cut from each part of the lattice replace it in memory.
  std::vector<std::vector<CutTet>> parts(lattice.tets.piece_count());
  parallel_for(0, parts.size(), 1, [&](std::size_t first_part, std::size_t last_part) {
    for (std::size_t part = first_part; part < last_part; ++part) {
      std::vector<CutTet>& out = parts[part];
      const std::span<const Tet> tets = lattice.tets.piece(part);
      Pieces pieces;
      for (std::size_t i = 0; i < tets.size(); ++i) {
        const Tet& t = tets[i];
        RegionIndex region;
        const Fate f = fate(lattice, t, region);
        const std::uint8_t owned = lattice.owns(part * TetList::piece_size + i);
        if (f == Fate::whole) out.push_back({t, region, owned});
        if (f != Fate::cut) continue;
        const int n = cut_tet_well(cut_case(lattice, t), pieces, [&](int a, int b) -> const Vec3& {
          return cut_points[cuts.edge(t[a], t[b])];
        });
        for (int p = 0; p < n; ++p) {
          if (pieces[p].region == outside_region && !lattice.keep_outside) continue;
          CutTet piece{{}, pieces[p].region, owned};
          for (int k = 0; k < 4; ++k) {
            std::array<int, 4> c;
            const int corners = corners_of(pieces[p].vertices[k], c);
            piece.tet[k] = corners == 1   ? t[c[0]]
                           : corners == 2 ? first_cut + cuts.edge(t[c[0]], t[c[1]])
                           : corners == 3
                               ? first_cut + cuts.face(t[c[0]], t[c[1]], t[c[2]])
                               : first_cut + cuts.tet(static_cast<Index>(part * TetList::piece_size + i));
          }
          out.push_back(piece);
        }
      }
      lattice.tets.give_back(part);
    }
  });
  lattice.free_stars();
  std::size_t size = 0;
  for (const std::vector<CutTet>& part : parts) size += part.size();
  CutMesh mesh;
  mesh.tets.reserve(size);
  mesh.regions.reserve(size);
  const bool in_brick = !lattice.owned.empty();
  if (in_brick) mesh.owned.reserve(size);
  for (std::vector<CutTet>& part : parts) {
    for (const CutTet& c : part) {
      mesh.tets.push_back(c.tet);
      mesh.regions.push_back(c.region);
      if (in_brick) mesh.owned.push_back(c.owned);
    }
    std::vector<CutTet>().swap(part);
  }
  compact(lattice, cut_points, mesh);
  return mesh;
}

}  // namespace tetwright
