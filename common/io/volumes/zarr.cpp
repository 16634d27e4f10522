// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/zarr.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <utility>

#include "common/io/encodings/byte_order.h"
#include "common/io/encodings/chunk_codecs.h"
#include "common/io/volumes/chunked_source.h"
#include "common/io/volumes/volume_axes.h"
#include "common/io/volumes/zarr_metadata.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Far larger than the metadata of any array; consolidated metadata are not read.
constexpr std::uint64_t max_metadata_bytes = std::uint64_t{1} << 26;

/// Levels of groups above an array that are searched for its image.
constexpr int max_groups_above = 8;

/// Indices of shards that are kept in any case, bytes: each is needed for all chunks of its shard.
constexpr std::size_t min_index_bytes = std::size_t{1} << 20;

/// Offset and length of a chunk in a shard: two numbers of 8 bytes.
constexpr std::size_t index_entry_bytes = 16;
/// Both numbers, of a chunk that a shard does not have.
constexpr std::uint64_t no_chunk = ~std::uint64_t{0};

std::string joined(const std::string& folder, const std::string& name) {
  return folder.empty() || folder.ends_with('/') ? folder + name : folder + "/" + name;
}

std::optional<std::string> metadata_text(const FileOpener& open, const std::string& path) {
  const std::unique_ptr<ByteRanges> file = open(path);
  if (!file) return std::nullopt;
  if (file->size() > max_metadata_bytes)
    throw InputError(path, 0, std::to_string(file->size()) + " bytes are not metadata of a zarr array");
  return std::string(file->bytes(0, static_cast<std::size_t>(file->size())).view());
}

class ZarrSource final : public ChunkedSource {
 public:
  ZarrSource(LabelGrid grid, const ChunkLayout& layout, std::size_t cache_bytes, ZarrArray array,
             const VolumeAxes& axes, std::string folder, FileOpener open)
      : ChunkedSource(std::move(grid), layout, cache_bytes),
        array_(std::move(array)),
        axes_(axes.spatial.begin(), axes.spatial.end()),
        folder_(std::move(folder)),
        open_(std::move(open)),
        indices_(std::max(cache_bytes / 8, min_index_bytes)) {
    if (axes.channel) axes_.push_back(*axes.channel);
    in_shard_.assign(array_.shape.size(), 1);
    for (std::size_t k = 0; k < array_.shard.size(); ++k)
      in_shard_[k] = array_.shard[k] / array_.chunk.size[k];
    std::uint64_t chunks = 1;
    for (const std::int64_t n : in_shard_) {
      if (static_cast<std::uint64_t>(n) > max_chunk_bytes / index_entry_bytes / chunks)
        throw InputError(folder_, 0, "its shards have too many chunks; store it in larger chunks");
      chunks *= static_cast<std::uint64_t>(n);
    }
    index_bytes_ = static_cast<std::size_t>(chunks) * index_entry_bytes;
    for (std::size_t k = 0; k < axes_.size(); ++k) {
      const std::int64_t size = array_.chunk.size[axes_[k]] * in_shard_[axes_[k]];
      shards_along_[k] = (array_.shape[axes_[k]] - 1) / size + 1;
    }
  }

 protected:
  ByteBuffer load_chunk(const ChunkNumber& chunk) const override {
    const std::unique_ptr<ByteRanges> file = open_(path_of(chunk));
    if (!file) return {};
    const std::string name = chunk_name(chunk);
    if (array_.shard.empty()) return decoded(*file, 0, file->size(), name);
    const auto [offset, n] = entry_of(chunk, *file);
    if (offset == no_chunk && n == no_chunk) return {};
    if (offset > file->size() || n > file->size() - offset)
      throw InputError(name + ": its shard says that it has " + std::to_string(n) + " bytes at byte " +
                       std::to_string(offset) + " of " + std::to_string(file->size()) +
                       "; the file is truncated or damaged");
    return decoded(*file, offset, n, name);
  }

  std::string chunk_name(const ChunkNumber& chunk) const override {
    std::string name = path_of(chunk);
    if (array_.shard.empty()) return name;
    std::string inner;
    for (std::size_t k = 0; k < array_.shape.size(); ++k)
      inner += (k ? "." : "") + std::to_string(number_along(k, chunk) % in_shard_[k]);
    return name + ": chunk " + inner;
  }

  MaterialTag fill_label(const ChunkNumber& chunk) const override {
    if (!array_.fill)
      throw InputError(chunk_name(chunk) + " is missing, and the fill value " + in_quotes(array_.fill_text) +
                       " is not a label; copy the array again, or store 0 as its fill value");
    return *array_.fill;
  }

