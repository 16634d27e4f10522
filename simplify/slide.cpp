#include "simplify/slide.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "common/morton.h"
#include "common/parallel.h"
#include "common/parallel_sort.h"
#include "common/point_triangle.h"

namespace tetwright {

namespace {

constexpr std::size_t leaf_items = 4;
constexpr std::size_t slide_grain = 4096;

/// Rounded outward, so that a box in single precision holds what it must.
float below(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float above(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

/// Points of the mesh that are used, numbered anew.
class PointCopies {
 public:
  explicit PointCopies(const EditableMesh& mesh) : mesh_(mesh), numbers_(mesh.point_slots(), no_index) {}
  Index number(Index p) {
    if (numbers_[p] == no_index) {
      numbers_[p] = static_cast<Index>(points.size());
      points.push_back(mesh_.position(p));
    }
    return numbers_[p];
  }
  std::vector<Vec3> points;

 private:
  const EditableMesh& mesh_;
  std::vector<Index> numbers_;
};

}  // namespace

NearestTree::NearestTree(std::vector<Vec3> points, std::vector<Item> items)
    : points_(std::move(points)), items_(std::move(items)) {
  if (items_.empty()) return;
  Vec3 low = points_.front(), high = low;
  for (const Vec3& p : points_) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const MortonGrid grid(low, high);
  struct Key {
    std::uint64_t morton;
    std::uint32_t item;
  };
  std::vector<Key> keys(items_.size());
  parallel_for(0, keys.size(), slide_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& c = items_[i].corners;
      keys[i] = {grid.key((points_[c[0]] + points_[c[1]] + points_[c[2]]) / 3),
                 static_cast<std::uint32_t>(i)};
    }
  });
  parallel_sort(keys, [](const Key& a, const Key& b) {
    return a.morton != b.morton ? a.morton < b.morton : a.item < b.item;
  });
  std::vector<Item> sorted(items_.size());
  for (std::size_t i = 0; i < keys.size(); ++i) sorted[i] = items_[keys[i].item];
  items_ = std::move(sorted);

  leaves_ = std::bit_ceil((items_.size() + leaf_items - 1) / leaf_items);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  boxes_.assign(2 * leaves_ - 1, {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}});
  for (std::size_t i = 0; i < items_.size(); ++i) {
    Box& box = boxes_[leaves_ - 1 + i / leaf_items];
    for (Index corner : items_[i].corners)
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], below(points_[corner][axis]));
        box.high[axis] = std::max(box.high[axis], above(points_[corner][axis]));
      }
  }
  for (std::size_t k = leaves_ - 1; k-- > 0;)
    for (int axis = 0; axis < 3; ++axis) {
      boxes_[k].low[axis] = std::min(boxes_[2 * k + 1].low[axis], boxes_[2 * k + 2].low[axis]);
      boxes_[k].high[axis] = std::max(boxes_[2 * k + 1].high[axis], boxes_[2 * k + 2].high[axis]);
    }
}

double NearestTree::squared_distance_to(const Box& box, const Vec3& p) const {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::max({box.low[axis] - p[axis], p[axis] - box.high[axis], 0.0});
    sum += d * d;
  }
  return sum;
}

std::optional<Vec3> NearestTree::nearest(const Vec3& p, Region first, Region second, double most) const {
  if (items_.empty()) return {};
  if (first > second) std::swap(first, second);
  double best = most * most;
  std::optional<Vec3> found;
  struct Entry {
    std::size_t node;
    double distance;
  };
  std::array<Entry, 64> stack;  // the tree of 2^32 items is 31 deep, and each level leaves one entry behind
  std::size_t size = 0;
  stack[size++] = {0, squared_distance_to(boxes_[0], p)};
  while (size > 0) {
    const Entry e = stack[--size];
    if (e.distance > best) continue;
    if (e.node >= leaves_ - 1) {
      const std::size_t begin = (e.node - (leaves_ - 1)) * leaf_items;
      for (std::size_t i = begin; i < std::min(items_.size(), begin + leaf_items); ++i) {
        const Item& item = items_[i];
        if (item.first != first || item.second != second) continue;
        const Vec3 q =
            closest_point(p, points_[item.corners[0]], points_[item.corners[1]], points_[item.corners[2]]);
        const double d = (q - p).squaredNorm();
        if (d > best || (d == best && found)) continue;
        best = d;
        found = q;
      }
      continue;
    }
    Entry near{2 * e.node + 1, squared_distance_to(boxes_[2 * e.node + 1], p)};
    Entry far{2 * e.node + 2, squared_distance_to(boxes_[2 * e.node + 2], p)};
    if (far.distance < near.distance) std::swap(near, far);
    if (far.distance <= best) stack[size++] = far;
    if (near.distance <= best) stack[size++] = near;
  }
  return found;
}

Slide::Slide(const EditableMesh& mesh, const ReferenceSurface* given) : given_(given), mesh_(&mesh) {
  const std::vector<EditableMesh::InterfaceFace> faces = mesh.interface_faces();
  if (!given) {
    PointCopies points(mesh);
    std::vector<NearestTree::Item> triangles;
    triangles.reserve(faces.size());
    for (const EditableMesh::InterfaceFace& f : faces)
      triangles.push_back({{points.number(f.ids[0]), points.number(f.ids[1]), points.number(f.ids[2])},
                           std::min(f.inside, f.across),
                           std::max(f.inside, f.across)});
    surfaces_ = NearestTree(std::move(points.points), std::move(triangles));
  }
  // The edges with other than two of the triangles: junction curves, and where the input is not manifold.
  std::vector<std::uint64_t> edges(3 * faces.size());
  parallel_for(0, faces.size(), slide_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int k = 0; k < 3; ++k) {
        const Index p = faces[i].ids[k], q = faces[i].ids[(k + 1) % 3];
        edges[3 * i + k] = std::uint64_t{std::min(p, q)} << 32 | std::max(p, q);
      }
  });
  parallel_sort(edges);
  PointCopies points(mesh);
  std::vector<NearestTree::Item> segments;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    if (j - i != 2) {
      const Index a = points.number(static_cast<Index>(edges[i] >> 32)),
                  b = points.number(static_cast<Index>(edges[i]));
      segments.push_back({{a, b, b}, 0, 0});
    }
    i = j;
  }
  // Where other than two segments meet, curves end or branch.
  std::vector<std::uint32_t> degrees(points.points.size(), 0);
  for (const NearestTree::Item& s : segments)
    for (Index p : {s.corners[0], s.corners[1]}) ++degrees[p];
  std::vector<NearestTree::Item> corners;
  for (Index p = 0; p < degrees.size(); ++p)
    if (degrees[p] != 2) corners.push_back({{p, p, p}, 0, 0});
  corners_ = NearestTree(points.points, std::move(corners));
  curves_ = NearestTree(std::move(points.points), std::move(segments));
}

std::optional<Vec3> Slide::onto_surface(const Vec3& p, Region first, Region second, double most) const {
  if (!given_) return surfaces_.nearest(p, first, second, most);
  const auto tag = [&](Region r) -> ReferenceSurface::Region {
    if (r == beyond_mesh) return {};
    return mesh_->tag(r);
  };
  const auto place = given_->project(mesh_->to_input(p), tag(first), tag(second), most / mesh_->scale());
  if (!place) return {};
  return mesh_->to_working(*place);
}

}  // namespace tetwright
