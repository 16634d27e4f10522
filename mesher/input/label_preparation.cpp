// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/label_preparation.h"

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "mesher/input/connected_components.h"
#include "mesher/input/voxel_contacts.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

std::string counted(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

/// Islands of one region that were merged into others.
struct Loss {
  std::size_t islands = 0, voxels = 0;
  std::size_t first_voxel = 0;
};

class Preparation {
 public:
  Preparation(LabelInput& result, std::size_t min_voxels) : result_(result), min_voxels_(min_voxels) {}

  void merge(const Progress* progress);
  /// Counts the parts of all regions.
  void count(const Progress* progress);

 private:
  Vec3 place(std::size_t voxel) const {
    const std::size_t nx = static_cast<std::size_t>(result_.size[0]);
    const std::size_t ny = static_cast<std::size_t>(result_.size[1]);
    const std::size_t x = voxel % nx, y = voxel / nx % ny, z = voxel / (nx * ny);
    const Vec3 index(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
    return result_.origin + result_.directions * index;
  }
  void add(DiagnosticCode code, const std::string& what, std::size_t count, const std::optional<Vec3>& at,
           const std::string& done) {
    if (count == 0) return;
    result_.findings.push_back(
        {.code = code, .file = result_.file, .what = what, .count = count, .done = done});
    if (at) result_.findings.back().places.push_back(*at);
  }
  MaterialOrOutside label_of(RegionIndex region) const {
    return region == outside_region ? MaterialOrOutside() : result_.materials[region - 1u].tag;
  }
  void report(const std::vector<Loss>& losses);
  void drop_lost(const std::vector<Loss>& losses);

  LabelInput& result_;
  const std::size_t min_voxels_;
};

void Preparation::merge(const Progress* progress) {
  const std::vector<VoxelContact> as_read = voxel_contacts(result_.regions, progress);
  const IslandMerging merging = merge_small_islands(result_.regions, min_voxels_, progress);
  if (merging.runs >= no_index)
    throw InputError(result_.file, 0,
                     "has " + std::to_string(merging.runs) +
                         " runs of equal voxels, too many to look for small islands; give --min-voxels 0");
  // Each label would be a material, and the mesh of no use.
  const auto voxels = result_.voxel_count();
  if (!result_.image && result_.materials.size() > InputTuning::GrayValues::min_labels &&
      static_cast<double>(merging.islands) * InputTuning::GrayValues::max_island >
          static_cast<double>(voxels))
    throw InputError(result_.file, 0,
                     "looks like an image of gray values: its " + std::to_string(result_.materials.size()) +
                         " labels are in " + std::to_string(merging.islands) + " islands of " +
                         std::to_string(voxels) +
                         " voxels; say with --iso from which value on a point is inside, or, if these are "
                         "labels, give --min-voxels 0");
  if (merging.none_reaches)
    add(DiagnosticCode::islands_all_small,
        "islands of voxels, none of which has " + std::to_string(min_voxels_), merging.islands, std::nullopt,
        "kept as they are");
  std::vector<Loss> losses(result_.materials.size() + 1);
  for (const MergedIsland& m : merging.merged) {
    Loss& loss = losses[m.from];
    if (loss.islands++ == 0) loss.first_voxel = m.voxel;
    loss.voxels += m.voxels;
    if (m.from != outside_region) result_.materials[m.from - 1u].voxels -= m.voxels;
    if (m.to != outside_region) result_.materials[m.to - 1u].voxels += m.voxels;
    ++result_.merged_islands;
    result_.merged_voxels += m.voxels;
  }
  std::map<std::pair<RegionIndex, RegionIndex>, VoxelContact> merged;
  if (!merging.merged.empty())
    for (const VoxelContact& c : voxel_contacts(result_.regions, progress)) merged[{c.first, c.second}] = c;
  for (const VoxelContact& c : as_read) {
    const auto after = merged.find({c.first, c.second});
    const VoxelContact& kept = after != merged.end() ? after->second : c;
    const bool lost = !merging.merged.empty() && after == merged.end();
    result_.contacts.push_back(
        {label_of(c.first), label_of(c.second), lost ? 0 : kept.faces, place(kept.voxel)});
  }
  for (const JoinedIslands& j : merging.joined) result_.fused.push_back({label_of(j.region), place(j.voxel)});
  report(losses);
  drop_lost(losses);
}

void Preparation::count(const Progress* progress) {
  const std::vector<RegionParts> all = count_parts(result_.regions, result_.materials.size() + 1, progress);
  for (std::size_t r = 0; r < all.size(); ++r) {
    LabelParts& parts = r == outside_region ? result_.outside_parts : result_.materials[r - 1].parts;
    parts = {all[r].touching, all[r].by_faces, std::nullopt};
    if (all[r].smallest != no_voxel) parts.smallest_place = place(all[r].smallest);
  }
}

void Preparation::report(const std::vector<Loss>& losses) {
  const std::string done = "merged into what they touch most";
  std::size_t named = 0, others = 0;
  Loss rest;
  for (std::size_t region = 0; region < losses.size(); ++region) {
    const Loss& loss = losses[region];
    if (loss.islands == 0) continue;
    const std::string voxels = " (" + counted(loss.voxels, "voxel") + ")";
    if (region == outside_region) {
      add(DiagnosticCode::islands_merged, "islands of outside" + voxels, loss.islands,
          place(loss.first_voxel), done);
      continue;
    }
    const LabelMaterial& m = result_.materials[region - 1];
    if (m.voxels == 0) {
      add(DiagnosticCode::islands_merged, "islands of '" + m.name + "'" + voxels + ", all there is of it",
          loss.islands, place(loss.first_voxel), done + "; this label is lost");
    } else if (named++ < InputTuning::Messages::max_named_labels) {
      add(DiagnosticCode::islands_merged, "islands of '" + m.name + "'" + voxels, loss.islands,
          place(loss.first_voxel), done);
    } else {
      if (others++ == 0) rest.first_voxel = loss.first_voxel;
      rest.islands += loss.islands;
      rest.voxels += loss.voxels;
    }
  }
  add(DiagnosticCode::islands_merged,
      "islands of " + counted(others, "other label") + " (" + counted(rest.voxels, "voxel") + ")",
      rest.islands, place(rest.first_voxel), done);
}

/// Removes labels without voxels from the materials and renumbers the others.
void Preparation::drop_lost(const std::vector<Loss>& losses) {
  std::vector<LabelMaterial> kept;
  std::vector<RegionIndex> renumbered(result_.materials.size() + 1, outside_region);
  for (std::size_t i = 0; i < result_.materials.size(); ++i) {
    LabelMaterial& m = result_.materials[i];
    if (m.voxels == 0) {
      result_.lost.push_back({m.tag, m.name, m.voxels_in_file, place(losses[i + 1].first_voxel)});
      continue;
    }
    kept.push_back(std::move(m));
    renumbered[i + 1] = static_cast<RegionIndex>(kept.size());
  }
  result_.materials = std::move(kept);
  if (result_.lost.empty()) return;
  result_.regions.renumber(renumbered);
  for (RegionIndex& region : result_.band_regions) {
    if (region == outside_region || region == on_interface) continue;
    region = renumbered[region] == outside_region ? on_interface : renumbered[region];
  }
}

}  // namespace

void set_grid(const LabelGrid& grid, const std::string& file, LabelInput& result) {
  result.file = file;
  result.size = grid.size;
  result.origin = grid.origin;
  result.directions = grid.directions;
  result.space = grid.space;
  if (grid.spacing_assumed)
    result.findings.push_back({.code = DiagnosticCode::spacing_assumed,
                               .file = file,
                               .what = "volume whose file gives no spacing",
                               .count = 1,
                               .done = "each voxel has the size 1"});
  if (grid.spacing_replaced)
    result.findings.push_back({.code = DiagnosticCode::spacing_replaced,
                               .file = file,
                               .what = "volume whose file gives another spacing",
                               .count = 1,
                               .done = "that of --spacing is used"});
  if (!grid.ignored_files.empty())
    result.findings.push_back(
        {.code = DiagnosticCode::input_dropped,
         .file = file,
         .what = (grid.ignored_files.size() == 1 ? "file that is no slice, "
                                                 : "files that are no slices, the first ") +
                 grid.ignored_files.front(),
         .count = grid.ignored_files.size(),
         .done = "not read"});
}

void prepare_regions(LabelInput& result, std::size_t min_voxels, const std::string& none_outside,
                     const Progress* progress) {
  if (progress) progress->throw_if_stopped();
  std::size_t outside = result.voxel_count();
  for (const LabelMaterial& m : result.materials) outside -= m.voxels;
  if (outside == 0)
    result.findings.push_back({.code = DiagnosticCode::no_outside,
                               .file = result.file,
                               .what = none_outside,
                               .count = result.voxel_count(),
                               .done = "all meshed, up to the border of the volume"});
  Preparation preparation(result, min_voxels);
  preparation.merge(progress);
  if (result.materials.empty())
    throw NothingToMeshError(result.file + ": every island of a material has fewer than " +
                             std::to_string(min_voxels) +
                             " voxels, and what is around them is outside; give a smaller --min-voxels");
  preparation.count(progress);
}

}  // namespace tetwright
