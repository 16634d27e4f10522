// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/encoded_volume.h"

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

std::vector<std::vector<MaterialTag>> labels_of_channels(EncodedVolume volume) {
  return channels_of<MaterialTag>(volume);
}

}  // namespace tetwright
