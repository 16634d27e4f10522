// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/tet_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

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

/// Whether volumes in the tet are mostly rounding error.
bool is_flat(const TetCorners& c, double volume) {
  const double edges =
      (c[1] - c[0]).squaredNorm() * (c[2] - c[0]).squaredNorm() * (c[3] - c[0]).squaredNorm();
  return volume * volume <= tolerance::flat_squared * edges;
}

/// Weights of a point inside the tet or its mirror image; std::nullopt for other points and for flat tets.
std::optional<TetWeights> weights_inside(const TetCorners& c, const Vec3& p) {
  const double volume = orient3d_value(c[0], c[1], c[2], c[3]);
  if (is_flat(c, volume)) return {};
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

std::vector<Index> all_tets(const TetMesh& mesh) {
  std::vector<Index> tets(mesh.tets.size());
  std::iota(tets.begin(), tets.end(), Index{0});
  return tets;
}

/// Whether a positive tet contains the point, exactly.
bool contains_exactly(const TetCorners& c, const Vec3& p) {
  return orient3d(p, c[1], c[2], c[3]) >= 0 && orient3d(c[0], p, c[2], c[3]) >= 0 &&
         orient3d(c[0], c[1], p, c[3]) >= 0 && orient3d(c[0], c[1], c[2], p) >= 0;
}

/// Weights of a point of a face.
TetWeights weights_on_face(const TetCorners& c, int face, const Vec3& p) {
  const auto [a, b, d] = face_corners(c, face);
  const std::array<double, 3> w = weights_in_triangle(p, a, b, d);
  TetWeights weights{};
  for (int i = 0; i < 3; ++i) weights[tet_faces[face][i]] = w[i];
  return weights;
}

/// Weights of a point that a positive tet contains. Quotients of volumes lose as many digits as the tet is
/// flat, so their error is corrected until the weights reproduce the point: each step reduces it by a factor
/// that is the accuracy of the volumes.
TetWeights weights_within(const TetCorners& c, const Vec3& p) {
  constexpr int max_steps = 8;  // in the flattest tets a step gains two digits of sixteen
  int nearest = 0;
  for (int i = 1; i < 4; ++i)
    if ((p - c[i]).squaredNorm() < (p - c[nearest]).squaredNorm()) nearest = i;
  const double volume = orient3d_value(c[0], c[1], c[2], c[3]);
  const Vec3 e1 = c[1] - c[0], e2 = c[2] - c[0], e3 = c[3] - c[0];
  const std::array<Vec3, 3> gradients{e2.cross(e3) / volume, e3.cross(e1) / volume, e1.cross(e2) / volume};
  TetWeights w{}, next{};
  next[nearest] = 1;  // exact at a corner
  double error = std::numeric_limits<double>::infinity();
  for (int step = 0; step < max_steps; ++step) {
    Vec3 left = Vec3::Zero();
    for (int i = 0; i < 4; ++i) left += next[i] * (p - c[i]);
    if (!(left.squaredNorm() < error)) break;  // only rounding is left
    error = left.squaredNorm();
    w = next;
    for (int i = 0; i < 3; ++i) {
      const double change = gradients[i].dot(left);
      next[i + 1] += change;
      next[0] -= change;
    }
  }
  const auto least = static_cast<int>(std::min_element(w.begin(), w.end()) - w.begin());
  if (w[least] < 0) {
    // The point is on this face, but for rounding. With this weight alone set to 0 it would move within it.
    const auto [a, b, d] = face_corners(c, least);
    w = weights_on_face(c, least, closest_point(p, a, b, d));
  }
  const double sum = w[0] + w[1] + w[2] + w[3];
  for (double& x : w) x /= sum;
  return w;
}

}  // namespace

std::vector<Index> usable_tets(const TetMesh& mesh) {
  std::vector<Index> tets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& v = mesh.tets[t];
    const TetCorners c{mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]};
    const double volume = orient3d_value(c[0], c[1], c[2], c[3]);
    // Far from flat, the sign of the rounded volume is exact.
    if (volume > 0 && !is_flat(c, volume)) tets.push_back(static_cast<Index>(t));
  }
  return tets;
}

TetTree::TetTree(const TetMesh& mesh, Order order) : TetTree(mesh, all_tets(mesh), order) {}

TetTree::TetTree(const TetMesh& mesh, std::vector<Index> tets, Order order)
    : mesh_(mesh), tets_(std::move(tets)) {
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

FoundTet TetTree::find_exactly(const Vec3& p) const {
  FoundTet found;
  tree_.any_containing(p, tree_.all(), [&](std::size_t i) {
    if (tets_[i] >= found.tet) return false;
    const TetCorners c = corners(tets_[i]);
    if (box_of(c).contains(p) && contains_exactly(c, p)) found.tet = tets_[i];
    return false;  // a tet with a smaller index may follow
  });
  if (found.tet == no_index) return find_nearest(p, tree_.all(), std::numeric_limits<double>::infinity());
  found.weights = weights_within(corners(found.tet), p);
  return found;
}

TetTree::Corners TetTree::corners(Index t) const {
  const Tet& v = mesh_.tets[t];
  return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]], mesh_.points[v[3]]};
}

void TetTree::sort(Order order) {
  Box3 whole;
  for (const Index t : tets_)
    for (const Index p : mesh_.tets[t]) whole.add(mesh_.points[p]);
  const MortonGrid grid(whole.low, whole.high);
  struct Key {
    MortonKey morton;
    MaterialTag material;
    Index tet;
  };
  std::vector<Key> keys(tets_.size());
  parallel_for(0, keys.size(), tree_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Index t = tets_[i];
      const Box3 box = box_of(corners(t));
      keys[i] = {grid.key(box.low + (box.high - box.low) / 2), order == Order::place ? 0 : mesh_.materials[t],
                 t};
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
    if (w) found = {tets_[i], *w, 0};
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
  FoundTet found{tet, {}, std::sqrt(best.squared_distance)};
  if (tet == no_index) return {};
  found.weights = weights_on_face(corners(tet), best.face, best.place);
  return found;
}

}  // namespace tetwright
