// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/surface_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "common/parallel/parallel_sort.h"
#include "simplify/constraints/surface_samples.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;
using Grid = SimplifyTuning::Grid;

void sort_ids(MeshTriangle& t) {
  const auto order = [&](int i, int j) {
    if (t.ids[i] > t.ids[j]) {
      std::swap(t.ids[i], t.ids[j]);
      std::swap(t.points[i], t.points[j]);
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
}

auto with_record(std::uint32_t record) {
  return [record](const auto& entry) { return entry.record == record; };
}

Vec3 low_corner(const MeshTriangle& t) { return t.points[0].cwiseMin(t.points[1]).cwiseMin(t.points[2]); }
Vec3 high_corner(const MeshTriangle& t) { return t.points[0].cwiseMax(t.points[1]).cwiseMax(t.points[2]); }

/// The common edge of two triangles, by its ends, if they are nearly folded together there.
std::optional<std::array<Index, 2>> narrow_edge(const MeshTriangle& f, const MeshTriangle& g) {
  std::array<int, 2> shared{};
  int count = 0, apex_f = -1, apex_g = 3;
  for (int i = 0; i < 3; ++i) {
    const auto at = std::find(g.ids.begin(), g.ids.end(), f.ids[i]);
    if (at == g.ids.end()) {
      apex_f = i;
      continue;
    }
    if (count < 2) shared[count] = i;
    ++count;
    apex_g -= static_cast<int>(at - g.ids.begin());
  }
  if (count != 2) return {};
  const Vec3 &a = f.points[shared[0]], along = (f.points[shared[1]] - a).normalized();
  const auto across = [&](const Vec3& apex) { return Vec3(apex - a - along * along.dot(apex - a)); };
  const Vec3 x = across(f.points[apex_f]), y = across(g.points[apex_g]);
  if (x.dot(y) < Grid::min_narrow_cosine * std::sqrt(x.squaredNorm() * y.squaredNorm())) return {};
  return std::array{f.ids[shared[0]], f.ids[shared[1]]};
}

}  // namespace

SurfaceGrid::Box SurfaceGrid::box_of(const Vec3& low, const Vec3& high) {
  Box box;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::nextafter(static_cast<float>(low[k]), -infinity);
    box.high[k] = std::nextafter(static_cast<float>(high[k]), infinity);
  }
  return box;
}

SurfaceGrid::Cell3 SurfaceGrid::smallest_cell_at(const Vec3& p) const {
  const auto axis = [&](int i) {
    // Clamp, so that a point far outside the grid's initial box still has a cell.
    return static_cast<std::int32_t>(std::floor(std::clamp((p[i] - origin_[i]) * to_cell_, -1e9, 1e9)));
  };
  return {axis(0), axis(1), axis(2)};
}

SurfaceGrid::CellRange SurfaceGrid::range_of(const MeshTriangle& t) const {
  return {smallest_cell_at(low_corner(t)), smallest_cell_at(high_corner(t))};
}

/// The lowest level whose cells are at least as large as the triangle, or the top one.
int SurfaceGrid::level_of(const MeshTriangle& t) const {
  const double cells = (high_corner(t) - low_corner(t)).maxCoeff() * to_cell_;
  return cells < 1 ? 0 : std::min(std::ilogb(cells) / 2 + 1, top_level_);
}

std::uint32_t SurfaceGrid::slot(const Cell3& c, int level) const {
  std::uint64_t h =
      (static_cast<std::uint32_t>(c.x) + (static_cast<std::uint64_t>(level) << 32)) * 0x9e3779b97f4a7c15u;
  h = (h ^ (h >> 29) ^ static_cast<std::uint32_t>(c.y)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 31) ^ static_cast<std::uint32_t>(c.z)) * 0x94d049bb133111ebu;
  return static_cast<std::uint32_t>(h >> 32) & mask_;
}

template <class F>
void SurfaceGrid::for_cells(const CellRange& range, int level, const F& f) {
  const Cell3 low = range.low.at_level(level), high = range.high.at_level(level);
  for (std::int32_t x = low.x; x <= high.x; ++x)
    for (std::int32_t y = low.y; y <= high.y; ++y)
      for (std::int32_t z = low.z; z <= high.z; ++z) f(Cell3{x, y, z});
}

