#include "mesher/material_field.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "common/parallel_sort.h"
#include "mesher/grid_winding.h"

namespace tetwright {

namespace {

using Grid = openvdb::FloatGrid;
using Tree = Grid::TreeType;
using Leaf = Tree::LeafNodeType;
/// Not registered with the tree: cheap to make, and the tree does not change any more.
using Accessor = openvdb::tree::ValueAccessor<const Tree, false>;

constexpr int leaf_side = static_cast<int>(Leaf::DIM);

/// Distances below this (finest cells) count as this, so that every grid point has a sign.
constexpr float smallest_distance = 1e-6f;

/// The triangles in grid coordinates, as OpenVDB wants them.
struct MeshAdapter {
  const std::vector<Vec3>& points;
  const std::vector<Triangle>& triangles;
  std::size_t polygonCount() const { return triangles.size(); }
  std::size_t pointCount() const { return points.size(); }
  std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t n, std::size_t v, openvdb::Vec3d& out) const {
    const Vec3& p = points[triangles[n][v]];
    out = {p.x(), p.y(), p.z()};
  }
};

struct Interrupter {
  Progress* progress;
  void start(const char* = nullptr) {}
  void end() {}
  bool wasInterrupted(int = -1) { return progress && progress->cancelled(); }
};

void initialise_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

/// Gives the unsigned distances of one leaf the signs of the grid points.
void sign_leaf(Leaf& leaf, const GridWinding& winding) {
  const openvdb::Coord corner = leaf.origin();
  float* values = leaf.buffer().data();
  for (int x = 0; x < leaf_side; ++x)
    for (int y = 0; y < leaf_side; ++y) {
      const auto row = winding.row(corner.x() + x, corner.y() + y);
      auto next = row.begin();
      bool inside = false;
      for (int z = 0; z < leaf_side; ++z) {
        for (; next != row.end() && next->first <= corner.z() + z; ++next) inside = next->winding > 0;
        float& value = values[(x * leaf_side + y) * leaf_side + z];
        const float size = std::clamp(value, smallest_distance, static_cast<float>(field_band));
        value = inside ? -size : size;
      }
    }
}

}  // namespace

struct MaterialField::Impl {
  Grid::Ptr grid;
  std::unique_ptr<GridWinding> winding;

  /// Where no leaf is, the interface is beyond the band.
  double far_value(int x, int y, int z) const { return winding->inside(x, y, z) ? -field_band : field_band; }
};

MaterialField::MaterialField(const ClosedSurface& surface, const Material& material, const GridFrame& frame,
                             Progress* progress)
    : impl_(std::make_unique<Impl>()), frame_(frame), material_(material) {
  initialise_openvdb();
  std::vector<Vec3> points(surface.points.size());
  parallel_for(0, points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = frame.to_grid(surface.points[i]);
  });
  impl_->winding = std::make_unique<GridWinding>(points, surface.triangles, frame.cells);
  if (progress) progress->throw_if_cancelled();

  Interrupter interrupter{progress};
  const MeshAdapter adapter{points, surface.triangles};
  impl_->grid = openvdb::tools::meshToVolume<Grid>(
      interrupter, adapter, *openvdb::math::Transform::createLinearTransform(1.0),
      static_cast<float>(field_band), static_cast<float>(field_band),
      openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  // An interrupted conversion hands back whatever it has so far.
  if (progress) progress->throw_if_cancelled();

  std::vector<Leaf*> leaves;
  impl_->grid->tree().getNodes(leaves);
  parallel_for(0, leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sign_leaf(*leaves[i], *impl_->winding);
  });
}

MaterialField::~MaterialField() = default;

