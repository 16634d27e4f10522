// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/connected_components.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <queue>
#include <span>

#include "common/mesh/disjoint_sets.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

/// The islands of a volume, as sets of runs: consecutive equal voxels along the first axis. Runs are numbered
/// in the order of their voxels, so the first run of an island contains its lowest voxel.
class Islands {
 public:
  Islands(std::vector<RegionIndex>& regions, const std::array<int, 3>& size, const Progress* progress)
      : regions_(regions),
        width_(static_cast<std::size_t>(size[0])),
        plane_(width_ * static_cast<std::size_t>(size[1])),
        progress_(progress),
        starts_(find_runs()),
        sets_(starts_.size() - 1) {
    unite_neighbours();
    count_voxels();
  }

  std::size_t islands() const { return islands_; }
  Index largest() const { return largest_; }
  std::vector<MergedIsland> merge(Index min_voxels);
  /// The number of islands of each region, without islands of the outside that reach the border.
  std::vector<std::size_t> parts(std::size_t regions, std::vector<Index>* smallest = nullptr);
  /// Unites islands of one region that touch in an edge or a corner.
  void unite_touching();

 private:
  using Span = std::pair<std::size_t, std::size_t>;  ///< voxels from first to before second

  std::vector<Index> find_runs() const;
  void unite_neighbours();
  void unite_across(std::size_t begin, std::size_t end, std::size_t shift);
  void unite_rows(std::size_t here, std::size_t there);
  void count_voxels();
  bool at_border(Index run) const;
  void enlarge_outside(Index min_voxels);
  void list_small(Index min_voxels);
  void collect_runs(Index island);
  RegionIndex max_shared();
  void join(Index a, Index b, Index min_voxels);
  void throw_if_stopped() const {
    if (progress_) progress_->throw_if_stopped();
  }

  Index runs() const { return static_cast<Index>(starts_.size() - 1); }
  Index run_of(std::size_t voxel) const {
    return static_cast<Index>(std::upper_bound(starts_.begin(), starts_.end(), voxel) - starts_.begin() - 1);
  }
  RegionIndex& region_of(Index run) const { return regions_[starts_[run]]; }

  /// Calls `body(begin, end)` for the ranges of voxels that share a face with the run: one voxel beyond each
  /// end, then the adjacent range in each neighbouring row.
  template <class Body>
  void for_each_contact(Index run, Body&& body) const {
    const std::size_t begin = starts_[run], end = starts_[run + 1];
    if (begin % width_ != 0) body(begin - 1, begin);
    if (end % width_ != 0) body(end, end + 1);
    const std::size_t in_plane = begin % plane_;
    if (in_plane >= width_) body(begin - width_, end - width_);
    if (in_plane + width_ < plane_) body(begin + width_, end + width_);
    if (begin >= plane_) body(begin - plane_, end - plane_);
    if (begin + plane_ < regions_.size()) body(begin + plane_, end + plane_);
  }

  std::vector<RegionIndex>& regions_;
  std::size_t width_, plane_;  ///< voxels of a row and of a plane
  const Progress* progress_;
  std::vector<Index> starts_;  ///< first voxel of each run, then the number of voxels
  DisjointSets sets_;          ///< of runs
  std::vector<Index> voxels_;  ///< at the root of each island
  std::size_t islands_ = 0;
  Index largest_ = 0;
  std::vector<Index> next_;              ///< another run of the same small island, in a ring
  std::vector<Index> small_;             ///< roots of small islands, ascending
  std::vector<Index> island_runs_;       ///< of the island being merged
  std::vector<std::size_t> faces_;       ///< by region, 0 between uses
  std::vector<RegionIndex> neighbours_;  ///< regions with faces
};

std::vector<Index> Islands::find_runs() const {
  const std::size_t rows = regions_.size() / width_;
  const std::size_t rows_at_once = std::max<std::size_t>(1, (1 << 16) / width_);
  std::vector<Index> starts =
      parallel_collect<Index>(0, rows, rows_at_once, [&](std::size_t begin, std::size_t end, auto& out) {
        throw_if_stopped();
        for (std::size_t row = begin; row < end; ++row) {
          const RegionIndex* const r = regions_.data() + row * width_;
          out.push_back(static_cast<Index>(row * width_));
          for (std::size_t x = 1; x < width_; ++x)
            if (r[x] != r[x - 1]) out.push_back(static_cast<Index>(row * width_ + x));
        }
      });
  starts.push_back(static_cast<Index>(regions_.size()));
  return starts;
}

/// Unites the runs of the voxels in [begin, end), which are whole rows, with the runs `shift` voxels before
/// them.
void Islands::unite_across(std::size_t begin, std::size_t end, std::size_t shift) {
  if (begin >= end) return;
  Index here = run_of(begin), there = run_of(begin - shift);
  while (starts_[here] < end) {
    if (region_of(here) == region_of(there)) sets_.unite(here, there);
    const std::size_t here_end = starts_[here + 1], there_end = starts_[there + 1] + shift;
    if (here_end <= there_end) ++here;
    if (there_end <= here_end) ++there;
  }
}

