// SPDX-License-Identifier: Apache-2.0
#include "tetwright/label_source.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <utility>

#include "common/whole_volume.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Voxels of the boxes that read_all() reads at a time, unless a block has more: enough to make the cost of a
/// call small, and few enough that many threads share a volume.
constexpr std::int64_t voxels_at_once = std::int64_t{1} << 21;

std::uint64_t label_count(const VoxelIndex& low, const VoxelIndex& high) {
  std::uint64_t n = 1;
  for (std::size_t k = 0; k < 3; ++k) n *= static_cast<std::uint64_t>(high[k] - low[k]);
  return n;
}

/// Index of a voxel in an array of all labels.
std::size_t label_index(const VoxelIndex& size, int x, int y, int z) {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(size[0]) +
         static_cast<std::size_t>(x);
}

/// The error of the lowest item that failed. Items are taken in order, so that all lower ones have ended.
class FirstError {
 public:
  bool before(std::size_t item) const {
    const std::lock_guard lock(mutex_);
    return error_ && item_ < item;
  }
  void add(std::size_t item, std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (error_ && item_ < item) return;
    item_ = item;
    error_ = std::move(error);
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  mutable std::mutex mutex_;
  std::size_t item_ = 0;
  std::exception_ptr error_;
};

}  // namespace

void LabelSource::read(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const {
  for (std::size_t k = 0; k < 3; ++k)
    TETWRIGHT_CHECK(0 <= low[k] && low[k] < high[k] && high[k] <= grid_.size[k]);
  TETWRIGHT_CHECK(out.size() == label_count(low, high));
  read_box(low, high, out);
}

MemoryLabelSource::MemoryLabelSource(LabelVolume volume)
    : LabelSource(static_cast<const LabelGrid&>(volume)), labels_(std::move(volume.labels)) {
  TETWRIGHT_CHECK(labels_.size() == grid().voxels());
}

void MemoryLabelSource::read_box(const VoxelIndex& low, const VoxelIndex& high,
                                 std::span<MaterialTag> out) const {
  auto to = out.begin();
  for (int z = low[2]; z < high[2]; ++z)
    for (int y = low[1]; y < high[1]; ++y)
      to = std::copy_n(labels_.begin() + static_cast<std::ptrdiff_t>(label_index(grid().size, low[0], y, z)),
                       high[0] - low[0], to);
}

LabelBoxes::LabelBoxes(const LabelSource& source, std::int64_t voxels) : size_(source.grid().size) {
  // Labels in memory have no blocks that would be decoded.
  const VoxelIndex block = source.in_memory() ? VoxelIndex{size_[0], 1, 1} : source.block();
  std::array<std::int64_t, 3> box{block[0], block[1], block[2]};
  bool joined = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t needed = (std::int64_t{size_[k]} + box[k] - 1) / box[k];
    if (joined) box[k] *= std::clamp<std::int64_t>(voxels / (box[0] * box[1] * box[2]), 1, needed);
    joined &= box[k] >= size_[k];
    box_[k] = static_cast<int>(std::min<std::int64_t>(box[k], size_[k]));
    boxes_[k] = (size_[k] - 1) / box_[k] + 1;
  }
}

std::size_t LabelBoxes::voxels() const { return label_count({0, 0, 0}, box_); }

std::size_t LabelBoxes::workers(int slices) const {
  const std::size_t boxes = static_cast<std::size_t>(boxes_[0]) * static_cast<std::size_t>(boxes_[1]) *
                            static_cast<std::size_t>((slices - 1) / box_[2] + 1);
  return std::min<std::size_t>(thread_count(), boxes);
}

void LabelBoxes::for_each(
    int first, int last,
    const std::function<void(const VoxelIndex&, const VoxelIndex&, unsigned)>& body) const {
  TETWRIGHT_CHECK(first % box_[2] == 0 && first < last && last <= size_[2]);
  const auto nx = static_cast<std::size_t>(boxes_[0]), ny = static_cast<std::size_t>(boxes_[1]);
  const int layers = (last - first - 1) / box_[2] + 1;
  const auto nz = static_cast<std::size_t>(layers);
  FirstError error;
  parallel_chunks(nx * ny * nz, [&](std::size_t item, unsigned worker) {
    if (error.before(item)) return;
    const std::array<std::size_t, 3> at{item % nx, item / nx % ny, item / nx / ny};
    VoxelIndex low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      const int end = k < 2 ? size_[k] : last;
      low[k] = (k < 2 ? 0 : first) + static_cast<int>(at[k]) * box_[k];
      high[k] = box_[k] < end - low[k] ? low[k] + box_[k] : end;
    }
    try {
      body(low, high, worker);
    } catch (...) {
      error.add(item, std::current_exception());
    }
  });
  error.rethrow();
}

