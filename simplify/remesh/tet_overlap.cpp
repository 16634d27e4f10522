#include "simplify/remesh/tet_overlap.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/geometry/predicates.h"

namespace tetwright {

namespace {

/// Each of four planes cuts a piece into three at most.
constexpr std::size_t max_pieces = 81;
/// Distances from a plane of less than this share of the largest are rounding errors of coordinates.
constexpr double rounding = 1e-13;

struct Pieces {
  std::array<TetCorners, max_pieces> tets;
  std::size_t count = 0;
  void add(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { tets[count++] = {a, b, c, d}; }
};

/// The prism between the triangles (a, b, c) and (d, e, f), whose edges ad, be and cf join them.
void add_prism(Pieces& out, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e,
               const Vec3& f) {
  out.add(a, b, c, f);
  out.add(a, b, f, e);
  out.add(a, e, f, d);
}

/// Appends what of a tet lies where the signed distances are positive; `distance`: of its corners.
void clip(const TetCorners& tet, const std::array<double, 4>& distance, Pieces& out) {
  std::array<int, 4> inside{}, outside{};
  int in = 0, outs = 0;
  for (int k = 0; k < 4; ++k) (distance[k] > 0 ? inside[in++] : outside[outs++]) = k;
  /// Where the edge from corner i to corner j crosses the plane.
  const auto crossing = [&](int i, int j) -> Vec3 {
    return tet[i] + (tet[j] - tet[i]) * (distance[i] / (distance[i] - distance[j]));
  };
  switch (in) {
    case 0:
      return;
    case 1: {
      const int p = inside[0];
      out.add(tet[p], crossing(p, outside[0]), crossing(p, outside[1]), crossing(p, outside[2]));
      return;
    }
    case 2: {
      const int p = inside[0], q = inside[1];
      add_prism(out, tet[p], crossing(p, outside[0]), crossing(p, outside[1]), tet[q],
                crossing(q, outside[0]), crossing(q, outside[1]));
      return;
    }
    case 3: {
      const int o = outside[0];
      add_prism(out, tet[inside[0]], tet[inside[1]], tet[inside[2]], crossing(inside[0], o),
                crossing(inside[1], o), crossing(inside[2], o));
      return;
    }
    default:
      out.add(tet[0], tet[1], tet[2], tet[3]);
  }
}

/// The planes of a positive tet's faces.
class Planes {
 public:
  explicit Planes(const TetCorners& tet) {
    for (int f = 0; f < 4; ++f) {
      const auto& face = tet_faces[f];
      origins_[f] = tet[face[0]];
      inward_[f] = (tet[face[2]] - origins_[f]).cross(tet[face[1]] - origins_[f]);
    }
  }
  /// Signed distances of points from a plane, times twice the area of its face: positive inside.
  std::array<double, 4> distances(int face, const TetCorners& corners) const {
    std::array<double, 4> d;
    for (int k = 0; k < 4; ++k) d[k] = inward_[face].dot(corners[k] - origins_[face]);
    return d;
  }

 private:
  std::array<Vec3, 4> origins_, inward_;
};

enum class Side { beyond, across, within };

/// On which side of a plane a tet lies, given the distances of its corners. What rounding alone puts across
/// it, such as the halves of an edge, does not count as such.
Side side_of(const std::array<double, 4>& d) {
  const auto [least, most] = std::minmax_element(d.begin(), d.end());
  const double tolerance = rounding * std::max(-*least, *most);
  return *most <= tolerance ? Side::beyond : *least >= -tolerance ? Side::within : Side::across;
}

double volume_of(const TetCorners& t) { return std::abs(orient3d_value(t[0], t[1], t[2], t[3])) / 6; }

}  // namespace

double overlap_volume(const TetCorners& first, const TetCorners& second) {
  const Planes planes(second);
  std::array<int, 4> cutting{};
  int cuts = 0;
  for (int f = 0; f < 4; ++f) {
    const Side side = side_of(planes.distances(f, first));
    if (side == Side::beyond) return 0;
    if (side == Side::across) cutting[cuts++] = f;
  }
  if (cuts == 0) return volume_of(first);
  const Planes others(first);
  bool inside = true;
  for (int f = 0; f < 4; ++f) {
    const Side side = side_of(others.distances(f, second));
    if (side == Side::beyond) return 0;
    inside &= side == Side::within;
  }
  if (inside) return volume_of(second);
  std::array<Pieces, 2> buffers;
  Pieces *pieces = &buffers[0], *next = &buffers[1];
  pieces->add(first[0], first[1], first[2], first[3]);
  for (int i = 0; i < cuts; ++i) {
    next->count = 0;
    for (std::size_t k = 0; k < pieces->count; ++k)
      clip(pieces->tets[k], planes.distances(cutting[i], pieces->tets[k]), *next);
    std::swap(pieces, next);
    if (pieces->count == 0) return 0;
  }
  double sum = 0;
  for (std::size_t i = 0; i < pieces->count; ++i) sum += volume_of(pieces->tets[i]);
  return sum;
}

}  // namespace tetwright
