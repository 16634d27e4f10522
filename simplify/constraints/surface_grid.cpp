#include "simplify/constraints/surface_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/error.h"
#include "common/parallel/parallel.h"

namespace tetwright {

namespace {

constexpr std::size_t triangle_grain = 4096;  ///< triangles a parallel loop hands out at a time

/// Cells that the largest triangle may span along an axis: bounds what one operation has to lock.
constexpr double max_cells_across = 24;

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

Vec3 low_corner(const MeshTriangle& t) { return t.points[0].cwiseMin(t.points[1]).cwiseMin(t.points[2]); }
Vec3 high_corner(const MeshTriangle& t) { return t.points[0].cwiseMax(t.points[1]).cwiseMax(t.points[2]); }

}  // namespace

SurfaceGrid::Cell3 SurfaceGrid::cell_at(const Vec3& p) const {
  const auto axis = [&](int i) {
    // Clamped: a point far outside the box it was built for still has a cell.
    return static_cast<std::int32_t>(std::floor(std::clamp((p[i] - origin_[i]) * to_cell_, -1e9, 1e9)));
  };
  return {axis(0), axis(1), axis(2)};
}

std::uint32_t SurfaceGrid::slot(const Cell3& c) const {
  std::uint64_t h = static_cast<std::uint32_t>(c.x) * 0x9e3779b97f4a7c15u;
  h = (h ^ (h >> 29) ^ static_cast<std::uint32_t>(c.y)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 31) ^ static_cast<std::uint32_t>(c.z)) * 0x94d049bb133111ebu;
  return static_cast<std::uint32_t>(h >> 32) & mask_;
}

template <class F>
void SurfaceGrid::for_cells(const MeshTriangle& t, const F& f) const {
  const Cell3 low = cell_at(low_corner(t)), high = cell_at(high_corner(t));
  for (std::int32_t x = low.x; x <= high.x; ++x)
    for (std::int32_t y = low.y; y <= high.y; ++y)
      for (std::int32_t z = low.z; z <= high.z; ++z) f(Cell3{x, y, z});
}

void SurfaceGrid::build(const EditableMesh& mesh, double min_cell, std::size_t spare) {
  mesh_ = &mesh;
  {
    const std::vector<InterfaceFace> faces = mesh.interface_faces();
    records_.resize(faces.size());
    parallel_for(0, faces.size(), triangle_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        MeshTriangle& triangle = records_[i];
        triangle.ids = faces[i].ids;
        for (int k = 0; k < 3; ++k) {
          triangle.points[k] = mesh.position(triangle.ids[k]);
          triangle.ids[k] = mesh.original(triangle.ids[k]);
        }
        sort_ids(triangle);
      }
    });
  }
  Vec3 low = Vec3::Zero();
  double sum = 0, largest = 0;
  bool first = true;
  for (const MeshTriangle& t : records_) {
    const Vec3 a = low_corner(t);
    const double extent = (high_corner(t) - a).maxCoeff();
    low = first ? a : low.cwiseMin(a);
    first = false;
    sum += extent;
    largest = std::max(largest, extent);
  }
  // Twice the mean extent: a triangle touches few cells, and a cell lists few triangles, also when they have
  // grown.
  const double mean = records_.empty() ? 1 : sum / static_cast<double>(records_.size());
  const double size = std::max({2 * mean, largest / max_cells_across, min_cell});
  origin_ = low;
  to_cell_ = size > 0 ? 1 / size : 1;
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(64, records_.size() / 2));
  mask_ = static_cast<std::uint32_t>(slots - 1);
  cells_.clear();
  cells_.resize(slots);
  locks_.reset(slots);
  parallel_for(0, records_.size(), triangle_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for_cells(records_[i], [&](const Cell3& c) {
        const std::uint32_t s = slot(c);
        while (!locks_.try_lock(s)) {  // for the few instructions that another thread needs to append
        }
        auto& list = cells_[s];
        const auto record = static_cast<std::uint32_t>(i);
        if (std::find(list.begin(), list.end(), record) == list.end()) list.push_back(record);
        locks_.unlock(s);
      });
  });
  next_spare_ = records_.size();
  records_.resize(records_.size() + spare);
}

