// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/connected_components.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "common/mesh/disjoint_sets.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Numbers of voxels end here.
constexpr Index many_voxels = std::numeric_limits<Index>::max();

Index sum_of_voxels(Index a, Index b) { return a > many_voxels - b ? many_voxels : a + b; }

/// A run, with its set and its number of voxels; if all of them are small islands, with what merging them
/// needs.
constexpr double bytes_per_run = 50;

/// The runs of a volume: consecutive equal voxels along the first axis, in the order of their voxels.
struct Runs {
  Runs(const RegionGrid& regions, const Progress* progress);

  std::uint64_t count = 0;
  std::vector<Index> of_rows;          ///< first run of each row, then `count`; empty if too many
  std::vector<Index> starts;           ///< by run: its first voxel along the row; then 0
  std::vector<RegionIndex> of_region;  ///< by run
};

Runs::Runs(const RegionGrid& regions, const Progress* progress) {
  const auto width = static_cast<std::size_t>(regions.size()[0]);
  const auto rows = static_cast<std::size_t>(regions.size()[1]);
  const auto slices = static_cast<std::size_t>(regions.size()[2]);
  /// Calls `body(row, x, region)` for each run of the volume; rows of different slices concurrently.
  const auto for_each_run = [&](const auto& body) {
    parallel_for(0, slices, 1, [&](std::size_t begin, std::size_t end) {
      std::vector<RegionIndex> slice(width * rows);
      for (std::size_t z = begin; z < end; ++z) {
        if (progress) progress->throw_if_stopped();
        regions.read_slices(static_cast<int>(z), static_cast<int>(z + 1), slice);
        for (std::size_t y = 0; y < rows; ++y) {
          const RegionIndex* const r = slice.data() + y * width;
          for (std::size_t x = 0; x < width; ++x)
            if (x == 0 || r[x] != r[x - 1]) body(z * rows + y, static_cast<Index>(x), r[x]);
        }
      }
    });
  };
  of_rows.assign(rows * slices + 1, 0);
  for_each_run([&](std::size_t row, Index, RegionIndex) { ++of_rows[row]; });
  for (const Index n : of_rows) count += n;
  if (count >= no_index) {
    of_rows.clear();
    return;
  }
  require_memory(bytes_per_run * static_cast<double>(count),
                 "looking for islands in " + std::to_string(count) + " runs of voxels",
                 "give --min-voxels 0 and fewer --labels, or crop the volume");
  Index first = 0;
  for (Index& n : of_rows) first += std::exchange(n, first);
  starts.resize(count + 1, 0);
  of_region.resize(count);
  std::vector<Index> next(of_rows.begin(), of_rows.end() - 1);
  for_each_run([&](std::size_t row, Index x, RegionIndex region) {
    const Index run = next[row]++;
    starts[run] = x;
    of_region[run] = region;
  });
}

/// The islands of a volume, as sets of runs. Runs are numbered in the order of their voxels, so the first run
/// of an island contains its lowest voxel.
class Islands {
 public:
  /// \pre there are not too many runs
  /// \param touching whether islands touch in edges and corners, too
  Islands(Runs runs, const VoxelIndex& size, bool touching, const Progress* progress)
      : runs_(std::move(runs)),
        width_(static_cast<Index>(size[0])),
        rows_(static_cast<std::size_t>(size[1])),
        slices_(static_cast<std::size_t>(size[2])),
        progress_(progress),
        sets_(runs_.count) {
    unite_neighbours(touching);
  }

  /// Counts islands and their voxels: by faces, or after unite_touching().
  void count_voxels();

  std::size_t islands() const { return islands_; }
  Index largest() const { return largest_; }
  /// \param regions receives the regions of merged islands
  std::vector<MergedIsland> merge(Index min_voxels, RegionGrid& regions, std::vector<JoinedIslands>& joined);
  /// The number of islands of each region, without islands of the outside that reach the border.
  std::vector<std::size_t> parts(std::size_t regions, std::vector<std::uint64_t>* smallest = nullptr);
  /// Unites islands of one region that touch in an edge or a corner.
  void unite_touching();

 private:
  void unite_neighbours(bool touching);
  void unite_rows(std::size_t row, std::size_t other, bool touching);
  void unite_slices(std::size_t z, bool touching);
  bool at_border(std::size_t row, Index run) const;
  void enlarge_outside(Index min_voxels);
  void list_small(Index min_voxels);
  void collect_runs(Index island);
  RegionIndex max_shared();
  void join(Index a, Index b, Index min_voxels);
  void throw_if_stopped() const {
    if (progress_) progress_->throw_if_stopped();
  }

