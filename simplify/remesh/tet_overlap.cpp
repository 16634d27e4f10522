// SPDX-License-Identifier: Apache-2.0
#include "simplify/remesh/tet_overlap.h"

#include <algorithm>
#include <cstddef>

#include "common/geometry/predicates.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using Transfer = SimplifyTuning::Transfer;

/// The first three planes each cut a piece into at most three; the last one only measures volumes.
constexpr std::size_t max_pieces = 27;

/// Signed distances of a point from the cutting planes. They are linear in the point, so coordinates are not
/// needed.
using Distances = std::array<double, 4>;

struct Piece {
  std::array<Distances, 4> corners;
  double volume;
};

struct Pieces {
  std::array<Piece, max_pieces> list;
  std::size_t count = 0;
  void add(const Distances& a, const Distances& b, const Distances& c, const Distances& d, double volume) {
    list[count++] = {{a, b, c, d}, volume};
  }
};

/// The corners of a piece on each side of a plane.
struct Sides {
  Sides(const Piece& piece, int plane) {
    for (int k = 0; k < 4; ++k) {
      distance[k] = piece.corners[k][plane];
      (distance[k] > 0 ? inside[in++] : outside[out++]) = k;
    }
  }
  /// Parameter at which the plane crosses the edge from an inner corner to an outer one.
  double share(int i, int o) const { return distance[i] / (distance[i] - distance[o]); }

  std::array<double, 4> distance{};
  std::array<int, 4> inside{}, outside{};
  int in = 0, out = 0;
};

/// Volume of the part of a piece inside a plane.
double volume_inside(const Piece& piece, int plane) {
  const Sides s(piece, plane);
  const auto& i = s.inside;
  const auto& o = s.outside;
  switch (s.in) {
    case 0:
      return 0;
    case 1:
      return piece.volume * s.share(i[0], o[0]) * s.share(i[0], o[1]) * s.share(i[0], o[2]);
    case 2: {
      const double a = s.share(i[0], o[0]), b = s.share(i[0], o[1]), c = s.share(i[1], o[0]),
                   d = s.share(i[1], o[1]);
      return piece.volume * (a * b * (1 - d) + a * d * (1 - c) + c * d);
    }
    case 3: {
      const double a = s.share(i[0], o[0]), b = s.share(i[1], o[0]), c = s.share(i[2], o[0]);
      return piece.volume * (1 - (1 - a) * (1 - b) * (1 - c));
    }
    default:
      return piece.volume;
  }
}

/// Appends the part of a piece inside a plane, as tets. Their volumes are determinants of the corners'
/// barycentric coordinates in the piece.
void clip(const Piece& piece, int plane, Pieces& out) {
  const Sides s(piece, plane);
  const auto crossing = [&](int i, double share, int o) {
    Distances d;
    for (int k = 0; k < 4; ++k)
      d[k] = piece.corners[i][k] + share * (piece.corners[o][k] - piece.corners[i][k]);
    return d;
  };
  const double v = piece.volume;
  const auto& i = s.inside;
  const auto& o = s.outside;
  switch (s.in) {
    case 0:
      return;
    case 1: {
      const double a = s.share(i[0], o[0]), b = s.share(i[0], o[1]), c = s.share(i[0], o[2]);
      out.add(piece.corners[i[0]], crossing(i[0], a, o[0]), crossing(i[0], b, o[1]), crossing(i[0], c, o[2]),
              v * a * b * c);
      return;
    }
    case 2: {  // a prism between the triangles at both inner corners
      const double a = s.share(i[0], o[0]), b = s.share(i[0], o[1]), c = s.share(i[1], o[0]),
                   d = s.share(i[1], o[1]);
      const Distances &p = piece.corners[i[0]], &q = piece.corners[i[1]];
      const Distances p0 = crossing(i[0], a, o[0]), p1 = crossing(i[0], b, o[1]),
                      q0 = crossing(i[1], c, o[0]), q1 = crossing(i[1], d, o[1]);
      out.add(p, p0, p1, q1, v * a * b * (1 - d));
      out.add(p, p0, q1, q0, v * a * d * (1 - c));
      out.add(p, q0, q1, q, v * c * d);
      return;
    }
    case 3: {  // a prism between the inner face and the plane
      const double a = s.share(i[0], o[0]), b = s.share(i[1], o[0]), c = s.share(i[2], o[0]);
      const Distances &p = piece.corners[i[0]], &q = piece.corners[i[1]], &r = piece.corners[i[2]];
      const Distances pc = crossing(i[0], a, o[0]), qc = crossing(i[1], b, o[0]),
                      rc = crossing(i[2], c, o[0]);
      out.add(p, q, r, rc, v * c);
      out.add(p, q, rc, qc, v * b * (1 - c));
      out.add(p, qc, rc, pc, v * a * (1 - b) * (1 - c));
      return;
    }
    default:
      out.list[out.count++] = piece;
  }
}

