// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/vdb_sizes.h"

#include <Eigen/LU>  // inverse()
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/message_text.h"
#include "common/tolerances.h"
#include "mesher/level_sets/openvdb_grids.h"
#include "mesher/level_sets/vdb_structure.h"
#include "tetwright/error.h"
#include "tetwright/files.h"

namespace tetwright {

namespace {

using IndexPlace = DistanceGrid::IndexPlace;

/// The first of two neighbouring voxels along one axis, and the weight of the second, 0 if that is not
/// needed.
struct Between {
  int voxel;
  double share;
};

/// std::nullopt for NaN and for indices beyond the range of OpenVDB's coordinates.
std::optional<Between> between(double index) {
  constexpr double farthest = 1 << 30;
  if (!(std::abs(index) < farthest)) return {};
  const double nearest = std::round(index);
  if (std::abs(index - nearest) <= tolerance::coinciding_cells) return Between{static_cast<int>(nearest), 0};
  const double below = std::floor(index);
  return Between{static_cast<int>(below), index - below};
}

class VdbSizes : public SizeSource {
 public:
  VdbSizes(DistanceGrid grid, const GridPlacement& placement, const std::string& name)
      : SizeSource(name),
        grid_(std::move(grid)),
        placement_(placement),
        to_index_(placement.directions.inverse()) {}

  std::optional<WantedLength> at(const Vec3& place) const override {
    const Vec3 index = to_index_ * (place - placement_.origin);
    const auto x = between(index.x()), y = between(index.y()), z = between(index.z());
    if (!x || !y || !z) return {};
    DistanceGridReader reader(grid_);
    double length = 0;
    for (int corner = 0; corner < 8; ++corner) {
      IndexPlace voxel;
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) {
        const Between& along = axis == 0 ? *x : axis == 1 ? *y : *z;
        const int upper = corner >> axis & 1;
        voxel[axis] = along.voxel + upper;
        weight *= upper ? along.share : 1 - along.share;
      }
      if (weight == 0) continue;
      float value;
      if (!reader.active(voxel[0], voxel[1], voxel[2], value)) return {};
      length += weight * static_cast<double>(value);
    }
    return WantedLength{length, 0};
  }

  void for_each_value(const std::function<void(const Vec3&, double)>& f) const override {
    grid_.for_each_active([&](const IndexPlace& first, const IndexPlace& last, float value) {
      const int corners = first == last ? 1 : 8;
      for (int corner = 0; corner < corners; ++corner) {
        IndexPlace voxel;
        for (int axis = 0; axis < 3; ++axis) voxel[axis] = (corner >> axis & 1 ? last : first)[axis];
        f(world(voxel), static_cast<double>(value));
      }
    });
  }

  /// Throws InputError for a value that is not an edge length, and if there is none.
  void check(const std::string& file) const {
    bool any = false;
    grid_.for_each_active([&](const IndexPlace& first, const IndexPlace&, float value) {
      any = true;
      if (!(std::isfinite(value) && value > 0))
        throw InputError(file, 0,
                         "the grid '" + field() + "' has the value " + short_number(value) + " at " +
                             place_text(world(first)) +
                             "; an edge length must be a number above 0: give it one, or set voxels inactive "
                             "where no length applies");
    });
    if (!any)
      throw InputError(
          file, 0, "the grid '" + field() + "' has no active voxel; set those active where a size is wanted");
  }

 private:
  Vec3 world(const IndexPlace& voxel) const {
    return placement_.origin + placement_.directions * Vec3(voxel[0], voxel[1], voxel[2]);
  }

  const DistanceGrid grid_;
  const GridPlacement placement_;
  const Eigen::Matrix3d to_index_;
};

bool has_real_numbers(const VdbGrid& grid) { return grid.type == "float" || grid.type == "double"; }

/// The grid that read_vdb_sizes() describes.
VdbGrid& choose_grid(std::vector<VdbGrid>& grids, const std::string& file) {
  for (const std::string_view name : size_names) {
    VdbGrid* found = nullptr;
    for (VdbGrid& grid : grids) {
      if (!has_real_numbers(grid) || grid.name != name) continue;
      if (found) throw InputError(file, 0, "has two grids called '" + grid.name + "'; rename one");
      found = &grid;
    }
    if (found) return *found;
  }
  for (const VdbGrid& grid : grids)
    if (std::find(size_names.begin(), size_names.end(), grid.name) != size_names.end())
      throw InputError(file, 0,
                       "the grid '" + grid.name + "' is of type " + grid.type +
                           ", and edge lengths are a grid of float or double; convert or rename it");
  std::vector<VdbGrid*> candidates;
  std::string all;
  for (VdbGrid& grid : grids) {
    all += (all.empty() ? "'" : ", '") + grid.name + "' (" +
           (grid.kind == "unknown" ? "no class" : grid.kind) + ", " + grid.type + ")";
    if (has_real_numbers(grid) && grid.kind != "level set") candidates.push_back(&grid);
  }
  if (candidates.size() == 1) return *candidates.front();
  throw InputError(file, 0,
                   std::string(candidates.empty() ? "has no grid of edge lengths, of floats and no level set"
                                                  : "has several grids that may be the edge length") +
                       "; there is " + (all.empty() ? "nothing in it" : all) + "; name one 'size'");
}

}  // namespace

std::unique_ptr<const SizeSource> read_vdb_sizes(const std::string& file) {
  std::vector<VdbGrid> grids;
  {
    const std::string bytes = read_whole_file(file);
    try {
      grids = split_vdb(bytes);
    } catch (const std::runtime_error& e) {
      throw InputError(file, 0, e.what());
    }
  }
  VdbGrid& chosen = choose_grid(grids, file);
  const std::string name = chosen.name;
  if (!chosen.fault.empty()) throw InputError(file, 0, chosen.fault);
  if (chosen.alone.empty())
    throw InputError(file, 0,
                     "the grid '" + name + "' does not have its own standard 5-4-3 tree; write a copy of it");
  DistanceGrid grid = DistanceGrid::from_vdb(chosen, file);
  const GridPlacement placement = grid.placement();
  const Eigen::Matrix3d inverse = placement.directions.inverse();
  if (!placement.origin.allFinite() || !placement.directions.allFinite() || !inverse.allFinite())
    throw InputError(file, 0, "the grid '" + name + "' has an invalid transform");
  auto sizes = std::make_unique<VdbSizes>(std::move(grid), placement, name);
  sizes->check(file);
  return sizes;
}

}  // namespace tetwright
