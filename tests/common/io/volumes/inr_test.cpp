// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/inr.h"

#include "tests/common/io/volume_bytes.h"

namespace tetwright::inr_test {
namespace {

std::string header(const std::string& lines, std::size_t blocks = 1) {
  std::string out = "#INRIMAGE-4#{\nXDIM=02\nYDIM=3\nZDIM=4\n" + lines;
  out.resize(256 * blocks - 4, '\n');
  return out + "##}\n";
}

const std::string bytes8 = "VDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\nSCALE=2**0\nCPU=decm\n";
const std::string body = counted_voxels<std::uint8_t>();

void expect_refused(const std::string& bytes, const std::string& first, const std::string& second = "") {
  expect_input_error(read_inr, bytes, first, second);
}

template <class Number>
void expect_type(const std::string& type) {
  for (const std::string cpu : {"decm", "alpha", "pc", "sun", "sgi"}) {
    const std::string lines =
        "TYPE=" + type + "\nPIXSIZE=" + std::to_string(8 * sizeof(Number)) + " bits\nCPU=" + cpu + "\n";
    const bool big = cpu[0] == 's';
    const std::string bytes = header(lines) + counted_voxels<Number>(big);
    for (const std::string& file : {bytes, deflated(bytes)}) {
      const LabelVolume v = read_inr(file, "f");
      EXPECT_EQ(v.size, (std::array<int, 3>{2, 3, 4})) << lines;
      EXPECT_EQ(v.labels, counted_labels()) << lines;
    }
  }
}

TEST(Inr, EveryTypeOfEveryMachine) {
  expect_type<std::uint8_t>("unsigned fixed");
  expect_type<std::uint16_t>("unsigned fixed");
  expect_type<std::uint32_t>("unsigned fixed");
  expect_type<std::uint64_t>("unsigned fixed");
  expect_type<std::int8_t>("signed fixed");
  expect_type<std::int16_t>("signed fixed");
  expect_type<std::int32_t>("signed fixed");
  expect_type<std::int64_t>("signed fixed");
  expect_type<float>("float");
  expect_type<double>("float");
}

TEST(Inr, Geometry) {
  const LabelVolume plain = read_inr(header(bytes8) + body, "f");
  EXPECT_EQ(plain.directions, Eigen::Matrix3d::Identity());
  EXPECT_EQ(plain.space, "");
  const LabelVolume v =
      read_inr(header(bytes8 + "VX=0.5\nVY=2\nVZ=1.5\nTX=1\nTY=-2\nTZ=3e1\nRX=0\n#GEOMETRY=CARTESIAN\n", 3) +
                   body + "x",
               "f");
  EXPECT_EQ(v.directions.diagonal(), Vec3(0.5, 2, 1.5));
  EXPECT_EQ(v.origin, Vec3(1, -2, 30));
  EXPECT_EQ(v.labels, counted_labels());
}

TEST(Inr, BadInput) {
  expect_refused("", "empty");
  expect_refused("#INRIMAGE-5#{\n", "line 1", "\"#INRIMAGE-5#{\"");
  expect_refused(header(bytes8).substr(0, 250), "no end");
  expect_refused("#INRIMAGE-4#{\n" + std::string(100000, '\n'), "no end");
  expect_refused(header(bytes8 + "what\n") + body, "line 10", "\"what\"");
  expect_refused(header(bytes8 + "VDIM=1\n") + body, "twice");
  expect_refused(replaced(header(bytes8), "VDIM=1", "VDIM=3") + body, "line 5", "3 numbers per voxel");
  expect_refused(replaced(header(bytes8), "ZDIM=4", "ZDIM=0") + body, "axis 2 is 0");
  expect_refused(replaced(header(bytes8), "ZDIM=4", "ZDIM=x") + body, "line 4", "\"x\"");
  expect_refused(replaced(header(bytes8), "ZDIM=4\n", "") + body, "no line \"zdim\"");
  expect_refused(replaced(header(bytes8), "unsigned fixed", "packed") + body, "line 6", "\"packed\"");
  expect_refused(replaced(header(bytes8), "8 bits", "12 bits") + body, "line 7", "\"12 bits\"");
  expect_refused(replaced(header(bytes8), "decm", "vax") + body, "line 9", "\"vax\"");
  expect_refused(header("TYPE=float\nPIXSIZE=32 bits\n") + body, "no line \"cpu\"");
  expect_refused(header(bytes8 + "VX=0\n") + body, "along axis 0 is zero");
  expect_refused(header(bytes8 + "TX=inf\n") + body, "not finite");
  expect_refused(header(bytes8 + "RZ=90\n") + body, "line 10", "rotated");
  expect_refused(header(bytes8) + body.substr(1), "need 24 bytes, but only 23 follow");
  expect_refused(deflated(header(bytes8) + body.substr(1)), "only 23 are there");
  expect_refused(deflated(header(bytes8)).substr(0, 30), "f: ");
}

}  // namespace
}  // namespace tetwright::inr_test