void SurfaceGrid::build(const EditableMesh& mesh) {
  mesh_ = &mesh;
  patches_.clear();
  {
    const std::vector<InterfaceFace> faces = mesh.interface_faces();
    records_.resize(faces.size());
    if (std::any_of(faces.begin(), faces.end(), [](const InterfaceFace& f) { return f.patch != 0; }))
      patches_.resize(faces.size());
    parallel_for(0, faces.size(), Grains::surface_triangles, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        MeshTriangle& triangle = records_[i];
        triangle.ids = faces[i].ids;
        for (int k = 0; k < 3; ++k) {
          triangle.points[k] = mesh.position(triangle.ids[k]);
          triangle.ids[k] = mesh.original(triangle.ids[k]);
        }
        sort_ids(triangle);
        if (!patches_.empty()) patches_[i] = faces[i].patch;
      }
    });
  }
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  double smallest = HUGE_VAL;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const Vec3 a = low_corner(records_[i]), b = high_corner(records_[i]);
    low = i == 0 ? a : low.cwiseMin(a);
    high = i == 0 ? b : high.cwiseMax(b);
    smallest = std::min(smallest, (b - a).maxCoeff());
  }
  const double all = (high - low).maxCoeff();
  smallest = std::max(smallest, std::ldexp(all, -Grid::max_ratio));
  origin_ = low;
  to_cell_ = all > 0 ? 1 / (Grid::smallest_cell * smallest) : 1;
  // A cell of the top level is as large as the whole surface.
  top_level_ = all * to_cell_ < 1 ? 0 : std::ilogb(all * to_cell_) / 2 + 1;
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(64, records_.size() / 2));
  mask_ = static_cast<std::uint32_t>(slots - 1);
  cells_.clear();
  cells_.resize(slots);
  free_records_.reset(records_.size(), records_.size());
  parallel_for(0, records_.size(), Grains::surface_triangles, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) insert(static_cast<std::uint32_t>(i));
  });
}

void SurfaceGrid::rebuild(const EditableMesh& mesh, const std::vector<Index>& new_points) {
  if (!samples_) {
    build(mesh);
    return;
  }
  struct Known {
    Triangle ids;
    std::uint32_t record;
  };
  const auto by_ids = [](const Known& a, const Known& b) { return a.ids < b.ids; };
  std::vector<Known> before;
  for (const std::uint32_t record : records_in_use()) {
    Triangle ids = records_[record].ids;
    for (Index& p : ids) p = new_points[p];
    std::sort(ids.begin(), ids.end());
    before.push_back({ids, record});
  }
  const std::size_t old_records = records_.size();
  build(mesh);
  std::vector<Known> after(records_.size());
  for (std::uint32_t i = 0; i < records_.size(); ++i) after[i] = {records_[i].ids, i};
  parallel_sort(before, by_ids);
  parallel_sort(after, by_ids);
  TETWRIGHT_CHECK(before.size() == after.size());
  std::vector<std::uint32_t> new_record(old_records, SurfaceSamples::none);
  for (std::size_t i = 0; i < before.size(); ++i) {
    TETWRIGHT_CHECK(before[i].ids == after[i].ids);
    new_record[before[i].record] = after[i].record;
  }
  samples_->renumber(new_record, records_.size());
}

void SurfaceGrid::reserve_twice() {
  records_.reserve(2 * records_.size());
  patches_.reserve(2 * patches_.size());
}

void SurfaceGrid::insert(std::uint32_t record) {
  const MeshTriangle& t = records_[record];
  const CellRange range = range_of(t);
  const int level = level_of(t);
  const Entry entry{record, level, range.low.at_level(level), box_of(low_corner(t), high_corner(t))};
  for_cells(range, level, [&](const Cell3& c) {
    Cell& cell = cells_[slot(c, level)];
    cell.lock();
    // Two cells that a triangle touches may share a slot.
    if (std::none_of(cell.entries.begin(), cell.entries.end(), with_record(record)))
      cell.entries.push_back(entry);
    cell.unlock();
  });
  for (int above = level + 1; above <= top_level_; ++above)
    for_cells(range, above, [&](const Cell3& c) { cells_[slot(c, above)].set_finer(); });
}

