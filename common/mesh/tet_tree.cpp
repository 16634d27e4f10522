// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/tet_tree.h"

#include <algorithm>

#include "common/geometry/morton.h"
#include "common/geometry/point_triangle.h"
#include "common/geometry/predicates.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr std::size_t tree_grain = 1024;

/// A box takes 48 bytes: with fewer tets in each leaf the boxes would take more memory than the mesh.
constexpr std::size_t leaf_tets = 8;

/// Corners of a tet.
using TetCorners = std::array<Vec3, 4>;

Box3 box_of(const TetCorners& corners) {
  Box3 box;
  for (const Vec3& p : corners) box.add(p);
  return box;
}

/// Weights of a point inside the tet or its mirror image; std::nullopt for other points and for flat tets.
std::optional<TetWeights> weights_inside(const TetCorners& c, const Vec3& p) {
  const double volume = orient3d_value(c[0], c[1], c[2], c[3]);
  const double edges =
      (c[1] - c[0]).squaredNorm() * (c[2] - c[0]).squaredNorm() * (c[3] - c[0]).squaredNorm();
  if (volume * volume <= tolerance::flat_squared * edges) return {};
  TetWeights w{orient3d_value(p, c[1], c[2], c[3]), orient3d_value(c[0], p, c[2], c[3]),
               orient3d_value(c[0], c[1], p, c[3]), orient3d_value(c[0], c[1], c[2], p)};
  double sum = 0;
  for (double& x : w) {
    if (volume < 0) x = -x;
    if (x < 0) return {};
    sum += x;
  }
  if (!(sum > 0)) return {};
  for (double& x : w) x /= sum;
  return w;
}

/// Nearest point of a tet's surface.
struct Nearest {
  double squared_distance = std::numeric_limits<double>::infinity();
  int face = 0;
  Vec3 place = Vec3::Zero();
};

std::array<Vec3, 3> face_corners(const TetCorners& c, int face) {
  const auto& f = tet_faces[face];
  return {c[f[0]], c[f[1]], c[f[2]]};
}

Nearest nearest_on_faces(const TetCorners& c, const Vec3& p) {
  Nearest best;
  for (int face = 0; face < 4; ++face) {
    const auto [a, b, d] = face_corners(c, face);
    const Vec3 q = closest_point(p, a, b, d);
    const double distance = (q - p).squaredNorm();
    if (distance < best.squared_distance) best = {distance, face, q};
  }
  return best;
}

}  // namespace

TetTree::TetTree(const TetMesh& mesh, Order order) : mesh_(mesh), tets_(mesh.tets.size()) {
  if (tets_.empty()) return;
  sort(order);
  tree_ = BoxTree(tets_.size(), leaf_tets, [&](std::size_t i) { return box_of(corners(tets_[i])); });
}

BoxTree::Range TetTree::of(MaterialTag material) const {
  // std::ranges is not used, since clang 14 cannot compile its subranges.
  const auto begin = std::partition_point(tets_.begin(), tets_.end(),
                                          [&](Index t) { return mesh_.materials[t] < material; });
  const auto end =
      std::partition_point(begin, tets_.end(), [&](Index t) { return mesh_.materials[t] == material; });
  if (begin == end) return all();
  return {static_cast<std::size_t>(begin - tets_.begin()), static_cast<std::size_t>(end - tets_.begin())};
}

FoundTet TetTree::find(const Vec3& p, const BoxTree::Range& range, double max_distance) const {
  if (tets_.empty()) return {};
  const FoundTet containing = find_containing(p, range);
  return containing.tet != no_index ? containing : find_nearest(p, range, max_distance);
}

TetTree::Corners TetTree::corners(Index t) const {
  const Tet& v = mesh_.tets[t];
  return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]], mesh_.points[v[3]]};
}

void TetTree::sort(Order order) {
  Box3 whole;
  for (const Tet& t : mesh_.tets)
    for (const Index p : t) whole.add(mesh_.points[p]);
  const MortonGrid grid(whole.low, whole.high);
  struct Key {
    MortonKey morton;
    MaterialTag material;
    Index tet;
  };
  std::vector<Key> keys(tets_.size());
  parallel_for(0, keys.size(), tree_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Box3 box = box_of(corners(static_cast<Index>(t)));
      keys[t] = {grid.key(box.low + (box.high - box.low) / 2), order == Order::place ? 0 : mesh_.materials[t],
                 static_cast<Index>(t)};
    }
  });
  parallel_sort(keys, [](const Key& a, const Key& b) {
    if (a.material != b.material) return a.material < b.material;
    return a.morton != b.morton ? a.morton < b.morton : a.tet < b.tet;
  });
  for (std::size_t i = 0; i < keys.size(); ++i) tets_[i] = keys[i].tet;
}

FoundTet TetTree::find_containing(const Vec3& p, const BoxTree::Range& range) const {
  FoundTet found;
  tree_.any_containing(p, range, [&](std::size_t i) {
    const TetCorners c = corners(tets_[i]);
    if (!box_of(c).contains(p)) return false;
    const auto w = weights_inside(c, p);
    if (w) found = {tets_[i], *w};
    return w.has_value();
  });
  return found;
}

FoundTet TetTree::find_nearest(const Vec3& p, const BoxTree::Range& range, double max_distance) const {
  Nearest best;
  Index tet = no_index;
  tree_.nearest(p, max_distance * max_distance, range, [&](std::size_t i, double so_far) {
    const TetCorners c = corners(tets_[i]);
    if (box_of(c).squared_distance(p) > so_far) return so_far;
    const Nearest n = nearest_on_faces(c, p);
    if (n.squared_distance > so_far || (n.squared_distance == so_far && tet < tets_[i])) return so_far;
    best = n;
    tet = tets_[i];
    return n.squared_distance;
  });
  FoundTet found{tet, {}};
  if (tet == no_index) return found;
  const auto [a, b, c] = face_corners(corners(tet), best.face);
  const std::array<double, 3> w = weights_in_triangle(best.place, a, b, c);
  for (int i = 0; i < 3; ++i) found.weights[tet_faces[best.face][i]] = w[i];
  return found;
}

}  // namespace tetwright
