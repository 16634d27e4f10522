#include "simplify/remesh/tet_overlap.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/geometry/predicates.h"

namespace tetwright {

namespace {

/// Each of four planes cuts a piece into three at most.
constexpr std::size_t max_pieces = 81;

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

/// Signed distances, times twice the area of a face, of points from the planes of a positive tet's faces:
/// positive inside.
class Planes {
 public:
  explicit Planes(const TetCorners& tet) {
    for (int f = 0; f < 4; ++f) {
      const auto& face = tet_faces[f];
      origins_[f] = tet[face[0]];
      inward_[f] = (tet[face[2]] - origins_[f]).cross(tet[face[1]] - origins_[f]);
    }
  }
  std::array<double, 4> distances(int face, const TetCorners& corners) const {
    std::array<double, 4> d;
    for (int k = 0; k < 4; ++k) d[k] = inward_[face].dot(corners[k] - origins_[face]);
    return d;
  }
  /// Whether all corners lie beyond one of the planes.
  bool separate(const TetCorners& corners) const {
    for (int f = 0; f < 4; ++f) {
      const std::array<double, 4> d = distances(f, corners);
      if (std::all_of(d.begin(), d.end(), [](double x) { return x <= 0; })) return true;
    }
    return false;
  }

 private:
  std::array<Vec3, 4> origins_, inward_;
};

}  // namespace

double overlap_volume(const TetCorners& first, const TetCorners& second) {
  const Planes planes(second);
  // Most pairs whose boxes meet have nothing in common.
  if (planes.separate(first) || Planes(first).separate(second)) return 0;
  std::array<Pieces, 2> buffers;
  Pieces *pieces = &buffers[0], *next = &buffers[1];
  pieces->add(first[0], first[1], first[2], first[3]);
  for (int f = 0; f < 4; ++f) {
    next->count = 0;
    for (std::size_t i = 0; i < pieces->count; ++i)
      clip(pieces->tets[i], planes.distances(f, pieces->tets[i]), *next);
    std::swap(pieces, next);
    if (pieces->count == 0) return 0;
  }
  double sum = 0;
  for (std::size_t i = 0; i < pieces->count; ++i) {
    const TetCorners& t = pieces->tets[i];
    sum += std::abs(orient3d_value(t[0], t[1], t[2], t[3]));
  }
  return sum / 6;
}

}  // namespace tetwright
