// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/dicom_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "common/io/encodings/byte_order.h"
#include "common/io/volumes/chunked_source.h"
#include "common/io/volumes/dicom_codecs.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Directions of rows and columns may differ from perpendicular unit vectors by rounding to a few digits.
constexpr double direction_tolerance = 1e-2;

/// The attributes of a frame: its own, those of all frames, and those of the file.
class FrameAttributes {
 public:
  FrameAttributes(const DicomItem& all, std::int64_t frame) : all_(all) {
    const std::vector<DicomItem>& frames = all.items(dicom::per_frame_functional_groups);
    if (static_cast<std::size_t>(frame) < frames.size()) own_ = &frames[static_cast<std::size_t>(frame)];
    const std::vector<DicomItem>& shared = all.items(dicom::shared_functional_groups);
    if (!shared.empty()) shared_ = &shared.front();
  }

  /// Numbers of an attribute, which is in a functional group, or is one of the file.
  std::vector<double> numbers(const DicomAttribute& group, const DicomAttribute& attribute, std::size_t count,
                              const std::string& file) const {
    for (const DicomItem* item : {own_, shared_}) {
      if (!item) continue;
      const std::vector<DicomItem>& in_group = item->items(group);
      if (!in_group.empty() && in_group.front().has(attribute))
        return in_group.front().numbers(attribute, count, file);
    }
    return all_.numbers(attribute, count, file);
  }
  /// Whether the frames have positions of their own.
  bool has_groups() const { return own_ && !own_->items(dicom::plane_position).empty(); }

 private:
  const DicomItem& all_;
  const DicomItem* own_ = nullptr;
  const DicomItem* shared_ = nullptr;
};

DicomPixelFormat pixel_format(const DicomStructure& structure, const std::string& file) {
  const DicomItem& all = structure.attributes;
  DicomPixelFormat format;
  if (structure.pixels.tag == dicom::float_pixel_data.tag)
    return {.type = VoxelType::float32, .bits_stored = 32};
  if (structure.pixels.tag == dicom::double_pixel_data.tag)
    return {.type = VoxelType::float64, .bits_stored = 64};
  const int bits = all.number(dicom::bits_allocated, 0, file);
  format.bits_stored = all.number(dicom::bits_stored, static_cast<std::uint16_t>(bits), file);
  format.shift = all.number(dicom::high_bit, static_cast<std::uint16_t>(format.bits_stored - 1), file) + 1 -
                 format.bits_stored;
  format.is_signed = all.number(dicom::pixel_representation, 0, file) != 0;
  using enum VoxelType;
  constexpr std::array<std::pair<int, std::array<VoxelType, 2>>, 4> types{
      {{8, {uint8, int8}}, {16, {uint16, int16}}, {32, {uint32, int32}}, {64, {uint64, int64}}}};
  for (const auto& [size, type] : types)
    if (bits == size) {
      format.type = type[format.is_signed ? 1 : 0];
      if (format.bits_stored < 1 || format.shift < 0 || format.bits_stored + format.shift > bits)
        throw InputError(file, 0,
                         "BitsStored is " + std::to_string(format.bits_stored) + " and HighBit " +
                             std::to_string(format.bits_stored + format.shift - 1) + ", with " +
                             std::to_string(bits) + " bits allocated; export the series again");
      return format;
    }
  throw InputError(file, 0,
                   "BitsAllocated is " + std::to_string(bits) + ", and 8, 16, 32 and 64 are supported" +
                       (bits == 1 ? "; convert a segmentation object to .nrrd or .nii.gz, for example in 3D "
                                    "Slicer"
                                  : "; export the series again"));
}

