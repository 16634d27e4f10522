// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/openvdb_grids.h"

#include <openvdb/io/Stream.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/Prune.h>

#include <mutex>
#include <new>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "mesher/level_sets/openvdb_types.h"
#include "mesher/level_sets/vdb_structure.h"
#include "tetwright/error.h"
#include "tetwright/label_volume.h"

namespace tetwright {

namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
/// An accessor that is not registered with its tree: cheap to construct, for immutable trees.
using Accessor = openvdb::tree::ValueAccessor<const Tree, false>;

static_assert(leaf_side == Leaf::DIM && leaf_points == Leaf::SIZE && leaf_points % 64 == 0);

GridLeaf<float> view_of(Leaf& leaf) {
  const openvdb::Coord& o = leaf.origin();
  return {{o.x(), o.y(), o.z()}, leaf.buffer().data(), &leaf.getValueMask().getWord<std::uint64_t>(0)};
}

/// Reads a stored grid and consumes its bytes.
template <class Grid>
typename Grid::Ptr read_grid(VdbGrid& stored, const std::string& file) {
  initialise_openvdb();
  typename Grid::Ptr grid;
  try {
    std::istringstream stream(std::exchange(stored.alone, {}));
    // OpenVDB does not check whether its reads succeeded.
    stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    const auto grids = openvdb::io::Stream(stream, false).getGrids();
    grid = openvdb::gridPtrCast<Grid>(grids->at(0));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // from OpenVDB or the stream
  }
  if (!grid) throw InputError(file, 0, "the grid '" + stored.name + "' is damaged; write it again");
  return grid;
}

/// Position of the grid points under a linear transform.
GridPlacement placement_of(const openvdb::math::Transform& transform) {
  // OpenVDB multiplies row vectors from the left: steps along the axes are rows.
  const openvdb::math::Mat4d to_world = transform.baseMap()->getAffineMap()->getMat4();
  GridPlacement placement;
  for (int row = 0; row < 3; ++row) {
    placement.origin[row] = to_world(3, row);
    for (int column = 0; column < 3; ++column) placement.directions(row, column) = to_world(column, row);
  }
  return placement;
}

/// Throws InputError for a value that is not a label.
template <class Grid>
void check_labels(const Grid& grid, const std::string& file, const std::string& name) {
  const auto check = [&](std::int64_t value) {
    if (!std::in_range<MaterialTag>(value))
      throw InputError(file, 0,
                       "the grid '" + name + "' has the value " + std::to_string(value) +
                           ", which is not a 32-bit label; number the labels from 0");
  };
  check(grid.background());
  for (auto value = grid.cbeginValueAll(); value; ++value) check(*value);
}

template <class Grid>
LabelVolume label_volume(const Grid& grid, std::size_t max_voxels, const std::string& file,
                         const std::string& name) {
  if constexpr (!std::is_same_v<typename Grid::ValueType, MaterialTag>) check_labels(grid, file, name);
  if (grid.activeVoxelCount() == 0)
    throw InputError(file, 0, "the grid '" + name + "' has no active voxel; set those of the volume active");
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  LabelVolume volume;
  std::uint64_t room = max_voxels;
  std::string size;
  for (int a = 0; a < 3; ++a) {
    const auto n = static_cast<std::uint64_t>(std::int64_t{box.max()[a]} - box.min()[a] + 1);
    room = n < std::uint64_t{1} << 31 ? room / n : 0;
    size += (a ? " x " : "") + std::to_string(n);
    volume.size[a] = static_cast<int>(n);
  }
  if (room == 0)
    throw InputError(file, 0,
                     "the active voxels of the grid '" + name + "' reach over " + size +
                         " voxels, more than " + std::to_string(max_voxels) +
                         "; crop the volume or make it coarser");
  const openvdb::Vec3d first = grid.indexToWorld(box.min());
  volume.origin = Vec3(first[0], first[1], first[2]);
  volume.directions = placement_of(grid.transform()).directions;
  check_geometry(volume, file);
  volume.labels.resize(static_cast<std::size_t>(box.volume()));
  openvdb::tools::Dense<MaterialTag, openvdb::tools::LayoutXYZ> dense(box, volume.labels.data());
  openvdb::tools::copyToDense(grid, dense);
  return volume;
}

}  // namespace

void initialise_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

