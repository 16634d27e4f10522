// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "common/io/encodings/file_ranges.h"
#include "common/io/volumes/voxel_data.h"
#include "common/io/volumes/voxel_source.h"

namespace tetwright {

/// Maximum number of bytes of a decoded chunk: a chunk is decoded as a whole, once for each thread.
inline constexpr std::int64_t max_chunk_bytes = (std::int64_t{1} << 31) - 1;

/// The chunks that were used last, up to a number of bytes. May be used concurrently; a chunk that several
/// threads need at a time is loaded by one of them.
class ChunkCache {
 public:
  /// Null data: the chunk is not in the file.
  using Chunk = std::shared_ptr<const ByteBuffer>;

  explicit ChunkCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Returns the chunk, and calls `load` if it is not kept. Rethrows an exception of `load`, and keeps
  /// nothing then, nor if memory runs out (std::bad_alloc); other threads that wait for the chunk load it.
  Chunk get(std::uint64_t key, const std::function<ByteBuffer()>& load);

 private:
  struct Entry {
    Chunk chunk;  ///< null while a thread loads it
    std::list<std::uint64_t>::iterator used;
  };
  void keep(std::uint64_t key, const Chunk& chunk);

  std::mutex mutex_;
  std::condition_variable loaded_;
  std::unordered_map<std::uint64_t, Entry> entries_;
  std::list<std::uint64_t> used_;  ///< keys of loaded chunks, the last used one first
  std::size_t max_bytes_, bytes_ = 0;
};

/// Shape of the decoded chunks of a volume. All chunks are whole, also where they extend beyond the grid.
struct ChunkLayout {
  VoxelIndex size{};                     ///< voxels along each axis
  std::array<std::size_t, 3> strides{};  ///< from one voxel to the next along each axis, bytes
  std::size_t bytes = 0;                 ///< size of a chunk
  VoxelFormat format;
  std::int64_t channels = 1;        ///< of the volume
  std::int64_t chunk_channels = 1;  ///< of a chunk
  std::size_t channel_stride = 0;   ///< from one channel to the next in a chunk, bytes
};

/// Number of a chunk along x, y, z and the axis of channels.
using ChunkNumber = std::array<int, 4>;

/// Checks the size of a chunk with voxels of `each` bytes.
/// \return its bytes
/// \throws InputError if they are more than max_chunk_bytes
std::int64_t checked_chunk_bytes(std::span<const std::int64_t> size, std::size_t each,
                                 const std::string& file);

/// A volume in chunks of equal size, decoded one by one.
class ChunkedSource : public VoxelSource {
 public:
  VoxelIndex block() const override { return layout_.size; }
  std::size_t decoding_bytes() const override { return layout_.bytes; }

 protected:
  /// \param cache_bytes decoded chunks that are kept, bytes
  ChunkedSource(LabelGrid grid, const ChunkLayout& layout, std::size_t cache_bytes);
  const ChunkLayout& layout() const { return layout_; }

  /// Reads and decodes a chunk. Is called concurrently.
  /// \return its voxels, or a buffer without data if it is not in the file
  virtual ByteBuffer load_chunk(const ChunkNumber& chunk) const = 0;
  /// File and chunk for messages.
  virtual std::string chunk_name(const ChunkNumber& chunk) const = 0;
  /// Label of all voxels of a chunk that is not in the file.
  virtual MaterialTag fill_label(const ChunkNumber& chunk) const = 0;
  /// Value of an image in such a chunk.
  virtual float fill_value(const ChunkNumber& chunk) const = 0;

  void read_box(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const override;
  void read_box_of_values(const VoxelIndex& low, const VoxelIndex& high, std::int64_t channel,
                          std::span<float> out) const override;

 private:
  template <class Value>
  void read_numbers(const VoxelIndex& low, const VoxelIndex& high, std::int64_t channel, Value* out) const;

  ChunkLayout layout_;
  std::array<std::uint64_t, 3> chunks_{};  ///< along each axis
  mutable ChunkCache cache_;
};

}  // namespace tetwright
