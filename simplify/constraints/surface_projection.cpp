// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/surface_projection.h"

#include <algorithm>

#include "common/parallel/parallel_sort.h"
#include "simplify/mesh/local_numbers.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;
using Projection = SimplifyTuning::Projection;

ProjectionTree::Kind kind_of(RegionId first, RegionId second, PatchId patch) {
  return {std::min(first, second), std::max(first, second), patch};
}

/// Copies of the points in use, renumbered.
class PointCopies {
 public:
  explicit PointCopies(std::span<const Vec3> from) : from_(from) {}
  Index number(Index p) {
    bool added;
    const std::uint32_t n = numbers_.number(p, added);
    if (added) points.push_back(from_[p]);
    return n;
  }
  std::vector<Vec3> points;

 private:
  std::span<const Vec3> from_;
  LocalNumbers numbers_;
};

}  // namespace

SurfaceProjection::SurfaceProjection(const EditableMesh& mesh, std::span<const Vec3> positions,
                                     const std::vector<InterfaceFace>& faces, const ReferenceSurface* given,
                                     const std::function<bool(Index)>& complete)
    : has_patches_(
          (!given || given->has_patches()) &&
          std::any_of(faces.begin(), faces.end(), [](const InterfaceFace& f) { return f.patch != 0; })),
      has_sheets_(
          std::any_of(faces.begin(), faces.end(), [](const InterfaceFace& f) { return f.is_sheet(); })),
      given_patches_(has_patches_ && given),
      has_labels_(given_patches_ && given->first_body_patch() != 0),
      given_(given),
      mesh_(&mesh) {
  if (!given_ || has_sheets_) {
    PointCopies points(positions);
    std::vector<ProjectionTree::Item> triangles;
    triangles.reserve(faces.size());
    for (const InterfaceFace& f : faces) {
      // A given surface does not have the sheets.
      if (given_ && !f.is_sheet()) continue;
      triangles.push_back({{points.number(f.ids[0]), points.number(f.ids[1]), points.number(f.ids[2])},
                           kind_of(f.inside, f.across, f.patch)});
    }
    surfaces_ = ProjectionTree(std::move(points.points), std::move(triangles));
  }
  // Collect the edges with a number of triangles other than two, or with two of different patches: junction
  // curves, and nonmanifold edges of the input.
  struct Edge {
    std::uint64_t key;
    PatchId patch;
    bool sheet;
  };
  // The edges of a range of first points are sorted at a time: all of them would take more memory than the
  // surface.
  const auto edges_from = [&](std::size_t low, std::size_t high) {
    std::vector<Edge> edges = parallel_collect<Edge>(
        0, faces.size(), Grains::surface_triangles,
        [&](std::size_t begin, std::size_t end, std::vector<Edge>& out) {
          for (std::size_t i = begin; i < end; ++i)
            for (int k = 0; k < 3; ++k) {
              const auto [p, q] = std::minmax(faces[i].ids[k], faces[i].ids[(k + 1) % 3]);
              if (p >= low && p < high)
                out.push_back({std::uint64_t{p} << 32 | q, faces[i].patch, faces[i].is_sheet()});
            }
        });
    parallel_sort(edges, [](const Edge& x, const Edge& y) {
      return x.key != y.key ? x.key < y.key : x.patch < y.patch;
    });
    return edges;
  };
  PointCopies points(positions);
  std::vector<ProjectionTree::Item> segments;
  const auto add_curves = [&](const std::vector<Edge>& edges) {
    for (std::size_t i = 0; i < edges.size();) {
      std::size_t j = i + 1;
      bool sheet = edges[i].sheet;
      while (j < edges.size() && edges[j].key == edges[i].key) sheet |= edges[j++].sheet;
      const auto p = static_cast<Index>(edges[i].key >> 32), q = static_cast<Index>(edges[i].key);
      // A given surface with patches provides its own feature edges, but not those of sheets, nor where it
      // gives up creases.
      const auto is_own = [&] {
        return !given_patches_ || has_labels_ || sheet || lacks_creases((positions[p] + positions[q]) / 2);
      };
      if ((j - i != 2 || (edges[i].patch != edges[i + 1].patch && is_own())) && complete(p) && complete(q) &&
          (sheet || !given_has_curve(positions[p], positions[q], j - i != 2))) {
        const Index a = points.number(p), b = points.number(q);
        segments.push_back({{a, b, b}, {}});
      }
      i = j;
    }
  };
  const std::size_t ranges = 1 + faces.size() / Projection::faces_at_once;
  for (std::size_t range = 0; range < ranges; ++range)
    add_curves(edges_from(range * positions.size() / ranges, (range + 1) * positions.size() / ranges));
  // Curves end or branch where the number of segments is not two.
  std::vector<std::uint32_t> degrees(points.points.size(), 0);
  for (const ProjectionTree::Item& s : segments)
    for (Index p : {s.corners[0], s.corners[1]}) ++degrees[p];
  std::vector<ProjectionTree::Item> corners;
  for (Index p = 0; p < degrees.size(); ++p)
    if (degrees[p] != 2) corners.push_back({{p, p, p}, {}});
  corners_ = ProjectionTree(points.points, std::move(corners));
  curves_ = ProjectionTree(std::move(points.points), std::move(segments));
}