DistanceGrid::DistanceGrid(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DistanceGrid::DistanceGrid(double background) {
  initialise_openvdb();
  impl_ = std::make_unique<Impl>(openvdb::FloatGrid::create(static_cast<float>(background)));
}
DistanceGrid::~DistanceGrid() = default;
DistanceGrid::DistanceGrid(DistanceGrid&&) noexcept = default;
DistanceGrid& DistanceGrid::operator=(DistanceGrid&&) noexcept = default;

DistanceGrid DistanceGrid::from_vdb(VdbGrid& stored, const std::string& file) {
  if (stored.type != "double")
    return DistanceGrid(std::make_unique<Impl>(read_grid<openvdb::FloatGrid>(stored, file)));
  const auto doubles = read_grid<openvdb::DoubleGrid>(stored, file);
  const auto tree = std::make_shared<Tree>(doubles->tree());
  const auto floats = openvdb::FloatGrid::create(tree);
  floats->setTransform(doubles->transformPtr());
  return DistanceGrid(std::make_unique<Impl>(floats));
}

DistanceGrid DistanceGrid::copy() const {
  return DistanceGrid(std::make_unique<Impl>(impl_->grid->deepCopy()));
}

float DistanceGrid::background() const { return impl_->grid->background(); }

bool DistanceGrid::has_both_signs() const {
  bool positive = false, negative = false;
  for (auto value = impl_->grid->cbeginValueOn(); value && !(positive && negative); ++value) {
    positive |= *value > 0;
    negative |= *value < 0;
  }
  return positive && negative;
}

float DistanceGrid::active_or(int x, int y, int z, float otherwise) const {
  float value;
  return impl_->grid->constTree().probeValue({x, y, z}, value) ? value : otherwise;
}

void DistanceGrid::for_each_active(
    const std::function<void(const IndexPlace&, const IndexPlace&, float)>& f) const {
  for (auto value = impl_->grid->cbeginValueOn(); value; ++value) {
    const openvdb::CoordBBox box = value.getBoundingBox();
    f({box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()}, *value);
  }
}

GridPlacement DistanceGrid::placement() const { return placement_of(impl_->grid->transform()); }

std::vector<GridLeaf<float>> DistanceGrid::leaves() {
  std::vector<Leaf*> nodes;
  impl_->grid->tree().getNodes(nodes);
  std::vector<GridLeaf<float>> views;
  views.reserve(nodes.size());
  for (Leaf* leaf : nodes) views.push_back(view_of(*leaf));
  return views;
}

std::vector<GridLeaf<const float>> DistanceGrid::leaves() const {
  // OpenVDB offers no pointer to the mask of a const leaf.
  std::vector<Leaf*> nodes;
  impl_->grid->tree().getNodes(nodes);
  std::vector<GridLeaf<const float>> views;
  views.reserve(nodes.size());
  for (Leaf* leaf : nodes) {
    const GridLeaf<float> view = view_of(*leaf);
    views.push_back({view.origin, view.values, view.active_bits});
  }
  return views;
}

GridLeaf<float> DistanceGrid::touch_leaf(const LeafOrigin& origin) {
  return view_of(*impl_->grid->tree().touchLeaf({origin[0], origin[1], origin[2]}));
}

void DistanceGrid::prune_inactive() { openvdb::tools::pruneInactive(impl_->grid->tree()); }

struct DistanceGridReader::Impl {
  Accessor accessor;
};

DistanceGridReader::DistanceGridReader(const DistanceGrid& grid)
    : impl_(new Impl{Accessor(grid.impl().grid->constTree())}) {}
DistanceGridReader::~DistanceGridReader() = default;
DistanceGridReader::DistanceGridReader(DistanceGridReader&&) noexcept = default;

float DistanceGridReader::value(int x, int y, int z) { return impl_->accessor.getValue({x, y, z}); }

bool DistanceGridReader::active(int x, int y, int z, float& value) {
  return impl_->accessor.probeValue({x, y, z}, value);
}

const float* DistanceGridReader::leaf_values(int x, int y, int z) {
  const Leaf* leaf = impl_->accessor.probeConstLeaf({x, y, z});
  return leaf ? leaf->buffer().data() : nullptr;
}

void DistanceGridReader::corners(int x, int y, int z, double values[8]) {
  const openvdb::Coord lowest(x, y, z);
  constexpr int last = leaf_side - 1;
  const Leaf* leaf = impl_->accessor.probeConstLeaf(lowest);
  if (leaf && (x & last) != last && (y & last) != last && (z & last) != last) {
    const float* at = leaf->buffer().data() + Leaf::coordToOffset(lowest);
    for (int k = 0; k < 8; ++k) values[k] = at[((k >> 2) * leaf_side + (k >> 1 & 1)) * leaf_side + (k & 1)];
  } else {
    for (int k = 0; k < 8; ++k) values[k] = value(x + (k >> 2), y + (k >> 1 & 1), z + (k & 1));
  }
}

std::string level_sets_to_vdb(std::span<const NamedGrid> grids, const GridFrame& frame) {
  // OpenVDB multiplies row vectors from the left: steps along the axes are rows.
  openvdb::math::Mat4d to_world = openvdb::math::Mat4d::identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      to_world(row, column) = frame.cell_size * frame.axes(column, row);
      to_world(3, column) = frame.origin[column];
    }
  try {
    openvdb::GridPtrVec all;
    for (const NamedGrid& named : grids) {
      const openvdb::FloatGrid::Ptr grid = named.grid.impl().grid->copy();  // shares the tree
      grid->setName(named.name);
      grid->setGridClass(openvdb::GRID_LEVEL_SET);
      grid->setTransform(openvdb::math::Transform::createLinearTransform(to_world));
      all.push_back(grid);
    }
    std::ostringstream stream;
    openvdb::io::Stream(stream).write(all);
    return std::move(stream).str();
  } catch (const openvdb::ArithmeticError& e) {
    throw std::domain_error(e.what());
  }
}

LabelVolume labels_from_vdb(VdbGrid& stored, std::size_t max_voxels, const std::string& file) {
  if (stored.type == "int32")
    return label_volume(*read_grid<openvdb::Int32Grid>(stored, file), max_voxels, file, stored.name);
  return label_volume(*read_grid<openvdb::Int64Grid>(stored, file), max_voxels, file, stored.name);
}

}  // namespace tetwright
