// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher_input.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>

#include "mesher/input/label_preparation.h"
#include "mesher/input/label_regions.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using LabelRange = std::pair<MaterialTag, MaterialTag>;
using LabelCount = std::pair<MaterialTag, std::uint64_t>;

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

}  // namespace

LabelInput make_label_input(std::unique_ptr<const LabelSource> source, const std::string& file,
                            const LabelChoice& choice, Progress* progress) {
  const LabelGrid grid = source->grid();
  LabelRegions read = read_regions(*source, file, Chosen(choice), progress);
  source.reset();
  check_choice(read, file, choice);

  LabelInput result;
  set_grid(grid, file, result);
  result.materials = name_materials(choice, read.counts);
  result.regions = std::move(read.regions);
  result.largest_label = read.largest;
  if (progress) progress->throw_if_stopped();

  prepare_regions(result, choice.min_voxels,
                  "voxels, none of them outside (label " + std::to_string(choice.outside_label) + ")",
                  progress);
  return result;
}

}  // namespace tetwright