  Index count() const { return static_cast<Index>(runs_.count); }
  Index start(Index run) const { return runs_.starts[run]; }
  /// The voxel after the last one, along the row.
  Index end(Index run) const {
    const Index next = runs_.starts[run + 1];
    return next == 0 ? width_ : next;
  }
  RegionIndex region_of(Index run) const { return runs_.of_region[run]; }
  std::size_t row_of(Index run) const {
    return static_cast<std::size_t>(std::upper_bound(runs_.of_rows.begin(), runs_.of_rows.end(), run) -
                                    runs_.of_rows.begin() - 1);
  }
  std::uint64_t first_voxel(Index run) const { return std::uint64_t{row_of(run)} * width_ + start(run); }

  /// Calls `body(row, run)` for all runs in order.
  template <class Body>
  void for_each_run(Body&& body) const {
    for (std::size_t row = 0; row + 1 < runs_.of_rows.size(); ++row)
      for (Index run = runs_.of_rows[row]; run < runs_.of_rows[row + 1]; ++run) body(row, run);
  }

  /// Calls `body(run)` for all runs with a voxel that touches one of a run, at least in a corner.
  template <class Body>
  void for_each_touching(Index run, Body&& body) const {
    const std::size_t row = row_of(run), y = row % rows_, z = row / rows_;
    const Index from = start(run) == 0 ? 0 : start(run) - 1, to = std::min(width_, end(run) + 1);
    for (std::size_t k = z == 0 ? 0 : z - 1; k < std::min(slices_, z + 2); ++k)
      for (std::size_t j = y == 0 ? 0 : y - 1; j < std::min(rows_, y + 2); ++j)
        for (Index other = run_at(k * rows_ + j, from);
             other < runs_.of_rows[k * rows_ + j + 1] && start(other) < to; ++other)
          if (other != run) body(other);
  }
  /// The run of a row that has a voxel.
  Index run_at(std::size_t row, Index x) const {
    const auto first = runs_.starts.begin() + runs_.of_rows[row];
    const auto last = runs_.starts.begin() + runs_.of_rows[row + 1];
    return static_cast<Index>(std::upper_bound(first, last, x) - runs_.starts.begin() - 1);
  }

  /// Calls `body(run, faces)` for all runs that share voxel faces with a run.
  template <class Body>
  void for_each_contact(Index run, Body&& body) const {
    const std::size_t row = row_of(run), y = row % rows_, z = row / rows_;
    const Index from = start(run), to = end(run);
    if (from > 0) body(run - 1, Index{1});
    if (to < width_) body(run + 1, Index{1});
    const auto visit = [&](std::size_t other) {
      for (Index at = run_at(other, from); at < runs_.of_rows[other + 1] && start(at) < to; ++at)
        body(at, std::min(end(at), to) - std::max(start(at), from));
    };
    if (y > 0) visit(row - 1);
    if (y + 1 < rows_) visit(row + 1);
    if (z > 0) visit(row - rows_);
    if (z + 1 < slices_) visit(row + rows_);
  }

  Runs runs_;
  Index width_;                ///< voxels of a row
  std::size_t rows_, slices_;  ///< rows of a slice
  const Progress* progress_;
  DisjointSets sets_;          ///< of runs
  std::vector<Index> voxels_;  ///< at the root of each island
  std::size_t islands_ = 0;
  Index largest_ = 0;
  std::vector<Index> next_;              ///< another run of the same small island, in a ring
  std::vector<Index> small_;             ///< roots of small islands, ascending
  std::vector<Index> island_runs_;       ///< of the island being merged
  std::vector<std::uint64_t> faces_;     ///< by region, 0 between uses
  std::vector<RegionIndex> neighbours_;  ///< regions with faces
};

/// Unites the runs of two rows that overlap, or with `touching` also those that would after a shift by one
/// voxel along the row.
void Islands::unite_rows(std::size_t row, std::size_t other, bool touching) {
  Index a = runs_.of_rows[row], b = runs_.of_rows[other];
  const Index a_last = runs_.of_rows[row + 1], b_last = runs_.of_rows[other + 1];
  while (a < a_last && b < b_last) {
    if (region_of(a) == region_of(b)) sets_.unite(a, b);
    const Index a_end = end(a), b_end = end(b);
    // If both end together, the next run of each touches the current run of the other.
    if (touching && a_end == b_end && a_end < width_) {
      if (region_of(a + 1) == region_of(b)) sets_.unite(a + 1, b);
      if (region_of(a) == region_of(b + 1)) sets_.unite(a, b + 1);
    }
    if (a_end <= b_end) ++a;
    if (b_end <= a_end) ++b;
  }
}

