#include "mesher/distance/level_set.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "common/parallel/parallel_sort.h"
#include "mesher/distance/level_set_grid.h"
#include "mesher/distance/level_set_signs.h"

namespace tetwright {

void initialise_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

LevelSet::LevelSet(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LevelSet::~LevelSet() = default;

std::shared_ptr<const LevelSet> LevelSet::of_surface(const RepairedSurface& surface, const GridFrame& frame,
                                                     Progress* progress) {
  std::vector<Vec3> points(surface.points.size());
  parallel_for(0, points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = frame.to_grid(surface.points[i]);
  });
  const NodeWinding winding(points, surface.triangles, surface.closed, frame.cells);
  if (progress) progress->throw_if_cancelled();

  auto impl = std::make_unique<Impl>();
  impl->cells = frame.cells;
  impl->grid = unsigned_distances(points, surface.triangles, progress);
  impl->caps = sign_band(*impl->grid, winding, progress);
  fill_outside_band(*impl->grid);
  return std::shared_ptr<const LevelSet>(new LevelSet(std::move(impl)));
}

std::vector<MortonKey> LevelSet::interface_cells() const {
  std::vector<const DistanceLeaf*> leaves;
  const DistanceTree& tree = impl_->grid->constTree();
  tree.getNodes(leaves);
  constexpr int n = leaf_side + 1;
  std::vector<MortonKey> keys = parallel_collect<MortonKey>(
      0, leaves.size(), 64, [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        const DistanceAccessor accessor(tree);
        for (std::size_t i = begin; i < end; ++i) {
          const openvdb::Coord o = leaves[i]->origin();
          // Bit z of a row: the grid point is inside. A leaf that does not exist lies wholly on one side,
          // beyond the band.
          unsigned rows[n][n] = {};
          for (int neighbour = 0; neighbour < 8; ++neighbour) {
            const int dx = neighbour & 1, dy = neighbour >> 1 & 1, dz = neighbour >> 2;
            const openvdb::Coord first = o.offsetBy(dx * leaf_side, dy * leaf_side, dz * leaf_side);
            const DistanceLeaf* leaf = neighbour == 0 ? leaves[i] : accessor.probeConstLeaf(first);
            const bool far_inside = !leaf && accessor.getValue(first) < 0;
            const float* values = leaf ? leaf->buffer().data() : nullptr;
            for (int x = 0; x < (dx ? 1 : leaf_side); ++x)
              for (int y = 0; y < (dy ? 1 : leaf_side); ++y)
                for (int z = 0; z < (dz ? 1 : leaf_side); ++z)
                  rows[dx * leaf_side + x][dy * leaf_side + y] |=
                      static_cast<unsigned>(values ? values[(x * leaf_side + y) * leaf_side + z] < 0
                                                   : far_inside)
                      << (dz * leaf_side + z);
          }
          for (int x = 0; x < leaf_side; ++x)
            for (int y = 0; y < leaf_side; ++y) {
              const unsigned any = rows[x][y] | rows[x + 1][y] | rows[x][y + 1] | rows[x + 1][y + 1];
              const unsigned all = rows[x][y] & rows[x + 1][y] & rows[x][y + 1] & rows[x + 1][y + 1];
              const unsigned mixed = (any | any >> 1) & ~(all & all >> 1);
              for (int z = 0; z < leaf_side; ++z)
                if (mixed >> z & 1) out.push_back(morton_encode(o.x() + x, o.y() + y, o.z() + z));
            }
        }
      });
  parallel_sort(keys);
  return keys;
}

std::vector<LeafOrigin> LevelSet::leaves() const {
  std::vector<const DistanceLeaf*> nodes;
  impl_->grid->constTree().getNodes(nodes);
  std::vector<LeafOrigin> origins;
  for (const DistanceLeaf* leaf : nodes)
    origins.push_back({leaf->origin().x(), leaf->origin().y(), leaf->origin().z()});
  std::sort(origins.begin(), origins.end());
  return origins;
}

struct LevelSetSampler::Impl {
  explicit Impl(const LevelSet& level_set)
      : accessor(level_set.impl_->grid->constTree()), cells(level_set.impl_->cells) {}

  double node(int x, int y, int z) const { return accessor.getValue({x, y, z}); }

  /// The lower corner of the cell around `p` and the eight values around it, z fastest.
  Eigen::Vector3i cell(const Vec3& p, double v[8]) const {
    Eigen::Vector3i c;
    for (int a = 0; a < 3; ++a)
      c[a] = static_cast<int>(std::floor(std::clamp(p[a], 0.0, static_cast<double>(cells[a]) - 0.5)));
    const openvdb::Coord corner(c.x(), c.y(), c.z());
    constexpr int last = leaf_side - 1;
    const DistanceLeaf* leaf = accessor.probeConstLeaf(corner);
    if (leaf && (c.x() & last) != last && (c.y() & last) != last && (c.z() & last) != last) {
      const float* at = leaf->buffer().data() + DistanceLeaf::coordToOffset(corner);
      for (int k = 0; k < 8; ++k) v[k] = at[((k >> 2) * leaf_side + (k >> 1 & 1)) * leaf_side + (k & 1)];
    } else {
      for (int k = 0; k < 8; ++k) v[k] = node(c.x() + (k >> 2), c.y() + (k >> 1 & 1), c.z() + (k & 1));
    }
    return c;
  }

  DistanceAccessor accessor;
  std::array<int, 3> cells;
};

LevelSetSampler::LevelSetSampler(const LevelSet& level_set) : impl_(std::make_unique<Impl>(level_set)) {}
LevelSetSampler::~LevelSetSampler() = default;

double LevelSetSampler::at_node(int x, int y, int z) { return impl_->node(x, y, z); }

double LevelSetSampler::at(const Vec3& point) {
  Vec3 unused;
  return at(point, unused);
}

double LevelSetSampler::at(const Vec3& point, Vec3& gradient) {
  double v[8];
  const Vec3 f = point - impl_->cell(point, v).cast<double>();
  // Along z, then y, then x.
  double z0[4], dz[4];
  for (int k = 0; k < 4; ++k) {
    dz[k] = v[2 * k + 1] - v[2 * k];
    z0[k] = v[2 * k] + f.z() * dz[k];
  }
  const double y0 = z0[0] + f.y() * (z0[1] - z0[0]), y1 = z0[2] + f.y() * (z0[3] - z0[2]);
  const double dz0 = dz[0] + f.y() * (dz[1] - dz[0]), dz1 = dz[2] + f.y() * (dz[3] - dz[2]);
  gradient = {y1 - y0, (z0[1] - z0[0]) + f.x() * ((z0[3] - z0[2]) - (z0[1] - z0[0])),
              dz0 + f.x() * (dz1 - dz0)};
  return y0 + f.x() * (y1 - y0);
}

}  // namespace tetwright
