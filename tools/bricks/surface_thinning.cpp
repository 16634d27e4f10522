// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/surface_thinning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/geometry/triangle_distance.h"
#include "tools/tuning/brick_rounds_tuning.h"

namespace tetwright {

namespace {

using Thinning = BrickRoundsTuning::Surface;

/// A surface whose points are removed.
class ThinnedSurface {
 public:
  ThinnedSurface(TetMesh& surface, const std::vector<std::uint8_t>& kept, double max_distance)
      : points_(surface.points),
        faces_(surface.interfaces),
        kept_(kept),
        max_squared_(max_distance * max_distance),
        first_corner_(points_.size(), no_index),
        next_corner_(3 * faces_.size()),
        first_removed_(faces_.size(), no_index),
        next_removed_(points_.size(), no_index),
        blocked_(points_.size(), 0) {
    for (std::size_t c = next_corner_.size(); c-- > 0;) push(point_at(static_cast<Index>(c)), c);
  }

  /// A pass over all points.
  /// \return the number of points removed
  std::size_t remove_points() {
    std::fill(blocked_.begin(), blocked_.end(), std::uint8_t{0});
    std::size_t removed = 0;
    for (Index p = 0; p < points_.size(); ++p)
      if (!kept_[p] && !blocked_[p] && first_corner_[p] != no_index) removed += remove(p);
    return removed;
  }

  /// Whether a face is left.
  bool has(std::size_t face) const { return faces_[face].ids[0] != no_index; }

 private:
  Index& point_at(Index corner) { return faces_[corner / 3].ids[corner % 3]; }
  void push(Index point, std::size_t corner) {
    next_corner_[corner] = first_corner_[point];
    first_corner_[point] = static_cast<Index>(corner);
  }
  template <class F>
  void for_each_face(Index point, const F& f) const {
    for (Index c = first_corner_[point]; c != no_index; c = next_corner_[c]) f(c / 3, c % 3);
  }

  /// Finds the faces and the neighbours of a point, in their order around it.
  /// \return false if they are no disc of one kind
  bool find_ring(Index p) {
    ring_.clear();
    around_.clear();
    open_.clear();
    bool one_kind = true;
    for_each_face(p, [&](Index f, Index k) {
      const InterfaceTriangle& t = faces_[f];
      open_.push_back({f, t.ids[(k + 1) % 3], t.ids[(k + 2) % 3]});
      const InterfaceTriangle& first = faces_[open_.front()[0]];
      one_kind &= t.material == first.material && t.other == first.other && t.patch == first.patch;
    });
    if (!one_kind || open_.size() < 4) return false;
    Index at = open_.front()[1];
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const auto found = std::find_if(open_.begin() + static_cast<std::ptrdiff_t>(i), open_.end(),
                                      [&](const auto& face) { return face[1] == at; });
      if (found == open_.end()) return false;
      std::swap(open_[i], *found);
      ring_.push_back(at);
      around_.push_back(open_[i][0]);
      at = open_[i][2];
    }
    // A point that the ring passes twice would be found twice.
    if (at != ring_.front()) return false;
    sorted_ = ring_;
    std::sort(sorted_.begin(), sorted_.end());
    return std::adjacent_find(sorted_.begin(), sorted_.end()) == sorted_.end();
  }

  bool remove(Index p) {
    if (!find_ring(p)) return false;
    const std::size_t n = ring_.size();
    candidates_.clear();
    for (std::size_t i = 0; i < n; ++i)
      candidates_.push_back({(points_[ring_[i]] - points_[p]).squaredNorm(), i});
    std::sort(candidates_.begin(), candidates_.end());
    const std::size_t tried = std::min(n, std::size_t{Thinning::tried_edges});
    for (std::size_t c = 0; c < tried; ++c)
      if (const std::size_t to = candidates_[c].second; topology_stays(to) && shape_stays(p, to)) {
        collapse(p, to);
        return true;
      }
    return false;
  }

  /// Whether the neighbours that p and ring_[to] have in common are the two beside their edge.
  bool topology_stays(std::size_t to) const {
    const std::size_t n = ring_.size();
    const Index before = ring_[(to + n - 1) % n], after = ring_[(to + 1) % n];
    bool stays = true;
    for_each_face(ring_[to], [&](Index f, Index) {
      for (const Index q : faces_[f].ids)
        stays &= q == ring_[to] || q == before || q == after ||
                 !std::binary_search(sorted_.begin(), sorted_.end(), q);
    });
    if (!stays || !kept_[ring_[to]]) return stays;
    // A new edge between two points that stay may exist on another surface as well.
    return std::none_of(ring_.begin(), ring_.end(),
                        [&](Index q) { return q != ring_[to] && q != before && q != after && kept_[q]; });
  }

