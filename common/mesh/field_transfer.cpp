#include "common/mesh/field_transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "common/geometry/box_tree.h"
#include "common/geometry/morton.h"
#include "common/geometry/point_triangle.h"
#include "common/geometry/predicates.h"
#include "common/mesh/point_table.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"

namespace tetwright {

namespace {

constexpr std::size_t grain = 1024;

/// A box has 48 bytes: with fewer tets to a leaf the boxes outweigh the mesh.
constexpr std::size_t leaf_tets = 8;

/// Weights, one for each vertex of a tet; none negative, their sum is 1 but for rounding.
using Weights = std::array<double, 4>;

/// Corners of a tet.
using TetCorners = std::array<Vec3, 4>;

/// The weights of a point that the tet or its mirror image holds; nothing for others and in flat tets.
std::optional<Weights> weights_inside(const TetCorners& c, const Vec3& p) {
  const double volume = orient3d_value(c[0], c[1], c[2], c[3]);
  const double edges =
      (c[1] - c[0]).squaredNorm() * (c[2] - c[0]).squaredNorm() * (c[3] - c[0]).squaredNorm();
  if (volume * volume <= tolerance::flat_squared * edges) return {};
  Weights w{orient3d_value(p, c[1], c[2], c[3]), orient3d_value(c[0], p, c[2], c[3]),
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

/// The weights of a point of a triangle; those of a degenerate triangle are on its longest edge.
std::array<double, 3> weights_in_triangle(const std::array<Vec3, 3>& c, const Vec3& p) {
  std::array<double, 3> w{1, 0, 0};
  const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const double area = normal.squaredNorm();
  if (area > tolerance::flat_squared * (c[1] - c[0]).squaredNorm() * (c[2] - c[0]).squaredNorm()) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      w[i] = std::max(0.0, normal.dot((c[(i + 1) % 3] - p).cross(c[(i + 2) % 3] - p)));
      sum += w[i];
    }
    if (sum > 0) {
      for (double& x : w) x /= sum;
      return w;
    }
    w = {1, 0, 0};
  }
  int from = 0;
  double longest = 0;
  for (int i = 0; i < 3; ++i)
    if (const double length = (c[(i + 1) % 3] - c[i]).squaredNorm(); length > longest) {
      longest = length;
      from = i;
    }
  if (longest == 0) return w;
  const int to = (from + 1) % 3;
  const double t = std::clamp((p - c[from]).dot(c[to] - c[from]) / longest, 0.0, 1.0);
  w = {0, 0, 0};
  w[from] = 1 - t;
  w[to] = t;
  return w;
}

/// The place of a tet's surface that is nearest to a point.
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

/// A tet found for a point, and the point's weights in it.
struct Found {
  Index tet = no_index;
  Weights weights{};
};

/// Finds tets by place. The mesh may not change while it lives. Finding may run concurrently.
class TetTree {
 public:
  enum class Order {
    place,          ///< all tets in Morton order
    material_place  ///< those of each material together, so that a search may be restricted to one
  };

  TetTree(const TetMesh& mesh, Order order) : mesh_(mesh), tets_(mesh.tets.size()) {
    if (tets_.empty()) return;
    sort(order);
    tree_ = BoxTree(tets_.size(), leaf_tets, [&](std::size_t i) { return box_of(corners(tets_[i])); });
  }

  /// All tets, as positions in the tree's order.
  BoxTree::Range all() const { return tree_.all(); }
  /// The tets of a material, or all if it has none. Only with Order::material_place.
  BoxTree::Range of(MaterialTag material) const {
    // Not by std::ranges, whose subranges clang 14 cannot compile.
    const auto begin = std::partition_point(tets_.begin(), tets_.end(),
                                            [&](Index t) { return mesh_.materials[t] < material; });
    const auto end =
        std::partition_point(begin, tets_.end(), [&](Index t) { return mesh_.materials[t] == material; });
    if (begin == end) return all();
    return {static_cast<std::size_t>(begin - tets_.begin()), static_cast<std::size_t>(end - tets_.begin())};
  }

  /// A tet of the range that contains `p`, the first in the tree's order, or else the nearest, of those the
  /// one of the smallest number; no_index without tets.
  Found find(const Vec3& p, const BoxTree::Range& range) const {
    if (tets_.empty()) return {};
    const Found containing = find_containing(p, range);
    return containing.tet != no_index ? containing : find_nearest(p, range);
  }