std::vector<MortonKey> MaterialField::interface_cells() const {
  std::vector<const Leaf*> leaves;
  const Tree& tree = impl_->grid->constTree();
  tree.getNodes(leaves);
  constexpr int n = leaf_side + 1;
  std::vector<MortonKey> keys = parallel_collect<MortonKey>(
      0, leaves.size(), 64, [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const openvdb::Coord o = leaves[i]->origin();
          // Bit z of a row: the grid point is inside. A leaf that does not exist lies wholly on one side,
          // beyond the band.
          unsigned rows[n][n] = {};
          for (int neighbour = 0; neighbour < 8; ++neighbour) {
            const int dx = neighbour & 1, dy = neighbour >> 1 & 1, dz = neighbour >> 2;
            const Leaf* leaf =
                neighbour == 0
                    ? leaves[i]
                    : tree.probeConstLeaf(o.offsetBy(dx * leaf_side, dy * leaf_side, dz * leaf_side));
            const openvdb::Coord first = o.offsetBy(dx * leaf_side, dy * leaf_side, dz * leaf_side);
            const bool far_inside = !leaf && impl_->far_value(first.x(), first.y(), first.z()) < 0;
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

struct FieldSampler::Impl {
  explicit Impl(const MaterialField& field)
      : source(*field.impl_), accessor(field.impl_->grid->constTree()), cells(field.frame().cells) {}

  double node(int x, int y, int z) const {
    const Leaf* leaf = accessor.probeConstLeaf({x, y, z});
    if (!leaf) return source.far_value(x, y, z);
    return leaf->getValue(Leaf::coordToOffset({x, y, z}));
  }

  /// The lower corner of the cell around `p` and the eight values around it, z fastest.
  Eigen::Vector3i cell(const Vec3& p, double v[8]) const {
    Eigen::Vector3i c;
    for (int a = 0; a < 3; ++a)
      c[a] = static_cast<int>(std::floor(std::clamp(p[a], 0.0, static_cast<double>(cells[a]) - 0.5)));
    const openvdb::Coord corner(c.x(), c.y(), c.z());
    constexpr int last = leaf_side - 1;
    const Leaf* leaf = accessor.probeConstLeaf(corner);
    if (leaf && (c.x() & last) != last && (c.y() & last) != last && (c.z() & last) != last) {
      const float* at = leaf->buffer().data() + Leaf::coordToOffset(corner);
      for (int k = 0; k < 8; ++k) v[k] = at[((k >> 2) * leaf_side + (k >> 1 & 1)) * leaf_side + (k & 1)];
    } else {
      for (int k = 0; k < 8; ++k) v[k] = node(c.x() + (k >> 2), c.y() + (k >> 1 & 1), c.z() + (k & 1));
    }
    return c;
  }

  const MaterialField::Impl& source;
  Accessor accessor;
  std::array<int, 3> cells;
};

FieldSampler::FieldSampler(const MaterialField& field) : impl_(std::make_unique<Impl>(field)) {}
FieldSampler::~FieldSampler() = default;

double FieldSampler::at_node(int x, int y, int z) { return impl_->node(x, y, z); }

double FieldSampler::at(const Vec3& point) {
  Vec3 unused;
  return at(point, unused);
}

double FieldSampler::at(const Vec3& point, Vec3& gradient) {
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

bool FieldSampler::project(Vec3& point) {
  constexpr int steps = 8;
  constexpr double close_enough = 1e-3;   // finest cells; far below what the voxels resolve
  constexpr double smallest_slope = 0.1;  // squared; below, the point is near a ridge of the distance
  Vec3 gradient;
  for (int step = 0; step < steps; ++step) {
    const double value = at(point, gradient);
    if (std::abs(value) < close_enough) return true;
    const double slope = gradient.squaredNorm();
    if (slope < smallest_slope) return false;
    point -= gradient * (value / slope);
  }
  return false;
}

double MaterialField::signed_distance(const Vec3& point, MaterialTag) const {
  FieldSampler sampler(*this);
  return frame_.cell_size * sampler.at(frame_.to_grid(point));
}

std::optional<Vec3> MaterialField::project(const Vec3& point, Region, Region, double max_distance) const {
  FieldSampler sampler(*this);
  const Vec3 start = frame_.to_grid(point);
  Vec3 end = start;
  if (!sampler.project(end)) return std::nullopt;
  if ((end - start).norm() * frame_.cell_size > max_distance) return std::nullopt;
  return frame_.to_input(end);
}

}  // namespace tetwright
