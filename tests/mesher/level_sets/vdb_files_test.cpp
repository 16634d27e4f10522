// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher_input.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <map>

#include "common/random.h"
#include "mesher/level_sets/level_set.h"
#include "mesher/level_sets/vdb_writer.h"
#include "tests/common/temporary_folder.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/resources.h"

namespace tetwright::vdb_files_test {
namespace {

constexpr double ball_volume = 4.18879;  // of radius 1

class VdbFiles : public testing::Test {
 protected:
  VdbFiles() { openvdb::initialize(); }
  std::string path(const std::string& name) const { return folder_ / name; }

  /// Writes a sphere's level set with write_level_sets().
  void write_sphere(const std::string& file, const std::string& name, double radius, const Vec3& centre,
                    double cell) const {
    const TriangleMesh mesh = make_sphere(radius, centre, 5);
    RepairedSurface s;
    s.points = mesh.points;
    s.triangles = mesh.triangles;
    s.closed = s.triangles.size();
    const Vec3 low = centre - Vec3::Constant(radius), high = centre + Vec3::Constant(radius);
    const GridFrame frame = make_grid_frame(low, high, cell, false);
    const auto level_set = LevelSet::of_surface(s, frame, nullptr);
    const auto read = [&](const LeafOrigin& o, std::span<float, leaf_points> values) {
      LevelSetSampler sampler(*level_set);
      for (int k = 0; k < leaf_points; ++k)
        values[k] = static_cast<float>(sampler.at_node(o[0] + k / 64, o[1] + k / 8 % 8, o[2] + k % 8));
    };
    write_level_sets(file, frame, level_set_band,
                     std::vector<LevelSetSource>{{name, level_set->leaves(), read}});
  }

  void write_grids(const std::string& file, const openvdb::GridPtrVec& grids) const {
    openvdb::io::File(file).write(grids);
  }

  std::string message_of(const std::string& file) const {
    return message_of(file, [&] { read_level_sets(file); });
  }
  std::string label_message_of(const std::string& file) const {
    return message_of(file, [&] { read_label_grid(file); });
  }

 private:
  template <class Read>
  static std::string message_of(const std::string& file, const Read& read) {
    try {
      read();
    } catch (const InputError& e) {
      EXPECT_TRUE(std::string_view(e.what()).starts_with(file + ": ")) << e.what();
      EXPECT_EQ(std::string_view(e.what()).find('\n'), std::string_view::npos);
      return std::string(e.what()).substr(file.size() + 2);
    }
    return "";
  }

  TemporaryFolder folder_;
};

openvdb::FloatGrid::Ptr ball(const std::string& name, float radius = 10, float cell = 0.1f) {
  const auto grid = openvdb::FloatGrid::create(3 * cell);
  for (int x = -14; x <= 14; ++x)
    for (int y = -14; y <= 14; ++y)
      for (int z = -14; z <= 14; ++z) {
        const auto d = static_cast<float>(openvdb::Vec3d(x, y, z).length()) - radius;
        if (std::abs(d) < 3) grid->tree().setValue({x, y, z}, d * cell);
      }
  openvdb::tools::signedFloodFill(grid->tree());
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(cell));
  return grid;
}

void expect_ball(const TriangleMesh& mesh, double radius, const Vec3& centre) {
  for (const Vec3& p : mesh.points) EXPECT_NEAR((p - centre).norm(), radius, 0.02 * radius);
  EXPECT_NEAR(enclosed_volume(mesh), ball_volume * std::pow(radius, 3),
              0.03 * ball_volume * std::pow(radius, 3));
  std::map<std::pair<Index, Index>, int> balance;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  for (const auto& [edge, sum] : balance) EXPECT_EQ(sum, 0);
}

TEST_F(VdbFiles, WhatIsWrittenIsReadAgain) {
  const Vec3 centre(1000.5, -20, 3);
  write_sphere(path("a.vdb"), "bone marrow", 2, centre, 0.1);
  const auto back = read_level_sets(path("a.vdb"));
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].name, "bone marrow");
  expect_ball(back[0].surface, 2, centre);
}

