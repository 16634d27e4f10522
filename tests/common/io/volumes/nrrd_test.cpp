// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/nrrd.h"

#include <limits>

#include "tests/common/io/tricky_meshes.h"
#include "tests/common/io/volume_boxes.h"
#include "tests/common/io/volume_bytes.h"

namespace tetwright::nrrd_test {
namespace {

const std::string head = "NRRD0004\n# a comment\ntype: uint8\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n";
const std::string body = counted_voxels<std::uint8_t>();
const std::string plain = head + "\n" + body;

std::string with(const std::string& line) { return head + line + "\n\n" + body; }

void expect_counted(const std::string& bytes) {
  const LabelVolume v = read_nrrd(bytes, "f");
  EXPECT_EQ(v.size, (std::array<int, 3>{2, 3, 4}));
  EXPECT_EQ(v.labels, counted_labels());
}

void expect_refused(const std::string& bytes, const std::string& first, const std::string& second = "") {
  expect_input_error([](std::string_view b, const char* name) { return read_nrrd(b, name); }, bytes, first,
                     second);
}

template <class Number>
void expect_type(const std::string& name) {
  for (const bool big : {false, true}) {
    const std::string h = replaced(head, "uint8", name) + "endian: " + (big ? "big" : "little") + "\n";
    expect_counted(h + "\n" + counted_voxels<Number>(big));
    expect_counted(replaced(h, "raw", "gzip") + "\n" + deflated(counted_voxels<Number>(big)));
  }
}

TEST(Nrrd, NamesOfSegments) {
  const std::string two_voxels = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n";
  const LabelVolume v =
      read_nrrd(two_voxels +
                    "Segment0_ID:=Segment_1\nSegment0_Name:=liver, left\nSegment0_LabelValue:=4\n"
                    "Segment0_Color:=0.5 0.25  1\nSegment1_Color:=red\n"
                    "Segment0_Layer:=0\nSegment1_Name:=tumour\nSegment1_LabelValue:=7\n"
                    "Segment2_Name:=no label\nSegment3_LabelValue:=9\nSegmentation_x:=1\n\n\4\7",
                "f");
  EXPECT_EQ(v.names, (std::map<MaterialTag, std::string>{{4, "liver, left"}, {7, "tumour"}}));
  EXPECT_EQ(v.colours, (std::map<MaterialTag, std::array<double, 3>>{{4, {0.5, 0.25, 1}}}));
  EXPECT_EQ(v.labels, (std::vector<MaterialTag>{4, 7}));
  expect_input_error(read_nrrd, two_voxels + "Segment0_Layer:=0\nSegment1_Layer:=2\n\n\4\7", "line 4",
                     "overlap, in 3 layers");
}

TEST(Nrrd, LayersOfOverlappingSegments) {
  const std::string segments =
      "Segment0_Name:=liver\nSegment0_LabelValue:=1\nSegment0_Layer:=0\nSegment1_Name:=tumour\n"
      "Segment1_LabelValue:=1\nSegment1_Layer:=1\n\n";
  const auto header = [](const std::string& sizes, const std::string& kinds) {
    return "NRRD0004\ntype: uchar\ndimension: 4\nencoding: text\nsizes: " + sizes + "\nkinds: " + kinds +
           "\n";
  };
  using Labels = std::vector<MaterialTag>;
  const auto expect = [&](const std::string& bytes, const std::array<int, 3>& size, const Labels& first,
                          const Labels& second) {
    const std::vector<LabelVolume> layers = read_nrrd_layers(bytes, "f");
    ASSERT_EQ(layers.size(), 2u);
    EXPECT_EQ(layers[0].size, size);
    EXPECT_EQ(layers[0].labels, first);
    EXPECT_EQ(layers[1].labels, second);
    EXPECT_EQ(layers[0].names, (std::map<MaterialTag, std::string>{{1, "liver"}}));
    EXPECT_EQ(layers[1].names, (std::map<MaterialTag, std::string>{{1, "tumour"}}));
    EXPECT_EQ(nrrd_layers({bytes, bytes.size()}, "f"), 2);
  };
  expect(header("2 1 3 2", "list domain domain domain") + segments + "1 2 3 4 5 6 7 8 9 10 11 12", {1, 3, 2},
         {1, 3, 5, 7, 9, 11}, {2, 4, 6, 8, 10, 12});
  expect(header("3 2 2 1", "domain list domain domain") + segments + "1 2 3 4 5 6 7 8 9 10 11 12", {3, 2, 1},
         {1, 2, 3, 7, 8, 9}, {4, 5, 6, 10, 11, 12});
  expect(header("3 1 2 2", "domain domain domain list") + segments + "1 2 3 4 5 6 7 8 9 10 11 12", {3, 1, 2},
         {1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12});
  EXPECT_EQ(read_nrrd_layers(plain, "f").front().labels, counted_labels());
  const auto read = [](std::string_view b, const char* name) { return read_nrrd_layers(b, name); };
  expect_input_error(read, header("3 1 3 2", "list domain domain domain") + segments + "1", "line 5",
                     "in 2 layers, but no axis of that size is other than spatial (of kind list)");
  expect_input_error(read, header("2 1 3 2", "list domain domain domain") + segments + "1 2 3", "", "");
}

TEST(Nrrd, EveryTypeInBothByteOrders) {
  expect_counted(plain);
  expect_type<std::int8_t>("signed char");
  expect_type<std::uint8_t>("Unsigned Char");
  expect_type<std::int16_t>("short");
  expect_type<std::uint16_t>("unsigned  short int");
  expect_type<std::int32_t>("int");
  expect_type<std::uint32_t>("uint32_t");
  expect_type<std::int64_t>("signed long long int");
  expect_type<std::uint64_t>("ulonglong");
  expect_type<float>("float");
  expect_type<double>("double");
}

TEST(Nrrd, Encodings) {
  expect_counted(replaced(head, "raw", "gz") + "\n" + deflated(body));
  // Several members, followed by other bytes.
  expect_counted(replaced(head, "raw", "gzip") + "\n" + deflated(body.substr(0, 7)) +
                 deflated(body.substr(7)) + "x");
  std::string text;
  for (int i = 0; i < 24; ++i) text += std::to_string(i) + (i % 6 == 5 ? "\n" : " ");
  for (const char* name : {"txt", "text", "ASCII"}) expect_counted(replaced(head, "raw", name) + "\n" + text);
  expect_counted(plain + "more");
  std::string windows;
  for (const char c : head + "\n") windows += c == '\n' ? "\r\n" : std::string(1, c);
  expect_counted(windows + body);
}

TEST(Nrrd, Geometry) {
  const LabelVolume plain_volume = read_nrrd(plain, "f");
  EXPECT_EQ(plain_volume.directions, Eigen::Matrix3d::Identity());
  EXPECT_EQ(plain_volume.origin, Vec3::Zero());
  EXPECT_EQ(plain_volume.space, "");
  const LabelVolume spaced = read_nrrd(with("spacings: 0.5 2 1e1\nkey:=any: thing"), "f");
  EXPECT_EQ(spaced.directions.diagonal(), Vec3(0.5, 2, 10));
  const LabelVolume turned = read_nrrd(
      with("space: LPS\nspace directions: (0,2,0) (-1, 0, 0) ( 0,0.5,3 )\nspace origin: (1,-2,3.5)"), "f");
  EXPECT_EQ(turned.space, "left-posterior-superior");
  EXPECT_EQ(turned.directions.col(0), Vec3(0, 2, 0));
  EXPECT_EQ(turned.directions.col(1), Vec3(-1, 0, 0));
  EXPECT_EQ(turned.directions.col(2), Vec3(0, 0.5, 3));
  EXPECT_EQ(turned.origin, Vec3(1, -2, 3.5));
  EXPECT_EQ(turned.to_input(Vec3(1, 1, 2)), Vec3(0, 1, 9.5));
  EXPECT_EQ(read_nrrd(with("space: RAS"), "f").space, "right-anterior-superior");
  const LabelVolume cells =
      read_nrrd(with("axis mins: 0 10 nan\naxis maxs: 4 16 nan\ncenterings: cell cell none"), "f");
  EXPECT_EQ(cells.directions.diagonal(), Vec3(2, 2, 1));
  EXPECT_EQ(cells.origin, Vec3(1, 11, 0));
  const LabelVolume nodes = read_nrrd(with("axis mins: 0 10 1\naxis maxs: 4 16 7"), "f");
  EXPECT_EQ(nodes.directions.diagonal(), Vec3(4, 3, 2));
  EXPECT_EQ(nodes.origin, Vec3(0, 10, 1));
}

TEST(Nrrd, AxesOfSizeOneAreDropped) {
  const std::string four = replaced(replaced(head, "dimension: 3", "dimension: 4"), "2 3 4", "1 2 3 4");
  expect_counted(
      four + "kinds: stub domain domain domain\nspace directions: none (2,0,0) (0,3,0) (0,0,4)\n\n" + body);
  const LabelVolume v =
      read_nrrd(four + "space directions: (nan,nan,nan) (2,0,0) (0,3,0) (0,0,4)\n\n" + body, "f");
  EXPECT_EQ(v.directions.diagonal(), Vec3(2, 3, 4));
  expect_counted(replaced(replaced(head, "dimension: 3", "dimension: 5"), "2 3 4", "2 1 3 4 1") +
                 "spacings: 1 1 2 3 nan\n\n" + body);
}

TEST(Nrrd, DetachedBodies) {
  const std::string detached = head + "data file: sub/b.raw\n";
  const auto read = [](const std::string& h, const std::string& bytes) {
    return read_nrrd(h, "dir/f.nhdr", one_file("dir/sub/b.raw", bytes)).labels;
  };
  EXPECT_EQ(read(detached, body), counted_labels());
  EXPECT_EQ(read(detached + "line skip: 2\nbyte skip: 3\n", "one\ntwo\n123" + body), counted_labels());
  EXPECT_EQ(read(detached + "byteskip: -1\n", "anything" + body), counted_labels());
  EXPECT_EQ(
      read(replaced(detached, "raw", "gzip") + "line skip: 1\nbyte skip: 2\n", "x\n" + deflated("ab" + body)),
      counted_labels());
  EXPECT_EQ(read(replaced(detached, "raw", "txt") + "line skip: 1\nbyte skip: 2\n",
                 "x\n999 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23")[2],
            1);
  // A body may begin with the bytes of a byte order mark.
  std::string marked = body;
  marked.replace(0, 3, "\xef\xbb\xbf");
  EXPECT_EQ(read(detached, marked)[0], 0xef);
  const auto refused = [&](const std::string& h, const std::string& part) {
    const std::string message = error_of<InputError>([&] { (void)read(h, body); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  refused(replaced(detached, "b.raw", "no.raw"),
          "dir/f.nhdr: line 7: the file with the voxels: cannot read dir/sub/no.raw");
  refused(head + "data file: LIST\na.raw\nb.raw\n", "line 7: voxels in several files");
  refused(head + "data file: a%02d.raw 1 4 1\n", "several files");
  refused(head + "data file:\n", "names no file");
  refused(detached + "byte skip: 1\n", "b.raw: its 2 x 3 x 4 voxels of 1 byte need 24 bytes, but only 23");
  refused(detached + "byte skip: 99\n", "99 bytes to skip, but the data have 24");
  refused(detached + "byte skip: -2\n", "-2 bytes");
  refused(detached + "line skip: 5\n", "5 lines to skip");
  refused(detached + "line skip: -1\n", "-1 lines");
  refused(replaced(detached, "raw", "gzip") + "byte skip: -1\n", "allowed only for raw data");
}

TEST(Nrrd, BadHeaders) {
  expect_refused("", "line 1", "empty");
  expect_refused("PLY\n", "line 1", "\"PLY\"");
  expect_refused(with("what is this"), "line 7", "\"what is this\"");
  expect_refused(with("spacing: 1 1 1"), "line 7", "unknown field \"spacing\"");
  expect_refused(with("type: int"), "line 7", "twice");
  expect_refused(replaced(plain, "type: uint8\n", ""), "no line \"type\"");
  expect_refused(replaced(plain, "uint8", "block"), "line 3", "\"block\"");
  expect_refused(replaced(plain, "raw", "bzip2"), "line 6", "\"bzip2\" is not supported");
  expect_refused(replaced(plain, "uint8", "short"), "no line \"endian\"");
  expect_refused(replaced(with("endian: middle"), "uint8", "short"), "line 7", "\"middle\"");
  expect_refused(replaced(plain, "dimension: 3", "dimension: 2"), "line 4", "dimension 2");
  expect_refused(replaced(plain, "dimension: 3", "dimension: 4"), "line 5", "3 sizes for 4 axes");
  expect_refused(replaced(plain, "2 3 4", "2 0 4"), "line 5", "axis 1 is 0");
  expect_refused(replaced(plain, "2 3 4", "2 -3 4"), "line 5", "axis 1 is -3");
  expect_refused(replaced(plain, "2 3 4", "2 x 4"), "line 5", "\"x\"");
  expect_refused(replaced(plain, "2 3 4", "65536 65536 4"), "line 5", "2147483648 voxels");
  expect_refused(replaced(plain, "2 3 4", "9223372036854775807 9223372036854775807 4"), "line 5", "voxels");
  expect_refused(replaced(replaced(plain, "dimension: 3", "dimension: 4"), "2 3 4", "2 3 2 2"), "line 5",
                 "4 axes of more than one item");
  expect_refused(with("kinds: RGB-color domain domain"), "line 5", "\"RGB-color\"");
  expect_refused(with("kinds: domain domain"), "line 7", "2 kinds for 3 axes");
  expect_refused(with("space dimension: 4"), "line 7", "3 are needed");
  expect_refused(with("space: left-posterior-superior-time"), "line 7", "not supported");
  expect_refused(with("space directions: (1,0,0) (0,1,0)"), "line 7", "2 space directions");
  expect_refused(with("space directions: (1,0,0) (0,1,0) (0,1)"), "line 7", "2 numbers");
  expect_refused(with("space directions: (1,0,0) (0,1,0) (0,1,a)"), "line 7", "(0,1,a)");
  expect_refused(with("space directions: (1,0,0) (0,1,0) (0,1,1"), "line 7", "(0,1,1");
  expect_refused(with("space directions: (1,0,0) (0,1,0) none"), "line 5", "not a spatial axis");
  expect_refused(with("space directions: (1,0,0) (0,1,0) (1,1,0)"), "in one plane");
  expect_refused(with("space directions: (1,0,0) (0,1,0) (1,nan,0)"), "not finite");
  expect_refused(with("space origin: (1,0,inf)"), "origin (1 0 inf) is not finite");
  expect_refused(with("space origin: none"), "line 7", "one vector");
  expect_refused(with("spacings: 1 0 1"), "along axis 1 is zero");
  expect_refused(with("spacings: 1 inf 1"), "not finite");
  expect_refused(with("spacings: 1 1"), "line 7", "expected 3 numbers as spacings, found 2");
}

TEST(Nrrd, BadBodies) {
  expect_refused(plain.substr(0, plain.size() - 1), "need 24 bytes, but only 23 follow");
  const std::string gzip = replaced(head, "raw", "gzip") + "\n";
  const std::string packed = deflated(body);
  expect_refused(gzip + deflated(body.substr(1)), "only 23 are there");
  expect_refused(gzip + packed.substr(0, 20), "are there; the file is truncated");
  expect_refused(gzip + "not gzip at all", "compressed data are damaged");
  std::string checksum = packed;
  checksum[checksum.size() - 6] ^= 1;
  expect_refused(gzip + checksum, "damaged");
  // No memory is allocated for voxels that the file cannot contain.
  expect_refused(replaced(gzip, "2 3 4", "1024 1024 1024") + packed, "need 1073741824 bytes", "at most");
  const std::string floats = replaced(head, "uint8", "float") + "endian: little\n\n";
  std::vector<float> numbers(24, 1);
  numbers[9] = 0.5f;
  expect_refused(floats + bytes_of(numbers), "voxel (1, 1, 1) has the value 0.5, not a whole number");
  numbers[9] = std::numeric_limits<float>::quiet_NaN();
  expect_refused(floats + bytes_of(numbers), "voxel (1, 1, 1) has the value nan, not a whole number");
  numbers[9] = 3e9f;
  expect_refused(floats + bytes_of(numbers), "voxel (1, 1, 1)", "not a 32-bit label");
  std::vector<std::uint32_t> large(24, 7);
  large[23] = 2147483648u;
  expect_refused(replaced(floats, "float", "uint") + bytes_of(large),
                 "voxel (1, 2, 3) has the value 2147483648,");
  large[23] = 2147483647u;
  EXPECT_EQ(read_nrrd(replaced(floats, "float", "uint") + bytes_of(large), "f").labels[23], 2147483647);
  const std::string text = replaced(head, "raw", "txt") + "\n";
  expect_refused(text + "1 2 3", "need 47 bytes or more");
  expect_refused(text + "1 2 three" + std::string(40, ' '), "line 8", "\"three\"");
  expect_refused(text + "1 2 3" + std::string(50, ' '), "after 3 of 24 voxels");
  expect_refused(text + "1 2 3.5" + std::string(50, ' '), "voxel (0, 1, 0)", "\"3.5\"");
}

TEST(Nrrd, WrittenInTheSmallestType) {
  const auto with_label = [](MaterialTag label) {
    LabelVolume v;
    v.size = {1, 2, 2};
    v.labels = {0, 1, label, 3};
    v.directions << 0, 0, 1.0 / 3, 0.1, 0, 0, 0, -7, 0;
    v.origin = Vec3(0.1 + 0.2, -1e300, 5e-324);
    v.space = "3D-left-handed";
    const std::string written = write_nrrd(v);
    const LabelVolume back = read_nrrd(written, "f");
    EXPECT_EQ(back.size, v.size);
    EXPECT_EQ(back.labels, v.labels);
    EXPECT_EQ(back.directions, v.directions);
    EXPECT_TRUE(same_bits({back.origin}, {v.origin}));
    EXPECT_EQ(back.space, v.space);
    const std::size_t at = written.find("type: ") + 6;
    return written.substr(at, written.find('\n', at) - at);
  };
  EXPECT_EQ(with_label(255), "uint8");
  EXPECT_EQ(with_label(-1), "int16");
  EXPECT_EQ(with_label(32767), "int16");
  EXPECT_EQ(with_label(65535), "uint16");
  EXPECT_EQ(with_label(65536), "int32");
  EXPECT_EQ(with_label(-2147483647 - 1), "int32");
  LabelVolume other;
  other.size = {1, 1, 1};
  other.labels = {1};
  other.space = "of my own";
  EXPECT_EQ(read_nrrd(write_nrrd(other), "f").space, "");
}

TEST(Nrrd, WrittenBySlabsInTheSmallestUnsignedType) {
  const auto type_of = [](MaterialTag largest) {
    LabelVolume volume = numbered_volume({5, 3, 4});
    volume.labels[7] = largest;
    volume.directions << 0, 0, 1.0 / 3, 0.1, 0, 0, 0, -7, 0;
    volume.origin = Vec3(0.1 + 0.2, -1e300, 5e-324);
    std::string written;
    write_raw_nrrd(
        MemoryLabelSource(volume), largest, [&](std::string_view bytes) { written += bytes; }, nullptr);
    const LabelVolume back = read_nrrd(written, "f");
    EXPECT_EQ(back.size, volume.size);
    EXPECT_EQ(back.labels, volume.labels);
    EXPECT_EQ(back.directions, volume.directions);
    EXPECT_TRUE(same_bits({back.origin}, {volume.origin}));
    const std::size_t at = written.find("type: ") + 6;
    return written.substr(at, written.find('\n', at) - at);
  };
  EXPECT_EQ(type_of(255), "uint8");
  EXPECT_EQ(type_of(256), "uint16");
  EXPECT_EQ(type_of(65535), "uint16");
  EXPECT_EQ(type_of(65536), "uint32");
  EXPECT_EQ(type_of(2147483647), "uint32");
}

TEST(Nrrd, CutAnywhereItIsRefused) {
  const std::string packed = replaced(head, "raw", "gzip") + "\n" + deflated(body);
  // The checksum may be cut off.
  for (std::size_t n = 0; n + 10 < packed.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_nrrd(packed.substr(0, n), "f"); });
}

}  // namespace
}  // namespace tetwright::nrrd_test
