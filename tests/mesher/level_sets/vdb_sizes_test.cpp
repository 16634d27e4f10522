// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/vdb_sizes.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <limits>

#include "common/random.h"
#include "tests/common/small_meshes.h"
#include "tests/common/temporary_folder.h"
#include "tetwright/error.h"
#include "tetwright/files.h"

namespace tetwright::vdb_sizes_test {
namespace {

double linear(const Vec3& p) { return 64 + 2 * p.x() - 0.5 * p.y() + 0.25 * p.z(); }

/// Position of voxel (i, j, k) of the grids made here.
Vec3 world(double i, double j, double k) { return {10 + 0.5 * i, 20 - 0.5 * j, 30 + 0.25 * k + 0.5 * i}; }

/// Active from (-2, 0, 0) to (9, 9, 9), with the value linear() at each voxel.
template <class Grid = openvdb::FloatGrid>
typename Grid::Ptr linear_grid(const std::string& name) {
  const auto grid = Grid::create(1000);
  for (int i = -2; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      for (int k = 0; k < 10; ++k)
        grid->tree().setValue({i, j, k}, static_cast<typename Grid::ValueType>(linear(world(i, j, k))));
  grid->setName(name);
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  matrix.setRow(0, openvdb::Vec4d(0.5, 0, 0.5, 0));
  matrix.setRow(1, openvdb::Vec4d(0, -0.5, 0, 0));
  matrix.setRow(2, openvdb::Vec4d(0, 0, 0.25, 0));
  matrix.setRow(3, openvdb::Vec4d(10, 20, 30, 1));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  return grid;
}

class VdbSizes : public testing::Test {
 protected:
  VdbSizes() { openvdb::initialize(); }
  std::string written(const openvdb::GridPtrVec& grids) const {
    openvdb::io::File(folder_ / "a.vdb").write(grids);
    return folder_ / "a.vdb";
  }
  std::string message(const openvdb::GridPtrVec& grids) const {
    const std::string file = written(grids);
    try {
      (void)read_vdb_sizes(file);
    } catch (const InputError& e) {
      EXPECT_TRUE(std::string_view(e.what()).starts_with(file + ": ")) << e.what();
      return std::string(e.what()).substr(file.size() + 2);
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(VdbSizes, TrilinearBetweenVoxels) {
  for (const bool doubles : {false, true})
    for (const bool half : {false, true}) {
      openvdb::GridBase::Ptr grid = linear_grid("size");
      if (doubles) grid = linear_grid<openvdb::DoubleGrid>("size");
      grid->setSaveFloatAsHalf(half);
      const auto source = read_vdb_sizes(written({grid}));
      Random random(1);
      for (int i = 0; i < 300; ++i) {
        const Vec3 p = world(-2 + 11 * random.uniform(), 9 * random.uniform(), 9 * random.uniform());
        const auto wanted = source->at(p);
        ASSERT_TRUE(wanted);
        EXPECT_NEAR(wanted->length, linear(p), half ? 0.07 : 1e-5);
        EXPECT_EQ(wanted->distance, 0);
      }
    }
}

TEST_F(VdbSizes, NothingWhereAVoxelThatIsNeededIsInactive) {
  const auto grid = linear_grid("size");
  grid->tree().setValueOff({4, 4, 4}, 5);
  const auto source = read_vdb_sizes(written({grid}));
  EXPECT_FALSE(source->at(world(4, 4, 4)));
  EXPECT_FALSE(source->at(world(3.5, 4.5, 4.5)));
  EXPECT_FALSE(source->at(world(3.001, 4, 4)));
  ASSERT_TRUE(source->at(world(3, 4, 4)));
  EXPECT_TRUE(source->at(world(3, 4.5, 4.5)));
  // Up to the centres of the last voxels, except for rounding.
  EXPECT_TRUE(source->at(world(9, 9, 9)));
  EXPECT_TRUE(source->at(world(9 + 1e-9, 0 - 1e-9, 9)));
  EXPECT_FALSE(source->at(world(9.001, 9, 9)));
  EXPECT_FALSE(source->at(world(-2.001, 0, 0)));
  EXPECT_FALSE(source->at(world(1e300, 0, 0)));
  EXPECT_FALSE(source->at(Vec3::Constant(std::nan(""))));
}

TEST_F(VdbSizes, TilesAreTheirVoxels) {
  const auto grid = openvdb::FloatGrid::create(1);
  grid->tree().addTile(1, {0, 0, 0}, 3, true);
  grid->tree().addTile(1, {8, 0, 0}, 4, false);
  grid->tree().setValue({-1, 0, 0}, 5);
  const auto source = read_vdb_sizes(written({grid}));
  ASSERT_TRUE(source->at({6.5, 6.5, 6.5}));
  EXPECT_EQ(source->at({6.5, 6.5, 6.5})->length, 3);
  EXPECT_EQ(source->at({-0.5, 0, 0})->length, 4);
  EXPECT_FALSE(source->at({7.5, 0, 0}));
  std::vector<std::pair<Vec3, double>> values;
  source->for_each_value([&](const Vec3& p, double length) { values.emplace_back(p, length); });
  ASSERT_EQ(values.size(), 9u);
  double sum = 0, farthest = 0;
  for (const auto& [p, length] : values) {
    sum += length;
    farthest = std::max(farthest, p.minCoeff());
  }
  EXPECT_EQ(sum, 8 * 3 + 5);
  EXPECT_EQ(farthest, 7);
}

TEST_F(VdbSizes, WhichGrid) {
  const auto level_set = linear_grid("distances");
  level_set->setGridClass(openvdb::GRID_LEVEL_SET);
  const auto length = [&](const openvdb::GridPtrVec& grids) {
    return read_vdb_sizes(written(grids))->at(world(1, 1, 1))->length;
  };
  const auto constant = [](const std::string& name, float value) {
    const auto grid = linear_grid(name);
    for (auto v = grid->beginValueOn(); v; ++v) v.setValue(value);
    return grid;
  };
  EXPECT_EQ(length({level_set, constant("any", 2)}), 2);
  EXPECT_EQ(length({constant("h", 3), constant("any", 2), constant("sizing", 4)}), 4);
  EXPECT_EQ(length({openvdb::Int32Grid::create(), constant("any", 2)}), 2);
  level_set->setName("size");
  EXPECT_NEAR(length({constant("any", 2), level_set}), linear(world(1, 1, 1)), 1e-5);
  EXPECT_EQ(message({constant("a", 2), linear_grid<openvdb::DoubleGrid>("b")}),
            "has several grids that may be the edge length; there is 'a' (no class, float), 'b' (no class, "
            "double); name one 'size'");
  EXPECT_EQ(message({constant("h", 2), constant("h", 3)}), "has two grids called 'h'; rename one");
  level_set->setName("distances");
  EXPECT_EQ(message({level_set, openvdb::Int32Grid::create()}),
            "has no grid of edge lengths, of floats and no level set; there is 'distances' (level set, "
            "float), '' (no class, int32); name one 'size'");
  EXPECT_EQ(message({}),
            "has no grid of edge lengths, of floats and no level set; there is nothing in it; "
            "name one 'size'");
}

TEST_F(VdbSizes, ValuesMustBeAboveZero) {
  for (const float bad : {0.f, -0.25f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    const auto grid = linear_grid("size");
    grid->tree().setValue({2, 4, 8}, bad);
    const std::string text = message({grid});
    EXPECT_NE(text.find("at (11, 18, 33); an edge length must be a number above 0"), std::string::npos)
        << text;
    if (bad < 0) {
      EXPECT_TRUE(text.starts_with("the grid 'size' has the value -0.25 at")) << text;
    }
    grid->tree().setValueOff({2, 4, 8}, bad);
    EXPECT_EQ(message({grid}), "");
  }
  EXPECT_EQ(message({openvdb::FloatGrid::create(2)}),
            "the grid '' has no active voxel; set those active where a size is wanted");
}

TEST_F(VdbSizes, DamagedFiles) {
  for (const bool doubles : {false, true}) {
    openvdb::GridBase::Ptr grid = linear_grid("size");
    if (doubles) grid = linear_grid<openvdb::DoubleGrid>("size");
    const std::string whole = read_whole_file(written({grid})), file = folder_ / "damaged.vdb";
    for (std::size_t k = 0; k < 40; ++k) {
      put(file, whole.substr(0, whole.size() * k / 40));
      EXPECT_THROW((void)read_vdb_sizes(file), InputError) << k;
    }
    Random random(3);
    for (int k = 0; k < 200; ++k) {
      std::string bytes = whole;
      const auto reach =
          static_cast<double>(k % 2 ? bytes.size() : std::min<std::size_t>(1500, bytes.size()));
      for (int n = 0; n <= k % 3; ++n)
        bytes[static_cast<std::size_t>(random.uniform() * reach)] =
            static_cast<char>(static_cast<unsigned char>(random.uniform() * 256));
      put(file, bytes);
      try {
        (void)read_vdb_sizes(file)->at(world(1.5, 1.5, 1.5));
      } catch (const InputError&) {
      }
    }
  }
}

}  // namespace
}  // namespace tetwright::vdb_sizes_test
