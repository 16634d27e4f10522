#include "mesher/distance/vdb_files.h"

#include <openvdb/io/Stream.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "common/error.h"
#include "common/formats/atomic_file.h"
#include "common/formats/voxel_data.h"
#include "common/parallel/parallel.h"
#include "mesher/distance/level_set_grid.h"
#include "mesher/distance/vdb_structure.h"

namespace tetwright {

namespace {

std::vector<VdbGrid> take_apart(const std::string& file) {
  const std::string bytes = read_whole_file(file);
  try {
    return take_apart_vdb(bytes);
  } catch (const std::runtime_error& e) {
    throw InputError(file, 0, e.what());
  }
}

bool has_both_signs(const DistanceGrid& grid) {
  bool positive = false, negative = false;
  for (auto value = grid.cbeginValueOn(); value && !(positive && negative); ++value) {
    positive |= *value > 0;
    negative |= *value < 0;
  }
  return positive && negative;
}

/// What OpenVDB makes of a grid that was taken apart; its bytes are gone then.
template <class Grid>
typename Grid::Ptr grid_of(VdbGrid& grid, const std::string& file) {
  typename Grid::Ptr made;
  try {
    std::istringstream stream(std::exchange(grid.alone, {}));
    // OpenVDB itself does not look whether its reading worked.
    stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    const auto grids = openvdb::io::Stream(stream, false).getGrids();
    made = openvdb::gridPtrCast<Grid>(grids->at(0));
  } catch (const std::exception&) {  // of OpenVDB or the stream
  }
  if (!made) throw InputError(file, 0, "the grid '" + grid.name + "' is damaged; write it again");
  return made;
}

/// The grid itself if it is a level set, else nothing.
DistanceGrid::Ptr level_set_of(VdbGrid& grid, const std::string& file) {
  const bool without_kind = grid.kind == "unknown";
  if (grid.type != "float" || grid.alone.empty() || !(without_kind || grid.kind == "level set"))
    return nullptr;
  DistanceGrid::Ptr distances = grid_of<DistanceGrid>(grid, file);
  if (without_kind && !(distances->background() > 0 && has_both_signs(*distances))) return nullptr;
  distances->setGridClass(openvdb::GRID_LEVEL_SET);
  return distances;
}

bool has_whole_numbers(const VdbGrid& grid) { return grid.type == "int32" || grid.type == "int64"; }

/// As in "density (fog volume, float)".
std::string described(const VdbGrid& grid) {
  return grid.name + " (" + (grid.kind == "unknown" ? "no class" : grid.kind) + ", " + grid.type + ")";
}

/// The places of a grid's index coordinates in the world, in doubles throughout.
class ToWorld {
 public:
  explicit ToWorld(const DistanceGrid& grid) : transform_(grid.transform()) {
    const openvdb::Vec3d middle = grid.evalActiveVoxelBoundingBox().getCenter();
    const Vec3 o = at(middle);
    mirrors_ =
        (at(middle + openvdb::Vec3d(1, 0, 0)) - o)
            .dot((at(middle + openvdb::Vec3d(0, 1, 0)) - o).cross(at(middle + openvdb::Vec3d(0, 0, 1)) - o)) <
        0;
  }
  bool mirrors() const { return mirrors_; }
  Vec3 at(const openvdb::Vec3d& index) const {
    const openvdb::Vec3d p = transform_.indexToWorld(index);
    return {p.x(), p.y(), p.z()};
  }

 private:
  const openvdb::math::Transform& transform_;
  bool mirrors_;
};

TriangleMesh surface_of(DistanceGrid& grid) {
  // In index coordinates, because OpenVDB's points are floats; shares the tree.
  const DistanceGrid::Ptr local = grid.copy();
  local->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*local, points, triangles, quads, 0.0, 0.0);