DicomImage image_of(DicomStructure& structure, const std::string& file) {
  const DicomItem& all = structure.attributes;
  DicomImage image;
  image.file = file;
  image.series = all.text(dicom::series_instance_uid);
  const std::string number = all.text(dicom::series_number), text = all.text(dicom::series_description);
  image.description = (number.empty() ? std::string() : "number " + number + " ") +
                      (text.empty() ? std::string() : in_quotes(text) + " ") +
                      (image.series.empty() ? "without SeriesInstanceUID" : in_quotes(image.series));
  const std::string colours = all.text(dicom::photometric_interpretation);
  const int samples = all.number(dicom::samples_per_pixel, 1, file);
  if (samples != 1 || !(colours.empty() || colours.starts_with("MONOCHROME")))
    throw InputError(
        file, 0,
        "it is a colour image (PhotometricInterpretation " + in_quotes(colours) + ", " +
            std::to_string(samples) +
            " samples for each pixel), and gray values are needed; remove it from the folder, or "
            "export it in gray");
  image.columns = all.number(dicom::columns, 0, file);
  image.rows = all.number(dicom::rows, 0, file);
  if (image.columns == 0 || image.rows == 0)
    throw InputError(file, 0,
                     "Columns is " + std::to_string(image.columns) + " and Rows " +
                         std::to_string(image.rows) + "; the file is damaged, export the series again");
  if (!all.items(dicom::modality_lut).empty())
    throw InputError(file, 0,
                     "its values are given by a table (ModalityLUTSequence), and only RescaleSlope and "
                     "RescaleIntercept are supported; export the series with these");
  if (const std::vector<double> frames = all.numbers(dicom::number_of_frames, 1, file); !frames.empty()) {
    if (!(frames[0] >= 1 && frames[0] <= std::numeric_limits<int>::max() &&
          frames[0] == std::floor(frames[0])))
      throw InputError(
          file, 0,
          "NumberOfFrames is " + short_number(frames[0]) + "; the file is damaged, export the series again");
    image.frames = static_cast<std::int64_t>(frames[0]);
  }
  image.format = pixel_format(structure, file);
  const std::int64_t size[] = {image.columns, image.rows};
  (void)checked_chunk_bytes(size, voxel_bytes(image.format.type), file);
  image.transfer_syntax = structure.transfer_syntax;
  image.big_endian = structure.big_endian_pixels;
  image.pixels = std::move(structure.pixels);
  return image;
}

/// \throws InputError unless the file has the pixels of all frames
void check_pixels(const DicomImage& image) {
  const std::vector<DicomRange>& ranges = image.pixels.ranges;
  if (!image.pixels.encapsulated) {
    const std::uint64_t needed = frame_bytes(image) * static_cast<std::uint64_t>(image.frames);
    if (ranges.front().bytes < needed)
      throw InputError(image.file, 0,
                       "its pixels need " + std::to_string(needed) + " bytes, and PixelData has " +
                           std::to_string(ranges.front().bytes) +
                           "; the file is truncated or damaged, copy or export it again");
    return;
  }
  const auto fragments = static_cast<std::int64_t>(ranges.size()) - 1;
  if (fragments < image.frames || (image.frames > 1 && fragments != image.frames))
    throw InputError(image.file, 0,
                     "it has " + std::to_string(std::max<std::int64_t>(fragments, 0)) +
                         " compressed fragments, and " + std::to_string(image.frames) +
                         " frames; convert it, for example by gdcmconv --raw");
}

Vec3 unit_vector(const double* of, const std::string& file) {
  const Vec3 v(of[0], of[1], of[2]);
  if (!(std::fabs(v.norm() - 1) < direction_tolerance))
    throw InputError(file, 0,
                     "ImageOrientationPatient has the direction " + place_text(v) +
                         ", whose length is not 1; export the series again");
  return v.normalized();
}

void set_orientation(const std::vector<double>& numbers, const std::string& file, DicomSlice& slice) {
  if (numbers.empty()) return;
  slice.along_row = unit_vector(numbers.data(), file);
  slice.along_column = unit_vector(numbers.data() + 3, file);
  slice.oriented = true;
  if (std::fabs(slice.along_row.dot(slice.along_column)) > direction_tolerance)
    throw InputError(file, 0,
                     "the two directions of ImageOrientationPatient, " + place_text(slice.along_row) +
                         " and " + place_text(slice.along_column) +
                         ", are not perpendicular; export the series again");
}

