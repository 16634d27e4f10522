// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/cut_tet.h"

#include <utility>

namespace tetwright {

namespace {

constexpr PieceVertex corner(int k) { return static_cast<PieceVertex>(1 << k); }

/// Cuts the part of one region out of a tet of two regions.
class TwoRegions {
 public:
  /// \param region the region that is cut out
  TwoRegions(const CutCase& cut, RegionIndex region, Pieces& pieces, int& count)
      : region_(region), pieces_(pieces), count_(count) {
    // Sort the corners: this region (by rank), on the interface, other region (by rank). Record whether that
    // inverts the tet.
    const auto place = [&](int k) {
      return cut.regions[k] == region ? 0 : cut.regions[k] == on_interface ? 1 : 2;
    };
    for (int i = 1; i < 4; ++i)
      for (int j = i; j > 0; --j) {
        const int a = v_[j], b = v_[j - 1];
        if (std::pair(place(a), cut.ranks[a]) > std::pair(place(b), cut.ranks[b])) break;
        std::swap(v_[j], v_[j - 1]);
        turned_ = !turned_;
      }
    for (int k = 0; k < 4; ++k) {
      own_ += place(k) == 0;
      others_ += place(k) == 2;
    }
  }

  void emit_pieces(bool other_diagonal) {
    const auto end = [&](int k) { return k >= 4 - others_ ? between(0, k) : at(k); };
    if (own_ == 1) {
      // A smaller tet at the corner.
      emit(at(0), end(1), end(2), end(3));
    } else if (own_ == 2 && others_ == 1) {
      // A pyramid over the quadrilateral 0, 1, 13, 03 with its tip on the interface (corner 2).
      emit(at(0), at(1), at(2), between(1, 3));
      emit(at(0), between(1, 3), at(2), between(0, 3));
    } else if (own_ == 3) {
      // A prism between 0, 1, 2 and 03, 13, 23 with the diagonals 0-13, 0-23, 1-23.
      emit(at(0), at(1), at(2), between(2, 3));
      emit(at(0), at(1), between(2, 3), between(1, 3));
      emit(at(0), between(1, 3), between(2, 3), between(0, 3));
    } else {
      // A prism between 0, 02, 03 and 1, 12, 13 with the diagonals 0-12, 0-13 and either within the tet.
      emit(at(0), at(1), between(1, 2), between(1, 3));
      if (other_diagonal) {
        emit(at(0), between(1, 3), between(1, 2), between(0, 3));
        emit(at(0), between(1, 2), between(0, 2), between(0, 3));
      } else {
        emit(at(0), between(1, 3), between(0, 2), between(0, 3));
        emit(at(0), between(1, 2), between(0, 2), between(1, 3));
      }
    }
  }

 private:
  PieceVertex at(int k) const { return corner(v_[k]); }
  PieceVertex between(int k, int l) const { return static_cast<PieceVertex>(at(k) | at(l)); }
  /// Each vertex of a piece takes the slot of the corner that it coincides with or is cut towards. The piece
  /// is positive because its matrix of barycentric coordinates is triangular up to a positive minor.
  void emit(PieceVertex a, PieceVertex b, PieceVertex c, PieceVertex d) {
    if (turned_) std::swap(c, d);
    pieces_[count_++] = {{a, b, c, d}, region_};
  }

  RegionIndex region_;
  Pieces& pieces_;
  int& count_;
  std::array<int, 4> v_{0, 1, 2, 3};
  bool turned_ = false;
  int own_ = 0, others_ = 0;
};

/// Cuts a tet of three or four regions: the triangles of its faces are joined to an apex.
class ManyRegions {
 public:
  ManyRegions(const CutCase& cut, PieceVertex apex, Pieces& pieces, int& count)
      : cut_(cut), apex_(apex), pieces_(pieces), count_(count) {}

  /// Adds the face of corners x, y, z, listed so that its normal points out of the tet.
  void face(int x, int y, int z) {
    const RegionIndex a = cut_.regions[x], b = cut_.regions[y], c = cut_.regions[z];
    const PieceVertex vx = corner(x), vy = corner(y), vz = corner(z);
    if (a == b && b == c) {
      emit(vx, vy, vz, a);
    } else if (a != b && b != c && c != a) {
      const PieceVertex middle = join(join(vx, vy), vz);
      const std::array<int, 3> ring{x, y, z};
      for (int i = 0; i < 3; ++i) {
        const int from = ring[i], to = ring[(i + 1) % 3];
        const PieceVertex cut = join(corner(from), corner(to));
        emit(corner(from), cut, middle, cut_.regions[from]);
        emit(cut, corner(to), middle, cut_.regions[to]);
      }
    } else if (a == b) {
      pair_and_tip(x, y, z);
    } else if (b == c) {
      pair_and_tip(y, z, x);
    } else {
      pair_and_tip(z, x, y);
    }
  }

 private:
  /// Adds a face with x and y in one region, z in another.
  void pair_and_tip(int x, int y, int z) {
    const PieceVertex vx = corner(x), vy = corner(y), vz = corner(z);
    const PieceVertex xz = join(vx, vz), yz = join(vy, vz);
    emit(xz, yz, vz, cut_.regions[z]);
    if (cut_.ranks[x] < cut_.ranks[y]) {
      emit(vx, vy, yz, cut_.regions[x]);
      emit(vx, yz, xz, cut_.regions[x]);
    } else {
      emit(vx, vy, xz, cut_.regions[x]);
      emit(vy, yz, xz, cut_.regions[x]);
    }
  }

  static PieceVertex join(PieceVertex a, PieceVertex b) { return static_cast<PieceVertex>(a | b); }
  void emit(PieceVertex a, PieceVertex b, PieceVertex c, RegionIndex region) {
    pieces_[count_++] = {{apex_, a, b, c}, region};
  }

  const CutCase& cut_;
  PieceVertex apex_;
  Pieces& pieces_;
  int& count_;
};

}  // namespace

int cut_tet(const CutCase& cut, bool other_diagonal, Pieces& pieces) {
  RegionSet regions;
  int on = -1;
  for (int k = 0; k < 4; ++k)
    if (cut.regions[k] == on_interface)
      on = k;
    else
      regions.insert(cut.regions[k]);
  int count = 0;
  if (regions.size() == 1) {
    pieces[count++] = {{corner(0), corner(1), corner(2), corner(3)}, regions[0]};
  } else if (regions.size() == 2) {
    for (RegionIndex r : regions) TwoRegions(cut, r, pieces, count).emit_pieces(other_diagonal);
  } else {
    constexpr PieceVertex within = 0b1111;
    ManyRegions many(cut, on < 0 ? within : corner(on), pieces, count);
    for (int k = 0; k < 4; ++k)
      if (on < 0 || k == on) many.face(tet_faces[k][0], tet_faces[k][1], tet_faces[k][2]);
  }
  return count;
}

}  // namespace tetwright
