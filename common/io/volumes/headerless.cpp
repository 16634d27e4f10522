// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/headerless.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/io/encodings/byte_order.h"
#include "common/lower_case.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Type "uint16" or "uint16be".
std::optional<VoxelFormat> named_format(const std::string& text) {
  std::string name = lower_case(text);
  const bool big = name.ends_with("be");
  if (big || name.ends_with("le")) name.resize(name.size() - 2);
  const std::optional<VoxelType> type = voxel_type_called(name);
  if (!type) return std::nullopt;
  VoxelFormat format;
  format.type = *type;
  format.swap = voxel_bytes(*type) > 1 && big == little_endian_machine;
  return format;
}

}  // namespace

void check_volume_options(const VolumeFileOptions& options) {
  if (options.dimensions)
    for (const int n : *options.dimensions)
      if (n < 1)
        throw UsageError("--dimensions: " + std::to_string(n) +
                         " voxels along an axis; give 1 or more along each");
  if (!options.voxel_type.empty() && !named_format(options.voxel_type))
    throw UsageError(
        "--voxel-type: " + in_quotes(options.voxel_type) +
        " is not one of int8, uint8, int16, uint16, int32, uint32, int64, uint64, float16, float32 and "
        "float64, with le or be for the byte order");
  if (options.spacing && !(options.spacing->minCoeff() > 0 && options.spacing->allFinite()))
    throw UsageError("--spacing: a distance between voxels is not a number above 0");
}

RawVolume headerless_volume(const std::string& file, std::uint64_t file_size,
                            const VolumeFileOptions& options) {
  if (!options.dimensions || options.voxel_type.empty())
    throw UsageError(
        file +
        ": a .raw file has voxels alone; give --dimensions NX,NY,NZ and --voxel-type, for example uint16");
  check_volume_options(options);
  const std::array<int, 3>& n = *options.dimensions;
  RawVolume volume{{}, file, 0, *named_format(options.voxel_type)};
  volume.grid.size = checked_size(std::array<std::int64_t, 3>{n[0], n[1], n[2]}, file, 0, max_source_voxels);
  volume.grid.spacing_assumed = true;
  if (voxel_data_bytes(volume.grid.size, volume.format.type) != file_size)
    throw InputError(file, 0,
                     needed_bytes(volume.grid.size, volume.format.type) + "the file has " +
                         std::to_string(file_size) + "; give its --dimensions and --voxel-type");
  return volume;
}

EncodedVolume encoded_headerless(std::string_view bytes, const std::string& name,
                                 const VolumeFileOptions& options) {
  const RawVolume volume = headerless_volume(name, bytes.size(), options);
  const std::array<std::int64_t, 3> size{volume.grid.size[0], volume.grid.size[1], volume.grid.size[2]};
  (void)checked_size(size, name, 0);
  return {volume.grid, {}, volume.format, ByteSource(bytes, ByteSource::Packing::none, name)};
}

}  // namespace tetwright