/// Puts frames without positions of their own in a row, as far as the file says how.
void place_frames(const DicomItem& all, DicomFrames& out) {
  const std::string& file = out.image.file;
  std::vector<double> offsets = all.numbers(dicom::grid_frame_offsets, 0, file);
  const std::vector<double> step = all.numbers(dicom::spacing_between_slices, 1, file);
  if (offsets.empty() && !step.empty())
    for (std::int64_t k = 0; k < out.image.frames; ++k)
      offsets.push_back(std::fabs(step[0]) * static_cast<double>(k));
  if (offsets.empty()) {
    for (DicomSlice& slice : out.slices) slice.position.reset();
    return;
  }
  if (static_cast<std::int64_t>(offsets.size()) != out.image.frames)
    throw InputError(file, 0,
                     "GridFrameOffsetVector has " + std::to_string(offsets.size()) + " numbers, and it has " +
                         std::to_string(out.image.frames) + " frames; export it again");
  for (DicomSlice& slice : out.slices) {
    const Vec3 first = slice.position.value_or(Vec3::Zero());
    const double offset = offsets[static_cast<std::size_t>(slice.frame)] - offsets.front();
    slice.position = first + offset * slice.along_row.cross(slice.along_column);
  }
}

/// Moves the stored bits of each pixel to the lowest ones, and extends their sign.
template <class Number>
void keep_stored_bits(std::span<char> bytes, const DicomPixelFormat& format) {
  using Unsigned = std::make_unsigned_t<Number>;
  const int unused = static_cast<int>(8 * sizeof(Number)) - format.bits_stored;
  for (std::size_t i = 0; i + sizeof(Number) <= bytes.size(); i += sizeof(Number)) {
    Unsigned number = load<Unsigned>(&bytes[i], false);
    number = static_cast<Unsigned>(number << (unused - format.shift));
    // The shift of a signed number to the right keeps its sign.
    const auto kept = static_cast<Number>(static_cast<Number>(number) >> unused);
    std::memcpy(&bytes[i], &kept, sizeof kept);
  }
}

void keep_stored_bits(std::span<char> bytes, const DicomPixelFormat& format) {
  switch (format.type) {
    case VoxelType::uint8:
      return keep_stored_bits<std::uint8_t>(bytes, format);
    case VoxelType::int8:
      return keep_stored_bits<std::int8_t>(bytes, format);
    case VoxelType::uint16:
      return keep_stored_bits<std::uint16_t>(bytes, format);
    case VoxelType::int16:
      return keep_stored_bits<std::int16_t>(bytes, format);
    case VoxelType::uint32:
      return keep_stored_bits<std::uint32_t>(bytes, format);
    case VoxelType::int32:
      return keep_stored_bits<std::int32_t>(bytes, format);
    case VoxelType::uint64:
      return keep_stored_bits<std::uint64_t>(bytes, format);
    case VoxelType::int64:
      return keep_stored_bits<std::int64_t>(bytes, format);
    default:
      return;
  }
}

void reverse_each(std::span<char> bytes, std::size_t each) {
  for (std::size_t i = 0; i + each <= bytes.size(); i += each)
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                 bytes.begin() + static_cast<std::ptrdiff_t>(i + each));
}

}  // namespace

std::string frame_name(const DicomImage& image, std::int64_t frame) {
  return image.frames == 1 ? image.file : image.file + ": frame " + std::to_string(frame + 1);
}

std::size_t frame_bytes(const DicomImage& image) {
  return static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.rows) *
         voxel_bytes(image.format.type);
}

