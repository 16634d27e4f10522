// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/npy.h"

#include "tests/common/io/file_test.h"
#include "tests/common/io/image_values.h"
#include "tests/common/io/volume_bytes.h"
#include "tetwright/io.h"

namespace tetwright::npy_test {
namespace {

using NumpyArrays = FileTest;

std::string npy(const std::string& dictionary, const std::string& body, int version = 1) {
  std::string bytes = "\x93NUMPY" + std::string(1, static_cast<char>(version)) + std::string(1, '\0');
  const std::string header = dictionary + "\n";
  if (version == 1)
    bytes += bytes_of<std::uint16_t>({static_cast<std::uint16_t>(header.size())});
  else
    bytes += bytes_of<std::uint32_t>({static_cast<std::uint32_t>(header.size())});
  return bytes + header + body;
}

std::string array_of(const std::string& type, const std::string& shape, const std::string& body,
                     bool fortran_order = false, int version = 1) {
  return npy("{'descr': '" + type + "', 'fortran_order': " + (fortran_order ? "True" : "False") +
                 ", 'shape': " + shape + ", }",
             body, version);
}

template <class Number>
void expect_type(const std::string& code) {
  for (const bool big : {false, true})
    for (int version = 1; version <= 3; ++version) {
      const std::string order = sizeof(Number) == 1 ? "|" : big ? ">" : "<";
      const std::string bytes =
          array_of(order + code, "(4, 3, 2)", counted_voxels<Number>(big), false, version);
      const LabelVolume volume = read_label_volume_bytes(bytes, "f", ".npy");
      EXPECT_EQ(volume.size, (VoxelIndex{2, 3, 4})) << order << code;
      EXPECT_EQ(volume.labels, counted_labels()) << order << code;
      EXPECT_TRUE(volume.spacing_assumed);
    }
}

TEST(Npy, EveryTypeByteOrderAndVersion) {
  expect_type<std::int8_t>("i1");
  expect_type<std::uint8_t>("u1");
  expect_type<std::int16_t>("i2");
  expect_type<std::uint16_t>("u2");
  expect_type<std::int32_t>("i4");
  expect_type<std::uint32_t>("u4");
  expect_type<std::int64_t>("i8");
  expect_type<std::uint64_t>("u8");
  expect_type<float>("f4");
  expect_type<double>("f8");
  EXPECT_EQ(
      read_label_volume_bytes(array_of("|b1", "(1, 2, 2)", std::string("\0\1\1\0", 4)), "f", ".npy").labels,
      (std::vector<MaterialTag>{0, 1, 1, 0}));
  // 1, -2.5, 65504, the smallest number above 0 and the largest below 2^-14.
  const std::string halves = bytes_of<std::uint16_t>({0x3c00, 0xc100, 0x7bff, 0x0001, 0x03ff});
  EXPECT_EQ(read_image_bytes(array_of("<f2", "(1, 1, 5)", halves), "f", ".npy").channels.front(),
            (std::vector<float>{1, -2.5f, 65504, 0x1p-24f, 0x1.ff8p-15f}));
  expect_input_error([](std::string_view b, const char* name) { return read_image_bytes(b, name, ".npy"); },
                     array_of("<f2", "(1, 1, 2)", bytes_of<std::uint16_t>({0x7c00, 0})),
                     "voxel (0, 0, 0) has the value inf, not a finite number");
}

TEST_F(NumpyArrays, TheAxisThatVariesFastestIsX) {
  constexpr VoxelIndex size{5, 4, 3};
  const auto expect = [&](const std::string& bytes, int channels) {
    put(path("a.npy"), bytes);
    expect_image(read_image(path("a.npy")), size, channels);
    expect_image(read_image_bytes(bytes, "f", ".npy"), size, channels);
  };
  const std::string one = bytes_of(image_numbers<float>(size, 1, 3)),
                    two = bytes_of(image_numbers<double>(size, 2, 3));
  expect(array_of("<f4", "(3, 4, 5)", one), 1);
  expect(array_of("<f4", "(5, 4, 3)", one, true), 1);
  expect(array_of("<f4", "(1, 3, 4, 5)", one), 1);
  expect(array_of("<f8", "(2, 3, 4, 5)", two), 2);
  expect(array_of("<f8", "(5, 4, 3, 2)", two, true), 2);
  EXPECT_EQ(file_kind("x/A.NPY"), FileKind::volume);
  put(path("b.npy"), array_of("|u1", "(4, 3, 2)", counted_voxels<std::uint8_t>()));
  const auto source = open_label_source(path("b.npy"));
  EXPECT_FALSE(source->in_memory());
  std::vector<MaterialTag> box(2);
  source->read({0, 1, 2}, {2, 2, 3}, box);
  EXPECT_EQ(box, (std::vector<MaterialTag>{14, 15}));
}

TEST(Npy, DamagedAndOtherArraysAreRefused) {
  const auto refused = [](const std::string& bytes, const std::string& message) {
    expect_input_error(
        [](std::string_view b, const char* name) { return read_label_volume_bytes(b, name, ".npy"); }, bytes,
        message);
  };
  const std::string good = array_of("|u1", "(4, 3, 2)", counted_voxels<std::uint8_t>());
  refused("", "the file is empty");
  refused("PK\3\4", "is this a .npy file?");
  for (std::size_t n = 1; n < good.size(); ++n) refused(good.substr(0, n), "");
  refused(good.substr(0, good.size() - 1), "its 2 x 3 x 4 voxels of 1 byte need 24 bytes, but only 23");
  refused(array_of("|u1", "(4, 3, 2)", "", false, 4), "version 4 of the format is not known");
  refused(array_of("|O", "(4, 3, 2)", ""), "items of type \"|O\" are not supported");
  refused(array_of("<c8", "(4, 3, 2)", ""), "items of type \"<c8\"");
  refused(array_of("|u2", "(4, 3, 2)", ""), "items of type \"|u2\"");
  refused(npy("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (4, 3, 2), }", ""),
          "records of several fields");
  refused(npy("{'descr': '<f4', 'fortran_order': maybe, 'shape': (4, 3, 2), }", ""),
          "neither True nor False");
  refused(npy("{'descr': '<f4', 'shape': (4, 3, 2), }", ""), "lacks descr, fortran_order or shape");
  refused(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (4, -3, 2), }", ""), "not a list of sizes");
  refused(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999, 3, 2), }", ""), "");
  refused(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (4, 3, 2), 'more': 1}", ""),
          "unknown entry \"more\"");
  refused(npy("{'descr': '<f4' 'fortran_order': False", ""), "expected a comma");
  refused(array_of("|u1", "(4, 3)", ""), "2 axes; a volume of labels has 3");
  refused(array_of("|u1", "(2, 4, 3, 2)", ""), "axis 0 has 2 items, and each voxel needs one label");
  refused(array_of("|u1", "(4, 0, 2)", ""), "the size along axis 1 is 0");
  refused(array_of("|u1", "(4000000, 4000000, 4000000)", ""), "voxels");
}

}  // namespace
}  // namespace tetwright::npy_test
