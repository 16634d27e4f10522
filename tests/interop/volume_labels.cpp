// SPDX-License-Identifier: Apache-2.0

// Writes the labels of a segmented volume as numbers of 32 bits, the first axis fastest, and prints its size,
// spacing and origin, and whether it is in memory: volume_labels FILE OUT. The labels are read in boxes that
// do not match the blocks of the file, with a cache of 64 kB, by several threads.
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/resources.h"

namespace {

using namespace tetwright;

constexpr VoxelIndex box{37, 23, 11};

void write_labels(const std::string& file, const std::string& out) {
  const auto source = open_label_source(file, {.cache_bytes = 1 << 16});
  const LabelGrid& grid = source->grid();
  std::vector<MaterialTag> labels(grid.voxels());
  const auto index = [&](int x, int y, int z) {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(grid.size[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(grid.size[0]) +
           static_cast<std::size_t>(x);
  };
  std::vector<VoxelIndex> corners;
  for (int z = 0; z < grid.size[2]; z += box[2])
    for (int y = 0; y < grid.size[1]; y += box[1])
      for (int x = 0; x < grid.size[0]; x += box[0]) corners.push_back({x, y, z});
  parallel_chunks(corners.size(), [&](std::size_t i, unsigned /*worker*/) {
    const VoxelIndex low = corners[i];
    VoxelIndex high;
    std::size_t n = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      high[k] = std::min(low[k] + box[k], grid.size[k]);
      n *= static_cast<std::size_t>(high[k] - low[k]);
    }
    std::vector<MaterialTag> part(n);
    source->read(low, high, part);
    auto from = part.begin();
    for (int z = low[2]; z < high[2]; ++z)
      for (int y = low[1]; y < high[1]; ++y, from += high[0] - low[0])
        std::copy_n(from, high[0] - low[0],
                    labels.begin() + static_cast<std::ptrdiff_t>(index(low[0], y, z)));
  });
  std::ofstream(out, std::ios::binary)
      .write(reinterpret_cast<const char*>(labels.data()),
             static_cast<std::streamsize>(labels.size() * sizeof(MaterialTag)));
  for (const int n : grid.size) std::printf("%d ", n);
  for (int k = 0; k < 3; ++k) std::printf("%.9g ", grid.directions(k, k));
  for (int k = 0; k < 3; ++k) std::printf("%.9g ", grid.origin[k]);
  std::printf("%d\n", source->in_memory() ? 1 : 0);
}

void count_labels(const std::string& file) {
  const auto source = open_label_source(file, {.cache_bytes = 1 << 16});
  const VoxelIndex block = source->block(), size = source->grid().size;
  std::uint64_t labelled = 0;
  for (int z = 0; z < size[2]; z += block[2])
    for (int y = 0; y < size[1]; y += block[1])
      for (int x = 0; x < size[0]; x += block[0]) {
        const VoxelIndex high{std::min(x + block[0], size[0]), std::min(y + block[1], size[1]),
                              std::min(z + block[2], size[2])};
        std::vector<MaterialTag> labels(static_cast<std::size_t>(high[0] - x) *
                                        static_cast<std::size_t>(high[1] - y) *
                                        static_cast<std::size_t>(high[2] - z));
        source->read({x, y, z}, high, labels);
        labelled += static_cast<std::uint64_t>(
            std::count_if(labels.begin(), labels.end(), [](MaterialTag label) { return label != 0; }));
      }
  std::printf("%d %d %d voxels, %llu labelled\n", size[0], size[1], size[2],
              static_cast<unsigned long long>(labelled));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return 2;
  try {
    if (argc == 3)
      write_labels(argv[1], argv[2]);
    else
      count_labels(argv[1]);
  } catch (const tetwright::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
