// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/voxel_contacts.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <span>

#include "mesher/tuning/input_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// The contacts of a range of slices, found voxel by voxel.
class ContactFinder {
 public:
  explicit ContactFinder(const RegionGrid& regions)
      : regions_(regions),
        width_(static_cast<std::size_t>(regions.size()[0])),
        rows_(static_cast<std::size_t>(regions.size()[1])),
        here_(width_ * rows_),
        above_(width_ * rows_) {}

  /// Contacts of the voxels of slice `z` among each other and with those of the next one.
  void add_slice(int z) {
    const bool last = z + 1 == regions_.size()[2];
    if (read_ == z)
      std::swap(here_, above_);
    else
      regions_.read_slices(z, z + 1, here_);
    if (!last) {
      regions_.read_slices(z + 1, z + 2, above_);
      read_ = z + 1;
    }
    const std::uint64_t first_voxel = static_cast<std::uint64_t>(z) * rows_ * width_;
    for (std::size_t y = 0; y < rows_; ++y) {
      const RegionIndex* const row = here_.data() + y * width_;
      const std::uint64_t voxel = first_voxel + y * width_;
      along_row(row, voxel);
      if (y + 1 < rows_) with_row(row, row + width_, voxel, true);
      if (last) continue;
      const RegionIndex* const next = above_.data() + y * width_;
      with_row(row, next, voxel, true);
      if (y > 0) with_row(row, next - width_, voxel, false);
      if (y + 1 < rows_) with_row(row, next + width_, voxel, false);
    }
  }

  const std::map<std::pair<RegionIndex, RegionIndex>, VoxelContact>& found() const { return found_; }

 private:
  void along_row(const RegionIndex* row, std::uint64_t voxel) {
    for (std::size_t x = 0; x + 1 < width_; ++x)
      if (row[x] != row[x + 1]) add(row[x], row[x + 1], voxel + x, 1);
  }

  /// \param faces whether the rows share faces
  void with_row(const RegionIndex* row, const RegionIndex* other, std::uint64_t voxel, bool faces) {
    // Most rows and their neighbours are in one region.
    const std::size_t bytes = width_ * sizeof(RegionIndex);
    const bool same = std::memcmp(row, other, bytes) == 0;
    if (same && (width_ == 1 || std::memcmp(row, row + 1, bytes - sizeof(RegionIndex)) == 0)) return;
    for (std::size_t x = 0; x < width_; ++x) {
      const RegionIndex region = row[x];
      if (other[x] != region) add(region, other[x], voxel + x, faces ? 1 : 0);
      if (x > 0 && other[x - 1] != region) add(region, other[x - 1], voxel + x, 0);
      if (x + 1 < width_ && other[x + 1] != region) add(region, other[x + 1], voxel + x, 0);
    }
  }

  void add(RegionIndex a, RegionIndex b, std::uint64_t voxel, std::uint64_t faces) {
    if (a > b) std::swap(a, b);
    // Voxels beside each other mostly have the same pair.
    if (!last_ || last_->first != a || last_->second != b)
      last_ = &found_.try_emplace({a, b}, VoxelContact{a, b, 0, voxel}).first->second;
    last_->faces += faces;
  }

  const RegionGrid& regions_;
  const std::size_t width_, rows_;
  std::vector<RegionIndex> here_, above_;
  int read_ = -1;  ///< slice in `above_`
  std::map<std::pair<RegionIndex, RegionIndex>, VoxelContact> found_;
  VoxelContact* last_ = nullptr;
};

}  // namespace

std::vector<VoxelContact> voxel_contacts(const RegionGrid& regions, const Progress* progress) {
  const auto slices = static_cast<std::size_t>(regions.size()[2]);
  constexpr std::size_t at_a_time = InputGrains::slices;
  std::vector<std::vector<VoxelContact>> parts((slices + at_a_time - 1) / at_a_time);
  parallel_for(0, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      if (progress) progress->throw_if_stopped();
      ContactFinder own(regions);
      for (std::size_t z = part * at_a_time; z < std::min(slices, (part + 1) * at_a_time); ++z)
        own.add_slice(static_cast<int>(z));
      for (const auto& [pair, contact] : own.found()) parts[part].push_back(contact);
    }
  });
  std::map<std::pair<RegionIndex, RegionIndex>, VoxelContact> all;
  for (const std::vector<VoxelContact>& part : parts)
    for (const VoxelContact& contact : part) {
      const auto [sum, is_new] = all.try_emplace({contact.first, contact.second}, contact);
      if (!is_new) sum->second.faces += contact.faces;
    }
  std::vector<VoxelContact> contacts;
  contacts.reserve(all.size());
  for (const auto& [pair, contact] : all) contacts.push_back(contact);
  return contacts;
}

}  // namespace tetwright