void Islands::unite_neighbours() {
  const std::size_t planes = regions_.size() / plane_;
  const std::size_t slabs = std::min<std::size_t>(planes, 4 * thread_count());
  const auto slab_begin = [&](std::size_t slab) { return slab * planes / slabs; };
  // The smaller root wins, so slabs are independent until they are joined.
  parallel_for(0, slabs, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t slab = first; slab < last; ++slab)
      for (std::size_t z = slab_begin(slab); z < slab_begin(slab + 1); ++z) {
        throw_if_stopped();
        unite_across(z * plane_ + width_, (z + 1) * plane_, width_);
        if (z > slab_begin(slab)) unite_across(z * plane_, (z + 1) * plane_, plane_);
      }
  });
  for (std::size_t slab = 1; slab < slabs; ++slab)
    unite_across(slab_begin(slab) * plane_, (slab_begin(slab) + 1) * plane_, plane_);
}

void Islands::count_voxels() {
  voxels_.assign(runs(), 0);
  for (Index run = 0; run < runs(); ++run) {
    const Index root = sets_.root(run);
    islands_ += root == run;
    voxels_[root] += starts_[run + 1] - starts_[run];
    largest_ = std::max(largest_, voxels_[root]);
  }
}

/// Finds the small islands and links the runs of each.
void Islands::list_small(Index min_voxels) {
  next_.resize(runs());
  for (Index run = 0; run < runs(); ++run) {
    const Index root = sets_.root(run);
    if (root != run) {
      next_[run] = next_[root];
      next_[root] = run;
      continue;
    }
    next_[run] = run;
    if (voxels_[run] < min_voxels) small_.push_back(run);
  }
}

void Islands::collect_runs(Index island) {
  island_runs_.clear();
  Index run = island;
  do island_runs_.push_back(run);
  while ((run = next_[run]) != island);
}

/// The other region that shares most voxel faces with the island whose runs were collected.
RegionIndex Islands::max_shared() {
  const RegionIndex own = region_of(island_runs_[0]);
  neighbours_.clear();
  for (Index run : island_runs_)
    for_each_contact(run, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        if (const RegionIndex r = regions_[v]; r != own && faces_[r]++ == 0) neighbours_.push_back(r);
    });
  // The voxels around the island are in other regions, and the island is not the whole volume, since another
  // island is larger.
  TETWRIGHT_CHECK(!neighbours_.empty());
  RegionIndex best = neighbours_[0];
  for (RegionIndex r : neighbours_)
    if (faces_[r] > faces_[best] || (faces_[r] == faces_[best] && r < best)) best = r;
  for (RegionIndex r : neighbours_) faces_[r] = 0;
  return best;
}

void Islands::join(Index a, Index b, Index min_voxels) {
  a = sets_.root(a);
  b = sets_.root(b);
  if (a == b) return;
  const auto total = static_cast<Index>(
      std::min<std::uint64_t>(std::uint64_t{voxels_[a]} + voxels_[b], std::numeric_limits<Index>::max()));
  // Swapping successors joins two rings. Large islands need no ring.
  if (total < min_voxels) std::swap(next_[a], next_[b]);
  sets_.unite(a, b);
  voxels_[sets_.root(a)] = total;
}

/// Axes with a single voxel have no border, since a slice is an image.
bool Islands::at_border(Index run) const {
  const std::size_t begin = starts_[run], end = starts_[run + 1], voxels = regions_.size();
  const std::size_t in_plane = begin % plane_;
  return (width_ > 1 && (begin % width_ == 0 || end % width_ == 0)) ||
         (plane_ > width_ && (in_plane < width_ || in_plane + width_ >= plane_)) ||
         (voxels > plane_ && (begin < plane_ || begin + plane_ >= voxels));
}

/// Counts islands of the outside that touch the border as large: they continue beyond it.
void Islands::enlarge_outside(Index min_voxels) {
  for (Index run = 0; run < runs(); ++run) {
    if (region_of(run) != outside_region || !at_border(run)) continue;
    Index& voxels = voxels_[sets_.root(run)];
    voxels = std::max(voxels, min_voxels);
  }
}