TEST_F(VdbFiles, OtherProgramsReadWhatIsWritten) {
  write_sphere(path("a.vdb"), "bone", 2, Vec3(5, 6, 7), 0.1);
  openvdb::io::File file(path("a.vdb"));
  file.open(false);
  ASSERT_TRUE(file.hasGrid("bone"));
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("bone"));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_FLOAT_EQ(grid->background(), 0.3f);
  EXPECT_NEAR(grid->voxelSize()[0], 0.1, 1e-12);
  const auto at = [&](double x) {
    return grid->tree().getValue(openvdb::Coord::round(grid->worldToIndex({x, 6, 7})));
  };
  EXPECT_FLOAT_EQ(at(5), -0.3f);
  EXPECT_NEAR(at(7), 0, 0.06);
  EXPECT_FLOAT_EQ(at(8), 0.3f);
}

TEST_F(VdbFiles, TheSameBytesForAnyThreads) {
  std::string bytes[2];
  for (const unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    write_sphere(path("a.vdb"), "bone", 2, Vec3(5, 6, 7), 0.1);
    bytes[threads > 1] = read_whole_file(path("a.vdb"));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST_F(VdbFiles, SeveralAndOtherGridsBetween) {
  const auto fog = ball("fog");
  fog->setGridClass(openvdb::GRID_FOG_VOLUME);
  const auto unclassed = ball("no class");
  unclassed->setGridClass(openvdb::GRID_UNKNOWN);
  const auto mirrored = ball("mirrored");
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  matrix.preScale(openvdb::Vec3d(-0.2, 0.2, 0.2));
  matrix.postTranslate(openvdb::Vec3d(100, 0, 0));
  mirrored->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  write_grids(path("a.vdb"), {ball("b"), fog, openvdb::Int32Grid::create(), unclassed, mirrored});
  const auto back = read_level_sets(path("a.vdb"));
  ASSERT_EQ(back.size(), 3u);
  EXPECT_EQ(back[0].name, "b");
  EXPECT_EQ(back[1].name, "no class");
  expect_ball(back[0].surface, 1, Vec3::Zero());
  expect_ball(back[1].surface, 1, Vec3::Zero());
  expect_ball(back[2].surface, 2, Vec3(100, 0, 0));
}

TEST_F(VdbFiles, EveryCompression) {
  for (const std::uint32_t compression : {0u, 1u, 2u, 3u, 4u, 6u})
    for (const bool half : {false, true}) {
      const auto grid = ball("b");
      grid->setSaveFloatAsHalf(half);
      openvdb::io::File out(path("a.vdb"));
      out.setCompression(compression);
      out.write(openvdb::GridPtrVec{grid});
      out.close();
      const auto back = read_level_sets(path("a.vdb"));
      ASSERT_EQ(back.size(), 1u) << compression << ' ' << half;
      expect_ball(back[0].surface, 1, Vec3::Zero());
    }
}

TEST_F(VdbFiles, SaysWhatIsWrong) {
  const std::string file = path("a.vdb");
  write_file_atomically(file, "OFF\n3 1 0\n");
  EXPECT_EQ(message_of(file), "is not a .vdb file");
  write_file_atomically(file, "");
  EXPECT_EQ(message_of(file), "is not a .vdb file");
  write_grids(file, {});
  EXPECT_EQ(message_of(file),
            "has no level set of floats and no grid of whole numbers; there is nothing in it");

  const auto fog = ball("density");
  fog->setGridClass(openvdb::GRID_FOG_VOLUME);
  const auto labels = openvdb::Int32Grid::create();
  labels->setName("labels");
  const auto doubles = openvdb::GridBase::createGrid("Tree_double_5_4_3");
  doubles->setName("precise");
  doubles->setGridClass(openvdb::GRID_LEVEL_SET);
  const auto velocity = openvdb::GridBase::createGrid("Tree_vec3s_5_4_3");
  velocity->setName("v");
  const auto one_sided = openvdb::FloatGrid::create(1);
  one_sided->setName("mask");
  write_grids(file, {fog, labels, doubles, velocity, one_sided});
  EXPECT_EQ(
      message_of(file),
      "has no level set of floats; there is density (fog volume, float), labels (no class, int32), precise "
      "(level set, double), v (no class, vec3s), mask (no class, float)");

  const auto empty = openvdb::FloatGrid::create(1);
  empty->setName("gone");
  empty->setGridClass(openvdb::GRID_LEVEL_SET);
  write_grids(file, {ball("b"), empty});
  EXPECT_EQ(message_of(file), "the level set 'gone' is empty: its values do not cross 0; remove it");
  write_grids(file, {ball("b"), ball("b", 5)});
  EXPECT_EQ(message_of(file), "has two level sets called 'b'; rename one");

  EXPECT_THROW(read_level_sets(path("missing.vdb")), InputError);
}

/// The file with one to three bytes changed; for even k at the start, which holds names, counts and the
/// transform.
std::string damaged(std::string bytes, int k, Random& random) {
  const std::size_t reach = k % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 1500);
  for (int n = 0; n <= k % 3; ++n)
    bytes[static_cast<std::size_t>(random.uniform() * static_cast<double>(reach))] =
        static_cast<char>(static_cast<unsigned char>(random.uniform() * 256));
  return bytes;
}

// Truncated anywhere and with bytes changed at random: an error or a surface, no crash.
TEST_F(VdbFiles, DamagedFiles) {
  write_grids(path("a.vdb"), {ball("b")});
  const std::string whole = read_whole_file(path("a.vdb"));
  const std::string file = path("damaged.vdb");
  for (std::size_t k = 0; k < 60; ++k) {
    put(file, whole.substr(0, whole.size() * k / 60));
    EXPECT_THROW(read_level_sets(file), InputError) << k;
  }
  Random random(5);
  for (int k = 0; k < 300; ++k) {
    put(file, damaged(whole, k, random));
    try {
      read_level_sets(file);
    } catch (const InputError&) {
    }
  }
}

/// Labels i + 10 j + 100 k at the indices (-2, 5, 100) to (1, 7, 101), and an inactive 7 beyond.
template <class Grid>
typename Grid::Ptr label_grid(const std::string& name) {
  const auto grid = Grid::create(-1);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 2; ++k) grid->tree().setValue({i - 2, j + 5, k + 100}, i + 10 * j + 100 * k);
  grid->tree().setValueOff({0, 6, 100}, 77);
  grid->tree().setValueOff({1, 6, 100}, -1);
  grid->tree().setValueOff({5, 5, 100}, 7);
  grid->setName(name);
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  matrix.setRow(0, openvdb::Vec4d(0, 2, 0, 0));
  matrix.setRow(1, openvdb::Vec4d(1, 0, 0.5, 0));
  matrix.setRow(2, openvdb::Vec4d(0, 0, 3, 0));
  matrix.setRow(3, openvdb::Vec4d(10, 20, 30, 1));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  return grid;
}