/// Unites the runs of a slice with those of the slice before it.
void Islands::unite_slices(std::size_t z, bool touching) {
  for (std::size_t y = 0; y < rows_; ++y) {
    const std::size_t row = z * rows_ + y;
    unite_rows(row, row - rows_, touching);
    if (touching && y > 0) unite_rows(row, row - rows_ - 1, true);
    if (touching && y + 1 < rows_) unite_rows(row, row - rows_ + 1, true);
  }
}

void Islands::unite_neighbours(bool touching) {
  const std::size_t slabs = std::min<std::size_t>(slices_, 4 * thread_count());
  const auto slab_begin = [&](std::size_t slab) { return slab * slices_ / slabs; };
  // The smaller root wins, so slabs are independent until they are joined.
  parallel_for(0, slabs, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t slab = first; slab < last; ++slab)
      for (std::size_t z = slab_begin(slab); z < slab_begin(slab + 1); ++z) {
        throw_if_stopped();
        for (std::size_t row = z * rows_ + 1; row < (z + 1) * rows_; ++row)
          unite_rows(row, row - 1, touching);
        if (z > slab_begin(slab)) unite_slices(z, touching);
      }
  });
  for (std::size_t slab = 1; slab < slabs; ++slab) unite_slices(slab_begin(slab), touching);
}

void Islands::count_voxels() {
  voxels_.assign(count(), 0);
  islands_ = 0;
  largest_ = 0;
  for (Index run = 0; run < count(); ++run) {
    const Index root = sets_.root(run);
    islands_ += root == run;
    voxels_[root] = sum_of_voxels(voxels_[root], end(run) - start(run));
    largest_ = std::max(largest_, voxels_[root]);
  }
}