template <class Test>
bool SurfaceGrid::any_in_cell(const Cell3& c, int level, const CellRange& range, const Box& box,
                              const Test& test) const {
  const Cell& cell = cells_[slot(c, level)];
  const Cell3 low = range.low.at_level(level);
  for (const Entry& e : cell.entries)
    // A pair that shares several cells is tested in the cell with the low corner of the intersection of their
    // boxes.
    if (e.level == level && std::max(low.x, e.low.x) == c.x && std::max(low.y, e.low.y) == c.y &&
        std::max(low.z, e.low.z) == c.z && box.meets(e.box) && test(e))
      return true;
  if (level == 0 || !cell.has_finer()) return false;
  const Cell3 first = range.low.at_level(level - 1), last = range.high.at_level(level - 1);
  for (std::int32_t x = std::max(4 * c.x, first.x); x <= std::min(4 * c.x + 3, last.x); ++x)
    for (std::int32_t y = std::max(4 * c.y, first.y); y <= std::min(4 * c.y + 3, last.y); ++y)
      for (std::int32_t z = std::max(4 * c.z, first.z); z <= std::min(4 * c.z + 3, last.z); ++z)
        if (any_in_cell({x, y, z}, level - 1, range, box, test)) return true;
  return false;
}

template <class Test>
bool SurfaceGrid::any_near(const Vec3& low, const Vec3& high, const Test& test) const {
  const CellRange range{smallest_cell_at(low), smallest_cell_at(high)};
  const Box box = box_of(low, high);
  bool found = false;
  for_cells(range, top_level_,
            [&](const Cell3& c) { found = found || any_in_cell(c, top_level_, range, box, test); });
  return found;
}

bool SurfaceGrid::embedded() const {
  std::atomic<bool> meet{false};
  parallel_for(0, records_.size(), Grains::surface_triangles, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !meet.load(std::memory_order_relaxed); ++i) {
      const MeshTriangle& t = records_[i];
      if (any_near(low_corner(t), high_corner(t), [&](const Entry& e) {
            return e.record != i && triangles_intersect(t, records_[e.record]);
          }))
        meet.store(true, std::memory_order_relaxed);
    }
  });
  return !meet;
}

std::uint32_t SurfaceGrid::record_of(const MeshTriangle& t) const {
  const int level = level_of(t);
  const auto& list = cells_[slot(smallest_cell_at(low_corner(t)).at_level(level), level)].entries;
  const auto it =
      std::find_if(list.begin(), list.end(), [&](const Entry& e) { return records_[e.record].ids == t.ids; });
  TETWRIGHT_CHECK(it != list.end());
  return it->record;
}

void SurfaceGrid::find_records(Edit& edit) const {
  const auto prepare = [&](MeshTriangle& t) {
    for (Index& id : t.ids) id = mesh_->original(id);
    sort_ids(t);
  };
  edit.removed_records.clear();
  for (MeshTriangle& t : edit.removed) {
    prepare(t);
    edit.removed_records.push_back(record_of(t));
  }
  for (Added& a : edit.added) prepare(a.triangle);
}

void SurfaceGrid::replace(Edit& edit) {
  find_records(edit);
  take_records(edit);
  commit(edit);
  end_batch();
}

bool SurfaceGrid::test(Edit& edit) const {
  find_records(edit);
  edit.narrow_edges.clear();
  edit.near.clear();
  if (edit.added.empty()) return true;
  for (std::size_t i = 0; i < edit.added.size(); ++i) {
    const Vec3 low = low_corner(edit.added[i].triangle), high = high_corner(edit.added[i].triangle);
    edit.low = i == 0 ? low : edit.low.cwiseMin(low);
    edit.high = i == 0 ? high : edit.high.cwiseMax(high);
  }
  // The added triangles are next to each other: one walk through the grid finds what may meet any of them.
  const auto is_removed = [&](std::uint32_t record) {
    return std::find(edit.removed_records.begin(), edit.removed_records.end(), record) !=
           edit.removed_records.end();
  };
  any_near(edit.low, edit.high, [&](const Entry& e) {
    if (!is_removed(e.record)) edit.near.push_back({e.box, e.record});
    return false;
  });
  const auto may_stay = [&](const MeshTriangle& added, const MeshTriangle& other) {
    if (triangles_intersect(added, other)) return false;
    if (const auto edge = narrow_edge(added, other)) edit.narrow_edges.push_back(*edge);
    return true;
  };
  for (std::size_t i = 0; i < edit.added.size(); ++i) {
    const MeshTriangle& t = edit.added[i].triangle;
    const Box box = box_of(low_corner(t), high_corner(t));
    for (const Edit::Near& other : edit.near)
      if (box.meets(other.box) && !may_stay(t, records_[other.record])) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (!may_stay(t, edit.added[j].triangle)) return false;
  }
  // Sort: the order of a cell's records depends on the threads.
  std::sort(edit.narrow_edges.begin(), edit.narrow_edges.end());
  edit.narrow_edges.erase(std::unique(edit.narrow_edges.begin(), edit.narrow_edges.end()),
                          edit.narrow_edges.end());
  return true;
}

