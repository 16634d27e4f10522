// SPDX-License-Identifier: Apache-2.0
#include "tetwright/label_source.h"

#include "tests/common/io/volume_boxes.h"
#include "tetwright/resources.h"

namespace tetwright::label_source_test {
namespace {

TEST(LabelSource, VolumesInMemoryServeTheirLabels) {
  LabelVolume volume = numbered_volume({7, 5, 9});
  volume.names[3] = "bone";
  const MemoryLabelSource source(volume);
  EXPECT_TRUE(source.in_memory());
  EXPECT_EQ(source.grid().names.at(3), "bone");
  expect_labels(source, volume);
}

/// Labels that follow from the position of a voxel; those from `first_bad` on fail.
class ComputedSource final : public LabelSource {
 public:
  ComputedSource(const VoxelIndex& size, const VoxelIndex& block, int first_bad,
                 std::size_t decoding_bytes = 0)
      : LabelSource(grid_of(size)), block_(block), first_bad_(first_bad), decoding_bytes_(decoding_bytes) {}
  VoxelIndex block() const override { return block_; }
  std::size_t decoding_bytes() const override { return decoding_bytes_; }

 protected:
  void read_box(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const override {
    auto to = out.begin();
    for (int z = low[2]; z < high[2]; ++z) {
      if (z >= first_bad_) throw InputError("slice " + std::to_string(z));
      for (int y = low[1]; y < high[1]; ++y)
        for (int x = low[0]; x < high[0]; ++x) *to++ = x ^ y ^ z;
    }
  }

 private:
  static LabelGrid grid_of(const VoxelIndex& size) {
    LabelGrid grid;
    grid.size = size;
    return grid;
  }
  VoxelIndex block_;
  int first_bad_;
  std::size_t decoding_bytes_;
};

TEST(LabelSource, BlocksOfAnyShapeFillTheVolume) {
  const VoxelIndex size{150, 170, 190};
  for (const VoxelIndex& block : {VoxelIndex{1, 1, 1},
                                  {64, 64, 64},
                                  {150, 170, 1},
                                  {150, 1, 1},
                                  {1, 170, 190},
                                  {1000, 1000, 1000},
                                  {7, 2000, 3}}) {
    const LabelVolume volume = read_all(ComputedSource(size, block, size[2]), "f");
    std::size_t i = 0, wrong = 0;
    for (int z = 0; z < size[2]; ++z)
      for (int y = 0; y < size[1]; ++y)
        for (int x = 0; x < size[0]; ++x) wrong += volume.labels[i++] != (x ^ y ^ z);
    EXPECT_EQ(wrong, 0u);
  }
}

TEST(LabelSource, TheFirstErrorIsReportedForAnyNumberOfThreads) {
  for (const unsigned threads : {1u, 2u, 8u}) {
    const ThreadLimit limit(threads);
    for (int i = 0; i < 20; ++i)
      EXPECT_EQ(error_of<InputError>([&] {
                  (void)read_all(ComputedSource({512, 512, 40}, {512, 512, 1}, 9), "f");
                }),
                "slice 9");
  }
}

TEST(LabelSource, VolumesThatAreTooLargeForMemoryAreRefused) {
  const ComputedSource huge({2147483647, 2147483647, 4}, {64, 64, 64}, 4);
  EXPECT_EQ(huge.grid().voxels(), 4 * std::uint64_t{2147483647} * 2147483647);
  std::vector<MaterialTag> labels(2 * 3 * 4);
  huge.read({2147483645, 2147483644, 0}, {2147483647, 2147483647, 4}, labels);
  EXPECT_EQ(labels[0], 2147483645 ^ 2147483644);
  EXPECT_NE(error_of<InputError>([&] { (void)read_all(huge, "f"); }).find("more than 2147483648"),
            std::string::npos);
  const MemoryLimit limit(1e6);
  EXPECT_NE(error_of<OutputError>([&] {
              (void)read_all(ComputedSource({100, 100, 100}, {9, 9, 9}, 100), "f");
            }).find("the labels of f would take"),
            std::string::npos);
}

TEST(LabelSource, BlocksOfAllThreadsAreCountedAgainstTheMemory) {
  const MemoryLimit limit(2e8);
  // 42 MB of labels in five boxes.
  const ComputedSource source({512, 512, 40}, {512, 512, 1}, 40, 50000000);
  for (const unsigned threads : {1u, 3u}) {
    const ThreadLimit threads_limit(threads);
    EXPECT_EQ(read_all(source, "f").labels.size(), source.grid().voxels());
  }
  const ThreadLimit threads_limit(8);
  const std::string message = error_of<OutputError>([&] { (void)read_all(source, "f"); });
  EXPECT_NE(message.find("the labels of f and the blocks that 5 threads decode at a time would take"),
            std::string::npos)
      << message;
  // Boxes that are copied count, too: 8 MB for each thread, beside 160 MB of labels.
  EXPECT_NE(error_of<OutputError>([&] {
              (void)read_all(ComputedSource({400, 400, 250}, {128, 128, 128}, 250), "f");
            }).find("8 threads decode"),
            std::string::npos);
}

}  // namespace
}  // namespace tetwright::label_source_test
