// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/tiff_stack.h"

#include <tiffio.h>

#include <filesystem>

#include "tests/common/io/file_test.h"
#include "tests/common/io/volume_boxes.h"
#include "tetwright/io.h"

namespace tetwright::tiff_stack_test {
namespace {

using TiffStacks = FileTest;

constexpr std::size_t cache_bytes = 1 << 12;
const VoxelIndex size{37, 29, 11};

/// How pages are stored.
struct Stored {
  const char* mode = "w";  ///< "wb": big-endian, "w8": BigTIFF
  int compression = COMPRESSION_NONE;
  std::uint32_t strip_rows = 7;
  std::uint32_t tile = 0;  ///< side of tiles, a multiple of 16; 0: strips
  int predictor = PREDICTOR_NONE;
  std::string description = {};
  float resolution = 0;
  int resolution_unit = RESUNIT_NONE;
};

template <class Number>
void write_page(TIFF* file, const LabelVolume& volume, int z, const Stored& stored) {
  const int format = std::is_floating_point_v<Number> ? SAMPLEFORMAT_IEEEFP
                     : std::is_signed_v<Number>       ? SAMPLEFORMAT_INT
                                                      : SAMPLEFORMAT_UINT;
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, volume.size[0]);
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, volume.size[1]);
  TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * sizeof(Number)));
  TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, format);
  TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(file, TIFFTAG_COMPRESSION, stored.compression);
  if (stored.predictor != PREDICTOR_NONE) TIFFSetField(file, TIFFTAG_PREDICTOR, stored.predictor);
  if (z == 0 && !stored.description.empty())
    TIFFSetField(file, TIFFTAG_IMAGEDESCRIPTION, stored.description.c_str());
  if (stored.resolution > 0) {
    TIFFSetField(file, TIFFTAG_XRESOLUTION, static_cast<double>(stored.resolution));
    TIFFSetField(file, TIFFTAG_YRESOLUTION, static_cast<double>(2 * stored.resolution));
    TIFFSetField(file, TIFFTAG_RESOLUTIONUNIT, stored.resolution_unit);
  }
  const auto number = [&](int x, int y) {
    const bool inside = x < volume.size[0] && y < volume.size[1];
    return static_cast<Number>(
        inside ? volume.labels[static_cast<std::size_t>((z * volume.size[1] + y) * volume.size[0] + x)] : 99);
  };
  if (stored.tile > 0) {
    const int side = static_cast<int>(stored.tile);
    TIFFSetField(file, TIFFTAG_TILEWIDTH, stored.tile);
    TIFFSetField(file, TIFFTAG_TILELENGTH, stored.tile);
    std::uint32_t tile = 0;
    for (int y = 0; y < volume.size[1]; y += side)
      for (int x = 0; x < volume.size[0]; x += side) {
        std::vector<Number> numbers;
        for (int j = y; j < y + side; ++j)
          for (int i = x; i < x + side; ++i) numbers.push_back(number(i, j));
        TIFFWriteEncodedTile(file, tile++, numbers.data(),
                             static_cast<tmsize_t>(numbers.size() * sizeof(Number)));
      }
  } else {
    TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, stored.strip_rows);
    for (int y = 0; y < volume.size[1]; ++y) {
      std::vector<Number> row;
      for (int x = 0; x < volume.size[0]; ++x) row.push_back(number(x, y));
      TIFFWriteScanline(file, row.data(), static_cast<std::uint32_t>(y));
    }
  }
  TIFFWriteDirectory(file);
}

template <class Number>
void write_stack(const std::string& path, const LabelVolume& volume, const Stored& stored = {}) {
  TIFF* file = TIFFOpen(path.c_str(), stored.mode);
  ASSERT_NE(file, nullptr);
  for (int z = 0; z < volume.size[2]; ++z) write_page<Number>(file, volume, z, stored);
  TIFFClose(file);
}

LabelVolume slice_of(const LabelVolume& volume, int z) {
  LabelVolume slice;
  slice.size = {volume.size[0], volume.size[1], 1};
  slice.labels = box_of(volume, {0, 0, z}, {volume.size[0], volume.size[1], z + 1});
  return slice;
}

