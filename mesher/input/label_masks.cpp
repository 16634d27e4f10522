// SPDX-License-Identifier: Apache-2.0
#include "tetwright/label_masks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "common/message_text.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// A range of voxels with the same pair of masks.
struct PairRun {
  MaterialTag first, second;
  std::size_t first_voxel, voxels;
  bool operator<(const PairRun& other) const {
    if (first != other.first) return first < other.first;
    return second != other.second ? second < other.second : first_voxel < other.first_voxel;
  }
};

/// Numbers of voxels by label.
/// \param label_at label of a voxel
template <class LabelAt>
std::map<MaterialTag, std::size_t> count_labels_at(std::size_t voxels, const LabelAt& label_at) {
  using Count = std::pair<MaterialTag, std::size_t>;
  const std::vector<Count> runs = parallel_collect<Count>(
      0, voxels, InputGrains::voxels, [&](std::size_t begin, std::size_t end, std::vector<Count>& out) {
        std::map<MaterialTag, std::size_t> counts;
        for (std::size_t i = begin; i < end; ++i) ++counts[label_at(i)];
        out.assign(counts.begin(), counts.end());
      });
  std::map<MaterialTag, std::size_t> counts;
  for (const auto& [label, count] : runs) counts[label] += count;
  return counts;
}

}  // namespace

void LabelMasks::begin(LabelVolume& volume, const std::string& file) {
  // The masks together, and the next one.
  require_memory(2 * static_cast<double>(volume.labels.size()) * sizeof(MaterialTag),
                 "joining masks like " + file, "crop them or make them coarser");
  static_cast<LabelGrid&>(result_) = volume;
  result_.names.clear();
  result_.colours.clear();
  result_.labels.assign(volume.labels.size(), 0);
}

void LabelMasks::add(LabelVolume volume, const std::string& file,
                     const std::map<MaterialTag, LabelMask>& masks, MaterialTag outside) {
  grid_.add(volume, file);
  if (result_.labels.empty()) begin(volume, file);
  std::vector<MaterialTag>& labels = result_.labels;
  const auto mask_at = [&](std::size_t i) -> MaterialTag {
    if (volume.labels[i] == outside) return 0;
    const auto found = masks.find(volume.labels[i]);
    return found == masks.end() ? 0 : found->second.tag;
  };
  std::map<MaterialTag, std::size_t> counts = count_labels_at(labels.size(), mask_at);
  for (const auto& [label, mask] : masks) {
    materials_.push_back({mask, counts[mask.tag]});
    result_.names[mask.tag] = mask.name;
    if (const auto colour = volume.colours.find(label); colour != volume.colours.end())
      result_.colours[mask.tag] = colour->second;
  }
  // Pairs that overlap, in runs of voxels.
  std::vector<PairRun> runs = parallel_collect<PairRun>(
      0, labels.size(), InputGrains::voxels,
      [&](std::size_t begin, std::size_t end, std::vector<PairRun>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const MaterialTag before = labels[i], tag = before == 0 ? 0 : mask_at(i);
          if (tag == 0) continue;
          if (!out.empty() && out.back().first == before && out.back().second == tag &&
              out.back().first_voxel + out.back().voxels == i)
            ++out.back().voxels;
          else
            out.push_back({before, tag, i, 1});
        }
      });
  if (!runs.empty() && in_several_.empty()) in_several_.resize(labels.size(), false);
  for (const PairRun& run : runs)
    std::fill_n(in_several_.begin() + static_cast<std::ptrdiff_t>(run.first_voxel), run.voxels, true);
  parallel_sort(runs);
  const std::size_t known = overlaps_.size();
  for (const PairRun& run : runs)
    if (overlaps_.size() > known && overlaps_.back().first == run.first &&
        overlaps_.back().second == run.second)
      overlaps_.back().voxels += run.voxels;
    else
      overlaps_.push_back({run.first, run.second, run.voxels, run.first_voxel});
  std::map<std::pair<MaterialTag, MaterialTag>, MaterialTag> shared;
  for (std::size_t k = known; k < overlaps_.size(); ++k) {
    const Overlap& o = overlaps_[k];
    if (rule_ == OverlapRule::error)
      throw InputError(file, 0,
                       "the masks '" + name_of(o.first) + "' and '" + name_of(o.second) + "' overlap in " +
                           std::to_string(o.voxels) + " voxels, the first at " +
                           place_text(centre(o.first_voxel)) +
                           "; separate them, or let the later one keep them with --on-overlap later");
    if (rule_ != OverlapRule::material) continue;
    shared_names_.push_back(name_of(o.first) + "+" + name_of(o.second));
    shared[{o.first, o.second}] = -static_cast<MaterialTag>(shared_names_.size());
  }
  parallel_for(0, labels.size(), InputGrains::voxels, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const MaterialTag tag = mask_at(i);
      if (tag == 0 || (labels[i] != 0 && rule_ == OverlapRule::first)) continue;
      labels[i] = labels[i] != 0 && rule_ == OverlapRule::material ? shared.at({labels[i], tag}) : tag;
    }
  });
}

std::string LabelMasks::name_of(MaterialTag tag) const {
  return tag < 0 ? shared_names_[static_cast<std::size_t>(-tag - 1)] : result_.names.at(tag);
}

Vec3 LabelMasks::centre(std::size_t voxel) const {
  const auto nx = static_cast<std::size_t>(result_.size[0]), ny = static_cast<std::size_t>(result_.size[1]);
  const std::size_t x = voxel % nx, y = voxel / nx % ny, z = voxel / (nx * ny);
  return result_.to_input(Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)));
}

