// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_bytes.h"

#include <gtest/gtest.h>

#include <zstd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "common/random.h"
#include "tetwright/error.h"

namespace tetwright::brick_bytes_test {
namespace {

/// A part whose members all differ from each other and from their defaults.
BrickPart small_part() {
  BrickPart part;
  part.border = {{{0, 32, 64}, {32, 64, 80}}, 16, {{{1, 2}, {3, 4}, {5, 6}}, {{7, SeamPoint::not_near}}}};
  part.kept_surface = true;
  part.mesh.points = {{0.1, -0.0, 1e-300}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1e300}};
  part.mesh.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  part.mesh.materials = {-2147483647 - 1, 2147483647};
  part.mesh.interfaces = {{{0, 1, 3}, -5, {}, 65535}, {{0, 2, 1}, -5, 0, 1}};
  part.flags = {BrickPart::shared, BrickPart::on_interface, 3, 0, 1};
  part.surface.points = {{4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
  part.surface.interfaces = {{{0, 1, 2}, -7, -6, 2}, {{2, 1, 0}, 3, {}, 0}};
  part.surface_shared = {1, 0, 1};
  part.cut_faces = {{{2, 1, 0}, -7, {}, 0}};
  part.leaves = 11;
  part.lattice_tets = 12;
  part.isolated_vertices = 13;
  MeshStatistics& dense = part.dense;
  dense.tets = 21;
  dense.points = 22;
  dense.materials = {{-7, {23, 24.5}}, {0, {25, 26.5}}};
  dense.volume = 27.5;
  dense.min_solid_angle = 0.125;
  dense.mean_solid_angle = 0.25;
  dense.below_count = 28;
  dense.below_percent = 29.5;
  dense.min_dihedral = 30.5;
  dense.max_dihedral = 131.5;
  dense.histogram.counts.front().front() = 41;
  dense.histogram.counts.back().back() = 42;
  dense.dihedrals.counts.front() = 43;
  dense.dihedrals.counts.back() = 44;
  dense.interfaces = {{{-7, {}}, {45, 46.5}}, {{-7, 3}, {47, 48.5}}};
  return part;
}

bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0);
}

void expect_equal(const BrickPart& a, const BrickPart& b) {
  EXPECT_EQ(a.border.brick, b.border.brick);
  EXPECT_EQ(a.border.halo, b.border.halo);
  EXPECT_EQ(a.kept_surface, b.kept_surface);
  EXPECT_EQ(a.border.seam.offered, b.border.seam.offered);
  EXPECT_EQ(a.border.seam.needed, b.border.seam.needed);
  EXPECT_TRUE(same_bits(a.mesh.points, b.mesh.points));
  EXPECT_EQ(a.mesh.tets, b.mesh.tets);
  EXPECT_EQ(a.mesh.materials, b.mesh.materials);
  EXPECT_EQ(a.mesh.interfaces, b.mesh.interfaces);
  EXPECT_EQ(a.flags, b.flags);
  EXPECT_TRUE(same_bits(a.surface.points, b.surface.points));
  EXPECT_EQ(a.surface.interfaces, b.surface.interfaces);
  EXPECT_EQ(a.surface_shared, b.surface_shared);
  EXPECT_EQ(a.cut_faces, b.cut_faces);
  EXPECT_EQ(a.leaves, b.leaves);
  EXPECT_EQ(a.lattice_tets, b.lattice_tets);
  EXPECT_EQ(a.isolated_vertices, b.isolated_vertices);
  EXPECT_EQ(a.dense.tets, b.dense.tets);
  EXPECT_EQ(a.dense.points, b.dense.points);
  ASSERT_EQ(a.dense.materials.size(), b.dense.materials.size());
  for (const auto& [tag, material] : a.dense.materials) {
    ASSERT_EQ(b.dense.materials.count(tag), 1u) << tag;
    EXPECT_EQ(material.tets, b.dense.materials.at(tag).tets) << tag;
    EXPECT_EQ(material.volume, b.dense.materials.at(tag).volume) << tag;
  }
  EXPECT_EQ(a.dense.volume, b.dense.volume);
  EXPECT_EQ(a.dense.min_solid_angle, b.dense.min_solid_angle);
  EXPECT_EQ(a.dense.mean_solid_angle, b.dense.mean_solid_angle);
  EXPECT_EQ(a.dense.below_count, b.dense.below_count);
  EXPECT_EQ(a.dense.below_percent, b.dense.below_percent);
  for (const auto angle : {&MeshStatistics::min_dihedral, &MeshStatistics::max_dihedral})
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.dense.*angle), std::bit_cast<std::uint64_t>(b.dense.*angle));
  EXPECT_EQ(a.dense.histogram.counts, b.dense.histogram.counts);
  EXPECT_EQ(a.dense.dihedrals.counts, b.dense.dihedrals.counts);
  ASSERT_EQ(a.dense.interfaces.size(), b.dense.interfaces.size());
  for (const auto& [pair, known] : b.dense.interfaces) {
    ASSERT_EQ(a.dense.interfaces.count(pair), 1u);
    EXPECT_EQ(a.dense.interfaces.at(pair).triangles, known.triangles);
    EXPECT_EQ(a.dense.interfaces.at(pair).area, known.area);
  }
  EXPECT_TRUE(b.dense.sheets.empty());
}

