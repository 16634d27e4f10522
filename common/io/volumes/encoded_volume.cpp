// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/encoded_volume.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "tetwright/error.h"

namespace tetwright {

namespace {

template <class Value>
std::vector<std::vector<Value>> channels_of(EncodedVolume& volume) {
  if (auto* body = std::get_if<TextScanner>(&volume.body))
    return read_voxels_as_text<Value>(*body, volume.grid.size, volume.channels);
  return read_voxels<Value>(std::get<ByteSource>(volume.body), volume.format, volume.grid.size,
                            volume.channels);
}

}  // namespace

LabelVolume labels_of(EncodedVolume volume) {
  TETWRIGHT_CHECK(volume.channels.count == 1);
  LabelVolume out{volume.grid, {}};
  out.labels = std::move(channels_of<MaterialTag>(volume).front());
  return out;
}

ImageVolume image_of(EncodedVolume volume) { return {volume.grid, channels_of<float>(volume)}; }

LabelVolume labels_of(const ImageVolume& image, const std::string& file) {
  check_channels(static_cast<std::int64_t>(image.channels.size()), image.size, VoxelUse::labels, file, 0);
  const std::vector<float>& values = image.channels.front();
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return labels_of(EncodedVolume{
      image, {}, {.type = VoxelType::float32}, ByteSource(bytes, ByteSource::Packing::none, file)});
}

ImageVolume image_of(const LabelVolume& labels) {
  ImageVolume image{labels, {}};
  std::vector<float>& values = image.channels.emplace_back(labels.labels.size());
  std::transform(labels.labels.begin(), labels.labels.end(), values.begin(),
                 [](MaterialTag label) { return static_cast<float>(label); });
  return image;
}

std::vector<std::vector<MaterialTag>> labels_of_channels(EncodedVolume volume) {
  return channels_of<MaterialTag>(volume);
}

}  // namespace tetwright
