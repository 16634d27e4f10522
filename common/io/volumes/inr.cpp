// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/inr.h"

#include <optional>
#include <utility>

#include "common/io/encodings/byte_order.h"
#include "common/io/encodings/vtk_numbers.h"
#include "common/io/volumes/header_fields.h"
#include "common/io/volumes/voxel_data.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::string_view inr_magic = "#INRIMAGE-4#{";
constexpr std::string_view header_end = "##}";
/// The size of a header is a multiple of this, bytes.
constexpr std::size_t block_size = 256;
constexpr std::size_t max_header_size = 256 * block_size;

std::string read_header_bytes(ByteSource& source) {
  std::string header(source.take(block_size));
  if (header.empty()) throw InputError(source.name() + ": the file is empty");
  if (!header.starts_with(inr_magic))
    throw InputError(source.name(), 1,
                     "expected \"#INRIMAGE-4#{\" at the beginning, found " +
                         in_quotes(std::string_view(header).substr(0, inr_magic.size())) +
                         "; is this an INR file?");
  for (;;) {
    if (const std::size_t end = header.find(header_end); end != std::string::npos) {
      header.resize(end);
      return header;
    }
    const std::string_view next = source.take(block_size);
    if (next.empty() || header.size() >= max_header_size)
      throw InputError(source.name() + ": the header has no end \"##}\"; the file is truncated or damaged");
    header += next;
  }
}

HeaderFields fields_of(const std::string& text, const std::string& name) {
  HeaderFields header(name);
  TextScanner in(text, name);
  in.skip_line();
  while (in.left() > 0) {
    const std::size_t line = in.line();
    const std::string_view row = in.rest_of_line();
    if (trimmed(row).empty() || row[0] == '#') continue;
    const std::size_t equals = row.find('=');
    if (equals == std::string_view::npos)
      throw InputError(name, line, "expected \"NAME=value\", found " + in_quotes(row));
    header.add(row.substr(0, equals), row.substr(equals + 1), line);
  }
  return header;
}

VoxelFormat voxel_format(const HeaderFields& header, VoxelUse use) {
  const std::string type = header.lower_text("type");
  const std::vector<std::string_view> size = header.words("pixsize");
  std::int64_t bits = 0;
  const bool readable =
      !size.empty() && parse_number(size[0], bits) && (size.size() == 1 || size[1] == "bits");
  const auto choose = [&]() -> std::optional<VoxelType> {
    if (type == "unsigned fixed") {
      if (bits == 8) return VoxelType::uint8;
      if (bits == 16) return VoxelType::uint16;
      if (bits == 32) return VoxelType::uint32;
      if (bits == 64) return VoxelType::uint64;
    } else if (type == "signed fixed") {
      if (bits == 8) return VoxelType::int8;
      if (bits == 16) return VoxelType::int16;
      if (bits == 32) return VoxelType::int32;
      if (bits == 64) return VoxelType::int64;
    } else if (type == "float") {
      if (bits == 32) return VoxelType::float32;
      if (bits == 64) return VoxelType::float64;
    }
    return std::nullopt;
  };
  const std::optional<VoxelType> known = readable ? choose() : std::nullopt;
  if (!known)
    header.fail(type == "unsigned fixed" || type == "signed fixed" || type == "float" ? "pixsize" : "type",
                "voxels of type " + in_quotes(header.text("type")) + " and size " +
                    in_quotes(header.text("pixsize")) + " are not supported; " +
                    numbers_to_save(use, "save the labels as unsigned fixed of 8, 16 or 32 bits"));
  VoxelFormat format;
  format.type = *known;
  if (voxel_bytes(format.type) > 1 || header.has("cpu")) {
    const std::string cpu = header.lower_text("cpu");
    const bool little = cpu == "decm" || cpu == "alpha" || cpu == "pc";
    if (!little && cpu != "sun" && cpu != "sgi")
      header.fail("cpu", "unknown CPU " + in_quotes(header.text("cpu")) +
                             "; supported: decm, alpha, pc, sun and sgi");
    format.swap = little != little_endian_machine;
  }
  return format;
}

}  // namespace

EncodedVolume open_inr(std::string_view bytes, const std::string& name, const FileReader& /*others*/,
                       VoxelUse use) {
  ByteSource source(
      bytes, bytes.starts_with("\x1f\x8b") ? ByteSource::Packing::deflate : ByteSource::Packing::none, name);
  const std::string header_bytes = read_header_bytes(source);
  const HeaderFields header = fields_of(header_bytes, name);
  LabelGrid volume;
  std::array<std::int64_t, 3> sizes;
  constexpr std::array<const char*, 3> size_names{"xdim", "ydim", "zdim"}, spacing_names{"vx", "vy", "vz"},
      origin_names{"tx", "ty", "tz"}, turn_names{"rx", "ry", "rz"};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<int>(k);
    sizes[k] = header.integer(size_names[k]);
    if (header.has(spacing_names[k])) volume.directions(axis, axis) = header.number(spacing_names[k]);
    if (header.has(origin_names[k])) volume.origin[axis] = header.number(origin_names[k]);
    if (header.has(turn_names[k]) && header.number(turn_names[k]) != 0)
      header.fail(turn_names[k], "a rotated volume (" + in_quotes(header.text(turn_names[k])) +
                                     ") is not supported; save it as NRRD or NIfTI");
  }
  volume.size = checked_size(sizes, name, header.line("xdim"));
  ChannelAxis channels{1, 0};
  if (header.has("vdim")) {
    channels.count = header.integer("vdim");
    if (use == VoxelUse::labels && channels.count != 1)
      header.fail("vdim", std::to_string(channels.count) +
                              " numbers per voxel; a volume with one label per voxel is needed");
    check_channels(channels.count, volume.size, use, name, header.line("vdim"));
  }
  check_geometry(volume, name);
  return {volume, channels, voxel_format(header, use), std::move(source)};
}

LabelVolume read_inr(std::string_view bytes, const std::string& name) {
  return labels_of(open_inr(bytes, name, {}, VoxelUse::labels));
}

}  // namespace tetwright