/// The message of the InputError that refuses these bytes; empty if they are accepted.
std::string refusal(std::string_view bytes) {
  try {
    (void)brick_part(bytes, "brick-7");
    return "";
  } catch (const InputError& e) {
    return e.what();
  }
}

std::string compressed(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  return out;
}

std::string decompressed(const std::string& bytes) {
  std::string out(ZSTD_getFrameContentSize(bytes.data(), bytes.size()), '\0');
  EXPECT_EQ(ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size()), out.size());
  return out;
}

TEST(BrickBytes, AllMembersReturn) {
  const BrickPart part = small_part();
  const std::string bytes = to_bytes(part);
  expect_equal(part, brick_part(bytes, "brick-7"));
  EXPECT_EQ(to_bytes(brick_part(bytes, "brick-7")), bytes);
}

BrickRequest small_request() {
  BrickRequest request{{7, 16, true, true, 3}, {}};
  BrickPieces& pieces = request.pieces;
  pieces.brick = {{1, 2, 3}, {4, 5, 6}};
  pieces.parts = {small_part(), {}, small_part()};
  pieces.parts.back().mesh.points.front().x() = 7;
  pieces.shared = {{0.1, -0.0, 1e-300}, {8, 9, 10}};
  return request;
}

TEST(BrickBytes, ARequestReturns) {
  const BrickRequest request = small_request();
  const BrickPieces& pieces = request.pieces;
  const std::string bytes = to_bytes(request);
  const BrickRequest returned = brick_request(bytes, "brick 7");
  const BrickPieces& read = returned.pieces;
  EXPECT_EQ(returned.task.brick, request.task.brick);
  EXPECT_EQ(returned.task.halo, request.task.halo);
  EXPECT_TRUE(returned.task.keep_surface && returned.task.thin);
  EXPECT_EQ(returned.task.round, request.task.round);
  EXPECT_EQ(read.brick, pieces.brick);
  EXPECT_TRUE(same_bits(read.shared, pieces.shared));
  ASSERT_EQ(read.parts.size(), pieces.parts.size());
  for (std::size_t p = 0; p < read.parts.size(); ++p) {
    BrickPart used;  // of a part, its mesh and flags
    used.mesh = pieces.parts[p].mesh;
    used.flags = pieces.parts[p].flags;
    expect_equal(read.parts[p], used);
  }
  EXPECT_EQ(to_bytes(returned), bytes);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW((void)brick_request(bytes.substr(0, size), "brick 7"), InputError) << size;
  EXPECT_THROW((void)brick_request(to_bytes(small_part()), "brick 7"), InputError);
}