void expect_labels(const std::optional<LabelVolume>& volume) {
  ASSERT_TRUE(volume);
  EXPECT_EQ(volume->size, (std::array<int, 3>{4, 3, 2}));
  std::vector<MaterialTag> expected;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) expected.push_back(i + 10 * j + 100 * k);
  expected[6] = 77, expected[7] = -1;
  EXPECT_EQ(volume->labels, expected);
  EXPECT_EQ(volume->directions.col(0), Vec3(0, 2, 0));
  EXPECT_EQ(volume->directions.col(1), Vec3(1, 0, 0.5));
  EXPECT_EQ(volume->directions.col(2), Vec3(0, 0, 3));
  EXPECT_LT((volume->origin - Vec3(15, 16, 332.5)).norm(), 1e-12);
  EXPECT_EQ(volume->space, "");
}

TEST_F(VdbFiles, LabelsOfWholeNumbers) {
  for (const std::uint32_t compression : {0u, 1u, 2u, 3u, 4u, 6u})
    for (const bool half : {false, true}) {
      const auto write = [&](const openvdb::GridBase::Ptr& grid) {
        grid->setSaveFloatAsHalf(half);
        openvdb::io::File out(path("a.vdb"));
        out.setCompression(compression);
        out.write(openvdb::GridPtrVec{grid});
      };
      write(label_grid<openvdb::Int32Grid>("labels"));
      expect_labels(read_label_grid(path("a.vdb")));
      write(label_grid<openvdb::Int64Grid>("labels"));
      expect_labels(read_label_grid(path("a.vdb")));
    }
}

TEST_F(VdbFiles, TilesOfLabels) {
  const auto grid = openvdb::Int32Grid::create(0);
  grid->tree().addTile(1, {0, 0, 0}, 3, true);       // 8 voxels along each side
  grid->tree().addTile(1, {8, 0, 0}, 4, false);      // inactive, but within the bounding box
  grid->tree().addTile(2, {128, 0, 0}, 5, true);     // 128 voxels
  grid->tree().addTile(3, {-4096, 0, 0}, 6, false);  // outside the active bounding box
  write_grids(path("a.vdb"), {grid});
  const auto volume = read_label_grid(path("a.vdb"));
  ASSERT_TRUE(volume);
  EXPECT_EQ(volume->size, (std::array<int, 3>{256, 128, 128}));
  EXPECT_EQ(volume->origin, Vec3::Zero());
  std::map<MaterialTag, std::size_t> counts;
  for (const MaterialTag label : volume->labels) ++counts[label];
  EXPECT_EQ(counts[3], 512u);
  EXPECT_EQ(counts[4], 512u);
  EXPECT_EQ(counts[5], std::size_t{1} << 21);
  EXPECT_EQ(counts[6], 0u);
}

