// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher_input.h"

#include <set>
#include <stdexcept>

#include "mesher/level_sets/openvdb_grids.h"
#include "mesher/level_sets/vdb_structure.h"
#include "tetwright/error.h"
#include "tetwright/files.h"

namespace tetwright {

namespace {

std::vector<VdbGrid> take_apart(const std::string& file) {
  const std::string bytes = read_whole_file(file);
  try {
    return split_vdb(bytes);
  } catch (const std::runtime_error& e) {
    throw InputError(file, 0, e.what());
  }
}

/// The distances of a grid that is a level set; std::nullopt for other grids.
std::optional<DistanceGrid> level_set_of(VdbGrid& grid, const std::string& file) {
  const bool without_kind = grid.kind == "unknown";
  if (grid.type != "float" || grid.alone.empty() || !(without_kind || grid.kind == "level set"))
    return std::nullopt;
  DistanceGrid distances = DistanceGrid::from_vdb(grid, file);
  if (without_kind && !(distances.background() > 0 && distances.has_both_signs())) return std::nullopt;
  return distances;
}

bool has_whole_numbers(const VdbGrid& grid) { return grid.type == "int32" || grid.type == "int64"; }

/// For example "density (fog volume, float)".
std::string described(const VdbGrid& grid) {
  return grid.name + " (" + (grid.kind == "unknown" ? "no class" : grid.kind) + ", " + grid.type + ")";
}

}  // namespace

std::vector<NamedSurface> read_level_sets(const std::string& file) {
  std::vector<NamedSurface> surfaces;
  std::set<std::string> names;
  std::string others;
  bool whole_numbers = false;
  for (VdbGrid& grid : take_apart(file)) {
    whole_numbers |= has_whole_numbers(grid);
    const std::optional<DistanceGrid> level_set = level_set_of(grid, file);
    if (!level_set) {
      others += (others.empty() ? "" : ", ") + described(grid);
      continue;
    }
    const std::string& name = grid.name;
    if (!names.insert(name).second)
      throw InputError(file, 0, "has two level sets called '" + name + "'; rename one");
    NamedSurface& out = surfaces.emplace_back(NamedSurface{name, {}});
    try {
      out.surface = level_set->zero_surface();
    } catch (const std::domain_error&) {
      throw InputError(file, 0, "the level set '" + name + "' has an invalid transform");
    }
    if (out.surface.triangles.empty())
      throw InputError(file, 0,
                       "the level set '" + name + "' is empty: its values do not cross 0; remove it");
    for (const Vec3& p : out.surface.points)
      if (!p.allFinite())
        throw InputError(file, 0, "the level set '" + name + "' has invalid values or an invalid transform");
  }
  if (surfaces.empty())
    throw InputError(file, 0,
                     std::string("has no level set of floats") +
                         (whole_numbers ? "" : " and no grid of whole numbers") + "; there is " +
                         (others.empty() ? "nothing in it" : others));
  return surfaces;
}

std::optional<LabelVolume> read_label_grid(const std::string& file, std::size_t max_voxels) {
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
                         "' does not have its own standard 5-4-3 tree; "
                         "write a copy of it");
  return labels_from_vdb(grid, max_voxels, file);
}

}  // namespace tetwright