TEST_F(TiffStacks, AllTypesByteOrdersAndBigTiff) {
  const LabelVolume volume = numbered_volume(size);
  for (const char* mode : {"wl", "wb", "w8"}) {
    const Stored stored{.mode = mode};
    const auto check = [&]<class Number>(Number /*zero*/) {
      write_stack<Number>(path("a.tif"), volume, stored);
      expect_labels(*open_tiff_stack(path("a.tif"), cache_bytes), volume);
    };
    check(std::uint8_t{});
    check(std::int8_t{});
    check(std::uint16_t{});
    check(std::int16_t{});
    check(std::uint32_t{});
    check(std::int32_t{});
    check(std::uint64_t{});
    check(float{});
    check(double{});
  }
}

TEST_F(TiffStacks, StripsTilesAndCompressions) {
  const LabelVolume volume = numbered_volume(size);
  for (const int compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS}) {
    for (const std::uint32_t rows : {1u, 7u, 29u, 1000u}) {
      write_stack<std::uint16_t>(path("a.tif"), volume, {.compression = compression, .strip_rows = rows});
      expect_labels(*open_tiff_stack(path("a.tif"), cache_bytes), volume);
    }
    write_stack<std::uint16_t>(path("a.tif"), volume, {.compression = compression, .tile = 16});
    const auto source = open_tiff_stack(path("a.tif"), cache_bytes);
    EXPECT_EQ(source->block(), (VoxelIndex{16, 16, 1}));
    expect_labels(*source, volume);
  }
  write_stack<std::uint16_t>(
      path("a.tif"), volume,
      {.mode = "wb", .compression = COMPRESSION_LZW, .predictor = PREDICTOR_HORIZONTAL});
  expect_labels(*open_tiff_stack(path("a.tif"), cache_bytes), volume);
}

TEST_F(TiffStacks, LargePagesAreReadByGroupsOfStrips) {
  const LabelVolume volume = numbered_volume({1000, 900, 2});
  write_stack<std::uint8_t>(path("a.tif"), volume, {.strip_rows = 13});
  const auto source = open_tiff_stack(path("a.tif"), cache_bytes);
  EXPECT_EQ(source->block(), (VoxelIndex{1000, 260, 1}));
  expect_labels(*source, volume);
}

TEST_F(TiffStacks, FoldersInNaturalOrder) {
  const LabelVolume volume = numbered_volume(size);
  std::filesystem::create_directory(path("slices"));
  for (int z = 0; z < size[2]; ++z) {
    // Strips of other pages may have another height.
    const Stored stored{.strip_rows = static_cast<std::uint32_t>(3 + z)};
    write_stack<std::uint8_t>(path("slices/slice_" + std::to_string(z) + (z % 2 ? ".tif" : ".TIFF")),
                              slice_of(volume, z), stored);
  }
  put(path("slices/notes.txt"), "not an image");
  EXPECT_EQ(file_kind(path("slices")), FileKind::volume);
  expect_labels(*open_label_source(path("slices")), volume);
  EXPECT_EQ(read_label_volume(path("slices")).labels, volume.labels);
  write_stack<std::uint8_t>(path("slices/slice_5.tif"), numbered_volume(size));
  std::string message = error_of<InputError>([&] { (void)open_label_source(path("slices")); });
  EXPECT_NE(message.find("slice_5.tif: it has several pages"), std::string::npos) << message;
  write_stack<std::uint8_t>(path("slices/slice_5.tif"), numbered_volume({36, 29, 1}));
  message = error_of<InputError>([&] { (void)open_label_source(path("slices")); });
  EXPECT_NE(message.find("slice_5.tif: it has 36 x 29 pixels, and the first page 37 x 29"), std::string::npos)
      << message;
  std::filesystem::create_directory(path("none"));
  EXPECT_EQ(file_kind(path("none")), FileKind::unknown);
}