TEST_F(VdbFiles, ALevelSetComesBeforeLabels) {
  const std::string file = path("a.vdb");
  const auto labels = label_grid<openvdb::Int32Grid>("labels");
  write_grids(file, {labels, ball("b")});
  EXPECT_FALSE(read_label_grid(file));
  EXPECT_EQ(read_level_sets(file).size(), 1u);
  // Labels are ignored even if they are unusable.
  labels->setTransform(
      openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 10));
  write_grids(file, {labels, ball("b")});
  EXPECT_FALSE(read_label_grid(file));
  EXPECT_EQ(read_level_sets(file).size(), 1u);
  const auto fog = ball("fog");
  fog->setGridClass(openvdb::GRID_FOG_VOLUME);
  write_grids(file, {fog});
  EXPECT_FALSE(read_label_grid(file));
  write_grids(file, {fog, label_grid<openvdb::Int32Grid>("labels")});
  expect_labels(read_label_grid(file));
}

TEST_F(VdbFiles, SaysWhatIsWrongWithLabels) {
  const std::string file = path("a.vdb");
  const auto labels = label_grid<openvdb::Int32Grid>("a");
  write_grids(file, {labels, label_grid<openvdb::Int64Grid>("b")});
  EXPECT_EQ(label_message_of(file), "has 2 grids of whole numbers, 'a', 'b'; keep the one of the labels");
  write_grids(file, {openvdb::Int32Grid::create(4)});
  EXPECT_EQ(label_message_of(file), "the grid '' has no active voxel; set those of the volume active");
  const auto large = label_grid<openvdb::Int32Grid>("large");
  large->tree().addTile(3, {4096, 0, 0}, 3, true);
  write_grids(file, {large});
  EXPECT_NE(label_message_of(file).find("more than 2147483648;"), std::string::npos);
  const auto wide = label_grid<openvdb::Int64Grid>("wide");
  wide->tree().setValue({0, 5, 100}, std::int64_t{1} << 31);
  write_grids(file, {wide});
  EXPECT_EQ(
      label_message_of(file),
      "the grid 'wide' has the value 2147483648, which is not a 32-bit label; number the labels from 0");
  labels->setTransform(
      openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 10));
  write_grids(file, {labels});
  EXPECT_NE(label_message_of(file).find("frustum"), std::string::npos);
  EXPECT_THROW(read_label_grid(path("missing.vdb")), InputError);
}

// As for level sets.
TEST_F(VdbFiles, DamagedLabels) {
  // Distant voxels that damage makes active are refused before memory is allocated for them.
  constexpr std::size_t max_voxels = 1 << 20;
  const std::string file = path("damaged.vdb");
  for (const std::uint32_t compression : {0u, 2u, 3u, 6u}) {
    {
      openvdb::io::File out(path("a.vdb"));
      out.setCompression(compression);
      const auto grid = openvdb::Int32Grid::create(0);
      for (int i = 0; i < 20; ++i) grid->tree().setValue({i, i % 7, i % 3}, i);
      grid->setName("labels");
      out.write(openvdb::GridPtrVec{grid});
    }
    const std::string whole = read_whole_file(path("a.vdb"));
    const std::size_t step = std::max<std::size_t>(3, whole.size() / 200);
    for (std::size_t length = 0; length < whole.size(); length += step) {
      put(file, whole.substr(0, length));
      EXPECT_THROW(read_label_grid(file, max_voxels), InputError) << compression << ' ' << length;
    }
    Random random(compression);
    for (int k = 0; k < 200; ++k) {
      put(file, damaged(whole, k, random));
      try {
        read_label_grid(file, max_voxels);
      } catch (const InputError&) {
      }
    }
  }
}

TEST_F(VdbFiles, CannotBeWritten) {
  EXPECT_THROW(write_sphere(path("missing/a.vdb"), "b", 1, Vec3::Zero(), 0.1), OutputError);
  EXPECT_THROW(write_sphere(path("a.vdb"), "b", 1e-5, Vec3::Zero(), 1e-6), OutputError);
}

}  // namespace
}  // namespace tetwright::vdb_files_test