void LabelMasks::report(Joined& joined) const {
  const double voxel = std::abs(result_.directions.determinant());
  const Overlap* most = nullptr;
  std::size_t shared = 0;
  for (const Overlap& o : overlaps_) {
    if (!most || o.voxels > most->voxels) most = &o;
    const std::string first = name_of(o.first), second = name_of(o.second);
    joined.overlaps.push_back({first, second, voxel * static_cast<double>(o.voxels),
                               rule_ == OverlapRule::later   ? second
                               : rule_ == OverlapRule::first ? first
                                                             : shared_names_[shared++],
                               centre(o.first_voxel)});
  }
  const std::size_t in_several =
      static_cast<std::size_t>(std::count(in_several_.begin(), in_several_.end(), true));
  if (most)
    joined.findings.push_back(
        {.code = DiagnosticCode::masks_overlap,
         .file = grid_.first_file(),
         .what = (in_several == 1 ? "voxel" : "voxels") + std::string(" in several masks, in ") +
                 std::to_string(overlaps_.size()) + (overlaps_.size() == 1 ? " pair" : " pairs") +
                 ", most in '" + name_of(most->first) + "' and '" + name_of(most->second) + "' (" +
                 std::to_string(most->voxels) + ")",
         .count = in_several,
         .done = rule_ == OverlapRule::later   ? "they belong to the later one"
                 : rule_ == OverlapRule::first ? "they belong to the first one"
                                               : "materials of their own",
         .places = {centre(most->first_voxel)}});
  const auto list = [&](const char* what, const auto& is_listed) {
    std::string names;
    std::size_t count = 0;
    for (const Material& m : materials_) {
      if (!is_listed(m)) continue;
      ++count;
      if (count <= InputTuning::Messages::max_listed_labels)
        names += (names.empty() ? "'" : ", '") + m.mask.name + "'";
      else if (count == InputTuning::Messages::max_listed_labels + 1)
        names += ", ...";
    }
    if (count > 0)
      joined.findings.push_back({.code = DiagnosticCode::masks_empty,
                                 .file = grid_.first_file(),
                                 .what = (count == 1 ? "mask " : "masks ") + std::string(what) + names,
                                 .count = count,
                                 .done = "not in the mesh"});
  };
  list("without a voxel: ", [](const Material& m) { return m.voxels == 0; });
  // With OverlapRule::material, a mask inside another one is a material of another name.
  if (most && rule_ != OverlapRule::material) {
    std::map<MaterialTag, std::size_t> left =
        count_labels_at(result_.labels.size(), [&](std::size_t i) { return result_.labels[i]; });
    list("without a voxel that does not belong to others: ",
         [&](const Material& m) { return m.voxels > 0 && left[m.mask.tag] == 0; });
  }
  const std::vector<Diagnostic> spaces = grid_.findings();
  joined.findings.insert(joined.findings.end(), spaces.begin(), spaces.end());
}

LabelMasks::Joined LabelMasks::join(const std::string& files) && {
  if (std::all_of(materials_.begin(), materials_.end(), [](const Material& m) { return m.voxels == 0; }))
    throw NothingToMeshError(files + ": no mask has a voxel");
  MaterialTag last = 0;
  for (const auto& [name, tag] : tags_) last = std::max(last, tag);
  std::set<std::string> used;
  for (const Material& m : materials_) {
    last = std::max(last, m.mask.tag);
    used.insert(m.mask.name);
  }
  std::vector<MaterialTag> shared_tags;
  for (std::string& name : shared_names_) {
    const std::string sum = name;
    for (int k = 2; !used.insert(name).second; ++k) name = sum + "_" + std::to_string(k);
    const auto known = tags_.find(name);
    if (known == tags_.end() && last == std::numeric_limits<MaterialTag>::max())
      throw InputError(files, 0,
                       "no label above " + std::to_string(last) + " is left for the material '" + name +
                           "', where masks overlap; give the masks smaller labels");
    if (known != tags_.end() && known->second <= 0)
      throw InputError(files, 0,
                       "the label " + std::to_string(known->second) + " of the material '" + name +
                           "', where masks overlap, must be above 0");
    shared_tags.push_back(known != tags_.end() ? known->second : ++last);
    if (!result_.names.emplace(shared_tags.back(), name).second)
      throw InputError(files, 0,
                       "the label " + std::to_string(shared_tags.back()) + " of the material '" + name +
                           "', where masks overlap, is that of another one; give it one of its own");
  }
  parallel_for(0, result_.labels.size(), InputGrains::voxels, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (MaterialTag& label = result_.labels[i]; label < 0)
        label = shared_tags[static_cast<std::size_t>(-label - 1)];
  });
  Joined joined;
  report(joined);
  joined.volume = std::move(result_);
  return joined;
}

MaterialTag label_of_mask(const LabelVolume& volume, MaterialTag outside, const std::string& file) {
  const auto is_other = [&](MaterialTag label) { return label != outside; };
  const auto first = std::find_if(volume.labels.begin(), volume.labels.end(), is_other);
  if (first == volume.labels.end()) return outside;
  const auto second = std::find_if(first, volume.labels.end(),
                                   [&](MaterialTag label) { return label != outside && label != *first; });
  if (second != volume.labels.end())
    throw InputError(file, 0,
                     "has the labels " + std::to_string(*first) + " and " + std::to_string(*second) +
                         ", but a mask has one besides " + std::to_string(outside) +
                         "; give a volume of labels alone and without a name, or a mask for each label");
  return *first;
}

}  // namespace tetwright
