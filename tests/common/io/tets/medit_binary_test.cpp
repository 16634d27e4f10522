// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/medit_binary.h"

#include "common/io/encodings/byte_order.h"
#include "tests/common/io/expect_error.h"
#include "tests/common/io/round_trip.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::medit_binary_test {
namespace {

TEST(MeditBinary, RoundTripKeepsEveryBit) {
  const TetMesh mesh = tricky_tets();
  const ReadTetMesh back = read_medit_binary(text_of(write_medit_binary, mesh), "f");
  EXPECT_TRUE(same_bits(back.mesh.points, mesh.points));
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.mesh.materials, mesh.materials);
  EXPECT_EQ(back.material_field, "medit:ref");
}

TEST(MeditBinary, TrianglesAreGroupsOfFaces) {
  const TetMesh mesh = mesh_with_surfaces();
  const ReadTetMesh back = read_medit_binary(text_of(write_medit_binary, mesh), "f");
  // Without names and comments only numbers remain: because of the region's number all groups become regions
  // of the input.
  std::vector<std::int64_t> numbers;
  for (const auto& [patch, group] : back.mesh.patch_groups) numbers.push_back(group.number);
  EXPECT_TRUE(std::find(numbers.begin(), numbers.end(), 5) != numbers.end());
  EXPECT_EQ(text_of(write_medit_binary, read_medit_binary(text_of(write_medit_binary, back.mesh), "f").mesh),
            text_of(write_medit_binary, back.mesh));
}

/// Builds a file of version `version` in either byte order.
struct File {
  int version;
  bool swap;
  std::string bytes;

  template <class Number>
  void put(Number value) {
    std::string one;
    append_bytes(one, value);
    if (swap) std::reverse(one.begin(), one.end());
    bytes += one;
  }
  void integer(std::int64_t value) {
    if (version >= 4)
      put(value);
    else
      put(static_cast<std::int32_t>(value));
  }
  void real(double value) {
    if (version >= 2)
      put(value);
    else
      put(static_cast<float>(value));
  }
  /// Adds a section whose content is written by `fill`.
  template <class Fill>
  void section(std::int32_t keyword, const Fill& fill) {
    File content{version, swap, {}};
    fill(content);
    put(keyword);
    const std::size_t next = bytes.size() + (version >= 3 ? 8 : 4) + content.bytes.size();
    if (version >= 3)
      put(static_cast<std::int64_t>(next));
    else
      put(static_cast<std::int32_t>(next));
    bytes += content.bytes;
  }
};

File small(int version, bool swap) {
  File f{version, swap, {}};
  f.put(std::int32_t{1});
  f.put(std::int32_t{version});
  f.section(3, [](File& s) { s.put(std::int32_t{3}); });
  f.section(4, [](File& s) {
    s.integer(4);
    for (const Vec3& p : one_tet().points) {
      for (const double x : p) s.real(x);
      s.integer(0);
    }
  });
  f.section(5, [](File& s) {
    s.integer(1);
    for (const int i : {1, 2, 9}) s.integer(i);
  });
  f.section(8, [](File& s) {
    s.integer(1);
    for (const int i : {1, 2, 3, 4, -3}) s.integer(i);
  });
  return f;
}

TEST(MeditBinary, EveryVersionAndByteOrder) {
  for (const int version : {1, 2, 3, 4})
    for (const bool swap : {false, true}) {
      SCOPED_TRACE(version);
      File f = small(version, swap);
      f.section(54, [](File&) {});
      const ReadTetMesh r = read_medit_binary(f.bytes, "f");
      EXPECT_EQ(r.mesh.points, one_tet().points);
      EXPECT_EQ(r.mesh.tets, one_tet().tets);
      EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{-3}));
      EXPECT_EQ(r.dropped, (std::vector<Dropped>{{"edges", 1}}));
    }
}

TEST(MeditBinary, BadInput) {
  const std::string good = small(2, false).bytes;
  expect_input_error(read_medit_binary, "", "empty");
  expect_input_error(read_medit_binary, "MeshVersionFormatted 2", "byte 0", "not a binary Medit mesh");
  expect_input_error(read_medit_binary, std::string("\1\0\0\0\7\0\0\0", 8), "byte 4", "version 7");
  File hexahedra = small(2, false);
  hexahedra.section(10, [](File& s) { s.integer(2); });
  expect_input_error(read_medit_binary, hexahedra.bytes, "2 hexahedra", "Tetrahedralize");
  File beyond = small(2, false);
  beyond.section(6, [](File& s) {
    s.integer(1);
    for (const int i : {1, 2, 5, 1}) s.integer(i);
  });
  expect_input_error(read_medit_binary, beyond.bytes, "point 5 of 4");
  File many = small(2, false);
  many.section(6, [](File& s) { s.integer(2000000000); });
  expect_input_error(read_medit_binary, many.bytes, "2000000000", "truncated");
  for (std::size_t n = 0; n < good.size(); ++n)
    (void)error_of<InputError>([&] { (void)read_medit_binary(good.substr(0, n), "f"); });
}

}  // namespace
}  // namespace tetwright::medit_binary_test
