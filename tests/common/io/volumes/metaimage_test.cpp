// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/metaimage.h"

#include "tests/common/io/volume_bytes.h"

namespace tetwright::metaimage_test {
namespace {

const std::string head =
    "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 2 3 4\nElementType = MET_UCHAR\n";
const std::string body = counted_voxels<std::uint8_t>();

std::string with(const std::string& line) { return head + line + "\nElementDataFile = LOCAL\n" + body; }

LabelVolume read(const std::string& bytes) { return read_metaimage(bytes, "f"); }

void expect_refused(const std::string& bytes, const std::string& first, const std::string& second = "") {
  expect_input_error([](std::string_view b, const char* name) { return read_metaimage(b, name); }, bytes,
                     first, second);
}

template <class Number>
void expect_type(const std::string& type) {
  for (const bool big : {false, true})
    for (const char* order : {"ElementByteOrderMSB", "BinaryDataByteOrderMSB"})
      EXPECT_EQ(read(replaced(head, "MET_UCHAR", type) + order + " = " + (big ? "True" : "False") +
                     "\nElementDataFile = LOCAL\n" + counted_voxels<Number>(big))
                    .labels,
                counted_labels())
          << type;
}

TEST(MetaImage, EveryTypeInBothByteOrders) {
  expect_type<std::int8_t>("MET_CHAR");
  expect_type<std::uint8_t>("MET_UCHAR");
  expect_type<std::int16_t>("MET_SHORT");
  expect_type<std::uint16_t>("MET_USHORT");
  expect_type<std::int32_t>("MET_INT");
  expect_type<std::uint32_t>("MET_UINT");
  expect_type<std::int32_t>("MET_LONG");
  expect_type<std::uint32_t>("MET_ULONG");
  expect_type<std::int64_t>("MET_LONG_LONG");
  expect_type<std::uint64_t>("MET_ULONG_LONG");
  expect_type<float>("MET_FLOAT");
  expect_type<double>("MET_DOUBLE");
}

TEST(MetaImage, Encodings) {
  EXPECT_EQ(read(head + "CompressedData = True\nElementDataFile = LOCAL\n" + deflated(body, 15)).labels,
            counted_labels());
  std::string text;
  for (int i = 0; i < 24; ++i) text += std::to_string(i) + " ";
  EXPECT_EQ(
      read(replaced(head, "BinaryData = True", "BinaryData = False") + "ElementDataFile = LOCAL\n" + text)
          .labels,
      counted_labels());
  EXPECT_EQ(read(with("HeaderSize = -1") + "").labels, counted_labels());
  const std::string skipped = head + "HeaderSize = 200\nElementDataFile = LOCAL\n";
  EXPECT_EQ(read(skipped + std::string(200 - skipped.size(), 'x') + body).labels, counted_labels());
}

TEST(MetaImage, Geometry) {
  const LabelVolume v = read(with(
      "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 1 2 3.5\nElementSpacing = 2 3 4\nElementSize = 9 9 9\n"
      "AnatomicalOrientation = RAI"));
  EXPECT_EQ(v.directions.col(0), Vec3(0, 2, 0));
  EXPECT_EQ(v.directions.col(1), Vec3(-3, 0, 0));
  EXPECT_EQ(v.directions.col(2), Vec3(0, 0, 4));
  EXPECT_EQ(v.origin, Vec3(1, 2, 3.5));
  EXPECT_EQ(v.space, "left-posterior-superior");
  const LabelVolume size = read(with("ElementSize = 1 2 3\nPosition = 4 5 6\nAnatomicalOrientation = ???"));
  EXPECT_EQ(size.directions.diagonal(), Vec3(1, 2, 3));
  EXPECT_EQ(size.origin, Vec3(4, 5, 6));
  EXPECT_EQ(size.space, "");
  EXPECT_EQ(read(with("Rotation = 1 0 0 0 0 1 0 1 0\nOrigin = 1 1 1")).directions.col(1), Vec3(0, 0, 1));
}

TEST(MetaImage, DetachedBodies) {
  const auto read_file = [](const std::string& lines, const std::string& bytes) {
    return read_metaimage(head + lines, "dir/f.mhd", one_file("dir/my voxels.raw", bytes)).labels;
  };
  const std::string named = "ElementDataFile = my voxels.raw\n";
  EXPECT_EQ(read_file(named, body), counted_labels());
  EXPECT_EQ(read_file("CompressedData = True\n" + named, deflated(body, 15)), counted_labels());
  EXPECT_EQ(read_file("HeaderSize = 3\n" + named, "abc" + body), counted_labels());
  EXPECT_EQ(read_file("HeaderSize = -1\n" + named, "abc" + body), counted_labels());
  const auto refused = [&](const std::string& lines, const std::string& part) {
    const std::string message = error_of<InputError>([&] { (void)read_file(lines, body); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  refused("ElementDataFile = no.raw\n",
          "dir/f.mhd: line 6: the file with the voxels: cannot read dir/no.raw");
  refused("ElementDataFile = LIST\na.raw\n", "several files");
  refused("ElementDataFile = a%03d.raw 1 4 1\n", "several files");
  refused("ElementDataFile =\n", "names no file");
  refused("HeaderSize = 99\n" + named, "99 bytes to skip, but the file has 24");
  refused("HeaderSize = 1\n" + named,
          "dir/my voxels.raw: its 2 x 3 x 4 voxels of 1 byte need 24 bytes, but only 23");
  refused("HeaderSize = -1\nCompressedData = True\n" + named, "allowed only for raw data");
}

TEST(MetaImage, BadInput) {
  expect_refused("", "line 1", "empty");
  expect_refused("solid x\n", "line 1", "\"solid x\"");
  expect_refused(head, "no line \"elementdatafile\"");
  expect_refused(replaced(with(""), "NDims = 3", "NDims = 4"), "line 2", "4 dimensions");
  expect_refused(replaced(with(""), "Image", "Tube"), "line 1", "\"Tube\"");
  expect_refused(replaced(with(""), "2 3 4", "2 3"), "line 4", "2 axes");
  expect_refused(replaced(with(""), "2 3 4", "2 0 4"), "line 4", "axis 1 is 0");
  expect_refused(replaced(with(""), "MET_UCHAR", "MET_OTHER"), "line 5", "\"MET_OTHER\"");
  expect_refused(with("ElementNumberOfChannels = 3"), "line 6", "3 channels");
  expect_refused(with("CompressedData = maybe"), "line 6", "\"maybe\"");
  expect_refused(with("Offset = 1 2"), "line 6", "expected 3 numbers as offset, found 2");
  expect_refused(with("Offset = 1 2 nan"), "not finite");
  expect_refused(with("ElementSpacing = 1 2 0"), "along axis 2 is zero");
  expect_refused(with("TransformMatrix = 1 0 0 0 1 0 1 1 0"), "in one plane");
  expect_refused(with("NDims = 3"), "line 6", "twice");
  expect_refused(replaced(with("CompressedData = True"), "BinaryData = True", "BinaryData = False"), "line 6",
                 "compressed text");
  expect_refused(with("").substr(0, with("").size() - 1), "need 24 bytes, but only 23 follow");
}

}  // namespace
}  // namespace tetwright::metaimage_test
