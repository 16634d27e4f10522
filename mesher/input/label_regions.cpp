// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/label_regions.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <numeric>
#include <set>
#include <unordered_map>

#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Labels = std::set<MaterialTag>;

/// Keeps the smallest labels of a set: those that messages list, another one and the outside label.
void keep_smallest(Labels& labels) {
  while (labels.size() > InputTuning::Messages::max_listed_labels + 2) labels.erase(std::prev(labels.end()));
}

/// Numbers of labels in the order in which threads find them, from 1; 0: not chosen.
class LabelNumbers {
 public:
  explicit LabelNumbers(const std::function<bool(MaterialTag)>& chosen) : chosen_(chosen) {}

  /// May be called concurrently.
  RegionIndex number(MaterialTag label) {
    if (!chosen_(label)) return outside_region;
    const std::lock_guard lock(mutex_);
    const auto found = numbers_.find(label);
    if (found != numbers_.end()) return found->second;
    if (labels_.size() == InputTuning::Limits::max_materials) {
      too_many_ = true;
      return outside_region;
    }
    labels_.push_back(label);
    return numbers_[label] = static_cast<RegionIndex>(labels_.size());
  }
  bool too_many() const { return too_many_; }
  const std::vector<MaterialTag>& labels() const { return labels_; }  ///< by number - 1

 private:
  const std::function<bool(MaterialTag)>& chosen_;
  std::mutex mutex_;
  std::unordered_map<MaterialTag, RegionIndex> numbers_;
  std::vector<MaterialTag> labels_;
  bool too_many_ = false;
};

/// The data of a thread that numbers voxels.
class Numbering {
 public:
  /// Reads a box and numbers its voxels.
  /// \param out the number of voxel `low`, followed by others at steps of 1, `row` and `slice`
  void read(const LabelSource& source, const VoxelIndex& low, const VoxelIndex& high, LabelNumbers& all,
            RegionIndex* out, std::size_t row, std::size_t slice) {
    const auto width = static_cast<std::size_t>(high[0] - low[0]);
    labels_.resize(width * static_cast<std::size_t>(high[1] - low[1]) *
                   static_cast<std::size_t>(high[2] - low[2]));
    source.read(low, high, labels_);
    const MaterialTag* label = labels_.data();
    for (int z = 0; z < high[2] - low[2]; ++z)
      for (int y = 0; y < high[1] - low[1]; ++y, label += width)
        number_row(label, width, all,
                   out + static_cast<std::size_t>(z) * slice + static_cast<std::size_t>(y) * row);
  }
  const std::vector<std::uint64_t>& counts() const { return counts_; }  ///< by number
  const Labels& smallest() const { return smallest_; }
  MaterialTag largest() const { return largest_; }  ///< of the labels that were read

 private:
  void number_row(const MaterialTag* labels, std::size_t width, LabelNumbers& all, RegionIndex* out) {
    for (std::size_t i = 0, j; i < width; i = j) {
      for (j = i + 1; j < width && labels[j] == labels[i];) ++j;
      const RegionIndex n = number(labels[i], all);
      std::fill(out + i, out + j, n);
      counts_[n] += j - i;
    }
  }
  RegionIndex number(MaterialTag label, LabelNumbers& all) {
    const auto found = numbers_.find(label);
    if (found != numbers_.end()) return found->second;
    // Gray values that are not chosen may have any number.
    if (numbers_.size() > 2 * InputTuning::Limits::max_materials) numbers_.clear();
    smallest_.insert(label);
    keep_smallest(smallest_);
    largest_ = std::max(largest_, label);
    const RegionIndex n = all.number(label);
    if (n >= counts_.size()) counts_.resize(n + std::size_t{1}, 0);
    return numbers_[label] = n;
  }

  std::vector<MaterialTag> labels_;
  std::unordered_map<MaterialTag, RegionIndex> numbers_;
  std::vector<std::uint64_t> counts_ = {0};
  Labels smallest_;
  MaterialTag largest_ = std::numeric_limits<MaterialTag>::min();
};

}  // namespace

