// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher_input.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>

#include "mesher/input/connected_components.h"
#include "mesher/input/label_regions.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using LabelRange = std::pair<MaterialTag, MaterialTag>;
using LabelCount = std::pair<MaterialTag, std::uint64_t>;

std::string counted(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string range_text(const LabelRange& range) {
  return std::to_string(range.first) +
         (range.first == range.second ? "" : " to " + std::to_string(range.second));
}

/// Tells which labels are meshed.
class Chosen {
 public:
  explicit Chosen(const LabelChoice& choice) : outside_(choice.outside_label), all_(choice.labels.empty()) {
    std::vector<LabelRange> sorted = choice.labels;
    std::sort(sorted.begin(), sorted.end());
    for (const LabelRange& range : sorted) {
      if (range.first > range.second)
        throw UsageError("the label range " + range_text(range) + " is empty; give the smaller label first");
      if (range.first <= outside_ && outside_ <= range.second)
        throw UsageError("label " + std::to_string(outside_) +
                         " of --labels is the outside label, which is " +
                         "not meshed; leave it out, or name another one with --outside-label");
      // Merge overlapping ranges, so that the last one that starts at or before a label determines whether it
      // is chosen.
      if (!ranges_.empty() && range.first <= ranges_.back().second)
        ranges_.back().second = std::max(ranges_.back().second, range.second);
      else
        ranges_.push_back(range);
    }
  }
  bool operator()(MaterialTag label) const {
    if (all_) return label != outside_;
    const auto after = std::upper_bound(ranges_.begin(), ranges_.end(), label,
                                        [](MaterialTag l, const LabelRange& r) { return l < r.first; });
    return after != ranges_.begin() && label <= std::prev(after)->second;
  }

 private:
  MaterialTag outside_;
  bool all_;
  std::vector<LabelRange> ranges_;
};

/// "1, 2, 3" for messages: labels that occur, without the outside label.
std::string labels_text(std::vector<MaterialTag> labels, MaterialTag outside) {
  std::erase(labels, outside);
  std::string text;
  for (std::size_t i = 0; i < std::min(labels.size(), InputTuning::Messages::max_listed_labels); ++i)
    text += (i ? ", " : "") + std::to_string(labels[i]);
  return text + (labels.size() > InputTuning::Messages::max_listed_labels ? ", ..." : "");
}

/// Throws if all of the volume is outside, or no label of a chosen range occurs.
void check_choice(const LabelRegions& read, const std::string& file, const LabelChoice& choice) {
  for (const LabelRange& range : choice.labels) {
    const auto first = std::lower_bound(read.counts.begin(), read.counts.end(), LabelCount(range.first, 0));
    if (first != read.counts.end() && first->first <= range.second) continue;
    const std::string there = labels_text(read.smallest, choice.outside_label);
    if (there.empty()) break;  // the whole volume is outside
    throw InputError(file, 0,
                     (range.first == range.second ? "there is no label " : "there are none of the labels ") +
                         range_text(range) + "; there are " + there);
  }
  if (read.counts.empty())
    throw NothingToMeshError(file + ": all voxels have the outside label " +
                             std::to_string(choice.outside_label) +
                             "; is another one outside? see --outside-label");
}

/// Throws an error about the name of label `tag`, citing its line if it comes from a file.
[[noreturn]] void refuse_name(const LabelChoice& choice, MaterialTag tag, const std::string& message) {
  const auto line = choice.name_lines.find(tag);
  if (line == choice.name_lines.end()) throw UsageError(message + " with --label-names");
  throw InputError(choice.names_file, line->second, message);
}

std::vector<LabelMaterial> name_materials(const LabelChoice& choice, const std::vector<LabelCount>& counts) {
  std::vector<LabelMaterial> materials;
  materials.reserve(counts.size());
  for (const auto& [tag, voxels] : counts) {
    const auto name = choice.names.find(tag);
    const bool named = name != choice.names.end() && !name->second.empty();
    materials.push_back({named ? name->second : "label_" + std::to_string(tag), tag, voxels, voxels});
  }
  std::vector<const LabelMaterial*> by_name;
  by_name.reserve(materials.size());
  for (const LabelMaterial& m : materials) by_name.push_back(&m);
  std::sort(by_name.begin(), by_name.end(), [](const LabelMaterial* a, const LabelMaterial* b) {
    return std::tie(a->name, a->tag) < std::tie(b->name, b->tag);
  });
  const auto twice = std::adjacent_find(by_name.begin(), by_name.end(),
                                        [](const auto* a, const auto* b) { return a->name == b->name; });
  if (twice != by_name.end()) {
    // Cite the later line: the earlier one is valid on its own.
    const auto line = [&](MaterialTag tag) {
      const auto found = choice.name_lines.find(tag);
      return found == choice.name_lines.end() ? std::size_t{0} : found->second;
    };
    const MaterialTag first = twice[0]->tag, second = twice[1]->tag;
    refuse_name(choice, line(first) > line(second) ? first : second,
                "labels " + std::to_string(first) + " and " + std::to_string(second) + " are both called '" +
                    twice[0]->name + "'; give one another name");
  }
  const auto outside =
      std::find_if(materials.begin(), materials.end(), [](const auto& m) { return m.name == outside_name; });
  if (outside != materials.end())
    refuse_name(choice, outside->tag,
                "label " + std::to_string(outside->tag) +
                    " is called 'outside', which is the name of the outside; make it the outside label "
                    "with --outside-label, or give it another name");
  return materials;
}

/// Islands of one region that were merged into others.
struct Loss {
  std::size_t islands = 0, voxels = 0;
  std::size_t first_voxel = 0;
};

class Preparation {
 public:
  Preparation(LabelInput& result, const LabelChoice& choice) : result_(result), choice_(choice) {}

  /// \param outside number of voxels outside before merging
  void merge(std::size_t outside, const Progress* progress);
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
  void report(const std::vector<Loss>& losses);
  void drop_lost(const std::vector<Loss>& losses);

  LabelInput& result_;
  const LabelChoice& choice_;
};

void Preparation::merge(std::size_t outside, const Progress* progress) {
  if (outside == 0)
    add(DiagnosticCode::no_outside,
        "voxels, none of them outside (label " + std::to_string(choice_.outside_label) + ")",
        result_.voxel_count(), std::nullopt, "all meshed, up to the border of the volume");
  const IslandMerging merging = merge_small_islands(result_.regions, choice_.min_voxels, progress);
  if (merging.runs >= no_index)
    throw InputError(result_.file, 0,
                     "has " + std::to_string(merging.runs) +
                         " runs of equal voxels, too many to look for small islands; give --min-voxels 0");
  if (merging.none_reaches)
    add(DiagnosticCode::islands_all_small,
        "islands of voxels, none of which has " + std::to_string(choice_.min_voxels), merging.islands,
        std::nullopt, "kept as they are");
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
}

}  // namespace

LabelInput make_label_input(std::unique_ptr<const LabelSource> source, const std::string& file,
                            const LabelChoice& choice, Progress* progress) {
  const LabelGrid grid = source->grid();
  LabelRegions read = read_regions(*source, file, Chosen(choice), progress);
  source.reset();
  check_choice(read, file, choice);

  LabelInput result;
  result.file = file;
  result.size = grid.size;
  result.origin = grid.origin;
  result.directions = grid.directions;
  result.space = grid.space;
  result.materials = name_materials(choice, read.counts);
  result.regions = std::move(read.regions);
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
  if (progress) progress->throw_if_stopped();

  std::size_t outside = result.voxel_count();
  for (const LabelMaterial& m : result.materials) outside -= m.voxels;
  Preparation(result, choice).merge(outside, progress);
  if (result.materials.empty())
    throw NothingToMeshError(file + ": every island of a label has fewer than " +
                             std::to_string(choice.min_voxels) +
                             " voxels, and what is around them is outside; give a smaller --min-voxels");
  Preparation(result, choice).count(progress);
  return result;
}

}  // namespace tetwright