TEST_F(TiffStacks, NaturalOrderOfNames) {
  std::vector<std::string> names{"slice_10",
                                 "slice_2",
                                 "slice_02",
                                 "Slice_3",
                                 "slice_9b",
                                 "slice",
                                 "slice_2a3",
                                 "slice_2a12",
                                 "1000000000000000000000",
                                 "999999999999999999999",
                                 ""};
  std::sort(names.begin(), names.end(), natural_less);
  EXPECT_EQ(names, (std::vector<std::string>{"", "999999999999999999999", "1000000000000000000000", "Slice_3",
                                             "slice", "slice_02", "slice_2", "slice_2a3", "slice_2a12",
                                             "slice_9b", "slice_10"}));
}

TEST_F(TiffStacks, SpacingFromDescriptions) {
  const LabelVolume volume = numbered_volume({4, 3, 2});
  const auto spacing = [&](const Stored& stored) {
    write_stack<std::uint8_t>(path("a.tif"), volume, stored);
    return Vec3(open_tiff_stack(path("a.tif"), cache_bytes)->grid().directions.diagonal());
  };
  EXPECT_EQ(spacing({}), Vec3(1, 1, 1));
  EXPECT_TRUE(open_tiff_stack(path("a.tif"), cache_bytes)->grid().spacing_assumed);
  EXPECT_EQ(spacing({.resolution = 1}), Vec3(1, 1, 1));
  EXPECT_EQ(spacing({.resolution = 4}), Vec3(0.25, 0.125, 0.25));
  EXPECT_EQ(spacing({.resolution = 4, .resolution_unit = RESUNIT_CENTIMETER}), Vec3(2.5, 1.25, 2.5));
  EXPECT_EQ(spacing({.resolution = 4, .resolution_unit = RESUNIT_INCH}), Vec3(6.35, 3.175, 6.35));
  EXPECT_EQ(spacing({.description = "ImageJ=1.53t\nimages=2\nslices=2\nunit=micron\nspacing=3.5\n",
                     .resolution = 4}),
            Vec3(0.25, 0.125, 3.5));
  EXPECT_EQ(spacing({.description = "ImageJ=1.53t\nimages=2\nunit=micron\n", .resolution = 4}),
            Vec3(0.25, 0.125, 1));
  EXPECT_FALSE(open_tiff_stack(path("a.tif"), cache_bytes)->grid().spacing_assumed);
  const std::string ome =
      "<?xml version=\"1.0\"?><OME><Image><Pixels SizeC=\"1\" SizeT=\"1\" PhysicalSizeX=\"0.5\" "
      "PhysicalSizeY=\"0.75\" PhysicalSizeZ=\"2\"/></Image></OME>";
  EXPECT_EQ(spacing({.description = ome}), Vec3(0.5, 0.75, 2));
  const auto refused = [&](const std::string& description, const std::string& expected) {
    const std::string message = error_of<InputError>([&] { (void)spacing({.description = description}); });
    EXPECT_NE(message.find(expected), std::string::npos) << message;
  };
  refused("ImageJ=1.53t\nimages=2\nchannels=2\n", "2 channels");
  refused("ImageJ=1.53t\nimages=2\nframes=2\n", "2 times");
  refused(replaced(ome, "SizeC=\"1\"", "SizeC=\"3\""), "3 channels");
  refused(replaced(ome, "PhysicalSizeX", "PhysicalSizeXUnit=\"nm\" PhysicalSizeX"), "different units");
}

