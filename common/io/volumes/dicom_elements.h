// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/io/encodings/file_ranges.h"

namespace tetwright {

/// An attribute of DICOM: its group and element, and its keyword for messages.
struct DicomAttribute {
  std::uint32_t tag;
  const char* keyword;
};

namespace dicom {

inline constexpr DicomAttribute series_description{0x0008103e, "SeriesDescription"},
    spacing_between_slices{0x00180088, "SpacingBetweenSlices"},
    series_instance_uid{0x0020000e, "SeriesInstanceUID"}, series_number{0x00200011, "SeriesNumber"},
    image_position{0x00200032, "ImagePositionPatient"},
    image_orientation{0x00200037, "ImageOrientationPatient"}, plane_position{0x00209113, "PlanePosition"},
    plane_orientation{0x00209116, "PlaneOrientation"}, samples_per_pixel{0x00280002, "SamplesPerPixel"},
    photometric_interpretation{0x00280004, "PhotometricInterpretation"},
    number_of_frames{0x00280008, "NumberOfFrames"}, rows{0x00280010, "Rows"}, columns{0x00280011, "Columns"},
    pixel_spacing{0x00280030, "PixelSpacing"}, bits_allocated{0x00280100, "BitsAllocated"},
    bits_stored{0x00280101, "BitsStored"}, high_bit{0x00280102, "HighBit"},
    pixel_representation{0x00280103, "PixelRepresentation"},
    rescale_intercept{0x00281052, "RescaleIntercept"}, rescale_slope{0x00281053, "RescaleSlope"},
    modality_lut{0x00283000, "ModalityLUTSequence"}, pixel_measures{0x00289110, "PixelMeasures"},
    pixel_value_transformation{0x00289145, "PixelValueTransformation"},
    grid_frame_offsets{0x3004000c, "GridFrameOffsetVector"}, dose_grid_scaling{0x3004000e, "DoseGridScaling"},
    shared_functional_groups{0x52009229, "SharedFunctionalGroups"},
    per_frame_functional_groups{0x52009230, "PerFrameFunctionalGroups"},
    float_pixel_data{0x7fe00008, "FloatPixelData"}, double_pixel_data{0x7fe00009, "DoubleFloatPixelData"},
    pixel_data{0x7fe00010, "PixelData"};

}  // namespace dicom

/// The attributes of a data set, or of an item of a sequence, of those in namespace dicom.
class DicomItem {
 public:
  bool has(const DicomAttribute& attribute) const;
  /// Text without white space at its ends; empty if the attribute is missing.
  std::string text(const DicomAttribute& attribute) const;
  /// Numbers that are stored as text.
  /// \return empty if the attribute is missing or has no value
  /// \throws InputError if the value is not `count` finite numbers; 0: any count
  std::vector<double> numbers(const DicomAttribute& attribute, std::size_t count,
                              const std::string& file) const;
  /// A number of 16 bits.
  /// \throws InputError if the value has another size
  std::uint16_t number(const DicomAttribute& attribute, std::uint16_t otherwise,
                       const std::string& file) const;
  /// Items of a sequence; empty if it is missing.
  const std::vector<DicomItem>& items(const DicomAttribute& sequence) const;

 private:
  friend class DicomScan;
  std::map<std::uint32_t, std::string> values_;
  std::map<std::uint32_t, std::vector<DicomItem>> sequences_;
  bool swap_ = false;
};

/// A range of bytes of a file.
struct DicomRange {
  std::uint64_t offset = 0, bytes = 0;
};

/// Where a file has its pixels.
struct DicomPixels {
  std::uint32_t tag = 0;  ///< 0: the file has none
  bool words = false;     ///< of 16 bits (OW), which matters for the order of bytes
  bool encapsulated = false;
  /// The pixels, or if they are encapsulated the offset table and then the fragments.
  std::vector<DicomRange> ranges;
};

/// The structure of a DICOM file up to its pixels.
struct DicomStructure {
  std::string transfer_syntax;
  bool big_endian_pixels = false;
  bool is_directory = false;  ///< DICOMDIR, which lists files
  DicomItem attributes;
  DicomPixels pixels;
};

/// Whether a file begins as DICOM files do: a preamble and "DICM". False if it cannot be read.
bool is_dicom_file(const std::string& path);

/// Reads the structure of a file, and checks that the file has all bytes of its elements up to the pixels.
/// Reads no pixels, and keeps no value but those of the attributes above.
/// \throws InputError if the file is no DICOM file, or is truncated or damaged
DicomStructure read_dicom_structure(const ByteRanges& file);

}  // namespace tetwright
