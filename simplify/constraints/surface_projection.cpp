#include "simplify/constraints/surface_projection.h"

#include <algorithm>

#include "common/geometry/morton.h"
#include "common/geometry/point_triangle.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

constexpr std::size_t leaf_items = 4;
constexpr std::size_t projection_grain = 4096;

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

ProjectionTree::ProjectionTree(std::vector<Vec3> points, std::vector<Item> items)
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
  parallel_for(0, keys.size(), projection_grain, [&](std::size_t begin, std::size_t end) {
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

  tree_ = BoxTree(items_.size(), leaf_items, [&](std::size_t i) {
    Box3 box;
    for (Index corner : items_[i].corners) box.add(points_[corner]);
    return box;
  });
}

std::optional<Vec3> ProjectionTree::nearest(const Vec3& p, RegionId first, RegionId second,
                                            double max_distance) const {
  if (first > second) std::swap(first, second);
  std::optional<Vec3> found;
  tree_.nearest(p, max_distance * max_distance, tree_.all(), [&](std::size_t i, double best) {
    const Item& item = items_[i];
    if (item.first != first || item.second != second) return best;
    const Vec3 q =
        closest_point(p, points_[item.corners[0]], points_[item.corners[1]], points_[item.corners[2]]);
    const double d = (q - p).squaredNorm();
    if (d > best || (d == best && found)) return best;
    found = q;
    return d;
  });
  return found;
}

SurfaceProjection::SurfaceProjection(const EditableMesh& mesh, const ReferenceSurface* given)
    : given_(given), mesh_(&mesh) {
  const std::vector<InterfaceFace> faces = mesh.interface_faces();
  if (!given) {
    PointCopies points(mesh);
    std::vector<ProjectionTree::Item> triangles;
    triangles.reserve(faces.size());
    for (const InterfaceFace& f : faces)
      triangles.push_back({{points.number(f.ids[0]), points.number(f.ids[1]), points.number(f.ids[2])},
                           std::min(f.inside, f.across),
                           std::max(f.inside, f.across)});
    surfaces_ = ProjectionTree(std::move(points.points), std::move(triangles));
  }
  // The edges with other than two of the triangles, or two of different patches: junction curves, and where
  // the input is not manifold.
  struct Side {
    std::uint64_t edge;
    PatchId patch;
  };
  std::vector<Side> edges(3 * faces.size());
  parallel_for(0, faces.size(), projection_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int k = 0; k < 3; ++k) {
        const Index p = faces[i].ids[k], q = faces[i].ids[(k + 1) % 3];
        edges[3 * i + k] = {std::uint64_t{std::min(p, q)} << 32 | std::max(p, q), faces[i].patch};
      }
  });
  parallel_sort(edges, [](const Side& a, const Side& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.patch < b.patch;
  });
  PointCopies points(mesh);
  std::vector<ProjectionTree::Item> segments;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j].edge == edges[i].edge) ++j;
    if (j - i != 2 || edges[i].patch != edges[i + 1].patch) {
      const Index a = points.number(static_cast<Index>(edges[i].edge >> 32)),
                  b = points.number(static_cast<Index>(edges[i].edge));
      segments.push_back({{a, b, b}, 0, 0});
    }
    i = j;
  }
  // Where other than two segments meet, curves end or branch.
  std::vector<std::uint32_t> degrees(points.points.size(), 0);
  for (const ProjectionTree::Item& s : segments)
    for (Index p : {s.corners[0], s.corners[1]}) ++degrees[p];
  std::vector<ProjectionTree::Item> corners;
  for (Index p = 0; p < degrees.size(); ++p)
    if (degrees[p] != 2) corners.push_back({{p, p, p}, 0, 0});
  corners_ = ProjectionTree(points.points, std::move(corners));
  curves_ = ProjectionTree(std::move(points.points), std::move(segments));
}

std::optional<Vec3> SurfaceProjection::onto_surface(const Vec3& p, RegionId first, RegionId second,
                                                    double max_distance) const {
  if (!given_) return surfaces_.nearest(p, first, second, max_distance);
  const auto tag = [&](RegionId r) -> MaterialOrOutside {
    if (r == outside_id) return {};
    return mesh_->tag(r);
  };
  const auto place = given_->project(mesh_->space().to_input(p), tag(first), tag(second),
                                     max_distance / mesh_->space().scale());
  if (!place) return {};
  return mesh_->space().to_working(*place);
}

}  // namespace tetwright
