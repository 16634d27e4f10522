// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/metaimage.h"

#include <array>
#include <memory>
#include <utility>

#include "common/io/encodings/byte_order.h"
#include "common/io/encodings/vtk_numbers.h"
#include "common/io/volumes/header_fields.h"
#include "common/io/volumes/voxel_data.h"
#include "common/lower_case.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

VoxelType metaimage_voxel_type(const HeaderFields& header, VoxelUse use) {
  // A long has 4 bytes in these files, whichever machine wrote them.
  constexpr std::array<std::pair<std::string_view, VoxelType>, 12> names{
      {{"met_char", VoxelType::int8},
       {"met_uchar", VoxelType::uint8},
       {"met_short", VoxelType::int16},
       {"met_ushort", VoxelType::uint16},
       {"met_int", VoxelType::int32},
       {"met_uint", VoxelType::uint32},
       {"met_long", VoxelType::int32},
       {"met_ulong", VoxelType::uint32},
       {"met_long_long", VoxelType::int64},
       {"met_ulong_long", VoxelType::uint64},
       {"met_float", VoxelType::float32},
       {"met_double", VoxelType::float64}}};
  const std::string type = header.lower_text("elementtype");
  for (const auto& [name, value] : names)
    if (name == type) return value;
  header.fail("elementtype", "type " + in_quotes(header.text("elementtype")) +
                                 " of the voxels is not supported; " +
                                 numbers_to_save(use, "save the labels as MET_UCHAR, MET_SHORT or MET_INT"));
}

/// Reads the header, including the line that locates the voxels.
HeaderFields read_metaimage_header(TextScanner& in) {
  if (in.left() == 0) in.fail("the file is empty");
  HeaderFields header(in.name());
  while (in.left() > 0) {
    const std::size_t line = in.line();
    const std::string_view text = in.rest_of_line();
    if (trimmed(text).empty() || trimmed(text)[0] == '#') continue;
    const std::size_t equals = text.find_first_of("=:");
    if (equals == std::string_view::npos)
      throw InputError(
          in.name(), line,
          "expected \"name = value\", found " + in_quotes(text) + "; is this a MetaImage header?");
    header.add(text.substr(0, equals), text.substr(equals + 1), line);
    if (header.has("elementdatafile")) break;
  }
  return header;
}

bool flag(const HeaderFields& header, const std::string& field, bool otherwise) {
  if (!header.has(field)) return otherwise;
  const std::string value = header.lower_text(field);
  if (value == "true" || value == "t" || value == "1") return true;
  if (value != "false" && value != "f" && value != "0")
    header.fail(field, "expected True or False as " + field + ", found " + in_quotes(header.text(field)));
  return false;
}

LabelGrid read_geometry(const HeaderFields& header, std::int64_t max_voxels, VoxelUse use) {
  if (header.has("objecttype") && header.lower_text("objecttype") != "image")
    header.fail("objecttype",
                "an object of type Image is needed, this one is " + in_quotes(header.text("objecttype")));
  if (const std::int64_t n = header.integer("ndims"); n != 3)
    header.fail("ndims", std::to_string(n) + " dimensions; " + name_of_use(use) + " has 3");
  LabelGrid volume;
  volume.size = checked_size(header.integers("dimsize"), header.file(), header.line("dimsize"), max_voxels);
  if (const std::string field = header.any_of({"offset", "position", "origin"}); header.has(field)) {
    const std::vector<double> origin = header.numbers(field, 3);
    volume.origin = Vec3(origin[0], origin[1], origin[2]);
  }
  if (const std::string field = header.any_of({"transformmatrix", "rotation", "orientation"});
      header.has(field)) {
    // The directions of the axes, one after the other.
    const std::vector<double> matrix = header.numbers(field, 9);
    volume.directions = Eigen::Map<const Eigen::Matrix3d>(matrix.data());
  }
  // Voxel size equals spacing unless there are gaps between voxels; the spacing includes them.
  if (const std::string field = header.any_of({"elementspacing", "elementsize"}); header.has(field)) {
    const std::vector<double> spacing = header.numbers(field, 3);
    for (int axis = 0; axis < 3; ++axis)
      volume.directions.col(axis) *= spacing[static_cast<std::size_t>(axis)];
  }
  // Coordinates follow ITK's convention if the header gives the patient's orientation.
  if (header.has("anatomicalorientation") && header.text("anatomicalorientation") != "???")
    volume.space = "left-posterior-superior";
  check_geometry(volume, header.file());
  return volume;
}