LabelRegions read_regions(const LabelSource& source, const std::string& file,
                          const std::function<bool(MaterialTag)>& chosen, const Progress* progress) {
  const VoxelIndex& size = source.grid().size;
  const std::size_t row = static_cast<std::size_t>(size[0]), slice = row * static_cast<std::size_t>(size[1]);
  const LabelBoxes boxes(source, InputGrains::voxels);
  // A layer is one of boxes, and at least one of tiles.
  const int depth = ((RegionGrid::side - 1) / boxes.slices() + 1) * boxes.slices();
  // Whole tiles leave nothing over.
  const int left_over = depth % RegionGrid::side == 0 ? 0 : RegionGrid::side - 1;
  const auto max_slices = static_cast<std::size_t>(std::min(size[2], depth + left_over));
  const double source_bytes =
      source.in_memory() ? static_cast<double>(source.grid().voxels()) * sizeof(MaterialTag) : 0;
  const double reading_bytes = static_cast<double>(max_slices * slice) * sizeof(RegionIndex) +
                               static_cast<double>(boxes.workers(std::min(size[2], depth))) *
                                   (static_cast<double>(source.decoding_bytes()) +
                                    static_cast<double>(boxes.voxels()) * sizeof(MaterialTag));
  LabelRegions result{RegionGrid(size), {}, {}, std::numeric_limits<MaterialTag>::min()};
  const auto require = [&] {
    require_memory(static_cast<double>(result.regions.bytes()) + source_bytes + reading_bytes,
                   "the labels of " + file, "crop the volume or make it coarser");
  };
  LabelNumbers all(chosen);
  std::vector<Numbering> threads(thread_count());
  std::vector<RegionIndex> layer;
  layer.reserve(max_slices * slice);
  int written = 0;
  for (int first = 0, last; first < size[2]; first = last) {
    if (progress) progress->throw_if_stopped();
    require();
    last = depth < size[2] - first ? first + depth : size[2];
    layer.resize(static_cast<std::size_t>(last - written) * slice);
    boxes.for_each(first, last, [&](const VoxelIndex& low, const VoxelIndex& high, unsigned thread) {
      threads[thread].read(source, low, high, all,
                           layer.data() + static_cast<std::size_t>(low[2] - written) * slice +
                               static_cast<std::size_t>(low[1]) * row + static_cast<std::size_t>(low[0]),
                           row, slice);
    });
    if (all.too_many())
      throw InputError(
          file, 0,
          "has more than " + std::to_string(InputTuning::Limits::max_materials) +
              " labels; mesh an image of gray values with --iso, or choose fewer labels with --labels");
    // Whole layers of tiles are packed; the rest waits for the next slices.
    const int end = last == size[2] ? last : last / RegionGrid::side * RegionGrid::side;
    const auto packed = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(end - written) * slice);
    result.regions.write_slices(written, std::span(layer).first(static_cast<std::size_t>(packed)));
    std::copy(layer.begin() + packed, layer.end(), layer.begin());
    written = end;
  }

  const std::vector<MaterialTag>& labels = all.labels();
  std::vector<std::uint64_t> counts(labels.size() + 1, 0);
  Labels smallest;
  for (const Numbering& thread : threads) {
    for (std::size_t n = 0; n < thread.counts().size(); ++n) counts[n] += thread.counts()[n];
    smallest.insert(thread.smallest().begin(), thread.smallest().end());
    result.largest = std::max(result.largest, thread.largest());
  }
  keep_smallest(smallest);
  result.smallest.assign(smallest.begin(), smallest.end());
  std::vector<std::size_t> order(labels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return labels[a] < labels[b]; });
  std::vector<RegionIndex> renumbered(labels.size() + 1, outside_region);
  for (const std::size_t i : order) {
    result.counts.emplace_back(labels[i], counts[i + 1]);
    renumbered[i + 1] = static_cast<RegionIndex>(result.counts.size());
  }
  result.regions.renumber(renumbered);
  return result;
}

}  // namespace tetwright
