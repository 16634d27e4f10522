// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/label_volume.h"

namespace tetwright {

/// Index of a voxel, or a corner of a box of voxels.
using VoxelIndex = std::array<int, 3>;

/// A segmented volume whose labels are read box by box, so that it need not fit into memory.
///
/// All functions may be called concurrently. open_label_source() of io.h opens files.
class LabelSource {
 public:
  virtual ~LabelSource() = default;
  LabelSource(const LabelSource&) = delete;
  LabelSource& operator=(const LabelSource&) = delete;

  const LabelGrid& grid() const { return grid_; }
  /// Sets the distance between voxels, see tetwright::set_spacing(). Not to be called concurrently with other
  /// functions.
  void set_spacing(const Vec3& spacing) { tetwright::set_spacing(grid_, spacing); }

  /// Voxels along each axis of the blocks in which the labels are stored. Boxes whose corners are multiples
  /// of it decode each block once. A block may extend beyond the grid.
  virtual VoxelIndex block() const = 0;

  /// Memory that each thread needs to decode a block, bytes.
  virtual std::size_t decoding_bytes() const { return 0; }

  /// Whether all labels are in memory, for example since their file is compressed as a whole.
  virtual bool in_memory() const { return false; }

  /// Reads the labels of the half-open box of voxels from `low` to `high`.
  /// \param out receives the labels, the first axis fastest
  /// \pre 0 <= low < high <= grid().size along each axis, and `out` has the size of the box
  /// \throws InputError naming the file, and its chunk, page or voxel, if it cannot be read, is damaged, or
  /// has
  ///   a value that is not a 32-bit integer; `out` is then undefined
  void read(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const;

 protected:
  explicit LabelSource(LabelGrid grid) : grid_(std::move(grid)) {}
  virtual void read_box(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const = 0;

 private:
  LabelGrid grid_;
};

/// A source that serves the labels of a volume in memory.
class MemoryLabelSource final : public LabelSource {
 public:
  /// \pre volume.labels has a label for each voxel
  explicit MemoryLabelSource(LabelVolume volume);
  VoxelIndex block() const override { return grid().size; }
  bool in_memory() const override { return true; }

 protected:
  void read_box(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const override;

 private:
  std::vector<MaterialTag> labels_;
};

/// The boxes in which all of a source is read: whole blocks, joined along the first axis, then the others.
class LabelBoxes {
 public:
  /// \param voxels of a box, unless a block has more
  LabelBoxes(const LabelSource& source, std::int64_t voxels);

  int slices() const { return box_[2]; }  ///< of a box
  std::size_t voxels() const;             ///< of a box, at most
  bool of_whole_slices() const { return boxes_[0] == 1 && boxes_[1] == 1; }
  /// Number of threads that for_each() uses for `slices` slices.
  std::size_t workers(int slices) const;

  /// Calls `body(low, high, worker)` for the boxes of the slices from `first` to before `last`, concurrently:
  /// a worker, numbered from 0, runs on one thread at a time. Rethrows the exception of the first box that
  /// has one, for any number of threads.
  ///
  /// \pre `first` is a multiple of slices()
  void for_each(int first, int last,
                const std::function<void(const VoxelIndex&, const VoxelIndex&, unsigned)>& body) const;

 private:
  VoxelIndex size_, box_, boxes_{};
};

/// Reads all labels of a source, decoding blocks in parallel. The volume takes four bytes for each voxel.
/// \param file file name for messages
/// \throws InputError if there are more than 2^31 voxels, and as LabelSource::read() does: the error of the
///   first block that has one, for any number of threads
/// \throws OutputError if the labels, and the blocks that threads decode at a time, exceed
///   available_memory()
LabelVolume read_all(const LabelSource& source, const std::string& file);

/// Maximum number of voxels of a volume in memory.
inline constexpr std::int64_t max_volume_voxels = std::int64_t{1} << 31;

}  // namespace tetwright