/// The header of a MetaImage file, checked.
struct MetaImageFile {
  MetaImageFile(TextScanner& in, std::int64_t max_voxels, VoxelUse use)
      : header(read_metaimage_header(in)), grid(read_geometry(header, max_voxels, use)) {
    if (const std::string field = "elementnumberofchannels"; header.has(field)) {
      channels = {header.integer(field), 0};
      check_channels(channels.count, grid.size, use, header.file(), header.line(field), max_voxels);
    }
    format.type = metaimage_voxel_type(header, use);
    const bool big = flag(header, header.any_of({"elementbyteordermsb", "binarydatabyteordermsb"}), false);
    format.swap = big == little_endian_machine;
    packed = flag(header, "compresseddata", false);
    as_text = !flag(header, "binarydata", true);
    if (packed && as_text)
      header.fail("compresseddata", "compressed text is not supported; save it as binary");
    local = header.lower_text("elementdatafile") == "local";
  }

  /// Offset of the voxels in their file.
  /// \param behind_header offset after a header in the same file, or 0
  std::uint64_t offset(std::uint64_t behind_header, std::uint64_t file_size) const {
    const std::int64_t skip = header.has("headersize") ? header.integer("headersize") : 0;
    if (skip == -1) {
      if (packed || as_text) header.fail("headersize", "HeaderSize -1 is allowed only for raw data");
      return behind_header +
             offset_from_end(file_size - behind_header, grid.size, format.type, channels.count);
    }
    // Counted from the beginning of the file, which may be the header's or a separate one.
    if (skip < 0 || static_cast<std::uint64_t>(skip) > file_size)
      header.fail("headersize",
                  std::to_string(skip) + " bytes to skip, but the file has " + std::to_string(file_size));
    return skip == 0 ? behind_header : static_cast<std::uint64_t>(skip);
  }

  HeaderFields header;
  LabelGrid grid;
  ChannelAxis channels;
  VoxelFormat format;
  bool packed = false, as_text = false;
  bool local = false;  ///< the voxels are in the file of the header
};

}  // namespace

EncodedVolume open_metaimage(std::string_view bytes, const std::string& name, const FileReader& read,
                             VoxelUse use) {
  TextScanner in(bytes, name);
  const MetaImageFile image(in, max_volume_voxels, use);
  DataFile file{name, {}};
  if (!image.local) file = read_data_file(image.header, "elementdatafile", read);
  const auto other = std::make_shared<const std::string>(std::move(file.bytes));
  const std::string_view whole = image.local ? bytes : std::string_view(*other);
  const std::string_view data =
      whole.substr(static_cast<std::size_t>(image.offset(image.local ? in.offset() : 0, whole.size())));
  if (image.as_text) return {image.grid, image.channels, image.format, TextScanner(data, file.path), other};
  return {
      image.grid, image.channels, image.format,
      ByteSource(data, image.packed ? ByteSource::Packing::deflate : ByteSource::Packing::none, file.path),
      other};
}

LabelVolume read_metaimage(std::string_view bytes, const std::string& name, const FileReader& read) {
  return labels_of(open_metaimage(bytes, name, read, VoxelUse::labels));
}

std::optional<RawVolume> find_metaimage(const HeaderBytes& head, const std::string& name, VoxelUse use) {
  // The last field of a header.
  if (!head.whole_file() && lower_case(head.bytes).find("elementdatafile") == std::string::npos)
    return std::nullopt;
  TextScanner in(head.bytes, name);
  const MetaImageFile image(in, max_source_voxels, use);
  if (image.packed || image.as_text) return std::nullopt;
  RawVolume found{image.grid, name, 0, image.format, image.channels};
  if (!image.local) found.file = data_file_path(image.header, "elementdatafile");
  const std::uint64_t size = image.local ? head.file_size : data_file_size(image.header, "elementdatafile");
  found.offset = image.offset(image.local ? in.offset() : 0, size);
  return found;
}

}  // namespace tetwright
