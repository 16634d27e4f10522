// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/dicom.h"

#include <filesystem>

#include "tests/common/io/file_test.h"
#include "tests/common/io/volume_boxes.h"
#include "tests/common/io/volumes/dicom_series.h"
#include "tetwright/io.h"

namespace tetwright::dicom_test {
namespace {

constexpr std::size_t cache_bytes = 1 << 12;
const VoxelIndex size{5, 4, 7};

class Dicom : public FileTest {
 protected:
  /// Writes a slice for each layer of the volume, 1.5 apart along `step`, under names in another order.
  /// \param change changes the slice of a layer
  void write(const LabelVolume& volume, const DicomToWrite& first, const Vec3& step,
             const std::function<void(int, DicomToWrite&)>& change = {}) const {
    std::filesystem::create_directories(path("series"));
    for (int z = 0; z < volume.size[2]; ++z) {
      DicomToWrite slice = first;
      slice.columns = volume.size[0];
      slice.rows = volume.size[1];
      slice.position += z * step;
      if (change) change(z, slice);
      put(path(name(z)), dicom_file(slice, pixels(volume, z, slice)));
    }
  }
  static std::string name(int z) { return "series/IM" + std::to_string(z * 5 % 7); }

  static std::string pixels(const LabelVolume& volume, int z, const DicomToWrite& slice) {
    const std::vector<MaterialTag> labels =
        box_of(volume, {0, 0, z}, {volume.size[0], volume.size[1], z + 1});
    const std::vector<std::uint8_t> bytes(labels.begin(), labels.end());
    const std::vector<std::uint16_t> words(labels.begin(), labels.end());
    const std::vector<std::int32_t> numbers(labels.begin(), labels.end());
    return slice.bits == 8    ? dicom_pixels(bytes, slice)
           : slice.bits == 16 ? dicom_pixels(words, slice)
                              : dicom_pixels(numbers, slice);
  }
  std::string message() const {
    return error_of<InputError>([&] { (void)read_label_volume(path("series")); });
  }
  void expect_refused(const std::string& expected) const {
    const std::string text = message();
    EXPECT_NE(text.find(expected), std::string::npos) << text;
  }
  const LabelVolume volume_ = numbered_volume(size);
};

TEST_F(Dicom, SlicesAreOrderedByTheirPositions) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const Vec3 oblique = Vec3(0.8, 0.6, 0), across = Vec3(0, 0, -1);
  for (const auto& [row, column] : {std::pair(x, y), std::pair(y, z), std::pair(x, Vec3(-z)),
                                    std::pair(oblique, across), std::pair(Vec3(-x), y)}) {
    const Vec3 normal = row.cross(column);
    write(volume_, {.position = Vec3(10, -20, 30), .along_row = row, .along_column = column}, 1.5 * normal);
    EXPECT_EQ(file_kind(path("series")), FileKind::volume);
    const auto source = open_dicom(path("series"), cache_bytes);
    expect_labels(*source, volume_);
    const LabelGrid& grid = source->grid();
    EXPECT_NEAR((grid.origin - Vec3(10, -20, 30)).norm(), 0, 1e-9);
    EXPECT_NEAR((grid.directions.col(0) - 0.25 * row).norm(), 0, 1e-9);
    EXPECT_NEAR((grid.directions.col(1) - 0.5 * column).norm(), 0, 1e-9);
    EXPECT_NEAR((grid.directions.col(2) - 1.5 * normal).norm(), 0, 1e-6);
    EXPECT_EQ(grid.space, "left-posterior-superior");
    EXPECT_FALSE(grid.spacing_assumed);
    EXPECT_TRUE(grid.ignored_files.empty());
  }
}

TEST_F(Dicom, SlicesAgainstTheNormalAreTurnedRound) {
  write(volume_, {}, Vec3(0, 0, -2));
  const auto source = open_dicom(path("series"), cache_bytes);
  LabelVolume turned = volume_;
  turned.labels.clear();
  for (int z = size[2]; z-- > 0;)
    for (const MaterialTag label : box_of(volume_, {0, 0, z}, {size[0], size[1], z + 1}))
      turned.labels.push_back(label);
  expect_labels(*source, turned);
  EXPECT_NEAR((source->grid().directions.col(2) - Vec3(0, 0, 2)).norm(), 0, 1e-9);
  EXPECT_NEAR((source->grid().origin - Vec3(0, 0, -12)).norm(), 0, 1e-9);
}

TEST_F(Dicom, TransferSyntaxesAndTypes) {
  for (const std::string syntax : {"1.2.840.10008.1.2", "1.2.840.10008.1.2.1", "1.2.840.10008.1.2.2"})
    for (const int bits : {8, 16, 32})
      for (const bool is_signed : {false, true}) {
        // An even number of bytes, so that bytes of big-endian words stay within their slice.
        write(volume_, {.transfer_syntax = syntax, .bits = bits, .is_signed = is_signed}, Vec3(0, 0, 1));
        expect_labels(*open_dicom(path("series"), cache_bytes), volume_);
      }
}

TEST_F(Dicom, BitsThatAreNotStoredAreNotRead) {
  const DicomToWrite slice{.columns = 2, .rows = 1, .stored = 12, .is_signed = true};
  std::filesystem::create_directories(path("series"));
  for (int z = 0; z < 2; ++z) {
    DicomToWrite placed = slice;
    placed.position[2] = z;
    put(path(name(z)), dicom_file(placed, dicom_pixels<std::uint16_t>({0xfffe, 0xf7ff}, placed)));
  }
  EXPECT_EQ(read_label_volume(path("series")).labels, (std::vector<MaterialTag>{-2, 2047, -2, 2047}));
  for (int z = 0; z < 2; ++z) {
    DicomToWrite placed = slice;
    placed.position[2] = z;
    placed.high = 15;
    put(path(name(z)), dicom_file(placed, dicom_pixels<std::uint16_t>({0xffef, 0x7ff0}, placed)));
  }
  EXPECT_EQ(read_label_volume(path("series")).labels, (std::vector<MaterialTag>{-2, 2047, -2, 2047}));
}

TEST_F(Dicom, SlopeAndInterceptOfEachSlice) {
  write(volume_, {.rescale_slope = "2", .rescale_intercept = "-1024"}, Vec3(0, 0, 1));
  ImageVolume image = read_image(path("series"));
  ASSERT_EQ(image.channels.size(), 1u);
  for (std::size_t i = 0; i < volume_.labels.size(); ++i)
    ASSERT_EQ(image.channels[0][i], static_cast<float>(2 * volume_.labels[i] - 1024));
  write(volume_, {}, Vec3(0, 0, 1), [](int z, DicomToWrite& slice) {
    slice.rescale_slope = std::to_string(0.5 + z);
    slice.rescale_intercept = std::to_string(-z);
    slice.is_signed = z % 2 == 0;
  });
  image = read_image(path("series"));
  for (std::size_t i = 0; i < volume_.labels.size(); ++i) {
    const int z = static_cast<int>(i) / (size[0] * size[1]);
    ASSERT_EQ(image.channels[0][i], static_cast<float>((0.5 + z) * volume_.labels[i] - z));
  }
  write(volume_, {.rescale_slope = "0"}, Vec3(0, 0, 1));
  expect_refused("RescaleSlope is 0");
}

TEST_F(Dicom, TiltedGantriesMakeSkewedGrids) {
  write(volume_, {}, Vec3(0, 0.3, 1.5));
  const auto source = open_dicom(path("series"), cache_bytes);
  expect_labels(*source, volume_);
  EXPECT_NEAR((source->grid().directions.col(2) - Vec3(0, 0.3, 1.5)).norm(), 0, 1e-6);
  write(volume_, {}, Vec3(0, 0, 1.5), [](int z, DicomToWrite& slice) { slice.position[1] = 0.1 * z * z; });
  expect_refused("positions must be on a line");
}

TEST_F(Dicom, MissingAndDoubledSlicesAreNamed) {
  write(volume_, {}, Vec3(0, 0, 1.5));
  const std::string third = get(path(name(3)));
  std::filesystem::remove(path(name(3)));
  expect_refused(
      "the distance between IM3 and IM6 is 3, and between most other slices 1.5; slices are missing");
  put(path(name(3)), third);
  put(path("series/copy.dcm"), third);
  expect_refused("IM1 and copy.dcm are at one position, (0, 0, 4.5)");
  expect_refused("8 slices at 7 positions");
  std::filesystem::remove(path("series/copy.dcm"));
  write(volume_, {}, Vec3(0, 0, 1.5),
        [](int z, DicomToWrite& slice) { slice.position[2] += z > 4 ? 0.1 : 0; });
  expect_refused("slices must have equal distances");
  write(volume_, {}, Vec3(0, 0, 1.5),
        [](int z, DicomToWrite& slice) { slice.position[2] += z > 4 ? 0.01 : 0; });
  EXPECT_EQ(read_label_volume(path("series")).labels, volume_.labels);
}

TEST_F(Dicom, SeveralSeriesAreListed) {
  write(volume_, {}, Vec3(0, 0, 1.5), [](int z, DicomToWrite& slice) {
    if (z > 1) return;
    slice.series = "1.2.4";
    slice.description = "soft";
  });
  expect_refused(
      "it has 2 series: \"bone\" \"1.2.3\" with 5 slices, the first IM1; \"soft\" \"1.2.4\" with 2 slices, "
      "the "
      "first IM0");
}

TEST_F(Dicom, SlicesThatDifferAreRefused) {
  const auto refused = [&](const std::function<void(DicomToWrite&)>& change, const std::string& expected) {
    write(volume_, {}, Vec3(0, 0, 1.5), [&](int z, DicomToWrite& slice) {
      if (z == 2) change(slice);
    });
    expect_refused("IM3: " + expected);
  };
  refused([](DicomToWrite& s) { s.rows = 3; }, "it has 5 x 3 pixels, and IM0 5 x 4");
  refused([](DicomToWrite& s) { std::swap(s.along_row, s.along_column); }, "its rows point along (0, 1, 0)");
  refused([](DicomToWrite& s) { s.pixel_spacing = "0.5\\0.3"; }, "its pixels are 0.3 x 0.5");
  refused([](DicomToWrite& s) { s.pixel_spacing = ""; }, "its pixels are of unknown size");
  refused([](DicomToWrite& s) { s.pixel_spacing = "0.5\\x"; }, "PixelSpacing is \"0.5\\x\"");
  refused([](DicomToWrite& s) { s.pixel_spacing = "0\\1"; }, "PixelSpacing is 0 and 1");
  refused([](DicomToWrite& s) { s.placed = false; }, "its rows point along");
  refused([](DicomToWrite& s) { s.others[0x00200032] = ""; }, "it has no ImagePositionPatient");
  refused([](DicomToWrite& s) { s.along_row *= 2; }, "ImageOrientationPatient has the direction (2, 0, 0)");
  refused(
      [](DicomToWrite& s) {
        s.photometric = "RGB";
        s.samples = 3;
      },
      "it is a colour image (PhotometricInterpretation \"RGB\", 3 samples");
  refused([](DicomToWrite& s) { s.photometric = "PALETTE COLOR"; }, "it is a colour image");
  refused([](DicomToWrite& s) { s.without_pixels = true; }, "it is an image without PixelData");
  refused([](DicomToWrite& s) { s.rows = 40; }, "its pixels need 400 bytes, and PixelData has 40");
  refused([](DicomToWrite& s) { s.rows = 0; }, "Columns is 5 and Rows 0");
  refused([](DicomToWrite& s) { s.stored = 17; }, "BitsStored is 17");
  refused([](DicomToWrite& s) { s.transfer_syntax = "1.2.840.10008.1.2.1.99"; },
          "its whole content is deflated");
  refused(
      [](DicomToWrite& s) {
        s.sequences[0x00283000] = {"", ""};
      },
      "its values are given by a table (ModalityLUTSequence)");
}

TEST_F(Dicom, OtherFilesAreNamed) {
  write(volume_, {}, Vec3(0, 0, 1.5));
  put(path("series/notes.txt"), "no slice");
  put(path("series/.hidden"), "no slice");
  std::filesystem::create_directory(path("series/folder"));
  DicomEncoder encoder("1.2.840.10008.1.2.1");
  put(path("series/report"), std::string(128, '\0') + "DICM" +
                                 encoder.element(0x00020010, "UI", "1.2.840.10008.1.2.1") +
                                 encoder.element(0x0020000e, "UI", "1.2.9"));
  const auto source = open_dicom(path("series"), cache_bytes);
  EXPECT_EQ(source->grid().ignored_files, (std::vector<std::string>{"notes.txt", "report"}));
  EXPECT_EQ(source->grid().size, size);
  // A slice that lost its beginning is not one of these.
  put(path("series/IM9.dcm"), "");
  expect_refused("IM9.dcm: it is no DICOM file");
  std::filesystem::create_directory(path("reports"));
  put(path("reports/report"), get(path("series/report")));
  EXPECT_NE(error_of<InputError>([&] { (void)read_image(path("reports")); }).find("have no pixels"),
            std::string::npos);
}

TEST_F(Dicom, FramesOfOneFile) {
  std::string pixels;
  for (int z = 0; z < size[2]; ++z) pixels += Dicom::pixels(volume_, z, {});
  DicomToWrite file{.columns = size[0], .rows = size[1], .frames = size[2], .position = Vec3(1, 2, 3)};
  put(path("a.dcm"), dicom_file(file, pixels));
  EXPECT_TRUE(open_dicom(path("a.dcm"), cache_bytes)->grid().spacing_assumed);
  file.others[0x00180088] = "1.25";
  put(path("a"), dicom_file(file, pixels));
  EXPECT_EQ(file_kind(path("a")), FileKind::volume);
  auto source = open_dicom(path("a"), cache_bytes);
  expect_labels(*source, volume_);
  EXPECT_NEAR((source->grid().origin - Vec3(1, 2, 3)).norm(), 0, 1e-9);
  EXPECT_EQ(Vec3(source->grid().directions.diagonal()), Vec3(0.25, 0.5, 1.25));
  // Functional groups have the attributes of each frame, here in the opposite order.
  const DicomEncoder encoder(file.transfer_syntax);
  const std::string orientation =
      encoder.sequence(0x00209116, {encoder.element(0x00200037, "DS", "1\\0\\0\\0\\1\\0")}, false);
  const std::string measures =
      encoder.sequence(0x00289110, {encoder.element(0x00280030, "DS", "2\\3")}, true);
  file.sequences[0x52009229] = {orientation + measures};
  std::string backwards;
  for (int z = size[2]; z-- > 0;) {
    backwards += Dicom::pixels(volume_, z, {});
    file.sequences[0x52009230].push_back(encoder.sequence(
        0x00209113, {encoder.element(0x00200032, "DS", "0\\0\\" + std::to_string(4 * z))}, false));
  }
  put(path("a.dcm"), dicom_file(file, backwards));
  source = open_dicom(path("a.dcm"), cache_bytes);
  expect_labels(*source, volume_);
  EXPECT_EQ(Vec3(source->grid().directions.diagonal()), Vec3(3, 2, 4));
  file.frames = 1;
  put(path("a.dcm"), dicom_file(file, backwards));
  EXPECT_NE(error_of<InputError>([&] { (void)read_image(path("a.dcm")); }).find("it is one slice alone"),
            std::string::npos);
}

TEST_F(Dicom, TruncatedAndDamagedFilesAreRefused) {
  write(volume_, {}, Vec3(0, 0, 1.5));
  const std::string bytes = get(path(name(3)));
  Random random(11);
  for (std::size_t left = 0; left < bytes.size(); left += 1 + random.below(8)) {
    put(path(name(3)), bytes.substr(0, left));
    std::string text;
    try {
      const LabelVolume read = read_label_volume(path("series"));
      EXPECT_LT(left, 132u);  // no DICOM file, and the slices at its sides are too far from each other
    } catch (const InputError& error) {
      text = error.what();
    }
    EXPECT_NE(text.find(left < 132 ? "slices are missing" : "IM1: "), std::string::npos) << left << text;
  }
  for (int i = 0; i < 300; ++i) {
    std::string damaged = bytes;
    for (std::uint32_t n = 0; n <= random.below(3); ++n)
      damaged[132 + random.below(static_cast<std::uint32_t>(damaged.size() - 132))] =
          static_cast<char>(random.below(256));
    put(path(name(3)), damaged);
    try {
      (void)read_label_volume(path("series"));
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace tetwright::dicom_test