  float fill_value(const ChunkNumber& chunk) const override {
    if (!array_.fill_value)
      throw InputError(chunk_name(chunk) + " is missing, and the fill value " + in_quotes(array_.fill_text) +
                       " is not a finite number; copy the array again, or store a number as its fill value");
    return *array_.fill_value;
  }

 private:
  /// Number of a chunk along an axis of the file.
  std::int64_t number_along(std::size_t axis, const ChunkNumber& chunk) const {
    for (std::size_t k = 0; k < axes_.size(); ++k)
      if (axes_[k] == axis) return chunk[k];
    return 0;
  }

  std::string path_of(const ChunkNumber& chunk) const {
    std::string key;
    for (std::size_t k = 0; k < array_.shape.size(); ++k) {
      if (k) key += array_.separator;
      key += std::to_string(number_along(k, chunk) / in_shard_[k]);
    }
    return joined(folder_, array_.key_prefix + key);
  }

  ByteBuffer decoded(const ByteRanges& file, std::uint64_t offset, std::uint64_t n,
                     const std::string& name) const {
    if (n > max_stored_size(layout().bytes))
      throw InputError(name + ": it has " + std::to_string(n) + " bytes, too many for a chunk of " +
                       std::to_string(layout().bytes) + "; the chunk or the metadata are wrong");
    return decode_chunk(file.bytes(offset, static_cast<std::size_t>(n)), array_.chunk.codecs, layout().bytes,
                        name);
  }

  /// Offset and length of a chunk in its shard.
  std::pair<std::uint64_t, std::uint64_t> entry_of(const ChunkNumber& chunk, const ByteRanges& file) const {
    std::uint64_t shard = 0;
    for (std::size_t k = axes_.size(); k-- > 0;)
      shard = shard * static_cast<std::uint64_t>(shards_along_[k]) +
              static_cast<std::uint64_t>(chunk[k] / in_shard_[axes_[k]]);
    const ChunkCache::Chunk index = indices_.get(shard, [&] { return read_index(file); });
    std::uint64_t entry = 0;
    for (std::size_t k = 0; k < in_shard_.size(); ++k)
      entry = entry * static_cast<std::uint64_t>(in_shard_[k]) +
              static_cast<std::uint64_t>(number_along(k, chunk) % in_shard_[k]);
    const char* at = index->data.get() + entry * index_entry_bytes;
    return {load<std::uint64_t>(at, array_.index_swap), load<std::uint64_t>(at + 8, array_.index_swap)};
  }

  ByteBuffer read_index(const ByteRanges& file) const {
    constexpr std::size_t checksum_bytes = 4;
    const std::size_t stored = index_bytes_ + checksum_bytes * array_.index_codecs.size();
    if (stored > file.size())
      throw InputError(file.name() + ": it has " + std::to_string(file.size()) +
                       " bytes, and the index of a shard " + std::to_string(stored) +
                       "; the file is truncated");
    return decode_chunk(file.bytes(array_.index_at_end ? file.size() - stored : 0, stored),
                        array_.index_codecs, index_bytes_, file.name() + ": the index of the shard");
  }

  ZarrArray array_;
  std::vector<std::size_t> axes_;  ///< x, y and z in the file, and that of channels if it has one
  std::string folder_;
  FileOpener open_;
  std::vector<std::int64_t> in_shard_;  ///< chunks of a file along each axis of the file
  std::array<std::int64_t, 4> shards_along_{};
  std::size_t index_bytes_ = 0;
  mutable ChunkCache indices_;  ///< of shards
};

/// An array, with the image to which it belongs.
struct OpenedArray {
  std::string folder;
  ZarrArray array;
  std::vector<std::string> axis_names;
  ZarrDataset placement;
};

std::optional<ZarrArray> array_at(const FileOpener& open, const std::string& folder) {
  const std::string second = joined(folder, ".zarray"), third = joined(folder, "zarr.json");
  if (const auto text = metadata_text(open, second)) return parse_zarr2_array(*text, second);
  if (const auto text = metadata_text(open, third)) return parse_zarr3_array(*text, third);
  return std::nullopt;
}

/// The image of a group.
/// \param group receives whether there is a group
std::optional<ZarrImage> image_at(const FileOpener& open, const std::string& folder, bool& group) {
  group = true;
  for (const char* name : {".zattrs", "zarr.json"}) {
    const std::string path = joined(folder, name);
    if (const auto text = metadata_text(open, path)) return parse_zarr_image(*text, path);
  }
  group = open(joined(folder, ".zgroup")) != nullptr;
  return std::nullopt;
}