template <class Value>
std::vector<std::vector<Value>> read_whole(const LabelSource& source, std::size_t arrays,
                                           const std::string& file, const std::string& what,
                                           const BoxReader<Value>& read) {
  const LabelGrid& grid = source.grid();
  if (grid.voxels() > static_cast<std::uint64_t>(max_volume_voxels) / arrays)
    throw InputError(file, 0,
                     "its " + std::to_string(grid.size[0]) + " x " + std::to_string(grid.size[1]) + " x " +
                         std::to_string(grid.size[2]) + " voxels" +
                         (arrays > 1 ? " of " + std::to_string(arrays) + " channels" : "") +
                         " are more than " + std::to_string(max_volume_voxels) +
                         "; crop the volume or make it coarser");
  const double all_bytes =
      static_cast<double>(grid.voxels()) * static_cast<double>(arrays) * static_cast<double>(sizeof(Value));
  require_memory(all_bytes, "the " + what + " of " + file, "crop the volume or make it coarser");
  const LabelBoxes boxes(source, voxels_at_once);
  // Boxes that contain whole slices are contiguous in the result.
  const bool slices = boxes.of_whole_slices();
  auto worker_bytes = static_cast<double>(source.decoding_bytes());
  if (!slices) worker_bytes += static_cast<double>(boxes.voxels()) * sizeof(Value);
  const std::size_t workers = boxes.workers(grid.size[2]);
  require_memory(all_bytes + static_cast<double>(workers) * worker_bytes,
                 "the " + what + " of " + file + " and the blocks that " + std::to_string(workers) +
                     " threads decode at a time",
                 "use fewer threads, or store it in smaller chunks");
  std::vector<std::vector<Value>> out(arrays);
  for (std::vector<Value>& values : out) values.resize(grid.voxels());
  boxes.for_each(0, grid.size[2], [&](const VoxelIndex& low, const VoxelIndex& high, unsigned /*worker*/) {
    const std::size_t n = label_count(low, high);
    if (slices) {
      std::vector<std::span<Value>> parts;
      parts.reserve(out.size());
      for (std::vector<Value>& values : out)
        parts.push_back(std::span(values).subspan(label_index(grid.size, 0, 0, low[2]), n));
      read(low, high, 0, parts);
      return;
    }
    std::vector<Value> box(n);
    for (std::size_t array = 0; array < arrays; ++array) {
      const std::span<Value> part(box);
      read(low, high, array, {&part, 1});
      auto from = box.begin();
      for (int z = low[2]; z < high[2]; ++z)
        for (int y = low[1]; y < high[1]; ++y, from += high[0] - low[0])
          std::copy_n(from, high[0] - low[0],
                      out[array].begin() + static_cast<std::ptrdiff_t>(label_index(grid.size, low[0], y, z)));
    }
  });
  return out;
}
template std::vector<std::vector<MaterialTag>> read_whole(const LabelSource&, std::size_t, const std::string&,
                                                          const std::string&, const BoxReader<MaterialTag>&);
template std::vector<std::vector<float>> read_whole(const LabelSource&, std::size_t, const std::string&,
                                                    const std::string&, const BoxReader<float>&);

LabelVolume read_all(const LabelSource& source, const std::string& file) {
  LabelVolume volume{source.grid(), {}};
  volume.labels =
      std::move(read_whole<MaterialTag>(
                    source, 1, file, "labels",
                    [&](const VoxelIndex& low, const VoxelIndex& high, std::size_t /*first*/,
                        std::span<const std::span<MaterialTag>> out) { source.read(low, high, out.front()); })
                    .front());
  return volume;
}

}  // namespace tetwright