std::vector<MergedIsland> Islands::merge(Index min_voxels) {
  enlarge_outside(min_voxels);
  list_small(min_voxels);
  std::vector<MergedIsland> merged;
  merged.reserve(small_.size());
  for (Index island : small_) {
    const RegionIndex region = region_of(island);
    merged.push_back({starts_[island], voxels_[island], region, region});
  }
  faces_.assign(on_interface + std::size_t{1}, 0);

  // The smallest island is on top; ties go to the lowest voxel.
  using Entry = std::pair<Index, Index>;  // voxels, island
  std::vector<Entry> entries;
  entries.reserve(small_.size());
  for (Index island : small_) entries.emplace_back(voxels_[island], island);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue({}, std::move(entries));
  for (std::size_t step = 0; !queue.empty(); ++step) {
    if (step % 4096 == 0) throw_if_stopped();
    const auto [count, island] = queue.top();
    queue.pop();
    // Skip an island that has grown since it was queued or was merged into another one.
    if (!sets_.is_root(island) || voxels_[island] != count) continue;
    collect_runs(island);
    const RegionIndex region = max_shared();
    for (Index run : island_runs_)
      std::fill(regions_.begin() + starts_[run], regions_.begin() + starts_[run + 1], region);
    // The smallest island comes first, so it never joins a smaller one and its size at least doubles. A voxel
    // is therefore visited at most log2(min_voxels) times.
    for (Index run : island_runs_)
      for_each_contact(run, [&](std::size_t begin, std::size_t end) {
        for (Index other = run_of(begin); starts_[other] < end; ++other)
          if (region_of(other) == region) join(run, other, min_voxels);
      });
    const Index root = sets_.root(island);
    if (region == outside_region &&
        std::any_of(island_runs_.begin(), island_runs_.end(), [&](Index run) { return at_border(run); }))
      voxels_[root] = std::max(voxels_[root], min_voxels);
    if (voxels_[root] < min_voxels) queue.emplace(voxels_[root], root);
  }
  for (MergedIsland& m : merged) m.to = regions_[m.voxel];
  std::erase_if(merged, [](const MergedIsland& m) { return m.from == m.to; });
  return merged;
}

std::vector<std::size_t> Islands::parts(std::size_t regions, std::vector<Index>* smallest) {
  // The mesh of a slice ends above and below it, and so does the outside.
  const bool slice = width_ == 1 || plane_ == width_ || regions_.size() == plane_;
  std::vector<std::uint8_t> reaches_border(runs(), 0);
  for (Index run = 0; run < runs(); ++run)
    if (region_of(run) == outside_region && (slice || at_border(run))) reaches_border[sets_.root(run)] = 1;
  std::vector<std::size_t> parts(regions, 0);
  std::vector<Index> min_sizes(regions, no_index);  // voxels
  for (Index run = 0; run < runs(); ++run) {
    if (!sets_.is_root(run) || reaches_border[run]) continue;
    const RegionIndex region = region_of(run);
    ++parts[region];
    if (!smallest || voxels_[run] >= min_sizes[region]) continue;
    min_sizes[region] = voxels_[run];
    (*smallest)[region] = starts_[run];
  }
  return parts;
}

/// Unites runs of two rows, given by their first voxels, that overlap or would overlap after a shift by one
/// voxel along the row.
void Islands::unite_rows(std::size_t here, std::size_t there) {
  const std::size_t here_end = here + width_, there_end = there + width_;
  Index a = run_of(here), b = run_of(there);
  while (starts_[a] < here_end && starts_[b] < there_end) {
    const std::size_t a_from = starts_[a] - here, a_to = starts_[a + 1] - here;
    const std::size_t b_from = starts_[b] - there, b_to = starts_[b + 1] - there;
    if (a_from <= b_to && b_from <= a_to && region_of(a) == region_of(b)) sets_.unite(a, b);
    // If both end together, the next run of each touches the current run of the other.
    if (a_to == b_to) {
      if (a_to < width_ && region_of(a + 1) == region_of(b)) sets_.unite(a + 1, b);
      if (a_to < width_ && region_of(a) == region_of(b + 1)) sets_.unite(a, b + 1);
    }
    if (a_to <= b_to) ++a;
    if (b_to <= a_to) ++b;
  }
}

void Islands::unite_touching() {
  const std::size_t rows = plane_ / width_, planes = regions_.size() / plane_;
  for (std::size_t z = 0; z < planes; ++z) {
    throw_if_stopped();
    for (std::size_t y = 0; y < rows; ++y) {
      const std::size_t row = z * plane_ + y * width_;
      if (y > 0) unite_rows(row, row - width_);
      if (z == 0) continue;
      unite_rows(row, row - plane_);
      if (y > 0) unite_rows(row, row - plane_ - width_);
      if (y + 1 < rows) unite_rows(row, row - plane_ + width_);
    }
  }
}

}  // namespace

std::vector<RegionParts> count_parts(std::vector<RegionIndex>& regions, const std::array<int, 3>& size,
                                     std::size_t count, const Progress* progress) {
  TETWRIGHT_CHECK(!regions.empty() && regions.size() < no_index);
  Islands islands(regions, size, progress);
  std::vector<Index> smallest(count, no_index);
  const std::vector<std::size_t> by_faces = islands.parts(count, &smallest);
  islands.unite_touching();
  const std::vector<std::size_t> touching = islands.parts(count);
  std::vector<RegionParts> parts(count);
  for (std::size_t r = 0; r < count; ++r) parts[r] = {touching[r], by_faces[r], smallest[r]};
  return parts;
}

IslandMerging merge_small_islands(std::vector<RegionIndex>& regions, const std::array<int, 3>& size,
                                  std::size_t min_voxels, const Progress* progress) {
  IslandMerging result;
  if (min_voxels <= 1 || regions.empty()) return result;
  TETWRIGHT_CHECK(regions.size() < no_index);
  Islands islands(regions, size, progress);
  result.islands = islands.islands();
  result.none_reaches = islands.largest() < min_voxels;
  if (!result.none_reaches) result.merged = islands.merge(static_cast<Index>(min_voxels));
  return result;
}

}  // namespace tetwright