TEST(BrickBytes, AnEmptyPartReturns) {
  const BrickPart part;  // its dihedral angles are NaN
  expect_equal(part, brick_part(to_bytes(part), "brick-7"));
}

TEST(BrickBytes, ALargePartReturns) {
  Random random(5);
  BrickPart part = small_part();
  part.mesh.points.clear();
  for (int i = 0; i < 50000; ++i)
    part.mesh.points.emplace_back(random.uniform(), random.uniform(), random.uniform());
  part.mesh.tets.assign(300000, {1, 2, 3, 4});  // compresses to a small fraction
  expect_equal(part, brick_part(to_bytes(part), "brick-7"));
}

TEST(BrickBytes, EveryChangedByteIsNoticed) {
  const std::string bytes = to_bytes(small_part());
  std::size_t noticed = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ 1 << bit);
      if (refusal(damaged).empty())
        expect_equal(small_part(), brick_part(damaged, "brick-7"));  // a code may have several forms
      else
        ++noticed;
    }
  EXPECT_GT(noticed, 7 * bytes.size());
}

TEST(BrickBytes, EveryTruncationIsNoticed) {
  const std::string bytes = to_bytes(small_part());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string message = refusal(bytes.substr(0, size));
    EXPECT_NE(message.find("brick-7"), std::string::npos) << size << ": " << message;
  }
}

TEST(BrickBytes, OtherBytesAreRefused) {
  const std::string bytes = to_bytes(small_part());
  for (const std::string& other :
       {std::string(), std::string("x"), std::string(1000, '\0'), std::string("mesh"), bytes + "x",
        bytes + std::string(8, '\0'), bytes + bytes, "x" + bytes, compressed(""), compressed("brick")})
    EXPECT_FALSE(refusal(other).empty()) << other.size() << " bytes";
  EXPECT_NE(refusal({}).find("incomplete"), std::string::npos);
}

// The checksum does not protect against a part that was written incompletely, or by another version.
TEST(BrickBytes, ContentsOfAnotherSizeAreRefused) {
  const std::string all = decompressed(to_bytes(small_part()));
  EXPECT_TRUE(refusal(compressed(all)).empty());
  for (std::size_t size = 0; size < all.size(); size += 7)
    EXPECT_NE(refusal(compressed(all.substr(0, size))).find("incomplete"), std::string::npos) << size;
  EXPECT_NE(refusal(compressed(all + '\0')).find("more data"), std::string::npos);
}

TEST(BrickBytes, AHugeCountIsRefusedBeforeMemoryIsTaken) {
  const std::string all = decompressed(to_bytes(small_part()));
  // The first vector's size follows the box, the halo and whether the surface was kept.
  const std::size_t at = sizeof(CellBox) + sizeof(int) + sizeof(bool);
  for (const std::size_t count :
       {std::size_t{1} << 30, std::size_t{1} << 60, std::numeric_limits<std::size_t>::max()}) {
    std::string damaged = all;
    std::memcpy(damaged.data() + at, &count, sizeof count);
    EXPECT_NE(refusal(compressed(damaged)).find("incomplete"), std::string::npos) << count;
  }
}

TEST(BrickBytes, AHugeSizeIsRefusedBeforeMemoryIsTaken) {
  const std::string bytes = to_bytes(small_part());
  for (const std::uint64_t size : {std::uint64_t{1} << 33, std::uint64_t{1} << 40, std::uint64_t{1} << 62}) {
    // The header of a frame in one segment with its size in eight bytes.
    std::string huge = bytes.substr(0, 4) + '\xe0' + std::string(8, '\0') + bytes.substr(8);
    std::memcpy(huge.data() + 5, &size, sizeof size);
    EXPECT_NE(refusal(huge).find("brick-7: the brick is damaged"), std::string::npos) << size;
  }
}

}  // namespace
}  // namespace tetwright::brick_bytes_test