/// A TIFF file of one page of 16 bits, whose voxels are those of all pages.
std::string one_entry(const LabelVolume& volume, const std::string& description, bool big) {
  constexpr std::uint32_t header_bytes = 8, entry_bytes = 12;
  const std::vector<std::array<std::uint32_t, 3>> fields{
      {TIFFTAG_IMAGEWIDTH, 1, static_cast<std::uint32_t>(volume.size[0])},
      {TIFFTAG_IMAGELENGTH, 1, static_cast<std::uint32_t>(volume.size[1])},
      {TIFFTAG_BITSPERSAMPLE, 1, 16},
      {TIFFTAG_COMPRESSION, 1, COMPRESSION_NONE},
      {TIFFTAG_PHOTOMETRIC, 1, PHOTOMETRIC_MINISBLACK},
      {TIFFTAG_IMAGEDESCRIPTION, static_cast<std::uint32_t>(description.size()), 0},
      {TIFFTAG_STRIPOFFSETS, 1, 0},
      {TIFFTAG_SAMPLESPERPIXEL, 1, 1},
      {TIFFTAG_ROWSPERSTRIP, 1, static_cast<std::uint32_t>(volume.size[1])},
      {TIFFTAG_STRIPBYTECOUNTS, 1, static_cast<std::uint32_t>(2 * volume.size[0] * volume.size[1])}};
  const auto text_at = static_cast<std::uint32_t>(header_bytes + 2 + entry_bytes * fields.size() + 4);
  std::string bytes = big ? "MM" : "II";
  bytes += bytes_of<std::uint16_t>({42}, big) + bytes_of<std::uint32_t>({header_bytes}, big);
  bytes += bytes_of<std::uint16_t>({static_cast<std::uint16_t>(fields.size())}, big);
  for (const auto& [tag, count, value] : fields) {
    const bool text = tag == TIFFTAG_IMAGEDESCRIPTION;
    const std::uint32_t offset = text ? text_at
                                 : tag == TIFFTAG_STRIPOFFSETS
                                     ? text_at + static_cast<std::uint32_t>(description.size())
                                     : value;
    bytes += bytes_of<std::uint16_t>(
        {static_cast<std::uint16_t>(tag), static_cast<std::uint16_t>(text ? TIFF_ASCII : TIFF_LONG)}, big);
    bytes += bytes_of<std::uint32_t>({count, offset}, big);
  }
  bytes += bytes_of<std::uint32_t>({0}, big) + description;
  return bytes + bytes_of(std::vector<std::uint16_t>(volume.labels.begin(), volume.labels.end()), big);
}

TEST_F(TiffStacks, StacksOfImageJWithOneEntry) {
  const LabelVolume volume = numbered_volume(size);
  for (const bool big : {false, true}) {
    const std::string bytes =
        one_entry(volume, std::string("ImageJ=1.53t\nimages=11\nslices=11\n\0", 34), big);
    put(path("a.tif"), bytes);
    expect_labels(*open_tiff_stack(path("a.tif"), cache_bytes), volume);
    put(path("a.tif"), bytes.substr(0, bytes.size() - 1));
    EXPECT_NE(
        error_of<InputError>([&] { (void)open_tiff_stack(path("a.tif"), cache_bytes); }).find("truncated"),
        std::string::npos);
  }
}

TEST_F(TiffStacks, ChannelsOfStacksOfImageJWithOneEntry) {
  const LabelVolume pages = numbered_volume({37, 29, 10});
  put(path("a.tif"), one_entry(pages, std::string("ImageJ=1.53t\nimages=10\nchannels=2\n\0", 35), false));
  const ImageVolume image = read_image(path("a.tif"));
  ASSERT_EQ(image.size, (VoxelIndex{37, 29, 5}));
  ASSERT_EQ(image.channels.size(), 2u);
  for (int page = 0; page < 10; ++page) {
    const std::vector<MaterialTag> expected = slice_of(pages, page).labels;
    const auto begin = image.channels[static_cast<std::size_t>(page % 2)].begin() + page / 2 * 37 * 29;
    EXPECT_EQ(std::vector<MaterialTag>(begin, begin + 37 * 29), expected) << page;
  }
}

TEST_F(TiffStacks, PagesCutFromStacksOfImageJAreReadAlone) {
  const LabelVolume page = slice_of(numbered_volume(size), 0);
  put(path("a.tif"), one_entry(page, std::string("ImageJ=1.53t\nimages=50\nslices=50\n\0", 34), false));
  expect_labels(*open_tiff_stack(path("a.tif"), cache_bytes), page);
  // Here the entry and the description follow the voxels.
  write_stack<std::uint8_t>(path("a.tif"), page, {.description = "ImageJ=1.53t\nimages=50\n"});
  expect_labels(*open_tiff_stack(path("a.tif"), cache_bytes), page);
  // They are longer than all images that the description promises.
  const LabelVolume small = numbered_volume({4, 3, 1});
  write_stack<std::uint8_t>(path("a.tif"), small, {.description = "ImageJ=1.53t\nimages=2\n"});
  expect_labels(*open_tiff_stack(path("a.tif"), cache_bytes), small);
}