DicomFrames read_dicom_frames(const std::string& file) {
  DicomStructure structure = read_dicom_structure(FileRanges(file));
  if (structure.pixels.tag == 0) {
    DicomFrames none;
    none.image.file = file;
    none.image.series = structure.attributes.text(dicom::series_instance_uid);
    if (none.image.series.empty() && !structure.is_directory)
      throw InputError(
          file, 0,
          "it has neither pixels nor a SeriesInstanceUID; the file is truncated or damaged, copy "
          "it again or remove it from the folder");
    if (!structure.attributes.has(dicom::rows)) return none;
    throw InputError(file, 0,
                     "it is an image without PixelData; the file is truncated, or its pixels are elsewhere: "
                     "copy or export it again");
  }
  DicomFrames out{image_of(structure, file), {}};
  check_pixels(out.image);
  bool placed = out.image.frames == 1;
  const DicomItem& all = structure.attributes;
  for (std::int64_t frame = 0; frame < out.image.frames; ++frame) {
    const FrameAttributes attributes(all, frame);
    const std::string name = frame_name(out.image, frame);
    DicomSlice& slice = out.slices.emplace_back();
    slice.frame = frame;
    if (const auto p = attributes.numbers(dicom::plane_position, dicom::image_position, 3, name); !p.empty())
      slice.position = Vec3(p[0], p[1], p[2]);
    set_orientation(attributes.numbers(dicom::plane_orientation, dicom::image_orientation, 6, name), name,
                    slice);
    // Rows come first in the attribute.
    if (const auto s = attributes.numbers(dicom::pixel_measures, dicom::pixel_spacing, 2, name); !s.empty()) {
      if (!(s[0] > 0 && s[1] > 0))
        throw InputError(name, 0,
                         "PixelSpacing is " + short_number(s[0]) + " and " + short_number(s[1]) +
                             ", not above 0; export the series again");
      slice.spacing = Vec3(s[1], s[0], 0);
    }
    std::vector<double> slope =
        attributes.numbers(dicom::pixel_value_transformation, dicom::rescale_slope, 1, name);
    if (slope.empty()) slope = all.numbers(dicom::dose_grid_scaling, 1, name);
    const std::vector<double> intercept =
        attributes.numbers(dicom::pixel_value_transformation, dicom::rescale_intercept, 1, name);
    if (!slope.empty()) slice.slope = slope[0];
    if (!intercept.empty()) slice.intercept = intercept[0];
    if (slice.slope == 0)
      throw InputError(name, 0, "RescaleSlope is 0, so all values are equal; export the series again");
    placed = placed || attributes.has_groups();
  }
  if (!placed) place_frames(all, out);
  return out;
}

ByteBuffer read_dicom_frame(const DicomImage& image, std::int64_t frame) {
  const FileRanges file(image.file);
  const std::size_t bytes = frame_bytes(image);
  ByteBuffer out;
  if (!image.pixels.encapsulated) {
    out = file.bytes(image.pixels.ranges.front().offset + static_cast<std::uint64_t>(frame) * bytes, bytes);
    if (image.big_endian == little_endian_machine) {
      const std::size_t each = voxel_bytes(image.format.type);
      reverse_each({out.data.get(), out.size}, each == 1 && image.pixels.words ? 2 : each);
    }
  } else {
    // The first range is the offset table. Frames have a fragment each, unless there is only one.
    const auto first = static_cast<std::size_t>(1 + frame);
    const std::size_t end = image.frames == 1 ? image.pixels.ranges.size() : first + 1;
    std::vector<ByteBuffer> fragments;
    for (std::size_t i = first; i < end; ++i)
      fragments.push_back(
          file.bytes(image.pixels.ranges[i].offset, static_cast<std::size_t>(image.pixels.ranges[i].bytes)));
    const DicomFrameShape shape{image.columns, image.rows,
                                static_cast<int>(8 * voxel_bytes(image.format.type)),
                                image.format.bits_stored, image.format.is_signed};
    out = decode_dicom_frame(image.transfer_syntax, shape, fragments, frame_name(image, frame));
  }
  DicomPixelFormat format = image.format;
  if (image.pixels.encapsulated) format.shift = 0;
  if (static_cast<std::size_t>(format.bits_stored) < 8 * voxel_bytes(format.type))
    keep_stored_bits({out.data.get(), out.size}, format);
  return out;
}

}  // namespace tetwright