 private:
  TetCorners corners(Index t) const {
    const Tet& v = mesh_.tets[t];
    return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]], mesh_.points[v[3]]};
  }

  static Box3 box_of(const TetCorners& corners) {
    Box3 box;
    for (const Vec3& p : corners) box.add(p);
    return box;
  }

  void sort(Order order) {
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
    parallel_for(0, keys.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const Box3 box = box_of(corners(static_cast<Index>(t)));
        keys[t] = {grid.key(box.low + (box.high - box.low) / 2),
                   order == Order::place ? 0 : mesh_.materials[t], static_cast<Index>(t)};
      }
    });
    parallel_sort(keys, [](const Key& a, const Key& b) {
      if (a.material != b.material) return a.material < b.material;
      return a.morton != b.morton ? a.morton < b.morton : a.tet < b.tet;
    });
    for (std::size_t i = 0; i < keys.size(); ++i) tets_[i] = keys[i].tet;
  }

  Found find_containing(const Vec3& p, const BoxTree::Range& range) const {
    Found found;
    tree_.any_containing(p, range, [&](std::size_t i) {
      const TetCorners c = corners(tets_[i]);
      if (!box_of(c).contains(p)) return false;
      const auto w = weights_inside(c, p);
      if (w) found = {tets_[i], *w};
      return w.has_value();
    });
    return found;
  }

  Found find_nearest(const Vec3& p, const BoxTree::Range& range) const {
    Nearest best;
    Index tet = no_index;
    tree_.nearest(p, best.squared_distance, range, [&](std::size_t i, double so_far) {
      const TetCorners c = corners(tets_[i]);
      if (box_of(c).squared_distance(p) > so_far) return so_far;
      const Nearest n = nearest_on_faces(c, p);
      if (n.squared_distance > so_far || (n.squared_distance == so_far && tet < tets_[i])) return so_far;
      best = n;
      tet = tets_[i];
      return n.squared_distance;
    });
    Found found{tet, {}};
    if (tet == no_index) return found;
    const std::array<double, 3> w = weights_in_triangle(face_corners(corners(tet), best.face), best.place);
    for (int i = 0; i < 3; ++i) found.weights[tet_faces[best.face][i]] = w[i];
    return found;
  }

  const TetMesh& mesh_;
  std::vector<Index> tets_;  ///< in the tree's order
  BoxTree tree_;
};

/// Fields like `fields`, for another number of points or tets.
std::vector<MeshField> empty_fields(const std::vector<MeshField>& fields, std::size_t count) {
  std::vector<MeshField> result;
  result.reserve(fields.size());
  for (const MeshField& f : fields)
    result.push_back({f.name, f.components, f.integer,
                      std::vector<double>(count * static_cast<std::size_t>(f.components),
                                          f.integer ? 0 : std::numeric_limits<double>::quiet_NaN())});
  return result;
}

void copy_values(const std::vector<MeshField>& from, std::size_t i, std::vector<MeshField>& to,
                 std::size_t j) {
  for (std::size_t f = 0; f < from.size(); ++f) {
    const auto components = static_cast<std::size_t>(from[f].components);
    for (std::size_t k = 0; k < components; ++k)
      to[f].values[j * components + k] = from[f].values[i * components + k];
  }
}

void interpolate(const std::vector<MeshField>& from, const Tet& t, const Weights& weights,
                 std::vector<MeshField>& to, std::size_t j) {
  int main = 0;
  for (int i = 1; i < 4; ++i)
    if (weights[i] > weights[main] || (weights[i] == weights[main] && t[i] < t[main])) main = i;
  for (std::size_t f = 0; f < from.size(); ++f) {
    const auto components = static_cast<std::size_t>(from[f].components);
    for (std::size_t k = 0; k < components; ++k) {
      const auto value = [&](int i) { return from[f].values[t[i] * components + k]; };
      double sum = value(main);
      // Differences, so that equal values stay to the bit; no weight, so that 0 * NaN does not count.
      if (!from[f].integer)
        for (int i = 0; i < 4; ++i)
          if (i != main && weights[i] > 0) sum += weights[i] * (value(i) - value(main));
      to[f].values[j * components + k] = sum;
    }
  }
}

void transfer_point_fields(const TetMesh& before, TetMesh& after) {
  after.point_fields = empty_fields(before.point_fields, after.points.size());
  if (before.point_fields.empty()) return;
  PointTable places(before.points, before.points.size());
  for (std::size_t p = 0; p < before.points.size(); ++p) places.add(static_cast<Index>(p));
  const TetTree tree(before, TetTree::Order::place);
  parallel_for(0, after.points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      if (const Index same = places.find(after.points[p]); same != no_index) {
        copy_values(before.point_fields, same, after.point_fields, p);
      } else if (const Found found = tree.find(after.points[p], tree.all()); found.tet != no_index) {
        interpolate(before.point_fields, before.tets[found.tet], found.weights, after.point_fields, p);
      }
    }
  });
}

void transfer_cell_fields(const TetMesh& before, TetMesh& after) {
  after.cell_fields = empty_fields(before.cell_fields, after.tets.size());
  if (before.cell_fields.empty()) return;
  const TetTree tree(before, TetTree::Order::material_place);
  parallel_for(0, after.tets.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      Vec3 centroid = Vec3::Zero();
      for (const Index p : after.tets[t]) centroid += after.points[p] / 4;
      const Found found = tree.find(centroid, tree.of(after.materials[t]));
      if (found.tet != no_index) copy_values(before.cell_fields, found.tet, after.cell_fields, t);
    }
  });
}

}  // namespace

void transfer_fields(const TetMesh& before, TetMesh& after) {
  transfer_point_fields(before, after);
  transfer_cell_fields(before, after);
}

}  // namespace tetwright