bool SurfaceGrid::hits_standing(const MeshTriangle& t, const Workspace& ws) const {
  const Vec3 low = low_corner(t), high = high_corner(t);
  bool hit = false;
  for_cells(t, [&](const Cell3& c) {
    if (hit) return;
    for (std::uint32_t i : cells_[slot(c)]) {
      const MeshTriangle& other = records_[i];
      const Vec3 common_low = low.cwiseMax(low_corner(other)),
                 common_high = high.cwiseMin(high_corner(other));
      if ((common_low.array() > common_high.array()).any()) continue;
      // A pair that shares several cells is tested in the one that holds the low corner of the common box.
      if (!(cell_at(common_low) == c)) continue;
      if (std::find(ws.removed_records.begin(), ws.removed_records.end(), i) != ws.removed_records.end())
        continue;
      if (triangles_intersect(t, other)) {
        hit = true;
        return;
      }
    }
  });
  return hit;
}

Outcome SurfaceGrid::begin_edit(Edit& edit, Workspace& ws, HeldLocks& held) {
  ws.cells.clear();
  ws.removed_records.clear();
  for (auto* list : {&edit.removed, &edit.added})
    for (MeshTriangle& t : *list) {
      for (Index& id : t.ids) id = mesh_->original(id);
      sort_ids(t);
      for_cells(t, [&](const Cell3& c) { ws.cells.push_back(slot(c)); });
    }
  std::sort(ws.cells.begin(), ws.cells.end());
  ws.cells.erase(std::unique(ws.cells.begin(), ws.cells.end()), ws.cells.end());
  for (std::uint32_t c : ws.cells)
    if (!held.try_lock(c)) return Outcome::lock_taken;
  for (const MeshTriangle& t : edit.removed) {
    const auto& list = cells_[slot(cell_at(low_corner(t)))];
    const auto it =
        std::find_if(list.begin(), list.end(), [&](std::uint32_t i) { return records_[i].ids == t.ids; });
    TETWRIGHT_CHECK(it != list.end());
    ws.removed_records.push_back(*it);
  }
  for (const MeshTriangle& t : edit.added)
    if (hits_standing(t, ws)) return Outcome::self_intersection;
  for (std::size_t i = 0; i < edit.added.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (triangles_intersect(edit.added[i], edit.added[j])) return Outcome::self_intersection;
  while (ws.free_records.size() + edit.removed.size() < edit.added.size()) {
    const std::size_t record = next_spare_.fetch_add(1, std::memory_order_relaxed);
    if (record >= records_.size()) {
      next_spare_.store(records_.size(), std::memory_order_relaxed);
      return Outcome::no_room;
    }
    ws.free_records.push_back(static_cast<std::uint32_t>(record));
  }
  return Outcome::done;
}

void SurfaceGrid::commit(const Edit& edit, Workspace& ws) {
  for (std::size_t k = 0; k < edit.removed.size(); ++k) {
    const std::uint32_t record = ws.removed_records[k];
    for_cells(edit.removed[k], [&](const Cell3& c) {
      auto& list = cells_[slot(c)];
      const auto it = std::find(list.begin(), list.end(), record);
      if (it == list.end()) return;  // two cells of one triangle may share a slot
      *it = list.back();
      list.pop_back();
    });
    ws.free_records.push_back(record);
  }
  for (const MeshTriangle& t : edit.added) {
    TETWRIGHT_CHECK(!ws.free_records.empty());  // begin_edit() saw to it
    const std::uint32_t record = ws.free_records.back();
    ws.free_records.pop_back();
    records_[record] = t;
    for_cells(t, [&](const Cell3& c) {
      auto& list = cells_[slot(c)];
      if (std::find(list.begin(), list.end(), record) == list.end()) list.push_back(record);
    });
  }
}

std::vector<MeshTriangle> SurfaceGrid::triangles() const {
  std::vector<std::uint32_t> seen;
  for (const auto& list : cells_) seen.insert(seen.end(), list.begin(), list.end());
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  std::vector<MeshTriangle> out;
  for (std::uint32_t i : seen) out.push_back(records_[i]);
  return out;
}

}  // namespace tetwright