/// Position of one tet's corners relative to another one's planes.
struct Relation {
  Relation(const PlanedTet& tet, const PlanedTet& planes) : volume(tet.volume()) {
    for (int k = 0; k < 4; ++k) distances[k] = planes.distances(tet.corners()[k]);
    const Eigen::Array4d max_distances = distances[0].max(distances[1]).max(distances[2].max(distances[3]));
    apart = (max_distances <= 0).any();
    if (apart) return;
    const Eigen::Array4d min_distances = distances[0].min(distances[1]).min(distances[2].min(distances[3])),
                         // Ignore corners that are across a plane only by rounding, as at the two halves of a
                         // split edge.
        tolerance = Transfer::plane_rounding * max_distances.max(-min_distances);
    apart = (max_distances <= tolerance).any();
    for (int f = 0; f < 4; ++f)
      if (min_distances[f] < -tolerance[f]) crossed[count++] = f;
  }
  /// The tet as distances from the planes that cross it.
  Piece piece() const {
    Piece piece{{}, volume};
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < 4; ++k) piece.corners[k][i] = distances[k][crossed[i]];
    return piece;
  }

  double volume;
  std::array<Eigen::Array4d, 4> distances;  ///< of the corners
  std::array<int, 4> crossed{};             ///< planes
  int count = 0;
  bool apart = false;
};

}  // namespace

PlanedTet::PlanedTet(const TetCorners& corners)
    : corners_(corners), volume_(orient3d_value(corners[0], corners[1], corners[2], corners[3]) / 6) {
  for (int f = 0; f < 4; ++f) {
    const auto& face = tet_faces[f];
    const Vec3& origin = corners[face[0]];
    const Vec3 inward = (corners[face[2]] - origin).cross(corners[face[1]] - origin);
    for (int axis = 0; axis < 3; ++axis) inward_[axis][f] = inward[axis];
    offset_[f] = inward.dot(origin);
  }
}

double overlap_volume(const PlanedTet& first, const PlanedTet& second) {
  const bool ordered = first.volume() <= second.volume();
  const PlanedTet &smaller = ordered ? first : second, &larger = ordered ? second : first;
  // The planes of the larger tet separate most pairs.
  const Relation a(smaller, larger);
  if (a.apart) return 0;
  if (a.count == 0) return smaller.volume();
  const Relation b(larger, smaller);
  if (b.apart) return 0;
  const Relation& fewer = a.count <= b.count ? a : b;
  std::array<Pieces, 2> buffers;
  Pieces *pieces = &buffers[0], *next = &buffers[1];
  pieces->list[pieces->count++] = fewer.piece();
  for (int plane = 0; plane + 1 < fewer.count; ++plane) {
    next->count = 0;
    for (std::size_t i = 0; i < pieces->count; ++i) clip(pieces->list[i], plane, *next);
    std::swap(pieces, next);
  }
  double sum = 0;
  for (std::size_t i = 0; i < pieces->count; ++i) sum += volume_inside(pieces->list[i], fewer.count - 1);
  return sum;
}

}  // namespace tetwright