bool SurfaceGrid::apart(const Edit& first, const Edit& second) {
  if ((first.low.array() > second.high.array()).any() || (second.low.array() > first.high.array()).any())
    return true;
  for (const Added& a : first.added)
    for (const Added& b : second.added)
      if (triangles_intersect(a.triangle, b.triangle) || narrow_edge(a.triangle, b.triangle)) return false;
  return true;
}

void SurfaceGrid::take_records(Edit& edit) {
  for (Added& a : edit.added) sort_ids(a.triangle);  // a new point has its final number now
  // Added triangles reuse the records of removed ones.
  const std::size_t reused = std::min(edit.removed.size(), edit.added.size());
  edit.added_records.assign(edit.removed_records.begin(),
                            edit.removed_records.begin() + static_cast<std::ptrdiff_t>(reused));
  for (std::size_t i = reused; i < edit.removed.size(); ++i) free_records_.give_back(edit.removed_records[i]);
  while (edit.added_records.size() < edit.added.size()) {
    if (free_records_.available() == 0) {
      free_records_.grow(1);
      records_.emplace_back();
      if (!patches_.empty()) patches_.push_back(0);
    }
    edit.added_records.push_back(free_records_.take());
  }
  if (samples_) samples_->resize(records_.size());
}

void SurfaceGrid::commit(const Edit& edit) {
  for (std::size_t k = 0; k < edit.removed.size(); ++k) {
    const std::uint32_t record = edit.removed_records[k];
    const int level = level_of(edit.removed[k]);
    for_cells(range_of(edit.removed[k]), level, [&](const Cell3& c) {
      Cell& cell = cells_[slot(c, level)];
      cell.lock();
      auto& list = cell.entries;
      if (const auto it = std::find_if(list.begin(), list.end(), with_record(record)); it != list.end()) {
        *it = list.back();
        list.pop_back();
      }
      cell.unlock();
    });
  }
  for (std::size_t k = 0; k < edit.added.size(); ++k) {
    const std::uint32_t record = edit.added_records[k];
    records_[record] = edit.added[k].triangle;
    if (!patches_.empty()) patches_[record] = edit.added[k].patch;
    insert(record);
  }
  if (samples_) samples_->commit(edit);
}

PatchId SurfaceGrid::patch(const EditableMesh& mesh, const Triangle& ids) const {
  if (!mesh.interface_patches()) return 0;
  MeshTriangle t;
  for (int k = 0; k < 3; ++k) {
    t.points[k] = mesh.position(ids[k]);
    t.ids[k] = mesh.original(ids[k]);
  }
  sort_ids(t);
  return patches_.empty() ? PatchId{0} : patches_[record_of(t)];
}

FacePatches SurfaceGrid::patches() const {
  FacePatches out;
  if (patches_.empty()) return out;
  for (const Cell& cell : cells_)
    for (const Entry& e : cell.entries)
      if (patches_[e.record] != 0) out.emplace(records_[e.record].ids, patches_[e.record]);
  return out;
}

std::vector<std::uint32_t> SurfaceGrid::records_in_use() const {
  std::vector<std::uint32_t> seen;
  for (const Cell& cell : cells_)
    for (const Entry& e : cell.entries) seen.push_back(e.record);
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  return seen;
}

std::vector<MeshTriangle> SurfaceGrid::triangles() const {
  std::vector<MeshTriangle> out;
  for (std::uint32_t i : records_in_use()) out.push_back(records_[i]);
  return out;
}

}  // namespace tetwright