/// Finds the small islands and links the runs of each.
void Islands::list_small(Index min_voxels) {
  next_.resize(count());
  for (Index run = 0; run < count(); ++run) {
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
    for_each_contact(run, [&](Index other, Index faces) {
      const RegionIndex r = region_of(other);
      if (r == own) return;
      if (faces_[r] == 0) neighbours_.push_back(r);
      faces_[r] += faces;
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
  const Index total = sum_of_voxels(voxels_[a], voxels_[b]);
  // Swapping successors joins two rings. Large islands need no ring.
  if (total < min_voxels) std::swap(next_[a], next_[b]);
  sets_.unite(a, b);
  voxels_[sets_.root(a)] = total;
}

/// Axes with a single voxel have no border, since a slice is an image.
bool Islands::at_border(std::size_t row, Index run) const {
  const auto first_or_last = [](std::size_t at, std::size_t n) { return n > 1 && (at == 0 || at + 1 == n); };
  return (width_ > 1 && (start(run) == 0 || end(run) == width_)) || first_or_last(row % rows_, rows_) ||
         first_or_last(row / rows_, slices_);
}

/// Counts islands of the outside that touch the border as large: they continue beyond it.
void Islands::enlarge_outside(Index min_voxels) {
  for_each_run([&](std::size_t row, Index run) {
    if (region_of(run) != outside_region || !at_border(row, run)) return;
    Index& voxels = voxels_[sets_.root(run)];
    voxels = std::max(voxels, min_voxels);
  });
}

std::vector<MergedIsland> Islands::merge(Index min_voxels, RegionGrid& regions,
                                         std::vector<JoinedIslands>& joined) {
  enlarge_outside(min_voxels);
  list_small(min_voxels);
  std::vector<MergedIsland> merged;
  merged.reserve(small_.size());
  for (Index island : small_) {
    const RegionIndex region = region_of(island);
    merged.push_back({first_voxel(island), voxels_[island], region, region});
  }
  faces_.assign(on_interface + std::size_t{1}, 0);

  // The smallest island is on top; ties go to the lowest voxel.
  using Entry = std::pair<Index, Index>;  // voxels, island
  std::vector<Entry> entries;
  entries.reserve(small_.size());
  for (Index island : small_) entries.emplace_back(voxels_[island], island);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue({}, std::move(entries));
  std::vector<Index> changed;  // runs
  for (std::size_t step = 0; !queue.empty(); ++step) {
    if (step % 4096 == 0) throw_if_stopped();
    const Index count = queue.top().first, island = queue.top().second;
    queue.pop();
    // Skip an island that has grown since it was queued or was merged into another one.
    if (!sets_.is_root(island) || voxels_[island] != count) continue;
    collect_runs(island);
    const RegionIndex region = max_shared();
    for (Index run : island_runs_) runs_.of_region[run] = region;
    changed.insert(changed.end(), island_runs_.begin(), island_runs_.end());
    // The smallest island comes first, so it never joins a smaller one and its size at least doubles. A voxel
    // is therefore visited at most log2(min_voxels) times.
    Index large = no_index;  // root of the first island it touches that is not small
    for (Index run : island_runs_)
      for_each_touching(run, [&](Index other) {
        if (region_of(other) != region) return;
        const Index root = sets_.root(other);
        if (root != sets_.root(run) && voxels_[root] >= min_voxels) {
          if (large != no_index) joined.push_back({region, first_voxel(island)});
          large = root;
        }
        join(run, other, min_voxels);
      });
    const Index root = sets_.root(island);
    if (region == outside_region && std::any_of(island_runs_.begin(), island_runs_.end(),
                                                [&](Index run) { return at_border(row_of(run), run); }))
      voxels_[root] = std::max(voxels_[root], min_voxels);
    if (voxels_[root] < min_voxels) queue.emplace(voxels_[root], root);
  }
  for (const Index run : changed) {
    const std::size_t row = row_of(run);
    regions.fill({static_cast<int>(start(run)), static_cast<int>(row % rows_), static_cast<int>(row / rows_)},
                 static_cast<int>(end(run) - start(run)), region_of(run));
  }
  for (std::size_t i = 0; i < merged.size(); ++i) merged[i].to = region_of(small_[i]);
  std::erase_if(merged, [](const MergedIsland& m) { return m.from == m.to; });
  return merged;
}

std::vector<std::size_t> Islands::parts(std::size_t regions, std::vector<std::uint64_t>* smallest) {
  // The mesh of a slice ends above and below it, and so does the outside.
  const bool slice = width_ == 1 || rows_ == 1 || slices_ == 1;
  std::vector<std::uint8_t> reaches_border(count(), 0);
  for_each_run([&](std::size_t row, Index run) {
    if (region_of(run) == outside_region && (slice || at_border(row, run)))
      reaches_border[sets_.root(run)] = 1;
  });
  std::vector<std::size_t> parts(regions, 0);
  std::vector<Index> min_sizes(regions, 0), runs(regions, no_index);  // of the smallest parts
  for (Index run = 0; run < count(); ++run) {
    if (!sets_.is_root(run) || reaches_border[run]) continue;
    const RegionIndex region = region_of(run);
    ++parts[region];
    if (runs[region] != no_index && voxels_[run] >= min_sizes[region]) continue;
    min_sizes[region] = voxels_[run];
    runs[region] = run;
  }
  for (std::size_t r = 0; smallest && r < regions; ++r)
    if (runs[r] != no_index) (*smallest)[r] = first_voxel(runs[r]);
  return parts;
}

void Islands::unite_touching() {
  for (std::size_t z = 0; z < slices_; ++z) {
    throw_if_stopped();
    for (std::size_t row = z * rows_ + 1; row < (z + 1) * rows_; ++row) unite_rows(row, row - 1, true);
    if (z > 0) unite_slices(z, true);
  }
}

}  // namespace

std::vector<RegionParts> count_parts(const RegionGrid& regions, std::size_t count, const Progress* progress) {
  TETWRIGHT_CHECK(regions.voxels() > 0);
  Runs runs(regions, progress);
  if (runs.of_rows.empty()) return {};
  Islands islands(std::move(runs), regions.size(), false, progress);
  islands.count_voxels();
  std::vector<std::uint64_t> smallest(count, no_voxel);
  const std::vector<std::size_t> by_faces = islands.parts(count, &smallest);
  islands.unite_touching();
  const std::vector<std::size_t> touching = islands.parts(count);
  std::vector<RegionParts> parts(count);
  for (std::size_t r = 0; r < count; ++r) parts[r] = {touching[r], by_faces[r], smallest[r]};
  return parts;
}

IslandMerging merge_small_islands(RegionGrid& regions, std::size_t min_voxels, const Progress* progress) {
  IslandMerging result;
  if (min_voxels <= 1 || regions.voxels() == 0) return result;
  Runs runs(regions, progress);
  result.runs = runs.count;
  if (runs.of_rows.empty()) return result;
  Islands islands(std::move(runs), regions.size(), true, progress);
  islands.count_voxels();
  const auto min = static_cast<Index>(std::min<std::size_t>(min_voxels, many_voxels));
  result.islands = islands.islands();
  result.none_reaches = islands.largest() < min;
  if (!result.none_reaches) result.merged = islands.merge(min, regions, result.joined);
  return result;
}

}  // namespace tetwright