  TriangleMesh mesh;
  if (quads.empty() && triangles.empty()) return mesh;
  const ToWorld to_world(grid);
  mesh.points.resize(points.size());
  parallel_for(0, points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) mesh.points[i] = to_world.at(openvdb::Vec3d(points[i]));
  });
  for (const openvdb::Vec3I& t : triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
  for (const openvdb::Vec4I& q : quads) {
    const auto length = [&](int a, int b) { return (mesh.points[q[a]] - mesh.points[q[b]]).squaredNorm(); };
    const int first = length(0, 2) <= length(1, 3) ? 0 : 1;
    mesh.triangles.push_back({q[first], q[first + 1], q[first + 2]});
    mesh.triangles.push_back({q[first + 2], q[(first + 3) % 4], q[first]});
  }
  // OpenVDB winds them with the outside on the back.
  if (!to_world.mirrors())
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Throws InputError at a number that is no label.
template <class Grid>
void check_labels(const Grid& grid, const std::string& file, const std::string& name) {
  const auto check = [&](std::int64_t value) {
    if (!std::in_range<MaterialTag>(value))
      throw InputError(file, 0,
                       "the grid '" + name + "' has the value " + std::to_string(value) +
                           ", which is no label of 32 bits; number the labels from 0");
  };
  check(grid.background());
  for (auto value = grid.cbeginValueAll(); value; ++value) check(*value);
}

template <class Grid>
LabelVolume volume_of(const Grid& grid, std::size_t max_voxels, const std::string& file,
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
  // OpenVDB multiplies row vectors from the left: steps along the axes are rows.
  const openvdb::math::Mat4d to_world = grid.transform().baseMap()->getAffineMap()->getMat4();
  const openvdb::Vec3d first = grid.indexToWorld(box.min());
  for (int row = 0; row < 3; ++row) {
    volume.origin[row] = first[row];
    for (int column = 0; column < 3; ++column) volume.directions(row, column) = to_world(column, row);
  }
  check_geometry(volume, file);
  volume.labels.resize(static_cast<std::size_t>(box.volume()));
  openvdb::tools::Dense<MaterialTag, openvdb::tools::LayoutXYZ> dense(box, volume.labels.data());
  openvdb::tools::copyToDense(grid, dense);
  return volume;
}

}  // namespace

std::vector<NamedSurface> read_level_sets(const std::string& file) {
  initialise_openvdb();
  std::vector<NamedSurface> surfaces;
  std::set<std::string> names;
  std::string others;
  bool whole_numbers = false;
  for (VdbGrid& grid : take_apart(file)) {
    whole_numbers |= has_whole_numbers(grid);
    const DistanceGrid::Ptr level_set = level_set_of(grid, file);
    if (!level_set) {
      others += (others.empty() ? "" : ", ") + described(grid);
      continue;
    }
    const std::string& name = grid.name;
    if (!names.insert(name).second)
      throw InputError(file, 0, "has two level sets called '" + name + "'; rename one");
    NamedSurface& out = surfaces.emplace_back(NamedSurface{name, {}});
    try {
      out.surface = surface_of(*level_set);
    } catch (const openvdb::Exception&) {  // a transform that can't be inverted
      throw InputError(file, 0, "the level set '" + name + "' has a transform without sense");
    }
    if (out.surface.triangles.empty())
      throw InputError(file, 0, "the level set '" + name + "' is empty: its values do not pass 0; remove it");
    for (const Vec3& p : out.surface.points)
      if (!p.allFinite())
        throw InputError(file, 0, "the level set '" + name + "' has values or a transform without sense");
  }
  if (surfaces.empty())
    throw InputError(file, 0,
                     std::string("has no level set of floats") +
                         (whole_numbers ? "" : " and no grid of whole numbers") + "; there is " +
                         (others.empty() ? "nothing in it" : others));
  return surfaces;
}

std::optional<LabelVolume> read_label_grid(const std::string& file, std::size_t max_voxels) {
  initialise_openvdb();
  std::vector<VdbGrid> grids = take_apart(file);
  std::vector<VdbGrid*> whole;
  for (VdbGrid& grid : grids)
    if (has_whole_numbers(grid)) whole.push_back(&grid);
  if (whole.empty()) return std::nullopt;
  for (VdbGrid& grid : grids)
    if (level_set_of(grid, file)) return std::nullopt;
  VdbGrid& grid = *whole.front();
  if (whole.size() > 1) {
    std::string names;
    for (const VdbGrid* g : whole) names += (names.empty() ? "'" : ", '") + g->name + "'";
    throw InputError(file, 0,
                     "has " + std::to_string(whole.size()) + " grids of whole numbers, " + names +
                         "; keep the one of the labels");
  }
  if (!grid.fault.empty()) throw InputError(file, 0, grid.fault);
  if (grid.alone.empty())
    throw InputError(file, 0,
                     "the grid '" + grid.name +
                         "' is no tree of its own of the usual kind (5, 4, 3); "
                         "write a copy of it");
  if (grid.type == "int32")
    return volume_of(*grid_of<openvdb::Int32Grid>(grid, file), max_voxels, file, grid.name);
  return volume_of(*grid_of<openvdb::Int64Grid>(grid, file), max_voxels, file, grid.name);
}

}  // namespace tetwright