bool SurfaceProjection::given_has_curve(const Vec3& p, const Vec3& q, bool junction) const {
  if (!given_patches_ || (junction && !given_->has_junctions())) return false;
  const WorkingSpace& space = mesh_->space();
  const double reach = Projection::same_curve_share * (q - p).norm() / space.scale();
  return given_->onto_crease(space.to_input((p + q) / 2), reach).has_value();
}

std::optional<Vec3> SurfaceProjection::onto_surface(const Vec3& p, RegionId first, RegionId second,
                                                    PatchId patch, double max_distance) const {
  if (!given_ || first == second) return surfaces_.nearest(p, kind_of(first, second, patch), max_distance);
  const auto tag = [&](RegionId r) -> MaterialOrOutside {
    if (r == outside_id) return {};
    return mesh_->tag(r);
  };
  const WorkingSpace& space = mesh_->space();
  const auto place = given_patches_ ? given_->onto_patch(space.to_input(p), tag(first), tag(second), patch,
                                                         max_distance / space.scale())
                                    : given_->project(space.to_input(p), tag(first), tag(second),
                                                      max_distance / space.scale());
  if (!place) return {};
  return space.to_working(*place);
}

std::optional<Vec3> SurfaceProjection::onto_curve(const Vec3& p, double max_distance) const {
  return nearer(p, curves_.nearest(p, {}, max_distance), max_distance, &ReferenceSurface::onto_crease);
}

std::optional<Vec3> SurfaceProjection::onto_crease(const Vec3& p, double max_distance) const {
  return nearer(p, {}, max_distance, &ReferenceSurface::onto_crease);
}

std::optional<Vec3> SurfaceProjection::onto_corner(const Vec3& p, double max_distance, bool of_bodies) const {
  const std::optional<Vec3> own = of_bodies ? std::nullopt : corners_.nearest(p, {}, max_distance);
  return nearer(p, own, max_distance, &ReferenceSurface::onto_corner);
}

std::optional<Vec3> SurfaceProjection::nearer(
    const Vec3& p, const std::optional<Vec3>& own, double max_distance,
    std::optional<Vec3> (ReferenceSurface::*onto)(const Vec3&, double) const) const {
  if (!given_patches_) return own;
  const WorkingSpace& space = mesh_->space();
  const double limit = own ? (*own - p).norm() : max_distance;
  const auto place = (given_->*onto)(space.to_input(p), limit / space.scale());
  if (!place) return own;
  return space.to_working(*place);
}

}  // namespace tetwright