  /// Whether the faces after the collapse of p to ring_[to] are near all points removed so far.
  bool shape_stays(Index p, std::size_t to) {
    const std::size_t n = ring_.size();
    const Vec3& target = points_[ring_[to]];
    distances_.clear();
    // The faces at `to` and the one before it vanish.
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const Vec3 &a = points_[ring_[(to + i) % n]], &b = points_[ring_[(to + i + 1) % n]];
      const Vec3 before = (a - points_[p]).cross(b - points_[p]), after = (a - target).cross(b - target);
      const double area_before = before.norm(), area_after = after.norm();
      if (!(before.dot(after) >= Thinning::min_cosine * area_before * area_after) || area_after == 0)
        return false;
      const auto longest = [&](const Vec3& at) {
        return std::max({(a - at).squaredNorm(), (b - at).squaredNorm(), (a - b).squaredNorm()});
      };
      const double share = Thinning::min_shape * std::sqrt(3) / 2;
      if (area_after < share * longest(target) &&
          area_after * longest(points_[p]) < area_before * longest(target))
        return false;
      distances_.emplace_back(target, a, b);
    }
    const auto nearest = [&](Index q) {
      double best = max_squared_;
      std::size_t face = distances_.size();
      for (std::size_t i = 0; i < distances_.size(); ++i)
        if (const double d = distances_[i].squared(points_[q], best); d < best) {
          best = d;
          face = i;
        }
      return face;
    };
    owners_.clear();
    const auto add = [&](Index q) {
      const std::size_t face = nearest(q);
      if (face == distances_.size()) return false;
      owners_.push_back({q, around_[(to + face + 1) % n]});
      return true;
    };
    if (!add(p)) return false;
    for (const Index f : around_)
      for (Index q = first_removed_[f]; q != no_index; q = next_removed_[q])
        if (!add(q)) return false;
    return true;
  }

  void collapse(Index p, std::size_t to) {
    const std::size_t n = ring_.size();
    const Index target = ring_[to];
    for (const Index f : around_) first_removed_[f] = no_index;
    for (const auto& [q, face] : owners_) next_removed_[q] = std::exchange(first_removed_[face], q);
    for (const std::size_t i : {to, (to + n - 1) % n}) vanish(around_[i]);
    for (Index c = first_corner_[p]; c != no_index;) {
      const Index next = next_corner_[c];
      if (has(c / 3)) {
        point_at(c) = target;
        push(target, c);
      }
      c = next;
    }
    first_corner_[p] = no_index;
    for (const Index q : ring_) blocked_[q] = 1;
  }
  /// Takes a face out of the lists of its points.
  void vanish(Index face) {
    for (Index k = 0; k < 3; ++k) {
      const Index corner = 3 * face + k;
      for (Index* at = &first_corner_[point_at(corner)]; *at != no_index; at = &next_corner_[*at])
        if (*at == corner) {
          *at = next_corner_[corner];
          break;
        }
    }
    faces_[face].ids = {no_index, no_index, no_index};
  }

  const std::vector<Vec3>& points_;
  std::vector<InterfaceTriangle>& faces_;
  const std::vector<std::uint8_t>& kept_;
  double max_squared_;
  /// Lists of the corners at each point: corner k of face f is 3 f + k.
  std::vector<Index> first_corner_, next_corner_;
  /// Lists of the removed points that each face stands for.
  std::vector<Index> first_removed_, next_removed_;
  std::vector<std::uint8_t> blocked_;  ///< by point: a neighbour was removed in this pass

  // The point that is looked at.
  std::vector<Index> ring_, sorted_;  ///< its neighbours in their order around it, and ascending
  std::vector<Index> around_;         ///< its faces: face i has ring_[i] and ring_[i + 1]
  std::vector<std::array<Index, 3>> open_;
  std::vector<std::pair<double, std::size_t>> candidates_;  ///< squared edges and indices into ring_
  std::vector<TriangleDistance> distances_;
  std::vector<std::pair<Index, Index>> owners_;  ///< removed points, and the face that now stands for them
};

}  // namespace

void thin_surface(TetMesh& surface, std::vector<std::uint8_t>& kept, double max_distance,
                  std::vector<InterfaceTriangle>& faces_left) {
  {
    ThinnedSurface thinned(surface, kept, max_distance);
    for (int pass = 0; pass < Thinning::passes; ++pass)
      if (thinned.remove_points() == 0) break;
  }
  std::erase_if(surface.interfaces, [](const InterfaceTriangle& t) { return t.ids[0] == no_index; });
  std::vector<Index> number(surface.points.size(), no_index);
  std::vector<Vec3> points;
  std::vector<std::uint8_t> kept_points;
  for (std::vector<InterfaceTriangle>* faces : {&surface.interfaces, &faces_left})
    for (InterfaceTriangle& t : *faces)
      for (Index& p : t.ids) {
        if (number[p] == no_index) {
          number[p] = static_cast<Index>(points.size());
          points.push_back(surface.points[p]);
          kept_points.push_back(kept[p]);
        }
        p = number[p];
      }
  surface.points = std::move(points);
  kept = std::move(kept_points);
}

}  // namespace tetwright