TEST_F(TiffStacks, StacksOfImageJWhoseBytesOverflowAreRefused) {
  // 2^31 - 1 images of 2^29 voxels; the file has two of them, as a hole.
  LabelVolume page;
  page.size = {1 << 15, 1 << 14, 1};
  put(path("a.tif"), one_entry(page, std::string("ImageJ=1.53t\nimages=2147483647\n\0", 33), false));
  std::filesystem::resize_file(path("a.tif"), std::uintmax_t{1} << 32);
  const std::string message =
      error_of<InputError>([&] { (void)open_tiff_stack(path("a.tif"), cache_bytes); });
  EXPECT_NE(message.find("makes more than 576460752303423488 voxels"), std::string::npos) << message;
}

TEST_F(TiffStacks, PagesThatAreNoLabelsAreNamed) {
  const LabelVolume volume = numbered_volume({4, 3, 3});
  const auto message = [&] {
    return error_of<InputError>(
        [&] { (void)read_all(*open_tiff_stack(path("a.tif"), cache_bytes), "a.tif"); });
  };
  const auto second_page = [&](const auto& change) {
    TIFF* file = TIFFOpen(path("a.tif").c_str(), "w");
    write_page<std::uint8_t>(file, volume, 0, {});
    change(file);
    TIFFClose(file);
  };
  second_page([&](TIFF* file) { write_page<std::uint8_t>(file, numbered_volume({5, 3, 1}), 0, {}); });
  EXPECT_NE(message().find("a.tif: page 2: it has 5 x 3 pixels"), std::string::npos) << message();
  second_page([&](TIFF* file) { write_page<std::uint16_t>(file, volume, 1, {}); });
  EXPECT_NE(message().find("a.tif: page 2: its samples have another type"), std::string::npos) << message();
  second_page([&](TIFF* file) { write_page<std::uint8_t>(file, volume, 1, {.tile = 16}); });
  EXPECT_NE(message().find("a.tif: page 2: its tiles"), std::string::npos) << message();
  TIFF* file = TIFFOpen(path("a.tif").c_str(), "w");
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, 2);
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, 1);
  TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 3);
  TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  std::string pixels = "123456";
  TIFFWriteScanline(file, pixels.data(), 0);
  TIFFClose(file);
  EXPECT_NE(message().find("a.tif: page 1: it has 3 samples for each pixel"), std::string::npos) << message();
  LabelVolume large = volume;
  large.labels[13] = -5;
  write_stack<std::int32_t>(path("a.tif"), large);
  EXPECT_EQ(read_all(*open_tiff_stack(path("a.tif"), cache_bytes), "a.tif").labels, large.labels);
  write_stack<std::uint64_t>(path("a.tif"), large);
  EXPECT_NE(message().find("a.tif: page 2: voxel (1, 0, 1) has the value 18446744073709551611"),
            std::string::npos)
      << message();
}

TEST_F(TiffStacks, DamagedFilesAreRefused) {
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
    write_stack<std::uint16_t>(path("a.tif"), numbered_volume(size), {.compression = compression});
    const std::string bytes = get(path("a.tif"));
    const auto read = [&] { (void)read_all(*open_tiff_stack(path("a.tif"), cache_bytes), "a.tif"); };
    for (const std::size_t left : {std::size_t{0}, std::size_t{3}, std::size_t{8}, bytes.size() / 2}) {
      put(path("a.tif"), bytes.substr(0, left));
      EXPECT_NE(error_of<InputError>(read).find("a.tif"), std::string::npos);
    }
    Random random(7);
    for (int i = 0; i < 300; ++i) {
      std::string damaged = bytes;
      for (std::uint32_t n = 0; n <= random.below(4); ++n)
        damaged[random.below(static_cast<std::uint32_t>(damaged.size()))] =
            static_cast<char>(random.below(256));
      put(path("a.tif"), damaged);
      try {
        read();
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("a.tif"), std::string::npos) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace tetwright::tiff_stack_test
