// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/raw_volume.h"

#include <cstring>
#include <fstream>
#include <optional>

#include "tests/common/io/file_test.h"
#include "tests/common/io/volume_boxes.h"
#include "tetwright/io.h"

namespace tetwright::raw_volume_test {
namespace {

using RawVolumes = FileTest;

const VoxelIndex size{19, 13, 11};

template <class Number>
std::string voxels(bool big = false) {
  std::vector<Number> numbers;
  for (const MaterialTag label : numbered_volume(size).labels) numbers.push_back(static_cast<Number>(label));
  return bytes_of(numbers, big);
}

std::string nrrd_header(const std::string& type, const std::string& rest) {
  return "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: 19 13 11\nspacings: 1 2 3\nencoding: raw\n" +
         rest + "\n";
}

template <class Number>
void expect_nrrd(const std::string& file, const std::string& type) {
  for (const bool big : {false, true}) {
    put(file, nrrd_header(type, big ? "endian: big\n" : "endian: little\n") + voxels<Number>(big));
    const auto source = open_label_source(file);
    EXPECT_FALSE(source->in_memory());
    EXPECT_EQ(source->grid().directions(2, 2), 3);
    expect_labels(*source, numbered_volume(size));
  }
}

TEST_F(RawVolumes, NrrdOfAllTypesAndByteOrders) {
  expect_nrrd<std::int8_t>(path("a.nrrd"), "int8");
  expect_nrrd<std::uint8_t>(path("a.nrrd"), "uchar");
  expect_nrrd<std::int16_t>(path("a.nrrd"), "short");
  expect_nrrd<std::uint16_t>(path("a.nrrd"), "ushort");
  expect_nrrd<std::int32_t>(path("a.nrrd"), "int");
  expect_nrrd<std::uint32_t>(path("a.nrrd"), "uint");
  expect_nrrd<std::int64_t>(path("a.nrrd"), "int64");
  expect_nrrd<std::uint64_t>(path("a.nrrd"), "uint64");
  expect_nrrd<float>(path("a.nrrd"), "float");
  expect_nrrd<double>(path("a.nrrd"), "double");
}

TEST_F(RawVolumes, NrrdWithSkippedBytesAndInAnotherFile) {
  const std::string bytes = voxels<std::uint8_t>();
  put(path("a.nrrd"), nrrd_header("uchar", "byte skip: 7\n") + "1234567" + bytes);
  expect_labels(*open_label_source(path("a.nrrd")), numbered_volume(size));
  put(path("a.nrrd"), nrrd_header("uchar", "byte skip: -1\n") + "some bytes" + bytes);
  expect_labels(*open_label_source(path("a.nrrd")), numbered_volume(size));
  put(path("a.nhdr"), nrrd_header("uchar", "data file: a.raw\nbyteskip: 3\n"));
  put(path("a.raw"), "123" + bytes);
  expect_labels(*open_label_source(path("a.nhdr")), numbered_volume(size));
  put(path("a.nrrd"), nrrd_header("uchar", "byte skip: 70000\n") + bytes);
  EXPECT_NE(
      error_of<InputError>([&] { (void)open_label_source(path("a.nrrd")); }).find("70000 bytes to skip, but"),
      std::string::npos);
}

TEST_F(RawVolumes, MetaImage) {
  const std::string header =
      "NDims = 3\nDimSize = 19 13 11\nElementSpacing = 1 2 3\nBinaryDataByteOrderMSB = True\nElementType = "
      "MET_SHORT\nElementDataFile = ";
  const std::string bytes = voxels<std::int16_t>(true);
  put(path("a.mha"), header + "LOCAL\n" + bytes);
  put(path("a.mhd"), "HeaderSize = -1\n" + header + "a.raw\n");
  put(path("a.raw"), "some bytes" + bytes);
  for (const char* name : {"a.mha", "a.mhd"}) {
    const auto source = open_label_source(path(name));
    EXPECT_FALSE(source->in_memory());
    expect_labels(*source, numbered_volume(size));
  }
  put(path("a.mhd"), "HeaderSize = 99999\n" + header + "a.raw\n");
  EXPECT_NE(error_of<InputError>([&] { (void)open_label_source(path("a.mhd")); }).find("99999 bytes to skip"),
            std::string::npos);
}

std::string nifti_header(const char* magic) {
  std::string header(352, '\0');
  const auto set = [&](std::size_t at, auto value) { std::memcpy(header.data() + at, &value, sizeof value); };
  set(0, std::int32_t{348});
  for (const auto& [at, n] : {std::pair{40u, 3}, {42u, 19}, {44u, 13}, {46u, 11}, {48u, 1}})
    set(at, static_cast<std::int16_t>(n));
  set(70, std::int16_t{512});
  for (const unsigned at : {80u, 84u, 88u}) set(at, 1.5F);
  set(344, std::array<char, 4>{magic[0], magic[1], magic[2], '\0'});
  return header;
}

TEST_F(RawVolumes, Nifti) {
  put(path("a.nii"), nifti_header("n+1") + voxels<std::uint16_t>());
  put(path("b.hdr"), nifti_header("ni1"));
  put(path("b.img"), voxels<std::uint16_t>());
  for (const char* name : {"a.nii", "b.hdr", "b.img"}) {
    const auto source = open_label_source(path(name));
    EXPECT_FALSE(source->in_memory()) << name;
    EXPECT_EQ(source->grid().directions(1, 1), 1.5);
    expect_labels(*source, numbered_volume(size));
  }
  put(path("b.img"), deflated(voxels<std::uint16_t>()));
  put(path("a.nii.gz"), deflated(nifti_header("n+1") + voxels<std::uint16_t>()));
  for (const char* name : {"a.nii.gz", "b.hdr"}) {
    const auto source = open_label_source(path(name));
    EXPECT_TRUE(source->in_memory()) << name;
    expect_labels(*source, numbered_volume(size));
  }
}

TEST_F(RawVolumes, CompressedAndTextFilesAreServedFromMemory) {
  const LabelVolume volume = numbered_volume(size);
  write_label_volume(volume, path("a.nrrd"));  // gzip
  std::string text;
  for (const MaterialTag label : volume.labels) text += std::to_string(label) + " ";
  put(path("b.nrrd"), replaced(nrrd_header("uchar", ""), "raw", "text") + text);
  put(path("c.mha"),
      "NDims = 3\nDimSize = 19 13 11\nElementType = MET_UCHAR\nCompressedData = True\n"
      "ElementDataFile = LOCAL\n" +
          deflated(voxels<std::uint8_t>(), 15));
  put(path("d.nrrd"), nrrd_header("uchar", "line skip: 1\n") + "a line\n" + voxels<std::uint8_t>());
  for (const char* name : {"a.nrrd", "b.nrrd", "c.mha", "d.nrrd"}) {
    const auto source = open_label_source(path(name));
    EXPECT_TRUE(source->in_memory()) << name;
    expect_labels(*source, volume);
  }
}

TEST_F(RawVolumes, TruncatedAndDamagedFilesAreNamed) {
  const std::string bytes = voxels<std::uint8_t>();
  put(path("a.nrrd"), nrrd_header("uchar", "") + bytes.substr(1));
  std::string message = error_of<InputError>([&] { (void)open_label_source(path("a.nrrd")); });
  EXPECT_NE(
      message.find(": its 19 x 13 x 11 voxels of 1 byte need 2717 bytes, but only 2716 follow the header"),
      std::string::npos)
      << message;
  put(path("a.nhdr"), nrrd_header("uchar", "data file: none.raw\n"));
  message = error_of<InputError>([&] { (void)open_label_source(path("a.nhdr")); });
  EXPECT_NE(message.find("line 7: the file with the voxels: cannot read"), std::string::npos) << message;
  message = error_of<InputError>([&] { (void)open_label_source(path("none.nrrd")); });
  EXPECT_NE(message.find("cannot read"), std::string::npos) << message;
  put(path("a.nrrd"), replaced(nrrd_header("uchar", ""), "19 13 11", "2147483647 2147483647 2147483647"));
  message = error_of<InputError>([&] { (void)open_label_source(path("a.nrrd")); });
  EXPECT_NE(message.find("makes more than 576460752303423488 voxels"), std::string::npos) << message;
  std::string floats = voxels<float>();
  floats.replace(4 * ((3 * 13 + 2) * 19 + 1), 4, bytes_of<float>({0.5F}));
  put(path("a.nrrd"), nrrd_header("float", "endian: little\n") + floats);
  message = error_of<InputError>([&] { (void)read_label_volume(path("a.nrrd")); });
  EXPECT_NE(message.find(": voxel (1, 2, 3) has the value 0.5, not a whole number"), std::string::npos)
      << message;
}

TEST_F(RawVolumes, SizesWhoseProductOverflowsAreRefused) {
  put(path("a.raw"), "a few bytes");
  for (const VoxelIndex& wrong : {VoxelIndex{1 << 20, 1 << 20, 1 << 24}, {1 << 20, 1 << 20, 1 << 20}}) {
    RawVolume volume{{}, path("a.raw"), 0, {}};
    volume.grid.size = wrong;
    const std::string message = error_of<InputError>([&] { (void)open_raw_volume(volume); });
    EXPECT_NE(message.find("makes more than 576460752303423488 voxels"), std::string::npos) << message;
  }
}

TEST_F(RawVolumes, FilesThatShrinkWhileTheyAreReadAreNamed) {
  put(path("a.nrrd"), nrrd_header("uchar", "") + voxels<std::uint8_t>());
  const auto source = open_label_source(path("a.nrrd"));
  put(path("a.nrrd"), nrrd_header("uchar", ""));
  const std::string message = error_of<InputError>([&] { (void)read_all(*source, "a.nrrd"); });
  EXPECT_NE(message.find("truncated while it was read"), std::string::npos) << message;
}

/// Bytes that this process has read, or std::nullopt if the system does not count them.
std::optional<std::uint64_t> bytes_read() {
  std::ifstream counts("/proc/self/io");
  std::string name;
  std::uint64_t count = 0;
  while (counts >> name >> count)
    if (name == "rchar:") return count;
  return std::nullopt;
}

TEST_F(RawVolumes, ChannelsThatAlternateAreReadOnce) {
  constexpr int side = 40, channels = 8;
  std::vector<std::uint16_t> numbers;
  for (int i = 0; i < side * side * side * channels; ++i)
    numbers.push_back(static_cast<std::uint16_t>(i % channels * 1000 + i / channels % 997));
  const std::string bytes = bytes_of(numbers, false);
  put(path("a.nrrd"),
      "NRRD0004\ntype: uint16\ndimension: 4\nsizes: 8 40 40 40\nkinds: vector domain domain "
      "domain\nencoding: raw\nendian: little\n\n" +
          bytes);
  const std::optional<std::uint64_t> before = bytes_read();
  const ImageVolume image = read_image(path("a.nrrd"));
  const std::optional<std::uint64_t> after = bytes_read();
  ASSERT_EQ(image.channels.size(), std::size_t{channels});
  for (std::size_t c = 0; c < channels; ++c)
    for (const std::size_t v : {std::size_t{0}, std::size_t{998}, std::size_t{side * side * side - 1}})
      EXPECT_EQ(image.channels[c][v], static_cast<float>(c * 1000 + v % 997));
  if (before) EXPECT_LT(*after - *before, bytes.size() + max_header_bytes + (std::size_t{1} << 16));
}

}  // namespace
}  // namespace tetwright::raw_volume_test
