// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/nifti.h"

#include <cmath>
#include <limits>

#include "tests/common/io/volume_bytes.h"

namespace tetwright::nifti_test {
namespace {

/// Header of a volume of 2 x 3 x 4 voxels, which tests can modify.
class Header {
 public:
  explicit Header(int type, int bits, bool big = false) : bytes_(352, '\0'), big_(big) {
    set<std::int32_t>(0, 348);
    const std::int16_t dim[8] = {3, 2, 3, 4, 1, 1, 1, 1};
    for (std::size_t k = 0; k < 8; ++k) set<std::int16_t>(40 + 2 * k, dim[k]);
    set<std::int16_t>(70, static_cast<std::int16_t>(type));
    set<std::int16_t>(72, static_cast<std::int16_t>(bits));
    for (std::size_t k = 0; k < 8; ++k) set<float>(76 + 4 * k, 1);
    set<float>(108, 352);
    bytes_.replace(344, 4, std::string("n+1\0", 4));
  }
  template <class Number>
  Header& set(std::size_t offset, Number value) {
    bytes_.replace(offset, sizeof(Number), bytes_of<Number>({value}, big_));
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  bool big_;
};

Header plain() { return Header(2, 8); }
const std::string body = counted_voxels<std::uint8_t>();

/// Reads a volume in a single file.
LabelVolume read_alone(std::string_view bytes, const std::string& name) {
  return read_nifti(bytes, name, [](const std::string& path) -> std::string {
    throw InputError(path + ": there is no such file");
  });
}

LabelVolume read(const Header& header) { return read_alone(header.bytes() + body, "f"); }

void expect_refused(const std::string& bytes, const std::string& first, const std::string& second = "") {
  expect_input_error(read_alone, bytes, first, second);
}
void expect_refused(const Header& header, const std::string& first, const std::string& second = "") {
  expect_refused(header.bytes() + body, first, second);
}

template <class Number>
void expect_type(int type) {
  for (const bool big : {false, true}) {
    const std::string bytes = Header(type, 8 * sizeof(Number), big).bytes() + counted_voxels<Number>(big);
    for (const std::string& file : {bytes, deflated(bytes)}) {
      const LabelVolume v = read_alone(file, "f");
      EXPECT_EQ(v.size, (std::array<int, 3>{2, 3, 4})) << type;
      EXPECT_EQ(v.labels, counted_labels()) << type;
    }
  }
}

TEST(Nifti, VersionTwo) {
  for (const bool big : {false, true}) {
    std::string bytes(544, '\0');
    const auto set = [&]<class Number>(std::size_t offset, Number value) {
      bytes.replace(offset, sizeof(Number), bytes_of<Number>({value}, big));
    };
    set(0, std::int32_t{540});
    bytes.replace(4, 8, std::string("n+2\0\r\n\032\n", 8));
    set(12, std::int16_t{4});
    const std::int64_t dim[8] = {3, 2, 3, 4, 1, 1, 1, 1};
    for (std::size_t k = 0; k < 8; ++k) set(16 + 8 * k, dim[k]);
    for (std::size_t k = 0; k < 8; ++k) set(104 + 8 * k, double{0.1} * static_cast<double>(k));
    set(168, std::int64_t{544});
    set(344, std::int32_t{1});
    for (std::size_t k = 0; k < 3; ++k) set(376 + 8 * k, 1.0 / 3 + static_cast<double>(k));
    for (const std::string& file :
         {bytes + counted_voxels<std::int16_t>(big), deflated(bytes + counted_voxels<std::int16_t>(big))}) {
      const LabelVolume v = read_alone(file, "f");
      EXPECT_EQ(v.size, (std::array<int, 3>{2, 3, 4}));
      EXPECT_EQ(v.labels, counted_labels());
      EXPECT_EQ(v.origin, Vec3(1.0 / 3, 1.0 / 3 + 1, 1.0 / 3 + 2));  // in double precision
      EXPECT_EQ(v.directions(2, 2), 0.1 * 3);
    }
    set(168, std::int64_t{540});
    expect_refused(bytes + body, "vox_offset is 540, not 544 or more");
    for (std::size_t n = 1; n < 540; n += 7) expect_refused(bytes.substr(0, n), "");
  }
}

TEST(Nifti, VoxelsInAFileBesideTheHeader) {
  std::string header = Header(2, 8).set<float>(108, 0).bytes();
  header.replace(344, 4, std::string("ni1\0", 4));
  const auto with = [&](const std::string& voxels) {
    return read_nifti(header, "a/b.hdr", [&](const std::string& path) {
      EXPECT_EQ(path, "a/b.img");
      return voxels;
    });
  };
  EXPECT_EQ(with(body).labels, counted_labels());
  EXPECT_EQ(with(deflated(body)).labels, counted_labels());
  EXPECT_NE(error_of<InputError>([&] { (void)with(body.substr(1)); }).find("a/b.img"), std::string::npos);
  EXPECT_EQ(error_of<InputError>([&] { (void)read_alone(header, "f"); }), "f.img: there is no such file");
}

TEST(Nifti, EveryTypeInBothByteOrders) {
  expect_type<std::uint8_t>(2);
  expect_type<std::int16_t>(4);
  expect_type<std::int32_t>(8);
  expect_type<float>(16);
  expect_type<double>(64);
  expect_type<std::int8_t>(256);
  expect_type<std::uint16_t>(512);
  expect_type<std::uint32_t>(768);
  expect_type<std::int64_t>(1024);
  expect_type<std::uint64_t>(1280);
}

TEST(Nifti, SpacingAlone) {
  Header h = plain();
  h.set<float>(80, 0.5f).set<float>(84, 2).set<float>(88, 3).set<float>(268, 9);
  const LabelVolume v = read(h);
  EXPECT_EQ(v.directions.diagonal(), Vec3(0.5, 2, 3));
  EXPECT_EQ(v.origin, Vec3::Zero());
  EXPECT_EQ(v.space, "");
}

TEST(Nifti, QuaternionOfTheQform) {
  Header h = plain();
  h.set<std::int16_t>(252, 1);
  h.set<float>(80, 2).set<float>(84, 3).set<float>(88, 4);
  h.set<float>(268, 10).set<float>(272, 20).set<float>(276, 30);
  // A quarter turn about z: x to y, y to -x.
  h.set<float>(264, static_cast<float>(std::sqrt(0.5)));
  LabelVolume v = read(h);
  EXPECT_TRUE(v.directions.col(0).isApprox(Vec3(0, 2, 0), 1e-6));
  EXPECT_TRUE(v.directions.col(1).isApprox(Vec3(-3, 0, 0), 1e-6));
  EXPECT_TRUE(v.directions.col(2).isApprox(Vec3(0, 0, 4), 1e-6));
  EXPECT_EQ(v.origin, Vec3(10, 20, 30));
  EXPECT_EQ(v.space, "right-anterior-superior");
  v = read(h.set<float>(76, -1));  // the third axis is reversed
  EXPECT_TRUE(v.directions.col(2).isApprox(Vec3(0, 0, -4), 1e-6));
  v = read(h.set<float>(76, 1).set<float>(256, 1).set<float>(264, 0));  // half a turn about x
  EXPECT_EQ(v.directions, Eigen::Matrix3d(Vec3(2, -3, -4).asDiagonal()));
  v = read(h.set<float>(256, 0.5f).set<float>(260, 0.5f).set<float>(264, 0.5f));  // x to y to z to x
  EXPECT_EQ(v.directions.col(0), Vec3(0, 2, 0));
  EXPECT_EQ(v.directions.col(1), Vec3(0, 0, 3));
  EXPECT_EQ(v.directions.col(2), Vec3(4, 0, 0));
}

TEST(Nifti, SformComesFirst) {
  Header h = plain();
  h.set<std::int16_t>(252, 1).set<std::int16_t>(254, 2);
  const float rows[12] = {0, 2, 0, 5, -3, 0, 0, 6, 0, 0.5f, 4, 7};
  for (std::size_t k = 0; k < 12; ++k) h.set<float>(280 + 4 * k, rows[k]);
  const LabelVolume v = read(h);
  EXPECT_EQ(v.directions.col(0), Vec3(0, -3, 0));
  EXPECT_EQ(v.directions.col(1), Vec3(2, 0, 0.5));
  EXPECT_EQ(v.directions.col(2), Vec3(0, 0, 4));
  EXPECT_EQ(v.origin, Vec3(5, 6, 7));
  EXPECT_EQ(v.space, "right-anterior-superior");
  h.set<float>(280 + 4, 0).set<float>(280 + 36, 0);
  expect_refused(h, "is zero or not finite");
  h.set<float>(280 + 4, std::numeric_limits<float>::infinity());
  expect_refused(h, "not finite");
}

TEST(Nifti, ScalingMustLeaveWholeNumbers) {
  EXPECT_EQ(read(plain().set<float>(112, 2).set<float>(116, -1)).labels[3], 5);
  EXPECT_EQ(read(plain().set<float>(112, 0).set<float>(116, 7)).labels[3], 3);
  EXPECT_EQ(read(plain().set<float>(112, std::numeric_limits<float>::quiet_NaN())).labels[3], 3);
  expect_refused(plain().set<float>(112, 0.5f), "voxel (1, 0, 0) has the value 0.5, not a whole number");
  expect_refused(plain().set<float>(112, 1e9f),
                 "voxel (1, 1, 0) has the value 3e+09, which is not a 32-bit label");
  expect_refused(plain().set<float>(112, 1).set<float>(116, std::numeric_limits<float>::infinity()),
                 "scl_inter");
}

TEST(Nifti, MoreAxesAndOffsets) {
  EXPECT_EQ(read(plain().set<std::int16_t>(40, 7)).labels, counted_labels());
  EXPECT_EQ(read(plain().set<float>(108, 0)).labels, counted_labels());
  EXPECT_EQ(
      read_alone(plain().set<float>(108, 368).bytes() + std::string(16, 'x') + body + "more", "f").labels,
      counted_labels());
  expect_refused(plain().set<std::int16_t>(40, 4).set<std::int16_t>(48, 2),
                 "dim[4] is 2; a volume of a single time point");
  expect_refused(plain().set<std::int16_t>(40, 5).set<std::int16_t>(50, 3),
                 "dim[5] is 3; a volume with one label");
  expect_refused(plain().set<std::int16_t>(40, 2), "dim[0] is 2");
  expect_refused(plain().set<std::int16_t>(44, 0), "axis 1 is 0");
  expect_refused(plain().set<std::int16_t>(44, -3), "axis 1 is -3");
  expect_refused(plain().set<float>(108, 100), "vox_offset is 100");
  expect_refused(plain().set<float>(108, 352.5f), "vox_offset is 352.5");
  expect_refused(plain().set<float>(108, std::numeric_limits<float>::quiet_NaN()), "vox_offset is nan");
  expect_refused(plain().set<float>(108, 4000), "begin at byte 4000 of 376; the file is truncated");
}

TEST(Nifti, BadInput) {
  expect_refused("", "empty");
  expect_refused(plain().bytes().substr(0, 347), "only 347 bytes");
  expect_refused(plain().set<std::int32_t>(0, 17), "size is 17");
  expect_refused(replaced(plain().bytes(), "n+1", std::string(3, '\0')) + body, "ANALYZE");
  expect_refused(Header(128, 24), "type 128 (RGB colours)");
  expect_refused(Header(2304, 32), "type 2304 (RGBA colours)");
  expect_refused(Header(32, 64), "type 32 (complex numbers)");
  expect_refused(Header(1792, 128), "complex");
  expect_refused(Header(1, 1), "single bits");
  expect_refused(Header(0, 0), "type 0 (unknown)");
  expect_refused(plain().set<float>(84, 0), "pixdim[2] is 0");
  expect_refused(plain().set<float>(84, -1), "pixdim[2] is -1");
  expect_refused(plain().set<std::int16_t>(252, 1).set<float>(256, std::numeric_limits<float>::infinity()),
                 "quaternion");
  expect_refused(plain().bytes() + body.substr(1), "need 24 bytes, but only 23 follow");
  const std::string packed = deflated(plain().bytes() + body.substr(1));
  expect_refused(packed, "only 23 are there");
  expect_refused(packed.substr(0, 5), "empty");
  for (std::size_t n = 0; n < packed.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_alone(packed.substr(0, n), "f"); });
}

}  // namespace
}  // namespace tetwright::nifti_test