/// Looks for the image that has the array as one of its datasets.
void take_image_above(const FileOpener& open, OpenedArray& opened) {
  std::filesystem::path folder = opened.folder;
  if (!folder.has_filename()) folder = folder.parent_path();  // it ends with a slash
  std::string path;
  for (int level = 0; level < max_groups_above && folder.has_filename(); ++level) {
    std::string last = folder.filename().string();
    if (!path.empty()) last.append("/").append(path);
    path = std::move(last);
    folder = folder.parent_path();
    bool group = false;
    const std::optional<ZarrImage> image = image_at(open, folder.string(), group);
    if (!group) return;
    if (!image) continue;
    for (const ZarrDataset& dataset : image->datasets)
      if (dataset.path == path) {
        opened.axis_names = image->axis_names;
        opened.placement = dataset;
        return;
      }
  }
}

OpenedArray find_array(const FileOpener& open, const std::string& path) {
  if (std::optional<ZarrArray> array = array_at(open, path)) {
    OpenedArray opened{path, std::move(*array), {}, {}};
    take_image_above(open, opened);
    return opened;
  }
  bool group = false;
  const std::optional<ZarrImage> image = image_at(open, path, group);
  if (!group)
    throw InputError(
        path, 0,
        "there is no zarr array (.zarray or zarr.json) in it; give the folder of an array or of an "
        "OME-Zarr image");
  if (!image)
    throw InputError(path, 0,
                     "it is a group of zarr arrays, and no image; give the folder of an array in it");
  const ZarrDataset& first = image->datasets.front();
  const std::string folder = joined(path, first.path);
  std::optional<ZarrArray> array = array_at(open, folder);
  if (!array)
    throw InputError(folder, 0, "the image names this array, and it is missing; copy the folder again");
  return {folder, std::move(*array), image->axis_names, first};
}

}  // namespace

std::unique_ptr<VoxelSource> open_zarr(const std::string& path, std::size_t cache_bytes,
                                       const FileOpener& open, VoxelUse use) {
  OpenedArray opened = find_array(open, path);
  ZarrArray& array = opened.array;
  const std::size_t axes = array.shape.size();
  const std::vector<std::string>& names =
      opened.axis_names.size() == axes ? opened.axis_names : array.axis_names;
  const VolumeAxes chosen = volume_axes(array.shape, names, use, opened.folder);
  const std::array<std::size_t, 3>& spatial = chosen.spatial;
  LabelGrid grid;
  std::array<std::int64_t, 3> size;
  for (std::size_t k = 0; k < 3; ++k) size[k] = array.shape[spatial[k]];
  grid.size = checked_size(size, opened.folder, 0, max_source_voxels);
  grid.spacing_assumed = opened.placement.scale.empty();
  if (!grid.spacing_assumed) {
    if (opened.placement.scale.size() != axes)
      throw InputError(opened.folder, 0,
                       "the array has " + std::to_string(axes) + " axes, and the scale of its image " +
                           std::to_string(opened.placement.scale.size()));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      grid.directions(axis, axis) = opened.placement.scale[spatial[k]];
      grid.origin[axis] = opened.placement.translation[spatial[k]];
    }
  }
  check_geometry(grid, opened.folder);
  ChunkLayout layout;
  layout.format = array.format;
  const std::size_t each = voxel_bytes(array.format.type);
  layout.bytes = static_cast<std::size_t>(checked_chunk_bytes(array.chunk.size, each, opened.folder));
  const std::vector<std::size_t> strides = strides_of(array.chunk.size, array.chunk.order);
  for (std::size_t k = 0; k < 3; ++k) {
    layout.size[k] = static_cast<int>(array.chunk.size[spatial[k]]);
    layout.strides[k] = strides[spatial[k]] * each;
  }
  if (chosen.channel) {
    layout.channels = array.shape[*chosen.channel];
    check_channels(layout.channels, grid.size, use, opened.folder, 0, max_source_voxels);
    layout.chunk_channels = array.chunk.size[*chosen.channel];
    layout.channel_stride = strides[*chosen.channel] * each;
  }
  return std::make_unique<ZarrSource>(std::move(grid), layout, cache_bytes, std::move(array), chosen,
                                      opened.folder, open);
}

bool is_zarr_folder(const std::string& path) {
  const std::filesystem::path folder = path;
  std::error_code error;
  for (const char* name : {".zarray", ".zgroup", "zarr.json"})
    if (std::filesystem::is_regular_file(folder / name, error)) return true;
  return false;
}

}  // namespace tetwright
