// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/chunked_source.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "tetwright/error.h"

namespace tetwright {

ChunkCache::Chunk ChunkCache::get(std::uint64_t key, const std::function<ByteBuffer()>& load) {
  std::unique_lock lock(mutex_);
  for (auto found = entries_.find(key); found != entries_.end(); found = entries_.find(key)) {
    if (found->second.chunk) {
      used_.splice(used_.begin(), used_, found->second.used);
      return found->second.chunk;
    }
    loaded_.wait(lock);
  }
  entries_.emplace(key, Entry{nullptr, used_.end()});
  lock.unlock();
  try {
    Chunk chunk = std::make_shared<const ByteBuffer>(load());
    lock.lock();
    keep(key, chunk);
    loaded_.notify_all();
    return chunk;
  } catch (...) {
    // Threads that wait for the chunk would wait for ever if its entry stayed.
    if (!lock.owns_lock()) lock.lock();
    entries_.erase(key);
    loaded_.notify_all();
    throw;
  }
}

void ChunkCache::keep(std::uint64_t key, const Chunk& chunk) {
  // A chunk that is not in the file takes an entry, too.
  const auto bytes_of = [](const Chunk& kept) { return kept->size + sizeof(Entry); };
  const std::size_t more = bytes_of(chunk);
  if (more > max_bytes_) {
    entries_.erase(key);
    return;
  }
  while (bytes_ + more > max_bytes_) {
    const auto last = entries_.find(used_.back());
    bytes_ -= bytes_of(last->second.chunk);
    entries_.erase(last);
    used_.pop_back();
  }
  used_.push_front(key);  // may throw, and has no effect then
  bytes_ += more;
  entries_.at(key) = {chunk, used_.begin()};
}

std::int64_t checked_chunk_bytes(std::span<const std::int64_t> size, std::size_t each,
                                 const std::string& file) {
  auto bytes = static_cast<std::int64_t>(each);
  std::string text;
  for (const std::int64_t n : size) text += (text.empty() ? "" : " x ") + std::to_string(n);
  for (const std::int64_t n : size) {
    if (n < 1) throw InputError(file, 0, "its chunks have the size " + text + "; the metadata are damaged");
    if (n > max_chunk_bytes / bytes)
      throw InputError(file, 0,
                       "its chunks of " + text + " voxels have more than " + std::to_string(max_chunk_bytes) +
                           " bytes; store it in smaller chunks");
    bytes *= n;
  }
  return bytes;
}

ChunkedSource::ChunkedSource(LabelGrid grid, const ChunkLayout& layout, std::size_t cache_bytes)
    : VoxelSource(std::move(grid), layout.channels), layout_(layout), cache_(cache_bytes) {
  for (std::size_t k = 0; k < 3; ++k)
    chunks_[k] = (static_cast<std::uint64_t>(this->grid().size[k]) + layout_.size[k] - 1) / layout_.size[k];
}

void ChunkedSource::read_box(const VoxelIndex& low, const VoxelIndex& high,
                             std::span<MaterialTag> out) const {
  read_numbers(low, high, 0, out.data());
}

void ChunkedSource::read_box_of_values(const VoxelIndex& low, const VoxelIndex& high, std::int64_t channel,
                                       std::span<float> out) const {
  read_numbers(low, high, channel, out.data());
}

template <class Value>
void ChunkedSource::read_numbers(const VoxelIndex& low, const VoxelIndex& high, std::int64_t channel,
                                 Value* out) const {
  VoxelIndex first, last;
  for (std::size_t k = 0; k < 3; ++k) {
    first[k] = low[k] / layout_.size[k];
    last[k] = (high[k] - 1) / layout_.size[k];
  }
  const auto row = static_cast<std::size_t>(high[0] - low[0]),
             slice = row * static_cast<std::size_t>(high[1] - low[1]);
  const std::int64_t channel_chunk = channel / layout_.chunk_channels;
  const std::size_t channel_offset =
      static_cast<std::size_t>(channel % layout_.chunk_channels) * layout_.channel_stride;
  const auto copy = [&](const ChunkNumber& chunk) {
    VoxelIndex begin, from, to;  // of the chunk, and of the part of the box in it
    for (std::size_t k = 0; k < 3; ++k) {
      begin[k] = chunk[k] * layout_.size[k];
      from[k] = std::max(low[k], begin[k]);
      to[k] = static_cast<int>(std::min<std::int64_t>(high[k], std::int64_t{begin[k]} + layout_.size[k]));
    }
    const std::uint64_t key =
        ((static_cast<std::uint64_t>(channel_chunk) * chunks_[2] + static_cast<std::uint64_t>(chunk[2])) *
             chunks_[1] +
         static_cast<std::uint64_t>(chunk[1])) *
            chunks_[0] +
        static_cast<std::uint64_t>(chunk[0]);
    const ChunkCache::Chunk kept = cache_.get(key, [&] { return load_chunk(chunk); });
    const auto n = static_cast<std::size_t>(to[0] - from[0]);
    for (int z = from[2]; z < to[2]; ++z)
      for (int y = from[1]; y < to[1]; ++y) {
        Value* values = out + static_cast<std::size_t>(z - low[2]) * slice +
                        static_cast<std::size_t>(y - low[1]) * row + (from[0] - low[0]);
        if (!kept->data) {
          if constexpr (std::is_same_v<Value, float>)
            std::fill_n(values, n, fill_value(chunk));
          else
            std::fill_n(values, n, fill_label(chunk));
          continue;
        }
        const char* bytes = kept->data.get() + channel_offset +
                            static_cast<std::size_t>(from[0] - begin[0]) * layout_.strides[0] +
                            static_cast<std::size_t>(y - begin[1]) * layout_.strides[1] +
                            static_cast<std::size_t>(z - begin[2]) * layout_.strides[2];
        const std::size_t bad = convert_row(bytes, layout_.strides[0], n, layout_.format, values);
        if (bad != n)
          throw InputError(chunk_name(chunk) + ": " +
                           bad_voxel<Value>({{from[0] + static_cast<int>(bad), y, z}, channel, channels()},
                                            bytes + bad * layout_.strides[0], layout_.format));
      }
  };
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x) copy({x, y, z, static_cast<int>(channel_chunk)});
}

}  // namespace tetwright
