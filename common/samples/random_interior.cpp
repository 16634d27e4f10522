// SPDX-License-Identifier: Apache-2.0
#include "common/samples/random_interior.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "common/geometry/predicates.h"
#include "common/random.h"

namespace tetwright {

namespace {

constexpr std::uint64_t skin_seed = 1, interior_seed = 2, walk_seed = 3;
/// Maximum displacement of a skin point from the grid, in cells; at a quarter or more, squares could fold
/// over.
constexpr double skin_jitter = 0.22;
/// Maximum number of steps of a walk to the tet that contains a point. All tets are searched after that,
/// since the body is not convex and a walk may end at the skin.
constexpr int max_steps = 2000;

/// Maps a point on the surface of the cube [-1, 1]^3 to the skin. Uses only sqrt, so that the bits are the
/// same on every machine.
Vec3 on_blob(const Vec3& p, double thickness) {
  const Vec3 u = p / std::sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
  const double radius = 1 + 0.3 * u.x() * u.y() + 0.25 * u.z() * u.z() * u.x() - 0.2 * u.y() * u.y();
  return {1.4 * radius * u.x(), radius * u.y(), thickness * radius * u.z()};
}

/// The cube's surface as squares, each split along a diagonal chosen at random, oriented outwards.
class Skin {
 public:
  Skin(Index cells, double thickness) : n_(cells), thickness_(thickness) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const Index side : {Index{0}, n_})
        for (Index i = 0; i < n_; ++i)
          for (Index j = 0; j < n_; ++j) add_square(axis, side, i, j);
  }

  std::vector<Vec3> points;
  std::vector<Triangle> triangles;

 private:
  Index point(std::size_t axis, Index side, Index u, Index v) {
    std::array<Index, 3> at;
    at[axis] = side;
    at[(axis + 1) % 3] = u;
    at[(axis + 2) % 3] = v;
    const auto [entry, is_new] = ids_.try_emplace(at, static_cast<Index>(points.size()));
    if (is_new) {
      // Points on the cube's edges move along their edge; its corners do not move.
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        const Index c = at[static_cast<std::size_t>(k)];
        const double away = c == 0 || c == n_ ? 0 : skin_jitter * (2 * random_.uniform() - 1);
        p[k] = 2 * (c + away) / n_ - 1;
      }
      points.push_back(on_blob(p, thickness_));
    }
    return entry->second;
  }

  void add_square(std::size_t axis, Index side, Index i, Index j) {
    std::array<Index, 4> q{point(axis, side, i, j), point(axis, side, i + 1, j),
                           point(axis, side, i + 1, j + 1), point(axis, side, i, j + 1)};
    if (side == 0) std::swap(q[1], q[3]);
    if (random_.below(2)) q = {q[1], q[2], q[3], q[0]};
    triangles.push_back({q[0], q[1], q[2]});
    triangles.push_back({q[0], q[2], q[3]});
  }

  Index n_;
  double thickness_;
  Random random_{skin_seed};
  std::map<std::array<Index, 3>, Index> ids_;
};

/// Whether p lies inside the circumsphere of a positive tet, up to rounding. A wrong decision leaves a tet
/// that is Delaunay up to rounding.
bool in_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& p) {
  const Vec3 ap = a - p, bp = b - p, cp = c - p, dp = d - p;
  const auto det = [](const Vec3& u, const Vec3& v, const Vec3& w) {
    return orient3d_value(Vec3::Zero(), u, v, w);
  };
  const auto square = [](const Vec3& v) { return v.x() * v.x() + v.y() * v.y() + v.z() * v.z(); };
  return square(ap) * det(bp, cp, dp) - square(bp) * det(ap, cp, dp) + square(cp) * det(ap, bp, dp) -
             square(dp) * det(ap, bp, cp) >
         0;
}

/// Incremental insertion of points (Bowyer 1981, Watson 1981). No cavity reaches across the skin.
class Insertion {
 public:
  /// Starts with the skin connected to the origin, from which all of it is visible.
  explicit Insertion(Skin&& skin) : points(std::move(skin.points)) {
    const auto origin = static_cast<Index>(points.size());
    points.push_back(Vec3::Zero());
    OpenFaces open;
    for (const Triangle& s : skin.triangles) {
      const auto t = static_cast<Index>(tets.size());
      tets.push_back({{origin, s[0], s[1], s[2]}, {no_index, no_index, no_index, no_index}});
      join(t, open);
    }
    mark_.resize(tets.size(), 0);
  }

  struct Cell {
    Tet points;
    std::array<Index, 4> next;  ///< across the face opposite each point; no_index: the skin
  };
  static constexpr Tet dead{no_index, no_index, no_index, no_index};
  std::vector<Vec3> points;
  std::vector<Cell> tets;  ///< deleted tets have the points `dead`

  /// Inserts a point. Returns false and leaves it out if it lies on a face, or would lie on a face of a tet
  /// that must be kept.
  bool insert(const Vec3& p) {
    const Index first = locate(p);
    if (first == no_index) return false;
    find_cavity(first, p);
    while (drop_hidden_faces(p)) {
    }
    if (cavity_.empty() || !contains_all_of(first)) return false;
    fill_cavity(p);
    return true;
  }

 private:
  /// Faces at the apex that have only one tet so far, by their other two points.
  using OpenFaces = std::map<std::pair<Index, Index>, std::pair<Index, int>>;

  const Vec3& at(Index t, int k) const { return points[tets[t].points[static_cast<std::size_t>(k)]]; }

  /// Orientation of the tet formed by p and a face: positive if p is on the inner side.
  int side(Index t, int face, const Vec3& p) const {
    const auto& f = tet_faces[static_cast<std::size_t>(face)];
    return -orient3d(at(t, f[0]), at(t, f[1]), at(t, f[2]), p);
  }

  bool holds(Index t, const Vec3& p) const {
    for (int f = 0; f < 4; ++f)
      if (side(t, f, p) <= 0) return false;
    return true;
  }

  /// Tet that contains p in its interior; no_index if p lies on a face.
  Index locate(const Vec3& p) {
    Index t = last_;
    for (int step = 0; step < max_steps; ++step) {
      Index next = no_index;
      bool outside_one = false;
      const int turn = static_cast<int>(walk_.below(4));
      for (int k = 0; k < 4 && next == no_index; ++k) {
        const int f = (k + turn) % 4;
        const int s = side(t, f, p);
        if (s == 0) return no_index;
        if (s > 0) continue;
        outside_one = true;
        next = tets[t].next[static_cast<std::size_t>(f)];
      }
      if (!outside_one) return t;
      if (next == no_index) break;
      t = next;
    }
    for (t = 0; t < tets.size(); ++t)
      if (tets[t].points != dead && holds(t, p)) return t;
    return no_index;
  }

  void find_cavity(Index first, const Vec3& p) {
    ++round_;
    cavity_.assign(1, first);
    mark_[first] = round_;
    for (std::size_t i = 0; i < cavity_.size(); ++i)
      for (const Index next : tets[cavity_[i]].next) {
        if (next == no_index || mark_[next] == round_) continue;
        if (!in_sphere(at(next, 0), at(next, 1), at(next, 2), at(next, 3), p)) continue;
        mark_[next] = round_;
        cavity_.push_back(next);
      }
  }

  /// Removes tets from the cavity that have a hull face not visible from p, and returns whether there were
  /// any. They occur near the skin, where the mesh is not Delaunay, and elsewhere where rounding decided.
  bool drop_hidden_faces(const Vec3& p) {
    const std::size_t before = cavity_.size();
    std::erase_if(cavity_, [&](Index t) {
      for (int f = 0; f < 4; ++f) {
        const Index next = tets[t].next[static_cast<std::size_t>(f)];
        if (next != no_index && mark_[next] == round_) continue;
        if (side(t, f, p) > 0) continue;
        mark_[t] = 0;
        return true;
      }
      return false;
    });
    return cavity_.size() < before;
  }

  /// Whether the cavity still contains the tet of p and no point is lost with it.
  bool contains_all_of(Index first) {
    if (mark_[first] != round_) return false;
    std::vector<Index> inner, outer;
    for (const Index t : cavity_)
      for (std::size_t f = 0; f < 4; ++f) {
        inner.push_back(tets[t].points[f]);
        const Index next = tets[t].next[f];
        if (next != no_index && mark_[next] == round_) continue;
        for (const std::uint8_t k : tet_faces[f]) outer.push_back(tets[t].points[k]);
      }
    for (std::vector<Index>* list : {&inner, &outer}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    return inner == outer;
  }

  void fill_cavity(const Vec3& p) {
    const auto apex = static_cast<Index>(points.size());
    points.push_back(p);
    struct HullFace {
      Triangle ids;
      Index outside;
      int back;  ///< index of this face in `outside`
    };
    std::vector<HullFace> hull;
    for (const Index t : cavity_)
      for (int f = 0; f < 4; ++f) {
        const Index next = tets[t].next[static_cast<std::size_t>(f)];
        if (next != no_index && mark_[next] == round_) continue;
        const auto& ids = tet_faces[static_cast<std::size_t>(f)];
        int back = 0;
        if (next != no_index)
          while (tets[next].next[static_cast<std::size_t>(back)] != t) ++back;
        hull.push_back(
            {{tets[t].points[ids[0]], tets[t].points[ids[1]], tets[t].points[ids[2]]}, next, back});
      }
    // There are usually, but not always, more new tets than old ones.
    for (; cavity_.size() < hull.size() && !free_.empty(); free_.pop_back()) cavity_.push_back(free_.back());
    for (; cavity_.size() < hull.size(); tets.push_back({}))
      cavity_.push_back(static_cast<Index>(tets.size()));
    for (; cavity_.size() > hull.size(); cavity_.pop_back()) {
      tets[cavity_.back()] = {dead, dead};
      free_.push_back(cavity_.back());
    }
    mark_.resize(tets.size(), 0);
    OpenFaces open;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Index t = cavity_[i];
      const auto& [ids, outside, back] = hull[i];
      tets[t] = {{apex, ids[0], ids[1], ids[2]}, {outside, no_index, no_index, no_index}};
      if (outside != no_index) tets[outside].next[static_cast<std::size_t>(back)] = t;
      join(t, open);
      last_ = t;
    }
  }

  /// Links a tet (apex, a, b, c) to the other tets at the apex, across the edges of its outer face.
  void join(Index t, OpenFaces& open) {
    for (int f = 1; f < 4; ++f) {
      const Index a = tets[t].points[static_cast<std::size_t>(f % 3 + 1)];
      const Index b = tets[t].points[static_cast<std::size_t>((f + 1) % 3 + 1)];
      const auto [entry, is_new] = open.try_emplace(std::minmax(a, b), std::pair(t, f));
      if (is_new) continue;
      const auto [other, face] = entry->second;
      tets[t].next[static_cast<std::size_t>(f)] = other;
      tets[other].next[static_cast<std::size_t>(face)] = t;
    }
  }

  std::vector<Index> cavity_, free_;
  std::vector<std::uint32_t> mark_;  ///< by tet: last round in which it was in the cavity
  std::uint32_t round_ = 0;
  Index last_ = 0;
  Random walk_{walk_seed};
};

/// Random points, uniform over the body: tets of a fan over the skin are chosen in proportion to their
/// volumes.
class Interior {
 public:
  explicit Interior(const Skin& skin) : skin_(skin) {
    for (const Triangle& s : skin.triangles) {
      const double volume =
          orient3d_value(Vec3::Zero(), skin.points[s[0]], skin.points[s[1]], skin.points[s[2]]);
      sums_.push_back((sums_.empty() ? 0 : sums_.back()) + volume);
    }
  }
  Vec3 next() {
    const auto chosen = std::upper_bound(sums_.begin(), sums_.end(), random_.uniform() * sums_.back());
    const auto i = std::min(static_cast<std::size_t>(chosen - sums_.begin()), sums_.size() - 1);
    // The gaps between three sorted uniform numbers are uniform barycentric coordinates.
    std::array<double, 3> w{random_.uniform(), random_.uniform(), random_.uniform()};
    std::sort(w.begin(), w.end());
    const Triangle& s = skin_.triangles[i];
    return w[0] * skin_.points[s[0]] + (w[1] - w[0]) * skin_.points[s[1]] +
           (w[2] - w[1]) * skin_.points[s[2]];
  }

 private:
  const Skin& skin_;
  std::vector<double> sums_;
  Random random_{interior_seed};
};

}  // namespace

TetMesh random_interior(Index skin_cells, std::size_t interior_points, double thickness) {
  Skin skin(skin_cells, thickness);
  Interior interior(skin);
  std::vector<Vec3> inside;
  for (std::size_t i = 0; i + 1 < interior_points; ++i) inside.push_back(interior.next());
  Insertion insertion(std::move(skin));
  for (const Vec3& p : inside) insertion.insert(p);
  TetMesh mesh;
  mesh.points = std::move(insertion.points);
  for (const Insertion::Cell& t : insertion.tets)
    if (t.points != Insertion::dead) mesh.tets.push_back(t.points);
  mesh.materials.assign(mesh.tets.size(), 1);
  mesh.material_names = {{1, "body"}};
  return mesh;
}

}  // namespace tetwright
